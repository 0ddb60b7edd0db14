// Pairs of random numbers side by side: PixelSampler::sample_2d() for many, operation for operation, compiled for AVX-512,
// AVX2, SSE4, NEON and none of them.
//
// Promise  the same bits as of one, on every processor.
#pragma once

#include "renderer/sampling/sampler.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace renderer {

// What is asked for, side by side; those behind the last hold anything.
struct PairRun {
    static constexpr std::size_t kPairs = 64;

    alignas(64) std::uint64_t pixel_key[kPairs];
    alignas(64) std::uint32_t sample[kPairs], dimension[kPairs];

    void set(std::size_t i, const PixelSampler& sampler, std::uint32_t number, std::uint32_t of_dimension)
    {
        pixel_key[i] = sampler.key();
        sample[i] = number;
        dimension[i] = of_dimension;
    }
};

// Fills `out` with the first out.size() pairs of the run, kPairs at most.
using DrawPairs = void (*)(const PairRun& run, std::span<Sample2> out);

// Those that this processor can run, the best first; and that one.
std::span<const DrawPairs> all_draw_pairs();
DrawPairs draw_pairs();

} // namespace renderer
