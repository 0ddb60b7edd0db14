#include "renderer/plan/predict_cost.h"

#include <algorithm>
#include <limits>

namespace renderer {

namespace {

// Of a core, what an atmosphere's tables take where light is scattered more than once: see sky/sky.h.
double table_seconds(const SceneDescription& scene, const TransportChoice& transport)
{
    const auto* const air =
        scene.environment ? std::get_if<AtmosphereDescription>(&*scene.environment) : nullptr;
    if (air == nullptr || air->scattering == SkyScattering::single || !is_lit(transport.integrator)) return 0;
    const std::size_t groups = (air->wavelengths_nm.size() + 3) / 4;
    return static_cast<double>(groups) * (air->mode == SkyMode::exact ? 11 : 1.5);
}

double rays_a_sample(const SceneDescription& scene, const TransportChoice& transport)
{
    const bool sky = scene.environment && !std::holds_alternative<NoEnvironment>(*scene.environment);
    // Asked at each point: every light, or one of them.
    const double lights = transport.picks_lights ? 1 : static_cast<double>(scene.lights.size());
    switch (transport.integrator) {
    case Integrator::normals:
        return 1;
    case Integrator::ambient_occlusion:
        return 2;
    case Integrator::direct:
        return 1 + lights + (sky ? 1 : 0);
    case Integrator::whitted:
        return std::min(4.0, 1.0 + transport.max_depth) * (1 + lights);
    case Integrator::path:
        return 1 + std::min(kUsualScatterings, static_cast<double>(transport.max_depth)) * (1 + lights);
    }
    return 1;
}

} // namespace

std::uint64_t most_camera_rays(const RenderSettings& settings)
{
    const QualitySettings& quality = settings.quality;
    return rendered_pixels(settings.image) *
           quality.samples.value_or(quality.time_s ? quality.max_samples : kDefaultSamples);
}

double most_rays_in_time(const RenderSettings& settings)
{
    const QualitySettings& quality = settings.quality;
    if (!quality.time_s || quality.samples) return std::numeric_limits<double>::infinity();
    return *quality.time_s * threads_of(settings.acceleration) / kSecondsARay;
}

Prediction predict_cost(const SceneDescription& scene,
                        const RenderSettings& settings,
                        const Budget& budget,
                        const TransportChoice& transport)
{
    Prediction p;
    p.camera_rays = most_camera_rays(settings);
    const double each = rays_a_sample(scene, transport);
    p.rays = static_cast<double>(p.camera_rays) * each;
    p.memory_bytes = memory_bytes(budget);
    p.threads = threads_of(settings.acceleration);
    const double in_time = most_rays_in_time(settings);
    if (p.rays > in_time) {
        p.rays = in_time;
        p.camera_rays = static_cast<std::uint64_t>(std::max(1.0, in_time / each));
    }
    p.seconds = p.rays * kSecondsARay / p.threads;
    p.seconds += table_seconds(scene, transport) / p.threads;
    return p;
}

} // namespace renderer
