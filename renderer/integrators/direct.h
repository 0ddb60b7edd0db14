// Direct light: what a camera ray sees: the environment, or a surface lit by lights and environment without
// detour.
//
// Units   radiance, linear Rec. 709, W/(m^2 sr).
// Cost    a sample: one camera ray, one shadow ray a light that reaches the surface's front, one for the
//         environment; no allocation, no lock, no virtual call.
// Source  the light transport equation cut after one scattering: J. Kajiya, "The Rendering Equation", 1986.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/geometry/ray.h"
#include "renderer/sampling/sampler.h"
#include "renderer/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>

namespace renderer {

// Dimensions of a camera sample: each is one number or one pair of PixelSampler.
enum class Dimension : std::uint32_t { pixel, lobe, direction };

struct RayTally {
    std::uint64_t camera_rays = 0;
    std::uint64_t shadow_rays = 0;
    std::uint64_t non_finite_samples = 0; // dropped: they add nothing to their pixel
    RayTally& operator+=(const RayTally& o)
    {
        camera_rays += o.camera_rays;
        shadow_rays += o.shadow_rays;
        non_finite_samples += o.non_finite_samples;
        return *this;
    }
};

// One sample of a pixel: the ray that sees it, and the numbers that it may use.
struct CameraSample {
    Ray ray;
    const PixelSampler* sampler;
    std::uint32_t number; // of the pixel's samples
};

// Radiance of each of at most kMostSamples samples; each is a function of that sample alone. Fastest where their
// rays run alike: they, and their shadow rays, are followed together. Once `stop` is requested nothing of the
// result is to be used.
void direct_radiance(const Scene& scene,
                     std::span<const CameraSample> samples,
                     std::span<Rgb> radiance,
                     RayTally& tally,
                     const std::stop_token& stop);
inline constexpr std::size_t kMostSamples = InstanceTree::kMostRays;

} // namespace renderer
