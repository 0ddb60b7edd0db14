#include "server/jobs/wait_estimate.h"

#include <gtest/gtest.h>

namespace {

using server::WaitEstimate;

TEST(WaitEstimate, IsASecondAtLeastAndAnHourAtMost)
{
    WaitEstimate estimate;
    EXPECT_EQ(estimate.seconds(0), 1);
    estimate.took(0.001);
    EXPECT_EQ(estimate.seconds(10), 1);
    estimate.took(1e9);
    EXPECT_EQ(estimate.seconds(1000), 3600);
    EXPECT_EQ(estimate.seconds(UINT64_MAX), 3600);
}

TEST(WaitEstimate, GrowsWithTheQueueAndFollowsWhatJobsTake)
{
    WaitEstimate estimate;
    estimate.took(10);
    EXPECT_EQ(estimate.seconds(1), 10);
    EXPECT_EQ(estimate.seconds(3), 30);
    estimate.took(20); // one of many: a fifth of the way
    EXPECT_EQ(estimate.seconds(1), 12);
    for (int i = 0; i < 100; ++i)
        estimate.took(20);
    EXPECT_EQ(estimate.seconds(1), 20);
}

} // namespace
