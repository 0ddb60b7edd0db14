#include "renderer/sampling/sampler.h"

namespace renderer {

namespace {

// Finaliser of splitmix64: every input bit reaches every output bit.
// Source: G. Steele, D. Lea, C. Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014.
std::uint64_t mix(std::uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

std::uint32_t reverse_bits(std::uint32_t x)
{
    x = __builtin_bswap32(x);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

// Two fractions, side by side in one word, are reversed at the price of one.
struct Pair {
    std::uint32_t x, y;
};
Pair reverse_bits(Pair pair)
{
    std::uint64_t v = __builtin_bswap64(std::uint64_t{pair.x} << 32 | pair.y); // x comes out below
    v = ((v >> 4) & 0x0f0f0f0f0f0f0f0fu) | ((v & 0x0f0f0f0f0f0f0f0fu) << 4);
    v = ((v >> 2) & 0x3333333333333333u) | ((v & 0x3333333333333333u) << 2);
    v = ((v >> 1) & 0x5555555555555555u) | ((v & 0x5555555555555555u) << 1);
    return {static_cast<std::uint32_t>(v), static_cast<std::uint32_t>(v >> 32)};
}

// Owen scrambling of a bit-reversed fraction: a bit depends on itself and on lower bits alone.
std::uint32_t scramble_reversed(std::uint32_t x, std::uint32_t seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Sobol's second coordinate from the first of the same point.
std::uint32_t second_from_first(std::uint32_t x)
{
    x ^= x << 16;
    x ^= (x & 0x00ff00ffu) << 8;
    x ^= (x & 0x0f0f0f0fu) << 4;
    x ^= (x & 0x33333333u) << 2;
    return x ^ ((x & 0x55555555u) << 1);
}

float to_unit(std::uint32_t fraction)
{
    return static_cast<float>(fraction >> 8) * 0x1p-24f;
}

// Three seeds for one (pixel, dimension): shuffle, first and second coordinate.
struct Seeds {
    std::uint32_t shuffle, x, y;
};

Seeds seeds_of(std::uint64_t pixel_key, std::uint32_t dimension)
{
    const std::uint64_t a = mix(pixel_key ^ (std::uint64_t{dimension} * 0xd6e8feb86659fd93u));
    const std::uint64_t b = mix(a);
    return {
        static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(a >> 32), static_cast<std::uint32_t>(b)};
}

} // namespace

SobolPoint sobol_2d(std::uint32_t index)
{
    const std::uint32_t x = reverse_bits(index);
    return {x, second_from_first(x)};
}

std::uint32_t owen_scramble(std::uint32_t fraction, std::uint32_t seed)
{
    return reverse_bits(scramble_reversed(reverse_bits(fraction), seed));
}

PixelSampler::PixelSampler(std::uint64_t seed, std::uint32_t pixel_x, std::uint32_t pixel_y)
    : pixel_key_(mix(mix(seed) ^ ((std::uint64_t{pixel_y} << 32) | pixel_x)))
{
}

// The sample's number is shuffled by scrambling it as its own fraction would be: a prefix of 2^k numbers
// becomes an aligned block of 2^k, which is stratified as well. Reversals that would undo one another are
// left out.
float PixelSampler::sample_1d(std::uint32_t sample, std::uint32_t dimension) const
{
    const Seeds seeds = seeds_of(pixel_key_, dimension);
    const std::uint32_t x = scramble_reversed(reverse_bits(sample), seeds.shuffle);
    return to_unit(owen_scramble(x, seeds.x));
}

Sample2 sample_pair(std::uint64_t pixel_key, std::uint32_t sample, std::uint32_t dimension)
{
    const Seeds seeds = seeds_of(pixel_key, dimension);
    const std::uint32_t x = scramble_reversed(reverse_bits(sample), seeds.shuffle);
    const Pair reversed = reverse_bits(Pair{x, second_from_first(x)});
    const Pair drawn =
        reverse_bits(Pair{scramble_reversed(reversed.x, seeds.x), scramble_reversed(reversed.y, seeds.y)});
    return {to_unit(drawn.x), to_unit(drawn.y)};
}

} // namespace renderer
