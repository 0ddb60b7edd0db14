#include "renderer/render.h"
#include "renderer/sampling/sampler.h"
#include "renderer/trace.h"
#include "tests/support/render_scene.h"

#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <limits>
#include <set>
#include <thread>
#include <type_traits>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

using namespace renderer;
using tests::digest;
using tests::kitchen_sink;
using tests::make_ready;
using tests::render_description;
using tests::TestScene;

TEST(Render, GivesTheSameBitsOnAnyNumberOfThreads)
{
    const std::uint64_t want = digest(render_description(kitchen_sink(), 1).film);
    for (const unsigned threads : {2u, 3u, 4u, 5u, 6u, 7u, 8u, 16u, 64u})
        EXPECT_EQ(digest(render_description(kitchen_sink(), threads).film), want) << threads;
    TestScene limited = kitchen_sink();
    limited.settings.acceleration.threads = 3; // of a pool of 8
    const RenderResult result = render_description(limited, 8);
    EXPECT_EQ(digest(result.film), want);
    EXPECT_EQ(result.report.threads, 3u);
}

TEST(Render, GivesTheSameBitsForEveryTileSize)
{
    const std::uint64_t want = digest(render_description(kitchen_sink(), 1).film);
    for (const std::uint32_t tile : {1u, 7u, 16u, 64u, 1000000u, 0xffffffffu}) {
        TestScene test = kitchen_sink();
        test.settings.acceleration.tile_px = tile;
        EXPECT_EQ(digest(render_description(test, 2).film), want) << tile;
    }
}

TEST(Render, GivesTheSameBitsWhateverTheAcceleration)
{
    TestScene small = kitchen_sink();
    small.settings.image.region = PixelRect{24, 16, 24, 18}; // without trees the whole picture takes long
    const std::uint64_t want = digest(render_description(small).film);
    for (const BvhSplit split : {BvhSplit::sah, BvhSplit::midpoint, BvhSplit::spatial})
        for (const BvhWidth width : {BvhWidth::wide, BvhWidth::binary})
            for (const BvhLevels levels : {BvhLevels::two, BvhLevels::mesh, BvhLevels::none})
                for (const bool bounds : {false, true}) {
                    TestScene test = small;
                    test.settings.acceleration.split = split;
                    test.settings.acceleration.width = width;
                    test.settings.acceleration.levels = levels;
                    test.settings.acceleration.bounds = bounds;
                    EXPECT_EQ(digest(render_description(test).film), want)
                        << static_cast<int>(split) << static_cast<int>(width) << static_cast<int>(levels)
                        << bounds;
                }
}

TEST(Render, GivesTheSameBitsWhateverEarlierFramesLeftBehind)
{
    TestScene test;
    test.settings.image.width_px = test.settings.image.height_px = 12;
    test.settings.quality.samples = 1;
    test.meshes.push_back(tests::knot(24, 6));
    for (int i = 0; i < 400; ++i) {
        ObjectDescription& object = test.description.objects.emplace_back();
        object.shape = i % 3 == 0 ? Shape{MeshShape{}} : Shape{SphereShape{0.3}};
        object.world_from_object = Affine3::translate({1.0 * (i % 8), 1.0 * (i / 8 % 8), 1.0 * (i / 64)}) *
                                   Affine3::scale({.2, .2, .2});
    }
    SceneCaches caches;
    EXPECT_EQ(render_description(test, 2, &caches).report.geometry.upper_level, UpperLevel::built);
    for (int frame = 1; frame <= 5; ++frame) {
        for (int i = frame; i < 400; i += 7) {
            Affine3& there = test.description.objects[static_cast<std::size_t>(i)].world_from_object;
            there = Affine3::translate({0.05 * (i % 3), 0.03, -0.01 * (i % 5)}) * there;
        }
        const RenderResult kept = render_description(test, 2, &caches), alone = render_description(test, 2);
        EXPECT_EQ(kept.report.geometry.upper_level, UpperLevel::refitted) << frame;
        EXPECT_EQ(alone.report.geometry.upper_level, UpperLevel::built);
        EXPECT_EQ(digest(kept.film), digest(alone.film)) << frame;
    }
}

