#include "renderer/integrators/direct.h"

#include <limits>

namespace renderer {

namespace {

// A shadow ray stops this share of its way short of the light, so that a light that lies in a surface is not
// shadowed by it.
constexpr double kShadowEnd = 1 - 0x1p-20;

struct ShadedPoint {
    std::size_t sample; // of the run
    Surface surface;
    Vec3f wo; // towards the viewer, in the shading frame

    // A smooth normal may see what the surface itself turns away from: light must not leak through.
    bool in_front(Vec3f wi) const { return dot(surface.geometric, wi) > 0; }
};

// Light that arrives unless something is in its way: asked for all points at once.
class PendingLight {
public:
    PendingLight(const Scene& scene, RayTally& tally) : scene_(scene), tally_(tally) {}

    void add(const ShadedPoint& point, Vec3d wi, double distance, Rgb light)
    {
        rays_[count_] = Ray{offset_origin(point.surface.point, wi), wi, 0, distance};
        light_[count_] = light;
        sample_[count_++] = point.sample;
    }
    void arrive(std::span<Rgb> radiance)
    {
        if (count_ == 0) return;
        tally_.shadow_rays += count_;
        const std::uint64_t shadowed = scene_.tree().any_hits({rays_, count_});
        for (std::size_t i = 0; i < count_; ++i)
            if ((shadowed >> i & 1) == 0) radiance[sample_[i]] += light_[i];
        count_ = 0;
    }

private:
    const Scene& scene_;
    RayTally& tally_;
    std::size_t count_ = 0;
    Ray rays_[kMostSamples];
    Rgb light_[kMostSamples];
    std::size_t sample_[kMostSamples];
};

void add_light(const ShadedPoint& point, const PreparedLight& light, PendingLight& pending)
{
    const LightSample s = illuminate(light, point.surface.point.position);
    const Vec3f wi = to_float(s.wi);
    if (is_black(s.irradiance) || !point.in_front(wi)) return;
    const Rgb f = eval(*point.surface.bsdf, point.wo, point.surface.shading.to_local(wi));
    if (!is_black(f)) pending.add(point, s.wi, s.distance * kShadowEnd, f * s.irradiance);
}

// One direction drawn by the material: as good as any for light that is the same from everywhere.
void add_environment(const ShadedPoint& point, const CameraSample& of, Rgb environment, PendingLight& pending)
{
    const float u_lobe = of.sampler->sample_1d(of.number, static_cast<std::uint32_t>(Dimension::lobe));
    const Sample2 u = of.sampler->sample_2d(of.number, static_cast<std::uint32_t>(Dimension::direction));
    const BsdfSample drawn = sample(*point.surface.bsdf, point.wo, u_lobe, u);
    if (is_black(drawn.weight)) return;
    const Vec3f wi = point.surface.shading.to_world(drawn.wi);
    if (point.in_front(wi))
        pending.add(
            point, to_double(wi), std::numeric_limits<double>::infinity(), drawn.weight * environment);
}

} // namespace

void direct_radiance(const Scene& scene,
                     std::span<const CameraSample> samples,
                     std::span<Rgb> radiance,
                     RayTally& tally,
                     const std::stop_token& stop)
{
    Ray rays[kMostSamples];
    SceneHit hits[kMostSamples];
    for (std::size_t i = 0; i < samples.size(); ++i)
        rays[i] = samples[i].ray;
    tally.camera_rays += samples.size();
    const std::uint64_t seen = scene.tree().closest_hits({rays, samples.size()}, hits, RayKind::camera);

    ShadedPoint points[kMostSamples];
    std::size_t count = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        radiance[i] = scene.environment();
        if ((seen >> i & 1) == 0) continue;
        const Vec3d toward_viewer = -rays[i].direction;
        ShadedPoint& point = points[count++];
        point.sample = i;
        point.surface = scene.surface_at(hits[i], toward_viewer);
        point.wo = point.surface.shading.to_local(to_float(toward_viewer));
        radiance[i] = point.surface.bsdf->ambient;
    }
    const std::span<const ShadedPoint> shaded(points, count);
    PendingLight pending(scene, tally);
    for (const PreparedLight& light : scene.lights()) {
        if (stop.stop_requested()) return;
        for (const ShadedPoint& point : shaded)
            add_light(point, light, pending);
        pending.arrive(radiance);
    }
    if (is_black(scene.environment())) return;
    for (const ShadedPoint& point : shaded)
        add_environment(point, samples[point.sample], scene.environment(), pending);
    pending.arrive(radiance);
}

} // namespace renderer
