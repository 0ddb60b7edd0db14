#include "renderer/scene/surroundings.h"

#include "renderer/math/transcendental.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

namespace renderer {

std::shared_ptr<const EnvironmentMap> environment_map(const SceneDescription& scene,
                                                      std::span<const SharedImage> images)
{
    const auto* const told = scene.environment ? std::get_if<ImageEnvironment>(&*scene.environment) : nullptr;
    if (told == nullptr) return nullptr;
    const SharedImage& image = images[told->image];
    const Texture texture(image, encoding_of(TextureUse{}, *image, true), false);
    std::vector<Rgb> texels;
    texels.reserve(image->pixels());
    const auto light = [told](float number) {
        constexpr double kMost = std::numeric_limits<float>::max();
        return static_cast<float>(std::clamp(static_cast<double>(number) * told->scale, 0.0, kMost));
    };
    for (std::uint32_t y = 0; y < image->height; ++y)
        for (std::uint32_t x = 0; x < image->width; ++x) {
            const TexturePoint at{(x + 0.5) / image->width, 1 - (y + 0.5) / image->height};
            const Rgb c = texture.lookup(at, TextureWrap::clamp, TextureFilter::nearest, {}).color;
            texels.push_back({light(c.r), light(c.g), light(c.b)});
        }
    return std::make_shared<const EnvironmentMap>(
        image->width, image->height, std::move(texels), told->rotation_deg);
}

std::shared_ptr<const SkyLight> sky_light(const SceneDescription& scene,
                                          const Plan& plan,
                                          ThreadPool& pool,
                                          const std::stop_token& stop,
                                          SkyCache* skies)
{
    const auto* const told =
        scene.environment ? std::get_if<AtmosphereDescription>(&*scene.environment) : nullptr;
    if (told == nullptr || !plan.sky) return nullptr;
    AtmosphereDescription air = *told;
    air.mode = plan.sky->mode;
    SkyCache alone;
    std::shared_ptr<const Sky> sky = (skies != nullptr ? *skies : alone).get(air, pool, stop);
    if (!sky) return nullptr;
    return std::make_shared<const SkyLight>(
        air, std::move(sky), scene.camera->position, plan.sky->far_m, pool, plan.sky->table_error);
}

std::shared_ptr<const EnvironmentMap> light_from(const SkyLight& sky, ThreadPool& pool, SceneLights& lights)
{
    const Vec3d travels = -sky.sun_direction();
    if (!(sky.sun_radius_rad() > 0)) {
        const Rgb irradiance = sky.sun_irradiance();
        if (!is_black(irradiance))
            lights.listed.push_back(prepare_light(DirectionalLight{travels, irradiance}));
    } else if (const Rgb mean = sky.mean_sun_radiance(); !is_black(mean)) {
        Sun sun = prepare_sun(SunLight{travels, {1, 1, 1}, sky.sun_radius_rad() * (180 / kPi)});
        sun.radiance = mean;
        lights.suns.insert(lights.suns.begin(), sun);
        lights.first_sun_is_of_sky = true;
    }
    constexpr std::uint32_t kWidth = 512, kHeight = 256;
    // From space the planet may be a few rows high, and its edge one of them all around.
    const std::uint32_t finer = sky.is_beyond_air() ? 16 : 1;
    SkyPanorama picture = sky.panorama(kWidth, kHeight, pool, finer);
    return std::make_shared<const EnvironmentMap>(kWidth, kHeight, std::move(picture.pixels), 0);
}

Media media_around(Vec3d point,
                   const InstanceTree& tree,
                   std::span<const Bsdf> bsdfs,
                   std::span<const Scene::Parts::Look> looks)
{
    Media media;
    if (std::none_of(bsdfs.begin(), bsdfs.end(), transmits)) return media;
    constexpr int kMostSurfaces = 4096; // glass that was not closed might never end
    constexpr Vec3d kAnyWay{0.5376, 0.7312, 0.4201};
    std::vector<std::pair<BodyId, const GlassMedium*>> left;
    std::map<BodyId, int> entered;
    Ray ray{point, kAnyWay};
    for (int i = 0; i < kMostSurfaces; ++i) {
        const std::optional<SceneHit> hit = tree.closest_hit(ray);
        if (!hit) break;
        ray.origin = offset_origin(hit->point, kAnyWay);
        const BodyId body{hit->instance, looks[hit->instance].bsdf_of(hit->primitive)};
        const Bsdf& bsdf = bsdfs[body.material];
        if (!transmits(bsdf)) continue;
        int& times = entered[body];
        if (dot(hit->point.normal, kAnyWay) < 0)
            ++times;
        else if (times > 0)
            --times;
        else
            left.emplace_back(body, &bsdf.medium);
    }
    for (auto body = left.rbegin(); body != left.rend(); ++body)
        media.cross(body->first, *body->second, true);
    return media;
}

} // namespace renderer