TEST(Render, GivesTheSameBitsOfASingleObjectWithoutTrees)
{
    TestScene test = kitchen_sink();
    test.description.objects.resize(1);
    const std::uint64_t want = digest(render_description(test).film);
    for (const BvhLevels levels : {BvhLevels::mesh, BvhLevels::none})
        for (const bool bounds : {false, true}) {
            test.settings.acceleration.levels = levels;
            test.settings.acceleration.bounds = bounds;
            EXPECT_EQ(digest(render_description(test).film), want) << static_cast<int>(levels) << bounds;
        }
}

TEST(Render, StopsWithinABlockOfPixels)
{
    // Two thousand million samples of one pixel: weeks, if stop were only looked at between pixels.
    TestScene test = kitchen_sink();
    test.settings.acceleration.levels = BvhLevels::none;
    ThreadPool pool(1);
    const tests::ReadyScene ready = make_ready(test, pool);
    std::stop_source source;
    std::optional<TracedUnit> traced;
    std::atomic<bool> begun = false;
    {
        const std::jthread tracer([&] {
            begun = true;
            traced = trace(*ready.scene, ready.plan, 1, {{30, 20, 1, 1}, {0, 1u << 31}}, source.get_token());
        });
        while (!begun)
            std::this_thread::yield();
        source.request_stop();
    }
    EXPECT_FALSE(traced);
}

TEST(Render, GivesACropThePixelsOfTheFullPicture)
{
    TestScene test = kitchen_sink();
    const Film full = render_description(test).film;
    for (const PixelRect region : {PixelRect{0, 0, 1, 1},
                                   PixelRect{69, 49, 1, 1},
                                   PixelRect{13, 9, 30, 20},
                                   PixelRect{0, 25, 70, 1}}) {
        test.settings.image.region = region;
        const Film crop = render_description(test).film;
        for (std::uint32_t y = 0; y < region.height; ++y)
            for (std::uint32_t x = 0; x < region.width; ++x)
                ASSERT_EQ(crop.sums[y * region.width + x], full.sums[(region.y + y) * 70 + region.x + x]);
    }
}

TEST(Render, DependsOnTheSeed)
{
    TestScene test = kitchen_sink();
    const std::uint64_t one = digest(render_description(test).film);
    test.settings.seed = 2;
    EXPECT_NE(digest(render_description(test).film), one);
}

TEST(Render, StoppedByTimeEqualsTheRenderOfThatManySamples)
{
    TestScene test = kitchen_sink();
    test.settings.quality = {};
    test.settings.quality.time_s = 0.05;
    const RenderResult stopped = render_description(test);
    EXPECT_GE(stopped.report.accuracy.samples, 1u);
    test.settings.quality = {};
    test.settings.quality.samples = stopped.report.accuracy.samples;
    EXPECT_EQ(digest(render_description(test).film), digest(stopped.film));
}

TEST(Render, MakesOneWholePassHoweverShortTheTime)
{
    TestScene test = kitchen_sink();
    test.settings.quality = {};
    test.settings.quality.time_s = 1e-9;
    const RenderResult result = render_description(test);
    EXPECT_EQ(result.report.accuracy.samples, 1u);
    EXPECT_EQ(result.report.accuracy.stop_reason, StopReason::time);
}

TEST(Render, StopsAtTheSamplesWhereTimeIsLeft)
{
    TestScene test = kitchen_sink();
    test.settings.quality.samples = 7; // within a pass
    const std::uint64_t want = digest(render_description(test).film);
    test.settings.quality.time_s = 1000;
    const RenderResult both = render_description(test);
    EXPECT_EQ(both.report.accuracy.samples, 7u);
    EXPECT_EQ(both.report.accuracy.stop_reason, StopReason::samples);
    EXPECT_EQ(digest(both.film), want);

    test.settings.quality.samples.reset();
    test.settings.quality.max_samples = 6;
    EXPECT_EQ(render_description(test).report.accuracy.samples, 6u);
}

