#include "renderer/materials/bsdf.h"

#include "renderer/math/transcendental.h"

#include <algorithm>
#include <variant>

namespace renderer {

namespace {

constexpr float kOneOverPi = static_cast<float>(1 / kPi);

float strongest(Rgb c)
{
    return std::max({c.r, c.g, c.b});
}

Vec3f mirrored(Vec3f w)
{
    return {-w.x, -w.y, w.z};
}

// 1 - R.V without cancellation: half the squared distance of two unit vectors.
double off_mirror(Vec3f wo, Vec3f wi)
{
    const Vec3d d = to_double(mirrored(wi)) - to_double(wo);
    return 0.5 * dot(d, d);
}

// max(0, R.V)^n
float lobe(const Bsdf& bsdf, Vec3f wo, Vec3f wi)
{
    const double off = off_mirror(wo, wi);
    return off < 1 ? static_cast<float>(power_of_cosine(off, bsdf.shininess)) : 0.0f;
}

Bsdf make_phong(const PhongMaterial& m)
{
    Bsdf bsdf{BsdfKind::phong_normalized, m.diffuse, m.specular, m.ambient, m.shininess, 0};
    // Samples are shared in proportion to what each part reflects of light from everywhere.
    float diffuse_power = strongest(m.diffuse), specular_power = strongest(m.specular);
    if (m.form == PhongForm::classic) {
        bsdf.kind = BsdfKind::phong_classic;
        diffuse_power *= static_cast<float>(kPi);
        specular_power *= static_cast<float>(2 * kPi / (m.shininess + 1));
    }
    const float all = diffuse_power + specular_power;
    bsdf.lobe_share = all > 0 ? specular_power / all : 0;
    return bsdf;
}

} // namespace

Bsdf make_bsdf(const Material& material)
{
    if (const auto* const phong = std::get_if<PhongMaterial>(&material)) return make_phong(*phong);
    Bsdf bsdf;
    bsdf.diffuse = std::get<DiffuseMaterial>(material).color;
    return bsdf;
}

Rgb eval(const Bsdf& bsdf, Vec3f wo, Vec3f wi)
{
    if (!(wi.z > 0)) return {};
    switch (bsdf.kind) {
    case BsdfKind::diffuse:
        return bsdf.diffuse * (wi.z * kOneOverPi);
    case BsdfKind::phong_classic:
        return bsdf.diffuse * wi.z + bsdf.specular * lobe(bsdf, wo, wi);
    case BsdfKind::phong_normalized: {
        const float norm = static_cast<float>((bsdf.shininess + 2) / (2 * kPi));
        return (bsdf.diffuse * kOneOverPi + bsdf.specular * (norm * lobe(bsdf, wo, wi))) * wi.z;
    }
    }
    return {};
}

float pdf(const Bsdf& bsdf, Vec3f wo, Vec3f wi)
{
    const float cosine_part = pdf_cosine_hemisphere(wi.z);
    if (bsdf.lobe_share == 0) return cosine_part;
    const auto lobe_part = static_cast<float>(pdf_power_lobe(off_mirror(wo, wi), bsdf.shininess));
    return (1 - bsdf.lobe_share) * cosine_part + bsdf.lobe_share * lobe_part;
}

BsdfSample sample(const Bsdf& bsdf, Vec3f wo, float u_lobe, Sample2 u)
{
    if (bsdf.kind == BsdfKind::diffuse) {
        const Vec3f wi = sample_cosine_hemisphere(u);
        // The cosine cancels: the weight is the colour, to the bit.
        if (!(wi.z > 0)) return {};
        return {wi, bsdf.diffuse, pdf_cosine_hemisphere(wi.z)};
    }
    const Vec3f wi = u_lobe < bsdf.lobe_share
                         ? Frame(mirrored(wo)).to_world(sample_power_lobe(u, bsdf.shininess))
                         : sample_cosine_hemisphere(u);
    const float density = pdf(bsdf, wo, wi);
    if (!(density > 0)) return {};
    return {wi, eval(bsdf, wo, wi) / density, density};
}

} // namespace renderer
