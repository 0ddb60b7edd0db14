#include "renderer/materials/layers.h"

#include "renderer/color/strongest.h"
#include "renderer/description/material.h"
#include "renderer/materials/facet_albedo.h"
#include "renderer/materials/fresnel.h"
#include "renderer/math/transcendental.h"

#include <algorithm>

namespace renderer {

namespace {

// F(c) <= white + slanted (1 - c)^5 for every cosine.
struct FresnelBound {
    double white, slanted;
};

// Schlick's own above index 1. Below, F rises to 1 at the critical angle: with any cosine c1, F(c) <= F(c1)
// + (1 - F(c1)) where c < c1, which is at most ((1 - c) / (1 - c1))^5. The c1 that bounds the average best
// is taken.
FresnelBound fresnel_bound(double ior, FacetAlbedo average)
{
    const double f0 = normal_reflectance(ior);
    if (ior >= 1) return {f0, 1 - f0};
    FresnelBound best{1, 0};
    constexpr int kPlaces = 32;
    for (int i = 1; i < kPlaces; ++i) {
        const double c1 = static_cast<double>(i) / kPlaces, f1 = fresnel_dielectric(c1, ior);
        const double rest = 1 - c1, rest2 = rest * rest;
        const FresnelBound bound{f1, (1 - f1) / (rest2 * rest2 * rest)};
        if (bound.white * average.white + bound.slanted * average.slanted <
            best.white * average.white + best.slanted * average.slanted)
            best = bound;
    }
    return best;
}

} // namespace

float several_facets(double average_f, double white_average)
{
    return static_cast<float>(average_f * average_f * white_average / (1 - average_f * (1 - white_average)));
}

void put_on_base(Layers& layers, Rgb base, double ior, double roughness, bool compensated)
{
    layers.base = base;
    const FacetAlbedo average = average_facet_albedo(roughness);
    const FresnelBound bound = fresnel_bound(ior, average);
    const double average_f = ior >= 1 ? bound.white + bound.slanted / 21 : average_fresnel_dielectric(ior);
    const float several = compensated ? several_facets(average_f, average.white) : 0;
    layers.white = static_cast<float>(bound.white);
    layers.slanted = static_cast<float>(bound.slanted);
    layers.several_white = several;
    // Where the bound reaches 1 the factor is cut off at 0, and its average is known by no table: 1 is
    // safe.
    const double reaches = ior >= 1 ? 1 - bound.white * average.white - bound.slanted * average.slanted -
                                          static_cast<double>(several) * (1 - average.white)
                                    : 1;
    layers.base_scale = reaches > 0 ? static_cast<float>(1 / (kPi * reaches)) : 0;
}

LayerAlbedo layer_albedo(const Layers& layers, double cosine, double roughness)
{
    const FacetAlbedo facets = facet_albedo(cosine, roughness);
    LayerAlbedo out;
    const auto white = static_cast<float>(facets.white), slanted = static_cast<float>(facets.slanted);
    out.facets = layers.f0 * (white - slanted) + Rgb{slanted, slanted, slanted};
    out.missing = 1 - facets.white;
    out.several = layers.several * static_cast<float>(out.missing);
    if (layers.base_scale > 0) {
        out.to_base = std::max(0.0,
                               1 - static_cast<double>(layers.white) * facets.white -
                                   static_cast<double>(layers.slanted) * facets.slanted -
                                   static_cast<double>(layers.several_white) * out.missing);
        out.base = layers.base * static_cast<float>(out.to_base);
    }
    return out;
}

Rgb below_facets(const Layers& layers, const LayerAlbedo& o, const LayerAlbedo& i)
{
    return layers.several * (static_cast<float>(o.missing * i.missing) * layers.one_over_missing) +
           layers.base * (static_cast<float>(o.to_base * i.to_base) * layers.base_scale);
}

float facet_share(const LayerAlbedo& o)
{
    const float facets = strongest(o.facets), below = strongest(o.several + o.base);
    return facets + below > 0 ? facets / (facets + below) : 1;
}

} // namespace renderer