TEST(Render, TakesTheDefaultSamplesWhereNothingIsSaid)
{
    TestScene test = kitchen_sink();
    test.settings.quality = {};
    test.settings.image.region = PixelRect{30, 20, 4, 4};
    EXPECT_EQ(render_description(test).report.accuracy.samples, kDefaultSamples);
}

TEST(Render, CountsItsRays)
{
    const TestScene test = kitchen_sink();
    const RenderReport report = render_description(test).report;
    EXPECT_EQ(report.timing.camera_rays, 70u * 50 * 7);
    EXPECT_GT(report.timing.shadow_rays, 0u);
    EXPECT_LE(report.timing.shadow_rays, 4 * report.timing.camera_rays); // three lights and the environment
    EXPECT_EQ(report.numerics.non_finite_samples, 0u);
    EXPECT_FALSE(report.models.used.empty());
    EXPECT_EQ(report.geometry.instances, 6u);
}

TEST(Render, DropsAndCountsSamplesThatAreNotFinite)
{
    TestScene test = kitchen_sink();
    const float huge = std::numeric_limits<float>::max();
    test.description.lights.emplace_back(DirectionalLight{{0, -1, 0}, {huge, huge, huge}});
    test.description.lights.emplace_back(DirectionalLight{{0, -1, 0}, {huge, huge, huge}});
    test.description.lights.emplace_back(DirectionalLight{{0, -1, 0}, {huge, huge, huge}});
    test.description.lights.emplace_back(DirectionalLight{{0, -1, 0}, {huge, huge, huge}});
    test.description.materials[0].material = PhongMaterial{.diffuse = {1, 1, 1}, .form = PhongForm::classic};
    const RenderResult result = render_description(test);
    EXPECT_GT(result.report.numerics.non_finite_samples, 0u);
    for (const RgbSum& sum : result.film.sums)
        ASSERT_TRUE(std::isfinite(sum.r + sum.g + sum.b));
}

#if defined(__SSE2__)
TEST(Render, GivesTheSameBitsUnderACallersFlushToZero)
{
    TestScene test;
    Mesh tiny = tests::faceted_sphere(24, 12);
    for (auto& p : tiny.positions)
        p = p * 1e-20f * 1e-19f; // subnormal, every coordinate
    test.meshes.push_back(tiny);
    ObjectDescription object;
    object.world_from_object = Affine3::scale(Vec3d{1, 1, 1} * 1e39);
    test.description.objects.push_back(object);
    test.settings.image.width_px = 32;
    test.settings.image.height_px = 24;
    test.settings.quality.samples = 2;
    const RenderResult rendered = render_description(test);
    const RgbSum middle = rendered.film.sums[12 * 32 + 16], corner = rendered.film.sums[0];
    EXPECT_NE(middle, corner) << "the mesh is not seen at all";
    const std::uint64_t as_is = tests::digest(rendered.film);
    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | 0x8040u); // flush to zero, denormals are zero
    const std::uint64_t flushed = tests::digest(render_description(test).film);
    const unsigned during = _mm_getcsr();
    _mm_setcsr(before);
    EXPECT_EQ(flushed, as_is);
    EXPECT_EQ(during & 0x8040u, 0x8040u) << "the caller's own mode was changed";
}
#endif

