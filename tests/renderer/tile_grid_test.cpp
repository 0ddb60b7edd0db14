#include "renderer/tile_grid.h"

#include <gtest/gtest.h>

using renderer::tile_side;

TEST(TileSide, IsTheOneAskedForWithinItsBounds)
{
    EXPECT_EQ(tile_side(16, 1u << 20), 16u);
    EXPECT_EQ(tile_side(0, 1u << 20), 1u);
    EXPECT_EQ(tile_side(100'000, 1u << 20), renderer::kLargestTile);
}

TEST(TileSide, ShrinksUntilItsPixelsFit)
{
    EXPECT_EQ(tile_side(256, 256 * 256), 256u);
    EXPECT_EQ(tile_side(256, 256 * 256 - 1), 255u);
    EXPECT_EQ(tile_side(256, 99), 9u);
    EXPECT_EQ(tile_side(256, 0), 1u);
}
