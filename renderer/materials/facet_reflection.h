// FacetReflection: what conductors and varnished surfaces share: facets that reflect, each by its Fresnel
// term, over layers.h.
#pragma once

#include "renderer/materials/bsdf.h"
#include "renderer/materials/microfacet.h"
#include "renderer/math/transcendental.h"
#include "renderer/sampling/warp.h"

namespace renderer {

inline bool has_layers(const Layers& layers)
{
    return layers.one_over_missing > 0 || layers.base_scale > 0;
}

inline void add_below_facets(BsdfValue& value, const Bsdf& bsdf, double cos_o, double cos_i)
{
    const auto roughness = static_cast<double>(bsdf.roughness);
    const LayerAlbedo o = layer_albedo(bsdf.layers, cos_o, roughness);
    const LayerAlbedo i = layer_albedo(bsdf.layers, cos_i, roughness);
    const auto cosine = static_cast<float>(cos_i);
    const float share = facet_share(o);
    value.f += below_facets(bsdf.layers, o, i) * cosine;
    value.pdf = share * value.pdf + (1 - share) * pdf_cosine_hemisphere(cosine);
}

// `fresnel` of the cosine between facet and ray.
template <typename Fresnel>
BsdfValue evaluate_facets(const Bsdf& bsdf, Vec3f wo, Vec3f wi, const Fresnel& fresnel)
{
    if (!(wo.z > 0) || !(wi.z > 0)) return {};
    const Vec3d o = unit_double(wo), i = unit_double(wi), h = o + i;
    const Microfacets facets(static_cast<double>(bsdf.roughness) * static_cast<double>(bsdf.roughness));
    const double density = facets.distribution(h);
    const double seen = 0.5 / (o.z + facets.slope_length(o.z)); // G1 / (4 cos_o)
    BsdfValue value{fresnel(0.5 * length(h)) *
                        static_cast<float>(density * facets.visibility(o.z, i.z) * i.z),
                    static_cast<float>(density * seen)};
    if (has_layers(bsdf.layers)) add_below_facets(value, bsdf, o.z, i.z);
    return value;
}

// A zero vector where none was drawn.
inline Vec3f sample_facets(const Bsdf& bsdf, Vec3f wo, float u_lobe, Sample2 u)
{
    if (!(wo.z > 0)) return {};
    const auto roughness = static_cast<double>(bsdf.roughness);
    const Vec3d o = unit_double(wo);
    if (has_layers(bsdf.layers) && u_lobe >= facet_share(layer_albedo(bsdf.layers, o.z, roughness)))
        return sample_cosine_hemisphere(u);
    const Vec3d h = sample_visible_facet(roughness * roughness, o, u);
    return to_float(h * (2 * dot(o, h)) - o);
}

} // namespace renderer