TEST(Render, CountsNoSampleTwiceInTheLargestPicture)
{
    // 2^30 pixels and 2^20 samples: whatever is numbered in 32 bits would come round again.
    TestScene test = kitchen_sink();
    test.settings.image.width_px = test.settings.image.height_px = 32768;
    test.settings.image.region = PixelRect{32760, 32760, 8, 8};
    ThreadPool pool(1);
    const tests::ReadyScene ready = tests::make_ready(test, pool);
    const auto traced = [&](std::uint32_t x, std::uint32_t first) {
        const WorkUnit unit{{x, 32767, 1, 1}, {first, first + 4}};
        return trace(*ready.scene, ready.plan, 7, unit, {}).value();
    };
    const TracedUnit last = traced(32767, (1u << 20) - 4);
    EXPECT_EQ(last.tally.camera_rays, 4u);
    std::set<std::uint64_t> seen;
    for (const std::uint32_t pixel : {0u, 4u, 16384u, 32767u})
        for (const std::uint32_t sample : {0u, 1u << 16, (1u << 20) - 4, 1u << 31, 0xfffffff8u}) {
            const PixelSampler sampler(7, pixel, 32767);
            const Sample2 u = sampler.sample_2d(sample, 0);
            seen.insert((std::uint64_t{std::bit_cast<std::uint32_t>(u.u0)} << 32) |
                        std::bit_cast<std::uint32_t>(u.u1));
        }
    EXPECT_EQ(seen.size(), 20u);
    static_assert(std::is_same_v<decltype(RayTally::camera_rays), std::uint64_t>);
}

TEST(Render, RendersThinAndSinglePixelPictures)
{
    for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 3000u}, {3000u, 1u}}) {
        TestScene test = kitchen_sink();
        test.settings.image.width_px = width;
        test.settings.image.height_px = height;
        test.settings.quality.samples = 1;
        EXPECT_EQ(render_description(test).film.sums.size(), std::size_t{width} * height);
    }
}

TEST(Render, GivesNothingWhenItIsStopped)
{
    TestScene test = kitchen_sink();
    test.settings.quality.samples = 1u << 30; // days
    ThreadPool pool(4);
    const auto ready = make_ready(test, pool);
    std::stop_source source;
    std::atomic<bool> told = false;
    const auto result =
        render(*ready.scene, ready.plan, test.settings, pool, source.get_token(), [&](const RenderProgress&) {
            told = true;
            source.request_stop(); // after the first sign of life
        });
    EXPECT_FALSE(result);
    EXPECT_TRUE(told);
    // And the pool works on.
    EXPECT_EQ(
        digest(render_description(kitchen_sink()).film),
        digest(render(*make_ready(kitchen_sink(), pool).scene, ready.plan, kitchen_sink().settings, pool)
                   ->film));
}

TEST(Render, TellsItsProgressOneAtATimeAndNeverBackwards)
{
    TestScene test = kitchen_sink();
    test.settings.quality = {};
    test.settings.quality.samples = 96;
    ThreadPool pool(4);
    const auto ready = make_ready(test, pool);
    std::atomic<int> inside = 0;
    double fraction = 0;
    RenderProgress last;
    const auto result =
        render(*ready.scene, ready.plan, test.settings, pool, {}, [&](const RenderProgress& p) {
            EXPECT_EQ(++inside, 1);
            EXPECT_GE(p.fraction, fraction);
            EXPECT_GE(p.samples, last.samples);
            EXPECT_GE(p.pass, last.pass);
            fraction = p.fraction;
            last = p;
            --inside;
        });
    ASSERT_TRUE(result);
    EXPECT_EQ(last.fraction, 1);
    EXPECT_EQ(last.samples, 96u);
    EXPECT_EQ(last.pass, 10u); // 1 1 2 4 8 and five of 16
}

TEST(Render, SharesOneHeavyTileAmongThreads)
{
    // One tile holds the whole picture: its slices are the units of work, and no sum depends on who took
    // them.
    TestScene test = kitchen_sink();
    test.settings.image.width_px = test.settings.image.height_px = 16;
    test.settings.quality.samples = 64;
    const std::uint64_t want = digest(render_description(test, 1).film);
    for (const unsigned threads : {2u, 5u, 8u})
        EXPECT_EQ(digest(render_description(test, threads).film), want);
}
