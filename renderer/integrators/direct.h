// Direct light without detour: what a camera ray sees, lit by lights without extent and an environment of one colour.
//
// For scenes with nothing else: no mirror, glass or emitter. The others take a path of one scattering (path.h).
//
// Units   radiance, linear Rec. 709, W/(m^2 sr).
// Cost    a sample: one camera ray, one shadow ray a light that reaches the surface's front, one for the
//         environment; no allocation, no lock, no virtual call.
// Source  the light transport equation cut after one scattering: J. Kajiya, "The Rendering Equation", 1986.
#pragma once

#include "renderer/integrators/first_hits.h"

#include <span>
#include <stop_token>

namespace renderer {

// Radiance of each of at most kMostSamples samples; each is a function of that sample alone. Fastest where their
// rays run alike: they, and their shadow rays, are followed together. Once `stop` is requested nothing of the
// result is to be used.
void direct_radiance(const Scene& scene,
                     std::span<const CameraSample> samples,
                     std::span<Rgb> radiance,
                     RayTally& tally,
                     const std::stop_token& stop,
                     FirstHits first = {});

} // namespace renderer
