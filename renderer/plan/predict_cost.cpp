#include "renderer/plan/predict_cost.h"

#include <algorithm>

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

Prediction predict_cost(const SceneDescription& scene,
                        const RenderSettings& settings,
                        const Budget& budget,
                        const TransportChoice& transport)
{
    Prediction p;
    const QualitySettings& quality = settings.quality;
    p.camera_rays = most_camera_rays(settings);
    p.rays = static_cast<double>(p.camera_rays) * rays_a_sample(scene, transport);
    p.memory_bytes = memory_bytes(budget);
    p.threads = threads_of(settings.acceleration);
    p.seconds = p.rays * kSecondsARay / p.threads;
    if (quality.time_s && !quality.samples) p.seconds = std::min(p.seconds, *quality.time_s);
    p.seconds += table_seconds(scene, transport) / p.threads;
    return p;
}

} // namespace renderer
