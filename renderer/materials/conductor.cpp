#include "renderer/materials/conductor.h"

#include "renderer/materials/fresnel.h"
#include "renderer/materials/microfacet.h"

namespace renderer {

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
    const double roughness = m.roughness.value;
    bsdf.kind = roughness < kSmoothBelow ? BsdfKind::conductor : BsdfKind::rough_conductor;
    bsdf.alpha = static_cast<float>(roughness * roughness);
    bsdf.specular = m.eta;
    bsdf.k = m.k;
    return bsdf;
}

Rgb mirror_reflectance(const Bsdf& bsdf, Vec3f wo)
{
    if (bsdf.kind == BsdfKind::mirror) return bsdf.specular;
    return fresnel_conductor(static_cast<double>(wo.z), bsdf.specular, bsdf.k);
}

BsdfValue evaluate_conductor(const Bsdf& bsdf, Vec3f wo, Vec3f wi)
{
    if (!(wo.z > 0) || !(wi.z > 0)) return {};
    const Vec3d o = unit_double(wo), i = unit_double(wi), h = o + i;
    const Microfacets facets(static_cast<double>(bsdf.alpha));
    const double density = facets.distribution(h);
    const Rgb reflected = fresnel_conductor(0.5 * length(h), bsdf.specular, bsdf.k);
    const double seen = 0.5 / (o.z + facets.slope_length(o.z)); // G1 / (4 cos_o)
    return {reflected * static_cast<float>(density * facets.visibility(o.z, i.z) * i.z),
            static_cast<float>(density * seen)};
}

Vec3f sample_conductor(const Bsdf& bsdf, Vec3f wo, Sample2 u)
{
    if (!(wo.z > 0)) return {};
    const Vec3d o = unit_double(wo);
    const Vec3d h = sample_visible_facet(static_cast<double>(bsdf.alpha), o, u);
    return to_float(h * (2 * dot(o, h)) - o);
}

Rgb albedo_conductor(const Bsdf& bsdf, Vec3f wo)
{
    return fresnel_conductor(static_cast<double>(wo.z), bsdf.specular, bsdf.k);
}

} // namespace renderer
