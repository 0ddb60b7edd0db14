#include "renderer/materials/bsdf.h"

#include "renderer/materials/conductor.h"
#include "renderer/materials/cook_torrance.h"
#include "renderer/materials/facet_reflection.h"
#include "renderer/materials/glass.h"
#include "renderer/materials/phong.h"
#include "renderer/math/transcendental.h"
#include "renderer/sampling/warp.h"

#include <type_traits>
#include <variant>

namespace renderer {

namespace {

constexpr float kOneOverPi = static_cast<float>(1 / kPi);

Bsdf make(const DiffuseMaterial& m)
{
    Bsdf bsdf;
    bsdf.diffuse = m.color.value;
    return bsdf;
}

Bsdf make(const PhongMaterial& m)
{
    return make_phong(m);
}

Bsdf make(const CookTorranceMaterial& m)
{
    return make_cook_torrance(m);
}

Bsdf make(const MirrorMaterial& m)
{
    return make_mirror(m);
}

Bsdf make(const GlassMaterial& m)
{
    return make_glass(m);
}

Bsdf make(const ConductorMaterial& m)
{
    return make_conductor(m);
}

Bsdf make(const EmitterMaterial& m)
{
    Bsdf bsdf;
    bsdf.kind = BsdfKind::black;
    bsdf.two_sided = m.two_sided;
    bsdf.emission = m.radiance.value;
    return bsdf;
}

// Drawn where a density is: weighed by it.
BsdfSample weighed(const Bsdf& bsdf, Vec3f wo, Vec3f wi)
{
    const BsdfValue value = evaluate(bsdf, wo, wi);
    if (!(value.pdf > 0)) return {};
    return {wi, value.f / value.pdf, value.pdf, false, transmits(bsdf) && wi.z < 0};
}

BsdfSample sample_mirror(const Bsdf& bsdf, Vec3f wo)
{
    if (!(wo.z > 0)) return {};
    return {{-wo.x, -wo.y, wo.z}, mirror_reflectance(bsdf, wo), 1, true, false};
}

} // namespace

Bsdf make_bsdf(const Material& material)
{
    return std::visit(
        [](const auto& m) {
            Bsdf bsdf = make(m);
            if constexpr (requires { m.surface; }) bsdf.two_sided = m.surface.two_sided;
            return bsdf;
        },
        material);
}

bool is_delta_only(const Bsdf& bsdf)
{
    switch (bsdf.kind) {
    case BsdfKind::diffuse:
    case BsdfKind::phong_classic:
    case BsdfKind::phong_normalized:
    case BsdfKind::cook_torrance:
    case BsdfKind::rough_conductor:
        return false;
    case BsdfKind::smooth_cook_torrance:
        return !has_layers(bsdf.layers);
    case BsdfKind::rough_glass:
        return passes_straight(bsdf);
    case BsdfKind::mirror:
    case BsdfKind::glass:
    case BsdfKind::conductor:
    case BsdfKind::black:
        return true;
    }
    return true;
}

bool transmits(const Bsdf& bsdf)
{
    return bsdf.kind == BsdfKind::glass || bsdf.kind == BsdfKind::rough_glass;
}

Rgb eval(const Bsdf& bsdf, Vec3f wo, Vec3f wi)
{
    switch (bsdf.kind) {
    case BsdfKind::diffuse:
        return wi.z > 0 ? bsdf.diffuse * (wi.z * kOneOverPi) : Rgb{};
    case BsdfKind::phong_classic:
    case BsdfKind::phong_normalized:
        return wi.z > 0 ? eval_phong(bsdf, wo, wi) : Rgb{};
    case BsdfKind::rough_glass:
        return evaluate_glass(bsdf, wo, wi).f;
    case BsdfKind::cook_torrance:
        return evaluate_cook_torrance(bsdf, wo, wi).f;
    case BsdfKind::smooth_cook_torrance:
        return evaluate_smooth_cook_torrance(bsdf, wo, wi).f;
    case BsdfKind::rough_conductor:
        return evaluate_conductor(bsdf, wo, wi).f;
    case BsdfKind::mirror:
    case BsdfKind::glass:
    case BsdfKind::conductor:
    case BsdfKind::black:
        return {};
    }
    return {};
}

float pdf(const Bsdf& bsdf, Vec3f wo, Vec3f wi)
{
    return evaluate(bsdf, wo, wi).pdf;
}

BsdfValue evaluate(const Bsdf& bsdf, Vec3f wo, Vec3f wi)
{
    switch (bsdf.kind) {
    case BsdfKind::diffuse:
        return {eval(bsdf, wo, wi), pdf_cosine_hemisphere(wi.z)};
    case BsdfKind::phong_classic:
    case BsdfKind::phong_normalized:
        return {eval(bsdf, wo, wi), pdf_phong(bsdf, wo, wi)};
    case BsdfKind::rough_glass:
        return evaluate_glass(bsdf, wo, wi);
    case BsdfKind::cook_torrance:
        return evaluate_cook_torrance(bsdf, wo, wi);
    case BsdfKind::smooth_cook_torrance:
        return evaluate_smooth_cook_torrance(bsdf, wo, wi);
    case BsdfKind::rough_conductor:
        return evaluate_conductor(bsdf, wo, wi);
    case BsdfKind::mirror:
    case BsdfKind::glass:
    case BsdfKind::conductor:
    case BsdfKind::black:
        return {};
    }
    return {};
}

BsdfSample diffuse_sample(const Bsdf& bsdf, Vec3f drawn)
{
    // The cosine cancels: the weight is the colour, to the bit.
    if (!(drawn.z > 0)) return {};
    return {drawn, bsdf.diffuse, pdf_cosine_hemisphere(drawn.z)};
}

BsdfSample sample(const Bsdf& bsdf, Vec3f wo, float u_lobe, Sample2 u)
{
    switch (bsdf.kind) {
    case BsdfKind::diffuse:
        return diffuse_sample(bsdf, sample_cosine_hemisphere(u));
    case BsdfKind::phong_classic:
    case BsdfKind::phong_normalized:
        return weighed(bsdf, wo, sample_phong(bsdf, wo, u_lobe, u));
    case BsdfKind::mirror:
    case BsdfKind::conductor:
        return sample_mirror(bsdf, wo);
    case BsdfKind::glass:
        return sample_smooth_glass(bsdf, wo, u_lobe);
    case BsdfKind::rough_glass:
        if (passes_straight(bsdf)) return sample_smooth_glass(bsdf, wo, u_lobe);
        return weighed(bsdf, wo, sample_rough_glass(bsdf, wo, u_lobe, u));
    case BsdfKind::smooth_cook_torrance:
        return sample_smooth_cook_torrance(bsdf, wo, u_lobe, u);
    case BsdfKind::cook_torrance:
    case BsdfKind::rough_conductor:
        return weighed(bsdf, wo, sample_facets(bsdf, wo, u_lobe, u));
    case BsdfKind::black:
        return {};
    }
    return {};
}

DeltaLobes delta_lobes(const Bsdf& bsdf, Vec3f wo)
{
    switch (bsdf.kind) {
    case BsdfKind::smooth_cook_torrance: {
        DeltaLobes out;
        if (wo.z > 0)
            out.lobes[out.count++] = {
                {-wo.x, -wo.y, wo.z}, varnish_reflectance(bsdf, static_cast<double>(wo.z)), false};
        return out;
    }
    case BsdfKind::mirror:
    case BsdfKind::conductor: {
        DeltaLobes out;
        const BsdfSample only = sample_mirror(bsdf, wo);
        if (only.pdf > 0) out.lobes[out.count++] = {only.wi, only.weight, false};
        return out;
    }
    case BsdfKind::glass:
    case BsdfKind::rough_glass:
        return delta_lobes_of_glass(bsdf, wo);
    case BsdfKind::diffuse:
    case BsdfKind::phong_classic:
    case BsdfKind::phong_normalized:
    case BsdfKind::cook_torrance:
    case BsdfKind::rough_conductor:
    case BsdfKind::black:
        return {};
    }
    return {};
}

Rgb albedo(const Bsdf& bsdf, Vec3f wo)
{
    switch (bsdf.kind) {
    case BsdfKind::diffuse:
        return bsdf.diffuse;
    case BsdfKind::phong_classic:
    case BsdfKind::phong_normalized:
        return albedo_phong(bsdf);
    case BsdfKind::mirror:
        return bsdf.specular;
    case BsdfKind::glass:
    case BsdfKind::rough_glass:
        return {1, 1, 1}; // what is not reflected passes
    case BsdfKind::conductor:
        return mirror_reflectance(bsdf, wo);
    case BsdfKind::cook_torrance:
    case BsdfKind::smooth_cook_torrance:
    case BsdfKind::rough_conductor:
        return layer_albedo(bsdf.layers, static_cast<double>(wo.z), static_cast<double>(bsdf.roughness))
            .sum();
    case BsdfKind::black:
        return {};
    }
    return {};
}

} // namespace renderer
