#include "renderer/lights/sun.h"
#include "renderer/math/transcendental.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace renderer;

namespace {

Sun sun_of(double radius_deg, Vec3d travels = {0, -1, 0})
{
    SunLight light;
    light.direction = travels;
    light.irradiance = {2, 2, 2};
    light.angular_radius_deg = radius_deg;
    return prepare_sun(light);
}

Vec3d draw(const Sun& sun, std::uint32_t i)
{
    return sample(sun, PixelSampler(6, 1, 2).sample_2d(i, 0));
}

} // namespace

TEST(Sun, GivesItsIrradianceToAFacingSurfaceWhateverItsSize)
{
    for (const double radius : {1e-6, 1e-3, 0.2665, 10.0, 60.0, 90.0, 180.0}) {
        const Sun sun = sun_of(radius);
        double sum = 0;
        constexpr std::uint32_t kSamples = 65536;
        for (std::uint32_t i = 0; i < kSamples; ++i)
            sum += std::max(0.0, draw(sun, i).y) * static_cast<double>(sun.radiance.g) / sun.pdf;
        EXPECT_NEAR(sum / kSamples, 2, 1e-3) << radius;
    }
}

TEST(Sun, IsSeenWhereItIsDrawn)
{
    for (const double radius : {1e-5, 0.2665, 30.0}) {
        const Sun sun = sun_of(radius, {1, -2, 0.5});
        for (std::uint32_t i = 0; i < 1000; ++i)
            ASSERT_GT(radiance_towards(sun, draw(sun, i)).g, 0) << radius << " " << i;
        EXPECT_EQ(radiance_towards(sun, -sun.toward).g, 0);
    }
}

TEST(Sun, CastsPenumbrasAsWideAsItsDiameterTimesTheDistance)
{
    // Of the sun as seen from the earth, 0.5357 degrees across: 0.00935 of the way from the edge that casts it.
    const Sun sun = sun_of(0.5357 / 2);
    double least = 1, most = -1;
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const Vec3d wi = draw(sun, i);
        least = std::min(least, wi.x / wi.y);
        most = std::max(most, wi.x / wi.y);
    }
    EXPECT_NEAR(most - least, 0.00935, 0.02 * 0.00935);
}
