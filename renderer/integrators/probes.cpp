#include "renderer/integrators/probes.h"

#include "renderer/sampling/warp.h"

namespace renderer {

namespace {

// What the samples see first: bit i of the result is set where sample i met surfaces[i].
std::uint64_t look(const Scene& scene,
                   std::span<const CameraSample> samples,
                   Surface* surfaces,
                   RayTally& tally,
                   FirstHits first)
{
    Ray rays[kMostSamples];
    SceneHit hits[kMostSamples];
    for (std::size_t i = 0; i < samples.size(); ++i)
        rays[i] = samples[i].ray;
    tally.camera_rays += samples.size();
    const std::uint64_t met = scene.closest_hits({rays, samples.size()}, hits, RayKind::camera);
    note_first_hits(scene, samples, hits, met, first);
    BsdfRoom room; // normals alone are looked at
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if ((met >> i & 1) == 0) continue;
        surfaces[i] =
            scene.surface_at(hits[i], -rays[i].direction, &room, scene.camera().width_at(hits[i].t));
        surfaces[i].bsdf = nullptr;
    }
    return met;
}

} // namespace

void occlusion_radiance(const Scene& scene,
                        std::span<const CameraSample> samples,
                        std::span<Rgb> radiance,
                        RayTally& tally,
                        const std::stop_token& stop,
                        FirstHits first)
{
    Surface surfaces[kMostSamples];
    const std::uint64_t met = look(scene, samples, surfaces, tally, first);
    Ray rays[kMostSamples];
    std::size_t of_ray[kMostSamples], count = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        radiance[i] = {1, 1, 1};
        if ((met >> i & 1) == 0) continue;
        radiance[i] = {};
        const Vec3f wi = surfaces[i].shading.to_world(
            sample_cosine_hemisphere(samples[i].two(dimension_of(0, ScatteringDimension::direction))));
        if (!(dot(wi, surfaces[i].geometric) > 0)) continue; // below the surface itself: it is shut there
        const Vec3d way = to_double(wi);
        rays[count] = Ray{offset_origin(surfaces[i].point, way), way};
        of_ray[count++] = i;
    }
    if (count == 0 || stop.stop_requested()) return;
    tally.shadow_rays += count;
    const std::uint64_t shut = scene.any_hits({rays, count});
    for (std::size_t i = 0; i < count; ++i)
        if ((shut >> i & 1) == 0) radiance[of_ray[i]] = {1, 1, 1};
}

void normals_radiance(const Scene& scene,
                      std::span<const CameraSample> samples,
                      std::span<Rgb> radiance,
                      RayTally& tally,
                      const std::stop_token& /*stop*/,
                      FirstHits first)
{
    Surface surfaces[kMostSamples];
    const std::uint64_t met = look(scene, samples, surfaces, tally, first);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Vec3f n = surfaces[i].shading.z;
        radiance[i] = (met >> i & 1) != 0 ? Rgb{(n.x + 1) / 2, (n.y + 1) / 2, (n.z + 1) / 2} : Rgb{};
    }
}

} // namespace renderer
