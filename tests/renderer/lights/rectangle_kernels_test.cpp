// Every kernel that this processor can run: the same points of a rectangle as drawn one by one.
#include "renderer/lights/rectangle_kernels.h"
#include "renderer/lights/sample_emitter.h"
#include "renderer/lights/spherical_sampling.h"
#include "renderer/math/vec3.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using namespace renderer;

// From far away to almost in the plane, on both sides, and at places where something is zero.
std::vector<Vec3d> places(std::size_t count)
{
    std::vector<Vec3d> places{
        {0, 0, 1}, {0, 0, -1}, {2, 0, 0}, {0, 0, 0}, {0.5, 0.25, 1e-9}, {0.5, 0.25, -1e-12}, {1e6, 0, 1}};
    const PixelSampler sampler(11, 2, 3);
    for (std::uint32_t i = 0; places.size() < count; ++i) {
        const Sample2 a = sampler.sample_2d(i, 0), b = sampler.sample_2d(i, 1);
        const auto spread = [](float u) { return 2 * static_cast<double>(u) - 1; };
        const double size = std::pow(10.0, 3 * spread(b.u1));
        places.push_back(Vec3d{spread(a.u0), spread(a.u1), spread(b.u0)} * size);
    }
    return places;
}

Emitter lamp(bool two_sided)
{
    Affine3 square;
    square.translation = {0.1, -0.2, 0.3};
    const Vec3d u = normalize(Vec3d{1, 0.2, -0.1}), v = normalize(cross(Vec3d{0.3, 0.1, 1}, u));
    for (std::size_t i = 0; i < 3; ++i) {
        square.rows[i][0] = u[i] * 1.7;
        square.rows[i][1] = v[i] * 0.6;
        square.rows[i][2] = cross(u, v)[i];
    }
    return *rectangle_emitter(square, {1, 2, 3}, two_sided);
}

} // namespace

TEST(RectangleKernels, DrawAsOneByOneToTheBit)
{
    const std::vector<Vec3d> at = places(4096);
    const PixelSampler sampler(5, 3, 4);
    const RectangleView view{.corner = {-0.7, -0.4, 0.25},
                             .x = {0.6, 0.8, 0},
                             .y = {-0.8, 0.6, 0},
                             .z = {0, 0, 1},
                             .width = 1.5,
                             .height = 0.75};
    std::size_t seen_by = 0;
    for (const DrawOnRectangle kernel : all_draw_on_rectangle())
        for (std::size_t first = 0; first < at.size(); first += RectangleRun::kPoints) {
            RectangleRun run;
            for (std::size_t i = 0; i < RectangleRun::kPoints; ++i) {
                for (std::size_t axis = 0; axis < 3; ++axis)
                    run.point[axis][i] = at[first + i][axis];
                const Sample2 u = sampler.sample_2d(static_cast<std::uint32_t>(first + i), 0);
                run.u0[i] = static_cast<double>(u.u0);
                run.u1[i] = static_cast<double>(u.u1);
            }
            kernel(view, run, RectangleRun::kPoints);
            for (std::size_t i = 0; i < RectangleRun::kPoints; ++i) {
                const Vec3d& point = at[first + i];
                const SphericalRectangle seen(
                    view.corner - point, {.x = view.x, .y = view.y, .z = view.z}, view.width, view.height);
                ASSERT_EQ(run.solid_angle[i], seen.solid_angle());
                if (!(seen.solid_angle() > 0)) continue;
                ++seen_by;
                const Vec3d way =
                    point + seen.sample({static_cast<float>(run.u0[i]), static_cast<float>(run.u1[i])}) -
                    point;
                const double distance = length(way);
                ASSERT_EQ(run.distance[i], distance);
                if (!(distance > 0)) continue;
                const Vec3d direction{run.direction[0][i], run.direction[1][i], run.direction[2][i]};
                ASSERT_EQ(direction, way / distance);
            }
        }
    EXPECT_GT(seen_by, at.size() / 2);
}

TEST(ManyPoints, AreLitByARectangleAsOneByOneToTheBit)
{
    const PixelSampler sampler(6, 3, 4);
    for (const bool two_sided : {false, true}) {
        const Emitter emitter = lamp(two_sided);
        ASSERT_TRUE(emitter.is_rectangle);
        for (const std::size_t count : {1u, 7u, 64u, 65u, 1000u}) {
            const std::vector<Vec3d> at = places(count);
            std::vector<Sample2> u(at.size());
            for (std::size_t i = 0; i < u.size(); ++i)
                u[i] = sampler.sample_2d(static_cast<std::uint32_t>(i), 0);
            std::vector<EmitterSample> drawn(at.size());
            sample_many(emitter, at, u, drawn);
            for (std::size_t i = 0; i < at.size(); ++i) {
                const EmitterSample alone = sample(emitter, at[i], u[i]);
                ASSERT_EQ(drawn[i].wi, alone.wi) << i;
                ASSERT_EQ(drawn[i].distance, alone.distance) << i;
                ASSERT_EQ(drawn[i].pdf, alone.pdf) << i;
            }
        }
    }
}
