#include "renderer/film/pack_floats.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

using renderer::pack_floats;
using renderer::unpack_floats;

namespace {

// Noise about a mean, as a rendered picture has it; a part of it black.
std::vector<float> film_like(std::size_t count)
{
    std::vector<float> values(count);
    std::uint32_t state = 7;
    for (std::size_t i = count / 4; i < count; ++i) {
        state = state * 1664525 + 1013904223;
        values[i] = 0.5f + 0.2f * std::ldexp(static_cast<float>(state >> 8), -24);
    }
    return values;
}

void expect_same(const std::vector<float>& values)
{
    const auto packed = pack_floats(values);
    std::vector<float> back(values.size(), -1.0f);
    ASSERT_TRUE(unpack_floats(packed, back));
    EXPECT_TRUE(values.empty() ||
                std::memcmp(back.data(), values.data(), values.size() * sizeof(float)) == 0);
}

} // namespace

TEST(PackFloats, KeepsEveryBit)
{
    const float inf = std::numeric_limits<float>::infinity();
    expect_same({});
    expect_same({1.0f, -0.0f, inf, -inf, std::nanf("3"), 1e-45f, 3.4e38f});
    expect_same(film_like(1000));
    expect_same(film_like(200000));
    expect_same(std::vector<float>(100000));
}

TEST(PackFloats, MakesAPictureSmallerAndABlackOneVerySmall)
{
    EXPECT_LT(pack_floats(film_like(200000)).size(), 200000u * 4 * 4 / 5);
    EXPECT_LT(pack_floats(std::vector<float>(200000)).size(), 8000u);
}

TEST(PackFloats, RefusesBytesThatItDidNotWrite)
{
    for (const std::size_t count : {std::size_t{10}, std::size_t{40000}}) {
        const auto packed = pack_floats(film_like(count));
        std::vector<float> back(count);
        for (const std::size_t cut : {std::size_t{0}, std::size_t{5}, packed.size() / 2, packed.size() - 1})
            EXPECT_FALSE(unpack_floats(std::span(packed).first(cut), back)) << cut;
        auto longer = packed;
        longer.push_back(0);
        EXPECT_FALSE(unpack_floats(longer, back));
        std::vector<float> more(count + 1), fewer(count - 1);
        EXPECT_FALSE(unpack_floats(packed, more));
        EXPECT_FALSE(unpack_floats(packed, fewer));
        auto other = packed;
        other[0] = 2;
        EXPECT_FALSE(unpack_floats(other, back));
        other[0] = packed[0];
        other[8] = 0xff; // a plane of 2^63 bytes
        EXPECT_FALSE(unpack_floats(other, back));
    }
}
