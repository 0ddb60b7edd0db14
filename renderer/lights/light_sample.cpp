#include "renderer/lights/light_sample.h"

#include "renderer/math/transcendental.h"

#include <algorithm>
#include <limits>
#include <variant>

namespace renderer {

namespace {

Rgb scaled(Rgb c, double s)
{
    return {static_cast<float>(static_cast<double>(c.r) * s),
            static_cast<float>(static_cast<double>(c.g) * s),
            static_cast<float>(static_cast<double>(c.b) * s)};
}

double spot_share(const PreparedLight& light, Vec3d wi)
{
    const double cosine = -dot(wi, light.toward);
    if (cosine >= light.cos_inner) return 1;
    if (cosine <= light.cos_outer) return 0;
    const double x = (cosine - light.cos_outer) / (light.cos_inner - light.cos_outer);
    return x * x * (3 - 2 * x);
}

} // namespace

PreparedLight prepare_light(const Light& light)
{
    PreparedLight out;
    if (const auto* const point = std::get_if<PointLight>(&light)) {
        out.kind = LightKind::point;
        out.position = point->position;
        out.strength = point->intensity;
    } else if (const auto* const spot = std::get_if<SpotLight>(&light)) {
        out.kind = LightKind::spot;
        out.position = spot->position;
        out.toward = normalize(spot->direction);
        out.strength = spot->intensity;
        out.cos_inner = sin_cos_deg(spot->inner_deg).second;
        out.cos_outer = sin_cos_deg(spot->outer_deg).second;
    } else {
        const auto& directional = std::get<DirectionalLight>(light);
        out.kind = LightKind::directional;
        out.toward = -normalize(directional.direction);
        out.strength = directional.irradiance;
    }
    return out;
}

LightSample illuminate(const PreparedLight& light, Vec3d point)
{
    if (light.kind == LightKind::directional)
        return {light.toward, std::numeric_limits<double>::infinity(), light.strength};
    const Vec3d to_light = light.position - point;
    const double distance = length(to_light);
    if (!(distance > 0)) return {}; // in the light itself: it has no direction
    const Vec3d wi = to_light / distance;
    const double share = light.kind == LightKind::spot ? spot_share(light, wi) : 1;
    return {wi, distance, share > 0 ? scaled(light.strength, share / distance / distance) : Rgb{}};
}

} // namespace renderer
