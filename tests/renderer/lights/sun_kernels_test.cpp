// Every kernel that this processor can run: the same directions to a sun as drawn one by one.
#include "renderer/lights/sun_kernels.h"
#include "tests/renderer/sampling/edge_numbers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace {

using namespace renderer;

Sun sun_of(Vec3d travels, double radius_deg)
{
    SunLight light;
    light.direction = travels;
    light.angular_radius_deg = radius_deg;
    return prepare_sun(light);
}

} // namespace

TEST(SunKernels, DrawAsOneByOneToTheBit)
{
    const std::vector<Sample2> u = tests::edge_numbers();
    for (const DrawTowardsSun kernel : all_draw_towards_sun())
        for (const Vec3d travels :
             {Vec3d{0, -1, 0}, Vec3d{0, 0, 1}, Vec3d{0, 0, -1}, Vec3d{-0.5, -1, -0.6}, Vec3d{3, 1e-9, -1}})
            for (const double radius : {1e-6, 0.263, 30.0, 90.0, 180.0}) {
                const Sun sun = sun_of(travels, radius);
                std::vector<Vec3d> drawn(u.size());
                kernel(sun, u, drawn);
                for (std::size_t i = 0; i < u.size(); ++i)
                    ASSERT_EQ(drawn[i], sample(sun, u[i])) << radius << ": " << u[i].u0 << ' ' << u[i].u1;
            }
}

TEST(SunKernels, WriteAsManyAsThereAre)
{
    const std::vector<Sample2> u = tests::edge_numbers();
    const Sun sun = sun_of({1, -2, 3}, 5);
    for (const DrawTowardsSun kernel : all_draw_towards_sun())
        for (std::size_t count = 0; count < 20; ++count) {
            const Vec3d untouched{7, 8, 9};
            std::vector<Vec3d> drawn(20, untouched);
            kernel(sun, std::span(u).first(count), drawn);
            EXPECT_EQ(std::ranges::count(drawn, untouched), static_cast<std::ptrdiff_t>(20 - count));
        }
}
