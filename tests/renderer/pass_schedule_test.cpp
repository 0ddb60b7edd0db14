#include "renderer/pass_schedule.h"

#include <gtest/gtest.h>

#include <vector>

using renderer::SampleRange;

TEST(PassSchedule, DoublesThenGoesOnInSixteens)
{
    const std::vector<SampleRange> want{
        {0, 1}, {1, 2}, {2, 4}, {4, 8}, {8, 16}, {16, 32}, {32, 48}, {48, 64}};
    for (std::uint32_t pass = 0; pass < want.size(); ++pass)
        EXPECT_EQ(renderer::samples_of_pass(pass), want[pass]);
    EXPECT_EQ(renderer::samples_of_pass(0xffffffffu).end, 0xffffffffu); // no overflow
}

TEST(PassSchedule, CutsEveryPassIntoWholeSlicesOfFourAtMost)
{
    std::uint32_t next = 0;
    for (std::uint32_t slice = 0; slice < 100; ++slice) {
        const SampleRange range = renderer::samples_of_slice(slice);
        EXPECT_EQ(range.first, next);
        EXPECT_LE(range.count(), 4u);
        EXPECT_EQ(renderer::slice_number(range.first), slice);
        EXPECT_EQ(renderer::slice_number(range.end), slice + 1);
        for (std::uint32_t samples = range.first + 1; samples < range.end; ++samples) {
            EXPECT_EQ(renderer::slice_number(samples), slice + 1); // cut short, it still is a slice
        }
        next = range.end;
    }
    for (std::uint32_t pass = 0; pass < 20; ++pass) {
        const SampleRange range = renderer::samples_of_pass(pass);
        EXPECT_EQ(renderer::samples_of_slice(renderer::slice_number(range.first)).first, range.first);
    }
    EXPECT_EQ(renderer::slice_number(1u << 30), 2u + (1u << 28));
}

TEST(PassSchedule, CountsPasses)
{
    EXPECT_EQ(renderer::passes_for(0), 0u);
    for (std::uint32_t samples = 1; samples < 200; ++samples) {
        const std::uint32_t passes = renderer::passes_for(samples);
        EXPECT_GE(renderer::samples_of_pass(passes - 1).end, samples);
        EXPECT_LT(renderer::samples_of_pass(passes - 1).first, samples);
    }
    EXPECT_EQ(renderer::passes_for(0xffffffffu), 268435460u);
}
