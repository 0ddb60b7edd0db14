#include "renderer/materials/conductor.h"

#include "renderer/materials/facet_albedo.h"
#include "renderer/materials/facet_reflection.h"
#include "renderer/materials/fresnel.h"

namespace renderer {

namespace {

// Of the light that meets several facets, by channel.
float several_of(float eta, float k, double white_average)
{
    const double average = average_fresnel_conductor(static_cast<double>(eta), static_cast<double>(k));
    return several_facets(average, white_average);
}

} // namespace

Bsdf make_mirror(const MirrorMaterial& m)
{
    Bsdf bsdf;
    bsdf.kind = BsdfKind::mirror;
    bsdf.specular = m.color.value;
    return bsdf;
}

Bsdf make_conductor(const ConductorMaterial& m)
{
    Bsdf bsdf;
    const ComplexIor ior = complex_ior(m.ior);
    const double roughness = m.roughness.value;
    bsdf.kind = roughness < kSmoothBelow ? BsdfKind::conductor : BsdfKind::rough_conductor;
    bsdf.roughness = static_cast<float>(roughness);
    bsdf.specular = ior.eta;
    bsdf.k = ior.k;
    bsdf.layers.f0 = fresnel_conductor(1, ior.eta, ior.k);
    if (bsdf.kind == BsdfKind::rough_conductor && compensates(m.multiscatter, m.roughness)) {
        const double white = average_facet_albedo(roughness).white;
        bsdf.layers.several = {several_of(ior.eta.r, ior.k.r, white),
                               several_of(ior.eta.g, ior.k.g, white),
                               several_of(ior.eta.b, ior.k.b, white)};
        bsdf.layers.one_over_missing = static_cast<float>(1 / (kPi * (1 - white)));
    }
    return bsdf;
}

Rgb mirror_reflectance(const Bsdf& bsdf, Vec3f wo)
{
    if (bsdf.kind == BsdfKind::mirror) return bsdf.specular;
    return fresnel_conductor(static_cast<double>(wo.z), bsdf.specular, bsdf.k);
}

BsdfValue evaluate_conductor(const Bsdf& bsdf, Vec3f wo, Vec3f wi)
{
    return evaluate_facets(
        bsdf, wo, wi, [&](double cosine) { return fresnel_conductor(cosine, bsdf.specular, bsdf.k); });
}

} // namespace renderer
