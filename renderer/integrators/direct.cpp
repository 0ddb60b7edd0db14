#include "renderer/integrators/direct.h"

#include <limits>

namespace renderer {

namespace {

// A shadow ray stops this share of its way short of the light, so that a light that lies in a surface is not
// shadowed by it.
constexpr double kShadowEnd = 1 - 0x1p-20;

class ShadedPoint {
public:
    ShadedPoint(const Scene& scene, const Surface& surface, Vec3d toward_viewer, RayTally& tally)
        : scene_(scene), surface_(surface), wo_(surface.shading.to_local(to_float(toward_viewer))),
          tally_(tally)
    {
    }

    Rgb from(const PreparedLight& light) const
    {
        const LightSample s = illuminate(light, surface_.point.position);
        const Vec3f wi = to_float(s.wi);
        if (is_black(s.irradiance) || !in_front(wi)) return {};
        const Rgb f = eval(*surface_.bsdf, wo_, surface_.shading.to_local(wi));
        if (is_black(f) || occluded(s.wi, s.distance * kShadowEnd)) return {};
        return f * s.irradiance;
    }

    // One direction drawn by the material: as good as any for light that is the same from everywhere.
    Rgb from_environment(const PixelSampler& sampler, std::uint32_t sample) const
    {
        const float u_lobe = sampler.sample_1d(sample, static_cast<std::uint32_t>(Dimension::lobe));
        const Sample2 u = sampler.sample_2d(sample, static_cast<std::uint32_t>(Dimension::direction));
        const BsdfSample drawn = renderer::sample(*surface_.bsdf, wo_, u_lobe, u);
        if (is_black(drawn.weight)) return {};
        const Vec3f wi = surface_.shading.to_world(drawn.wi);
        if (!in_front(wi) || occluded(to_double(wi), std::numeric_limits<double>::infinity())) return {};
        return drawn.weight * scene_.environment();
    }

private:
    // A smooth normal may see what the surface itself turns away from: light must not leak through.
    bool in_front(Vec3f wi) const { return dot(surface_.geometric, wi) > 0; }

    bool occluded(Vec3d wi, double t_max) const
    {
        ++tally_.shadow_rays;
        return scene_.tree().any_hit(Ray{offset_origin(surface_.point, wi), wi, 0, t_max});
    }

    const Scene& scene_;
    const Surface& surface_;
    Vec3f wo_;
    RayTally& tally_;
};

} // namespace

Rgb direct_radiance(const Scene& scene,
                    const Ray& camera_ray,
                    const PixelSampler& sampler,
                    std::uint32_t sample,
                    RayTally& tally)
{
    ++tally.camera_rays;
    const auto hit = scene.tree().closest_hit(camera_ray, RayKind::camera);
    if (!hit) return scene.environment();
    const Vec3d toward_viewer = -camera_ray.direction;
    const Surface surface = scene.surface_at(*hit, toward_viewer);
    const ShadedPoint point(scene, surface, toward_viewer, tally);
    Rgb radiance = surface.bsdf->ambient;
    for (const PreparedLight& light : scene.lights())
        radiance += point.from(light);
    if (!is_black(scene.environment())) radiance += point.from_environment(sampler, sample);
    return radiance;
}

} // namespace renderer
