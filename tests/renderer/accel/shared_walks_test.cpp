#include "renderer/accel/shared_walks.h"

#include <gtest/gtest.h>

using namespace renderer;

namespace {

constexpr std::uint32_t kLost = 32, kPaid = 16; // a third of the walks may be lost

// After `walked` walks more, each `of`th of which was lost: of 1600 different rays, those that would be followed
// together.
int tried_of_1600(SharedWalks& walks, int walked, int of)
{
    for (int i = 0; i < walked; ++i)
        walks.tell(i % of != 0);
    int tried = 0;
    for (int i = 0; i < 1600; ++i)
        tried += walks.worth_trying(Ray{{0, 0, 0}, {0.1 + 0.001 * i, 0, 1}});
    return tried;
}

} // namespace

TEST(SharedWalks, AreTriedUntilManyAreLostInARow)
{
    SharedWalks walks(kLost, kPaid);
    EXPECT_EQ(tried_of_1600(walks, 0, 1), 1600);
    EXPECT_EQ(tried_of_1600(walks, 100, 1), 1600);
}

TEST(SharedWalks, ThatDoNotPayAreTriedNowAndThen)
{
    SharedWalks walks(kLost, kPaid);
    const int tried = tried_of_1600(walks, 3000, 1);
    EXPECT_GT(tried, 50);
    EXPECT_LT(tried, 200);
}

TEST(SharedWalks, AreTakenUpAgainOnceTheyPay)
{
    SharedWalks walks(kLost, kPaid);
    EXPECT_LT(tried_of_1600(walks, 3000, 1), 200);
    EXPECT_EQ(tried_of_1600(walks, 100, 1000), 1600);
}

TEST(SharedWalks, GoOnWhereAQuarterIsLost)
{
    SharedWalks walks(kLost, kPaid);
    EXPECT_EQ(tried_of_1600(walks, 30000, 4), 1600);
}

TEST(SharedWalks, StopWhereHalfIsLost)
{
    SharedWalks walks(kLost, kPaid);
    EXPECT_LT(tried_of_1600(walks, 30000, 2), 200);
}

TEST(SharedWalks, ForAnyHitGoOnWhereHalfOfThemPay)
{
    SharedWalks walks = FanWalks().any;
    for (int i = 0; i < 30000; ++i)
        walks.tell(i % 2 == 0);
    EXPECT_EQ(tried_of_1600(walks, 0, 1), 1600);
    EXPECT_LT(tried_of_1600(walks, 30000, 1), 200);
}

// A corner of a mesh may be hard where the rest is not.
TEST(SharedWalks, ForAnyHitGoOnAfterThousandsThatWereLost)
{
    SharedWalks walks = FanWalks().any;
    EXPECT_EQ(tried_of_1600(walks, 3000, 1), 1600);
}
