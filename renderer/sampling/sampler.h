// PixelSampler: the random numbers of one pixel, each a pure function of (seed, pixel, sample, dimension).
//
// For every dimension the samples 0, 1, 2, ... of a pixel are a shuffled, Owen-scrambled Sobol sequence in
// one or two dimensions: any prefix of 2^k samples is stratified, any prefix at all is valid. Dimensions and
// pixels are independent of one another. Pixels are those of the full picture, so a crop has the same
// numbers.
//
// Units   u in [0, 1), multiples of 2^-24.
// Limits  sample below 2^32; the sequence does not repeat before.
// Cost    some 40 integer operations a number; no state, no tables.
// Source  B. Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020 (padding of 2-D pairs); the hash
//         is N. Vegdahl's, "Building a Better LK Hash", 2021, since Burley's own is visibly biased for some
//         seeds; Sobol's second dimension as a product with Pascal's matrix mod 2, whose structure (a
//         Kronecker power of [[1,1],[0,1]]) needs 5 steps instead of 32.
#pragma once

#include <cstdint>

namespace renderer {

struct Sample2 {
    float u0{}, u1{};
};

// A pair that is stratified together, for the pixel that the key stands for; see PixelSampler.
Sample2 sample_pair(std::uint64_t pixel_key, std::uint32_t sample, std::uint32_t dimension);

class PixelSampler {
public:
    PixelSampler(std::uint64_t seed, std::uint32_t pixel_x, std::uint32_t pixel_y);

    float sample_1d(std::uint32_t sample, std::uint32_t dimension) const;
    // A pair that is stratified together; 1-D and 2-D numbers of one dimension are not independent, so a
    // dimension is used for either.
    Sample2 sample_2d(std::uint32_t sample, std::uint32_t dimension) const
    {
        return sample_pair(pixel_key_, sample, dimension);
    }

    std::uint64_t key() const { return pixel_key_; } // of seed and pixel: what sampler_kernels.h works with

private:
    std::uint64_t pixel_key_;
};

// Point `index` of the plain (0,2)-sequence of Sobol, as 32-bit fractions.
struct SobolPoint {
    std::uint32_t x{}, y{};
};
SobolPoint sobol_2d(std::uint32_t index);

// Nested uniform (Owen) scrambling of a 32-bit fraction.
std::uint32_t owen_scramble(std::uint32_t fraction, std::uint32_t seed);

} // namespace renderer
