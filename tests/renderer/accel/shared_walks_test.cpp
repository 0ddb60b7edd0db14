#include "renderer/accel/shared_walks.h"

#include <gtest/gtest.h>

using namespace renderer;

namespace {

// Of many different rays, those that would be followed together.
int tried_of_1600(const SharedWalks& walks)
{
    int tried = 0;
    for (int i = 0; i < 1600; ++i)
        tried += walks.worth_trying(Ray{{0, 0, 0}, {0.1 + 0.001 * i, 0, 1}});
    return tried;
}

} // namespace

TEST(SharedWalks, AreTriedUntilTheyHaveBeenLostManyTimes)
{
    SharedWalks walks;
    EXPECT_EQ(tried_of_1600(walks), 1600);
    for (int i = 0; i < 100; ++i)
        walks.tell(false);
    EXPECT_EQ(tried_of_1600(walks), 1600);
}

TEST(SharedWalks, ThatDoNotPayAreTriedNowAndThen)
{
    SharedWalks walks;
    for (int i = 0; i < 1000; ++i)
        walks.tell(false);
    EXPECT_GT(tried_of_1600(walks), 50);
    EXPECT_LT(tried_of_1600(walks), 200);
}

TEST(SharedWalks, AreTakenUpAgainOnceTheyPay)
{
    SharedWalks walks;
    for (int i = 0; i < 1000; ++i)
        walks.tell(false);
    for (int i = 0; i < 16; ++i)
        walks.tell(true);
    EXPECT_EQ(tried_of_1600(walks), 1600);
}

TEST(SharedWalks, GoOnWhereOneInFourPays)
{
    SharedWalks walks;
    for (int i = 0; i < 1000; ++i)
        walks.tell(i % 4 == 0);
    EXPECT_EQ(tried_of_1600(walks), 1600);
}
