#include "renderer/materials/glass.h"

#include "renderer/materials/fresnel.h"
#include "renderer/materials/microfacet.h"

#include <cmath>

namespace renderer {

namespace {

// So near to 1 facets refract by less than a float's step, and reflect less than 1e-10 but at grazing
// angles.
constexpr float kNoBoundary = 1e-5f;

constexpr Rgb kWhite{1, 1, 1};

double alpha_of(const Bsdf& bsdf)
{
    return static_cast<double>(bsdf.roughness) * static_cast<double>(bsdf.roughness);
}

Rgb transmitted_radiance(const Bsdf& bsdf)
{
    return bsdf.diffuse * (1 / (bsdf.eta * bsdf.eta));
}

Vec3f mirrored(Vec3f w)
{
    return {-w.x, -w.y, w.z};
}

// What wo meets: its cosine from the sine where that is small, since a float's cosine near 1 says little of
// the angle.
DielectricBoundary meet(Vec3f wo, double eta)
{
    const Vec3d o = unit_double(wo);
    const double sine2 = o.x * o.x + o.y * o.y;
    return meet_dielectric(sine2 < 0.5 ? std::sqrt(1 - sine2) : o.z, eta);
}

// The way on through a flat boundary.
Vec3f refracted(Vec3f wo, double eta, double cos_transmitted)
{
    const Vec3d o = unit_double(wo);
    return to_float(normalize(Vec3d{-o.x / eta, -o.y / eta, -cos_transmitted}));
}

BsdfValue evaluate_reflection(const Microfacets& facets, double eta, Vec3d o, Vec3d i)
{
    const Vec3d h = o + i;
    const double reflected = fresnel_dielectric(0.5 * length(h), eta);
    const double density = facets.distribution(h) * reflected;
    const double seen = 0.5 / (o.z + facets.slope_length(o.z)); // G1 / (4 cos_o)
    return {kWhite * static_cast<float>(density * facets.visibility(o.z, i.z) * i.z),
            static_cast<float>(density * seen)};
}

BsdfValue evaluate_transmission(const Microfacets& facets, double eta, Rgb passing, Vec3d o, Vec3d i)
{
    // The facet that refracts i to o. Its length is what Walter's denominators square, up to its sign.
    const Vec3d along = o + i * eta;
    const double length2 = dot(along, along);
    if (!(length2 > 0)) return {};
    const Vec3d h = along * ((along.z > 0 ? 1 : -1) / std::sqrt(length2));
    const double o_h = dot(o, h), i_h = -dot(i, h);
    if (!(o_h > 0) || !(i_h > 0)) return {};
    const double passed = 1 - fresnel_dielectric(o_h, eta);
    const double scattered = passed * facets.distribution(h) * o_h * i_h / length2;
    const double cos_i = -i.z;
    const double seen = 2 / (o.z + facets.slope_length(o.z)); // G1 / cos_o
    return {passing * static_cast<float>(4 * scattered * facets.visibility(o.z, cos_i) * cos_i),
            static_cast<float>(scattered * seen * eta * eta)};
}

} // namespace

Bsdf make_glass(const GlassMaterial& m)
{
    Bsdf bsdf;
    const double roughness = m.roughness.value;
    bsdf.kind = roughness < kSmoothBelow ? BsdfKind::glass : BsdfKind::rough_glass;
    bsdf.roughness = static_cast<float>(roughness);
    bsdf.medium = {static_cast<float>(m.ior), m.priority, m.absorption};
    bsdf.eta = bsdf.medium.ior;
    bsdf.diffuse = m.transmission.value;
    return bsdf;
}

bool passes_straight(const Bsdf& bsdf)
{
    return bsdf.kind == BsdfKind::rough_glass ? std::abs(bsdf.eta - 1) < kNoBoundary : bsdf.eta == 1;
}

BsdfValue evaluate_glass(const Bsdf& bsdf, Vec3f wo, Vec3f wi)
{
    if (!(wo.z > 0) || wi.z == 0 || passes_straight(bsdf)) return {};
    const Microfacets facets(alpha_of(bsdf));
    const auto eta = static_cast<double>(bsdf.eta);
    return wi.z > 0 ? evaluate_reflection(facets, eta, unit_double(wo), unit_double(wi))
                    : evaluate_transmission(facets, eta, bsdf.diffuse, unit_double(wo), unit_double(wi));
}

BsdfSample sample_smooth_glass(const Bsdf& bsdf, Vec3f wo, float u_lobe)
{
    const DeltaLobes all = delta_lobes_of_glass(bsdf, wo);
    if (all.count == 0) return {};
    // The lobes' shares add up to 1 but for the factor of radiance: the first one's is its probability.
    const DeltaLobe& first = all.lobes[0];
    if (first.is_transmission) return {first.wi, first.weight, 1, true, true};
    if (all.count == 1) return {first.wi, kWhite, 1, true, false};
    const float reflected = first.weight.r;
    if (u_lobe < reflected) return {first.wi, kWhite, reflected, true, false};
    return {all.lobes[1].wi, transmitted_radiance(bsdf), 1 - reflected, true, true};
}

DeltaLobes delta_lobes_of_glass(const Bsdf& bsdf, Vec3f wo)
{
    DeltaLobes out;
    if (passes_straight(bsdf)) {
        out.lobes[out.count++] = {-wo, bsdf.diffuse, true};
        return out;
    }
    if (bsdf.kind == BsdfKind::rough_glass || !(wo.z > 0)) return out;
    const auto eta = static_cast<double>(bsdf.eta);
    const DielectricBoundary met = meet(wo, eta);
    const auto reflected = static_cast<float>(met.reflected);
    if (reflected > 0) out.lobes[out.count++] = {mirrored(wo), kWhite * reflected, false};
    if (reflected < 1)
        out.lobes[out.count++] = {
            refracted(wo, eta, met.cos_transmitted), transmitted_radiance(bsdf) * (1 - reflected), true};
    return out;
}

Vec3f sample_rough_glass(const Bsdf& bsdf, Vec3f wo, float u_lobe, Sample2 u)
{
    if (!(wo.z > 0)) return {};
    const Vec3d o = unit_double(wo);
    const Vec3d h = sample_visible_facet(alpha_of(bsdf), o, u);
    const auto eta = static_cast<double>(bsdf.eta);
    const double o_h = dot(o, h);
    const DielectricBoundary met = meet_dielectric(o_h, eta);
    const bool reflects = static_cast<double>(u_lobe) < met.reflected;
    const Vec3d wi = reflects ? h * (2 * o_h) - o : (h * o_h - o) / eta - h * met.cos_transmitted;
    // Beyond the horizon light would go on to other facets: it is lost.
    return reflects == (wi.z > 0) ? to_float(wi) : Vec3f{};
}

} // namespace renderer
