#include "renderer/materials/phong.h"

#include "renderer/color/strongest.h"
#include "renderer/math/transcendental.h"
#include "renderer/sampling/warp.h"

#include <algorithm>

namespace renderer {

namespace {

constexpr float kOneOverPi = static_cast<float>(1 / kPi);

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

} // namespace

Bsdf make_phong(const PhongMaterial& m)
{
    Bsdf bsdf;
    bsdf.kind = BsdfKind::phong_normalized;
    bsdf.diffuse = m.diffuse.value;
    bsdf.specular = m.specular.value;
    bsdf.ambient = m.ambient;
    bsdf.shininess = m.shininess;
    // Samples are shared in proportion to what each part reflects of light from everywhere.
    float diffuse_power = strongest(bsdf.diffuse), specular_power = strongest(bsdf.specular);
    if (m.form == PhongForm::classic) {
        bsdf.kind = BsdfKind::phong_classic;
        diffuse_power *= static_cast<float>(kPi);
        specular_power *= static_cast<float>(2 * kPi / (m.shininess + 1));
    }
    const float all = diffuse_power + specular_power;
    bsdf.lobe_share = all > 0 ? specular_power / all : 0;
    return bsdf;
}

Rgb eval_phong(const Bsdf& bsdf, Vec3f wo, Vec3f wi)
{
    if (bsdf.kind == BsdfKind::phong_classic) return bsdf.diffuse * wi.z + bsdf.specular * lobe(bsdf, wo, wi);
    const float norm = static_cast<float>((bsdf.shininess + 2) / (2 * kPi));
    return (bsdf.diffuse * kOneOverPi + bsdf.specular * (norm * lobe(bsdf, wo, wi))) * wi.z;
}

float pdf_phong(const Bsdf& bsdf, Vec3f wo, Vec3f wi)
{
    const float cosine_part = pdf_cosine_hemisphere(wi.z);
    if (bsdf.lobe_share == 0) return cosine_part;
    const auto lobe_part = static_cast<float>(pdf_power_lobe(off_mirror(wo, wi), bsdf.shininess));
    return (1 - bsdf.lobe_share) * cosine_part + bsdf.lobe_share * lobe_part;
}

Vec3f sample_phong(const Bsdf& bsdf, Vec3f wo, float u_lobe, Sample2 u)
{
    if (u_lobe < bsdf.lobe_share) return Frame(mirrored(wo)).to_world(sample_power_lobe(u, bsdf.shininess));
    return sample_cosine_hemisphere(u);
}

Rgb albedo_phong(const Bsdf& bsdf)
{
    if (bsdf.kind == BsdfKind::phong_normalized) return bsdf.diffuse + bsdf.specular;
    return bsdf.diffuse * static_cast<float>(kPi) +
           bsdf.specular * static_cast<float>(2 * kPi / (bsdf.shininess + 1));
}

} // namespace renderer
