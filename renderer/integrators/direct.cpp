#include "renderer/integrators/direct.h"

#include "renderer/integrators/direct_lighting.h"
#include "renderer/math/uninitialized.h"

namespace renderer {

void direct_radiance(const Scene& scene,
                     std::span<const CameraSample> samples,
                     std::span<Rgb> radiance,
                     RayTally& tally,
                     const std::stop_token& stop,
                     FirstHits first)
{
    Uninitialized<Ray, kMostSamples> rays;
    Uninitialized<SceneHit, kMostSamples> hits;
    for (std::size_t i = 0; i < samples.size(); ++i)
        rays[i] = samples[i].ray;
    tally.camera_rays += samples.size();
    const std::uint64_t seen =
        scene.closest_hits(rays.first(samples.size()), hits.first(samples.size()), RayKind::camera);
    note_first_hits(scene, samples, hits.first(samples.size()), seen, first);

    Uninitialized<Surface, kMostSamples> surfaces;
    BsdfRoom rooms[kMostSamples];
    Uninitialized<LitPoint, kMostSamples> points;
    Uninitialized<Rgb, kMostSamples> found;
    std::size_t of_point[kMostSamples], count = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        radiance[i] = scene.environment();
        if ((seen >> i & 1) == 0) continue;
        const Vec3d toward_viewer = -rays[i].direction;
        surfaces[count] =
            scene.surface_at(hits[i], toward_viewer, &rooms[count], scene.camera().width_at(hits[i].t));
        const Vec3f wo = surfaces[count].shading.to_local(to_float(toward_viewer));
        points[count] = {&surfaces[count], wo, &samples[i], 0};
        found[count] = surfaces[count].bsdf->ambient;
        of_point[count++] = i;
    }
    DirectLighting(scene, false, tally, stop).gather(points.first(count), found.first(count));
    for (std::size_t i = 0; i < count; ++i)
        radiance[of_point[i]] = found[i];
}

} // namespace renderer
