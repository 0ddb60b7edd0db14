#include "server/import/allowance.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace {

constexpr std::uint64_t kMiB = 1u << 20;

TEST(Allowance, GrowsWithTheFilesUpToTheLimits)
{
    renderer::Limits limits;
    limits.import_memory_bytes = 1024 * kMiB;
    limits.import_output_bytes = 512 * kMiB;
    limits.import_s = 30;
    const renderer::Limits small = server::allowance(limits, 5 * kMiB);
    EXPECT_EQ(small.import_memory_bytes, (256 + 60) * kMiB);
    EXPECT_EQ(small.import_output_bytes, (256 + 60) * kMiB);
    EXPECT_EQ(small.import_s, 15u);
    EXPECT_EQ(small.triangles, limits.triangles);
    const renderer::Limits large = server::allowance(limits, 64 * kMiB);
    EXPECT_EQ(large.import_memory_bytes, 1024 * kMiB);
    EXPECT_EQ(large.import_output_bytes, 512 * kMiB);
    EXPECT_EQ(large.import_s, 30u);
}

TEST(Allowance, NeverExceedsAWholeNumber)
{
    const renderer::Limits most = server::allowance(renderer::Limits::none(), ~std::uint64_t{0});
    EXPECT_GT(most.import_memory_bytes, 1ull << 56);
    EXPECT_EQ(server::allowance({}, 0).import_s, 10u);
}

} // namespace
