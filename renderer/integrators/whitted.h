// Whitted's ray tracing: direct light on every surface, and every mirror's and pane's ray followed as a tree.
//
// No random choice but the pixel's own: scenes of lights without extent have no noise inside a surface. A branch that
// carries less than kLeastWeight, or would pass max_depth, is not followed; how much was cut is counted.
//
// Source  T. Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980.
// Cost    at most 2^max_depth rays a sample, each with a shadow ray a light.
#pragma once

#include "renderer/integrators/first_hits.h"

#include <cstdint>
#include <span>
#include <stop_token>

namespace renderer {

// Of a camera ray's: 256 of them are one step of an 8-bit picture.
inline constexpr float kLeastWeight = 1.0f / 65536;

// Radiance of each of at most kMostSamples samples. Once `stop` is requested nothing of the result is to be used.
void whitted_radiance(const Scene& scene,
                      std::uint32_t max_depth,
                      std::span<const CameraSample> samples,
                      std::span<Rgb> radiance,
                      RayTally& tally,
                      const std::stop_token& stop,
                      FirstHits first = {});

} // namespace renderer
