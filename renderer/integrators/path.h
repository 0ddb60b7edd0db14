// Path tracing: all light that surfaces scatter, however often, by random paths from the camera.
//
// At each surface light that comes straight from lights is added (direct_lighting.h), and the path goes on where the
// material sends it; what that ray finds shining counts by the power heuristic. After some scatterings a path goes on
// by chance in proportion to what it carries (Russian roulette): no bias.
//
// Source  J. Kajiya, "The Rendering Equation", 1986; E. Veach, thesis, 1997, chapters 8 to 10.
// Cost    a scattering: one ray, one shadow ray a listed light; no allocation, no recursion, no virtual call.
#pragma once

#include "renderer/integrators/first_hits.h"

#include <cstdint>
#include <limits>
#include <span>
#include <stop_token>

namespace renderer {

// Which rays find what shines and has an extent: both ways weighted against each other, or for comparison one alone.
enum class LightSearch : std::uint8_t { both, lights, material };

struct PathLimits {
    std::uint32_t max_depth = std::numeric_limits<std::uint32_t>::max(); // scatterings, see transport.h
    float clamp = std::numeric_limits<float>::infinity();
    LightSearch search = LightSearch::both;
};

// Radiance of each of at most kMostSamples samples. Once `stop` is requested nothing of the result is to be used.
void path_radiance(const Scene& scene,
                   const PathLimits& limits,
                   std::span<const CameraSample> samples,
                   std::span<Rgb> radiance,
                   RayTally& tally,
                   const std::stop_token& stop,
                   FirstHits first = {});

} // namespace renderer
