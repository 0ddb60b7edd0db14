// DirectLighting: light that reaches points straight from lights and is scattered there towards their viewers.
//
// A shadow ray a light that is listed, one to a light picked by the tree, one to the environment's picture; those of all
// points of a run are asked at once.
//
// Weights with `bsdf_rays_follow`, a ray drawn by the material finds the same lights, and the two share by the power
//         heuristic (E. Veach, thesis, 1997, 9.2); lights without extent and the environment's plain colour are found
//         one way alone. Without it, this is all the light there is.
#pragma once

#include "renderer/integrators/radiance.h"
#include "renderer/lights/sample_emitter.h"
#include "renderer/math/uninitialized.h"
#include "renderer/sampling/sampler_kernels.h"

#include <span>
#include <stop_token>

namespace renderer {

struct LitPoint {
    const Surface* surface = nullptr;
    Vec3f wo{}; // towards the viewer, in the shading frame
    const CameraSample* of = nullptr;
    std::uint32_t scattering = 0; // of its path: which numbers it uses

    // A smooth normal may see what the surface itself turns away from: light must not leak through.
    bool agrees(Vec3f world_wi, Vec3f local_wi) const
    {
        return (dot(surface->geometric, world_wi) > 0) == (local_wi.z > 0);
    }
};

class DirectLighting {
public:
    DirectLighting(const Scene& scene, bool bsdf_rays_follow, RayTally& tally, const std::stop_token& stop)
        : scene_(scene), mis_(bsdf_rays_follow), tally_(tally), stop_(stop)
    {
    }

    // At most kMostSamples points; adds to added[i] what reaches points[i].
    void gather(std::span<const LitPoint> points, std::span<Rgb> added);

private:
    struct Arrival {
        Vec3d wi;
        double distance; // where the shadow ray ends
        Rgb radiance;    // times cosine and material it is radiance towards the viewer, over pdf
        double pdf;      // 0: a light without extent, radiance is irradiance
    };
    // The pair that each of the points has for this, in numbers_.
    std::span<const Sample2>
    draw(std::span<const LitPoint> points, ScatteringDimension which, std::uint32_t listed = 0);
    void add(const LitPoint& point, std::size_t i, const Arrival& arrival);
    void arrive(std::span<Rgb> added);
    void
    add(const LitPoint& point, std::size_t i, const Emitter& emitter, const EmitterSample& s, double chance);
    void add_sun(std::span<const LitPoint> points, const Sun& sun, std::uint32_t number);
    void add_map(std::span<const LitPoint> points, const EnvironmentMap& map);
    void add_emitter(std::span<const LitPoint> points, const Emitter& emitter, std::uint32_t number);
    void add_delta(const LitPoint& point, std::size_t i, const PreparedLight& light, double chance);
    void add_picked(const LitPoint& point, std::size_t i);
    void add_environment_color(const LitPoint& point, std::size_t i);

    const Scene& scene_;
    bool mis_;
    RayTally& tally_;
    const std::stop_token& stop_;
    std::size_t count_ = 0;
    Uninitialized<Ray, kMostSamples> rays_;
    Uninitialized<Rgb, kMostSamples> light_;
    std::size_t point_[kMostSamples];
    PairRun pairs_;
    Uninitialized<Sample2, kMostSamples> numbers_;
};

// Share of a sample whose density is `own` where the other way would have drawn it with `other`.
inline double power_heuristic(double own, double other)
{
    const double ratio = other / own;
    return 1 / (1 + ratio * ratio);
}

} // namespace renderer
