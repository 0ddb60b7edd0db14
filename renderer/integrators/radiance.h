// What every integrator gets and gives: runs of camera samples, radiance for each, a tally of rays.
//
// Units   radiance, linear Rec. 709, W/(m^2 sr).
// Promise the radiance of a sample is a function of that sample alone, whatever run it is in.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/geometry/ray.h"
#include "renderer/sampling/sampler.h"
#include "renderer/scene/scene.h"

#include <cstddef>
#include <cstdint>

namespace renderer {

// Dimensions of a camera sample: each is one number or one pair of PixelSampler. A scattering has kOfScattering of
// its own, from `scattering` on.
enum class Dimension : std::uint32_t { pixel, lens, scattering = 64 };

enum class ScatteringDimension : std::uint32_t {
    lobe,
    direction,
    roulette,
    pick,   // of a light
    picked, // where on that light
    environment,
    listed = 16 // where on listed light i: listed + i
};
inline constexpr std::uint32_t kOfScattering = 64;

constexpr std::uint32_t dimension_of(std::uint32_t scattering, ScatteringDimension which, std::uint32_t i = 0)
{
    return static_cast<std::uint32_t>(Dimension::scattering) + scattering * kOfScattering +
           static_cast<std::uint32_t>(which) + i;
}

struct RayTally {
    std::uint64_t camera_rays = 0;
    std::uint64_t shadow_rays = 0;
    std::uint64_t bounce_rays = 0;
    std::uint64_t non_finite_samples = 0; // dropped: they add nothing to their pixel
    std::uint64_t clamped = 0;            // contributions that `clamp` cut
    double cut_weight =
        0; // of branches that were not followed: most of the light outside that they could have added, a camera ray being 1
    RayTally& operator+=(const RayTally& o)
    {
        camera_rays += o.camera_rays;
        shadow_rays += o.shadow_rays;
        bounce_rays += o.bounce_rays;
        non_finite_samples += o.non_finite_samples;
        clamped += o.clamped;
        cut_weight += o.cut_weight;
        return *this;
    }
};

// One sample of a pixel: the ray that sees it, and the numbers that it may use.
struct CameraSample {
    Ray ray;
    const PixelSampler* sampler;
    std::uint32_t number; // of the pixel's samples

    float one(std::uint32_t dimension) const { return sampler->sample_1d(number, dimension); }
    Sample2 two(std::uint32_t dimension) const { return sampler->sample_2d(number, dimension); }
};
inline constexpr std::size_t kMostSamples = InstanceTree::kMostRays;

} // namespace renderer
