#include "renderer/integrators/surface_step.h"

#include "renderer/integrators/direct_lighting.h"
#include "renderer/math/transcendental.h"

#include <algorithm>
#include <cmath>

namespace renderer {

Rgb background(const Scene& scene, Vec3d direction, double drawn_pdf)
{
    Rgb seen = scene.environment();
    const SkyLight* const sky = drawn_pdf > 0 ? nullptr : scene.sky();
    if (sky != nullptr) {
        seen = sky->radiance(direction) + sky->sun_radiance(direction);
    } else if (const EnvironmentMap* const map = scene.environment_map()) {
        if (drawn_pdf > 0)
            seen += map->radiance(direction) *
                    static_cast<float>(power_heuristic(drawn_pdf, map->pdf(direction)));
        else
            seen += map->interpolated(direction);
    }
    for (std::size_t i = 0; i < scene.suns().size(); ++i) {
        if (sky != nullptr && scene.sun_is_of_sky(i)) continue; // seen through the air
        const Sun& sun = scene.suns()[i];
        const Rgb disk = radiance_towards(sun, direction);
        if (!is_black(disk))
            seen += disk * static_cast<float>(drawn_pdf > 0 ? power_heuristic(drawn_pdf, sun.pdf) : 1);
    }
    return seen;
}

Rgb transmittance(const Media& media, double way)
{
    const GlassMedium* const here = media.here();
    if (here == nullptr || is_black(here->absorption)) return {1, 1, 1};
    const auto left = [way](float absorption) {
        return absorption > 0 ? static_cast<float>(exp(-static_cast<double>(absorption) * way)) : 1.0f;
    };
    return {left(here->absorption.r), left(here->absorption.g), left(here->absorption.b)};
}

SkyLight::Between air_before(const Scene& scene, const Ray& ray, double distance)
{
    const SkyLight* const sky = scene.sky();
    if (sky == nullptr || !sky->has_air_before()) return {};
    return sky->air_before(ray.direction, distance);
}

Vec3d reflected(const Surface& surface, Vec3d direction)
{
    return normalize(direction - surface.normal * (2 * dot(direction, surface.normal)));
}

Vec3d refracted(const Surface& surface, Vec3d direction, double eta)
{
    if (eta == 1) return direction;                        // to the bit
    const double cosine = -dot(direction, surface.normal); // the normal is on the viewer's side
    const double sine2 = std::max(0.0, 1 - cosine * cosine) / (eta * eta);
    const double behind = std::sqrt(std::max(0.0, 1 - sine2));
    return normalize(direction / eta + surface.normal * (cosine / eta - behind));
}

double emitter_weight(const Scene& scene, Vec3d from, double drawn_pdf, const SceneHit& hit)
{
    const std::uint32_t number = scene.emitter_at(hit);
    if (number == Scene::kNoEmitter) return 1;
    double light_pdf = pdf(scene.emitters()[number], from, hit.point.position);
    if (!scene.light_tree().empty()) light_pdf *= scene.light_tree().probability(from, number);
    return light_pdf > 0 ? power_heuristic(drawn_pdf, light_pdf) : 1;
}

} // namespace renderer
