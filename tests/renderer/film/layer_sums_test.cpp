#include "renderer/film/film.h"
#include "renderer/film/layer_sums.h"

#include <gtest/gtest.h>

#include <limits>

using namespace renderer;

namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

LayerSet every_layer()
{
    LayerSet all;
    for (const LayerEntry& entry : kLayers)
        all.add(entry.layer);
    return all;
}

} // namespace

TEST(LayerSums, GiveTheMeanDepthOfWhatWasHitAndTheMeanOfAllElse)
{
    LayerSums sums(every_layer(), 2);
    sums.add(0, 2, {0, 0, 1}, {1, 0.5f, 0.25f});
    sums.add(0, 4, {0, 1, 0}, {1, 0.5f, 0.25f});
    const std::vector<LayerImage> images = sums.mean(4); // two of the first pixel's samples hit nothing
    ASSERT_EQ(images.size(), kLayers.size());
    EXPECT_EQ(images[0].values, (std::vector<float>{3, kFar}));
    EXPECT_EQ(images[1].values, (std::vector<float>{0, 0.25f, 0.25f, 0, 0, 0}));
    EXPECT_EQ(images[2].values, (std::vector<float>{0.5f, 0.25f, 0.125f, 0, 0, 0}));
    EXPECT_EQ(images[3].values, (std::vector<float>{4, 4}));
    for (std::size_t i = 0; i < images.size(); ++i)
        EXPECT_EQ(images[i].layer, kLayers[i].layer);
}

TEST(LayerSums, HoldNothingThatWasNotAskedFor)
{
    LayerSet depth;
    depth.add(Layer::depth);
    LayerSums sums(depth, 1);
    sums.add(0, 2, {0, 0, 1}, {1, 1, 1});
    const std::vector<LayerImage> images = sums.mean(1);
    ASSERT_EQ(images.size(), 1u);
    EXPECT_EQ(images[0].values, (std::vector<float>{2}));
    LayerSums none({}, 1);
    none.add(0, 2, {0, 0, 1}, {1, 1, 1});
    EXPECT_TRUE(none.mean(1).empty());
    EXPECT_EQ(layer_sum_bytes({}), 0u);
}

TEST(LayerSums, LeaveOutWhatIsNotFinite)
{
    LayerSums sums(every_layer(), 1);
    sums.add(0, 2, {0, 0, 1}, {1, 1, 1});
    sums.add(0, kFar, {kFar, 0, 0}, {std::numeric_limits<float>::quiet_NaN(), 0, 0});
    const std::vector<LayerImage> images = sums.mean(2);
    EXPECT_EQ(images[0].values, (std::vector<float>{2}));
    EXPECT_EQ(images[1].values, (std::vector<float>{0, 0, 0.5f}));
    EXPECT_EQ(images[2].values, (std::vector<float>{0.5f, 0.5f, 0.5f}));
}

TEST(LayerSums, AreBlackAndInfinitelyFarBeforeTheFirstSample)
{
    const std::vector<LayerImage> images = LayerSums(every_layer(), 1).mean(0);
    EXPECT_EQ(images[0].values, (std::vector<float>{kFar}));
    EXPECT_EQ(images[1].values, (std::vector<float>{0, 0, 0}));
    EXPECT_EQ(images[3].values, (std::vector<float>{0}));
}

TEST(LayerSums, GoWhereTheFullPictureHasTheTile)
{
    Film film(PixelRect{10, 20, 3, 2}, every_layer());
    LayerSums part(every_layer(), 2);
    part.add(0, 5, {1, 0, 0}, {});
    part.add(1, 7, {0, 1, 0}, {});
    film.merge(TileSums{{11, 21, 2, 1}, {{}, {}}, part});
    const std::vector<LayerImage> images = film.layers.mean(1);
    EXPECT_EQ(images[0].values, (std::vector<float>{kFar, kFar, kFar, kFar, 5, 7}));
    EXPECT_EQ(images[1].values[12], 1);
    EXPECT_EQ(images[1].values[16], 1);
}
