#include "renderer/plan/predict_cost.h"

#include <gtest/gtest.h>

namespace {

using namespace renderer;

Prediction predicted(const RenderSettings& settings)
{
    return predict_cost(SceneDescription{}, settings, Budget{}, {});
}

} // namespace

TEST(PredictCost, OfAGivenTimeIsWhatThatTimeTraces)
{
    RenderSettings settings;
    settings.acceleration.threads = 2;
    settings.quality.samples = 1000;
    const Prediction counted = predicted(settings);
    EXPECT_EQ(counted.camera_rays, std::uint64_t{1000} * settings.image.width_px * settings.image.height_px);
    settings.quality.samples.reset();
    settings.quality.time_s = 2;
    const Prediction timed = predicted(settings);
    EXPECT_DOUBLE_EQ(timed.seconds, 2);
    EXPECT_DOUBLE_EQ(timed.rays, 2 * 2 / kSecondsARay);
    EXPECT_GT(timed.camera_rays, 0u);
    EXPECT_LE(static_cast<double>(timed.camera_rays), timed.rays);
    // Time that is not needed is not taken.
    settings.quality.max_samples = 1;
    settings.quality.time_s = 1e6;
    const Prediction one = predicted(settings);
    EXPECT_EQ(one.camera_rays, std::uint64_t{settings.image.width_px} * settings.image.height_px);
    EXPECT_LT(one.seconds, 100);
    settings.quality.max_samples = 65536;
    settings.quality.time_s = 1e-9;
    EXPECT_GE(predicted(settings).camera_rays, 1u);
}
