#include "renderer/description/fault_list.h"

#include <gtest/gtest.h>

#include <string>

using renderer::FaultList;
using renderer::kMostFaults;

TEST(FaultList, GivesBackWhatItGotInItsOrder)
{
    FaultList list;
    EXPECT_TRUE(list.empty());
    list.add({"/b", "one", "first"});
    list.add({"/a", "two", "second"});
    EXPECT_EQ(list.count(), 2u);
    const auto faults = list.take();
    ASSERT_EQ(faults.size(), 2u);
    EXPECT_EQ(faults[0].pointer, "/b");
    EXPECT_EQ(faults[1].pointer, "/a");
    EXPECT_TRUE(list.empty());
}

TEST(FaultList, CountsWhatItHasNoRoomFor)
{
    FaultList list;
    for (std::size_t i = 0; i < kMostFaults; ++i)
        list.add({"/" + std::to_string(i), "code", "detail"});
    FaultList fuller = list;
    EXPECT_EQ(list.take().size(), kMostFaults); // as many as fit are no more than fit
    for (int i = 0; i < 234; ++i)
        fuller.add({"/x", "code", "detail"});
    EXPECT_EQ(fuller.count(), kMostFaults + 234);
    const auto faults = fuller.take();
    ASSERT_EQ(faults.size(), kMostFaults + 1);
    EXPECT_EQ(faults.back(), renderer::more_faults(234));
    EXPECT_EQ(faults.back().detail, "234 more faults are not listed here");
}
