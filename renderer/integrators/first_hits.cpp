#include "renderer/integrators/first_hits.h"

namespace renderer {

void note_first_hits(const Scene& scene,
                     std::span<const CameraSample> samples,
                     std::span<const SceneHit> hits,
                     std::uint64_t met,
                     FirstHits first)
{
    if (first.empty()) return;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        first[i] = {};
        if ((met >> i & 1) == 0) continue;
        BsdfRoom room;
        const SceneHit& hit = hits[i];
        const Vec3d toward_viewer = -samples[i].ray.direction;
        const Surface surface = scene.surface_at(hit, toward_viewer, &room, scene.camera().width_at(hit.t));
        const Vec3f wo = surface.shading.to_local(to_float(toward_viewer));
        first[i] = {true, hit.t, surface.shading.z, albedo(*surface.bsdf, wo)};
    }
}

} // namespace renderer
