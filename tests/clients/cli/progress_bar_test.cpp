#include "clients/cli/progress_bar.h"

#include <gtest/gtest.h>

#include <limits>

namespace {

using clients::progress_line;

TEST(ProgressLine, ShowsTheFractionAndWhatIsLeft)
{
    EXPECT_EQ(progress_line(0.5, 10, "32 samples"),
              "[###############...............]  50%  10 s left  32 samples");
    EXPECT_EQ(progress_line(1, 10, ""), "[##############################] 100%");
    EXPECT_EQ(progress_line(0.25, 100, ""), "[########......................]  25%  5 min 0 s left");
}

TEST(ProgressLine, DoesNotGuessTooEarly)
{
    EXPECT_EQ(progress_line(0.01, 10, "queued"), "[..............................]   1%  queued");
    EXPECT_EQ(progress_line(0.5, 0.1, ""), "[###############...............]  50%");
}

TEST(ProgressLine, BearsAnyNumber)
{
    EXPECT_EQ(progress_line(-1, 0, ""), "[..............................]   0%");
    EXPECT_EQ(progress_line(7, 0, ""), "[##############################] 100%");
    EXPECT_EQ(progress_line(std::numeric_limits<double>::quiet_NaN(), 0, ""),
              "[..............................]   0%");
}

} // namespace
