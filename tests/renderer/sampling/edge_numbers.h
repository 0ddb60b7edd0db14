// Pairs of random numbers for kernels to be held against one at a time: at the ends and middles of their range, and many between.
#pragma once

#include "renderer/sampling/sampler.h"

#include <cstdint>
#include <vector>

namespace tests {

inline std::vector<renderer::Sample2> edge_numbers()
{
    constexpr float kEdges[] = {
        0, 0x1p-24f, 0.125f, 0.25f, 0.5f - 0x1p-25f, 0.5f, 0.5f + 0x1p-24f, 0.75f, 1 - 0x1p-24f};
    std::vector<renderer::Sample2> numbers;
    for (const float u0 : kEdges)
        for (const float u1 : kEdges)
            numbers.push_back({u0, u1});
    const renderer::PixelSampler sampler(5, 3, 4);
    for (std::uint32_t i = 0; i < 5000; ++i)
        numbers.push_back(sampler.sample_2d(i, 0));
    return numbers;
}

} // namespace tests
