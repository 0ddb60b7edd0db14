// The pass schedule: which samples make pass 0, 1, 2, ... of any render, and how a pass is cut into slices.
//
// It is the same whatever the settings: 1, 1, 2, 4, 8, 16, 16, 16, ... samples, in slices of four at most
// that begin at multiples of four. So a render that stopped after a pass is the beginning of every longer
// one, sum for sum.
#pragma once

#include <cstdint>

namespace renderer {

// Samples [first, end) of every pixel.
struct SampleRange {
    std::uint32_t first = 0, end = 0;
    std::uint32_t count() const { return end - first; }
    friend bool operator==(const SampleRange&, const SampleRange&) = default;
};

SampleRange samples_of_pass(std::uint32_t pass);

// Slices are numbered over all passes; slice_number(samples) is that of the slice which begins with this
// sample, or the number of slices that make so many samples. A render that ends within a slice takes what is
// before its end.
SampleRange samples_of_slice(std::uint32_t slice);
std::uint32_t slice_number(std::uint32_t samples);

// How many passes it takes until `samples` are complete.
std::uint32_t passes_for(std::uint32_t samples);

} // namespace renderer
