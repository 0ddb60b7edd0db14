#include "renderer/materials/cook_torrance.h"

#include "renderer/materials/facet_albedo.h"
#include "renderer/materials/facet_reflection.h"
#include "renderer/materials/fresnel.h"

namespace renderer {

namespace {

constexpr Rgb kWhite{1, 1, 1};

Rgb mixed(Rgb a, Rgb b, float share_of_b)
{
    return a * (1 - share_of_b) + b * share_of_b;
}

// Averages of the Fresnel term: Schlick's over all directions is f0 + (1 - f0) / 21.
double average_f(float f0, float share_below_one, double ior)
{
    const auto schlick = static_cast<double>(f0) * (20.0 / 21) + 1.0 / 21;
    if (share_below_one == 0) return schlick;
    const double own = normal_reflectance(ior) * (20.0 / 21) + 1.0 / 21;
    return schlick + static_cast<double>(share_below_one) * (average_fresnel_dielectric(ior) - own);
}

} // namespace

Bsdf make_cook_torrance(const CookTorranceMaterial& m)
{
    Bsdf bsdf;
    const double roughness = m.roughness.value;
    const auto metallic = static_cast<float>(m.metallic.value);
    const bool compensated = roughness >= kSmoothBelow && compensates(m.multiscatter, m.roughness);
    bsdf.kind = roughness < kSmoothBelow ? BsdfKind::smooth_cook_torrance : BsdfKind::cook_torrance;
    bsdf.roughness = static_cast<float>(roughness);
    bsdf.eta = static_cast<float>(m.ior);
    bsdf.share_below_one = m.ior < 1 ? 1 - metallic : 0;
    Layers& layers = bsdf.layers;
    layers.f0 = mixed(kWhite * static_cast<float>(normal_reflectance(m.ior)), m.base_color.value, metallic);
    if (compensated) {
        const double white = average_facet_albedo(roughness).white;
        const auto several = [&](float f0) {
            return several_facets(average_f(f0, bsdf.share_below_one, m.ior), white);
        };
        layers.several = {several(layers.f0.r), several(layers.f0.g), several(layers.f0.b)};
        layers.one_over_missing = static_cast<float>(1 / (kPi * (1 - white)));
    }
    const Rgb base = m.base_color.value * (1 - metallic);
    if (!is_black(base)) put_on_base(layers, base, m.ior, roughness, compensated);
    return bsdf;
}

Rgb varnish_reflectance(const Bsdf& bsdf, double cosine)
{
    const auto slanted = static_cast<float>(schlick_weight(cosine));
    const Rgb schlick = bsdf.layers.f0 * (1 - slanted) + kWhite * slanted;
    if (bsdf.share_below_one == 0) return schlick;
    const auto ior = static_cast<double>(bsdf.eta);
    const auto own = static_cast<float>(normal_reflectance(ior)) * (1 - slanted) + slanted;
    const auto exact = static_cast<float>(fresnel_dielectric(cosine, ior));
    return schlick + kWhite * (bsdf.share_below_one * (exact - own));
}

BsdfValue evaluate_cook_torrance(const Bsdf& bsdf, Vec3f wo, Vec3f wi)
{
    return evaluate_facets(bsdf, wo, wi, [&](double cosine) { return varnish_reflectance(bsdf, cosine); });
}

BsdfValue evaluate_smooth_cook_torrance(const Bsdf& bsdf, Vec3f wo, Vec3f wi)
{
    if (!(wo.z > 0) || !(wi.z > 0) || !has_layers(bsdf.layers)) return {};
    BsdfValue value;
    add_below_facets(value, bsdf, static_cast<double>(wo.z), static_cast<double>(wi.z));
    return value;
}

BsdfSample sample_smooth_cook_torrance(const Bsdf& bsdf, Vec3f wo, float u_lobe, Sample2 u)
{
    if (!(wo.z > 0)) return {};
    const auto cosine = static_cast<double>(wo.z);
    const float share =
        has_layers(bsdf.layers)
            ? facet_share(layer_albedo(bsdf.layers, cosine, static_cast<double>(bsdf.roughness)))
            : 1;
    if (u_lobe < share)
        return {{-wo.x, -wo.y, wo.z}, varnish_reflectance(bsdf, cosine) / share, share, true, false};
    const Vec3f wi = sample_cosine_hemisphere(u);
    const BsdfValue value = evaluate_smooth_cook_torrance(bsdf, wo, wi);
    if (!(value.pdf > 0)) return {};
    return {wi, value.f / value.pdf, value.pdf, false, false};
}

} // namespace renderer
