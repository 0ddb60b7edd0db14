#include "server/jobs/wait_estimate.h"

#include <gtest/gtest.h>

namespace {

using server::WaitEstimate;

TEST(WaitEstimate, IsASecondAtLeastAndHalfAMinuteAtMost)
{
    WaitEstimate estimate;
    EXPECT_EQ(estimate.seconds(), 1);
    estimate.took(0.001);
    EXPECT_EQ(estimate.seconds(), 1);
    estimate.took(1e9);
    EXPECT_EQ(estimate.seconds(), 30);
}

TEST(WaitEstimate, IsWhatOneJobTakesAndFollowsTheLastOnes)
{
    WaitEstimate estimate;
    estimate.took(10);
    EXPECT_EQ(estimate.seconds(), 10);
    estimate.took(20); // one of many: a fifth of the way
    EXPECT_EQ(estimate.seconds(), 12);
    for (int i = 0; i < 100; ++i)
        estimate.took(20);
    EXPECT_EQ(estimate.seconds(), 20);
}

} // namespace
