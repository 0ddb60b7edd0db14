#include "renderer/math/transcendental.h"
#include "renderer/sky/color_error.h"

#include <gtest/gtest.h>

using namespace renderer;

namespace {

constexpr double kHalf = 0.5; // the sun at 30 degrees

AtmosphereDescription earth_at(std::vector<double> nm)
{
    AtmosphereDescription a = atmosphere_preset(AtmospherePreset::earth);
    a.wavelengths_nm = std::move(nm);
    return a;
}

std::vector<double> every(double step, double first)
{
    std::vector<double> nm;
    for (double at = first; at < 740; at += step)
        nm.push_back(at);
    return nm;
}

} // namespace

TEST(ColorError, IsNothingAtTheWavelengthsItIsMeasuredAgainst)
{
    const auto error = color_error(earth_at(every(10, 385)), 0, kHalf);
    ASSERT_TRUE(error);
    EXPECT_EQ(error->sky, 0);
    EXPECT_EQ(error->sun, 0);
}

TEST(ColorError, FallsAsWavelengthsAreAdded)
{
    const auto one = color_error(earth_at({550}), 0, kHalf),
               three = color_error(earth_at({680, 550, 440}), 0, kHalf),
               nine = color_error(earth_at(every(40, 400)), 0, kHalf);
    ASSERT_TRUE(one && three && nine);
    EXPECT_GT(one->sky, three->sky);
    EXPECT_GT(three->sky, 4 * nine->sky);
    EXPECT_GT(one->sun, three->sun);
    EXPECT_GT(three->sun, 2 * nine->sun);
    EXPECT_LT(nine->sky, 0.05);
}

TEST(ColorError, OfGreyAirIsNothing)
{
    AtmosphereDescription grey = earth_at({680, 550, 440});
    grey.rayleigh.scattering = {0};
    grey.ozone.absorption = {0};
    grey.mie.scattering = {4e-6};
    grey.mie.extinction = {5e-6};
    grey.planet.ground_albedo = {0.3};
    const auto error = color_error(grey, 0, kHalf);
    ASSERT_TRUE(error);
    EXPECT_LT(error->sky, 1e-6);
    EXPECT_LT(error->sun, 1e-6);
}

TEST(ColorError, IsNotToldOfCoefficientsListedOneByOne)
{
    AtmosphereDescription listed = earth_at({680, 550, 440});
    listed.rayleigh.scattering = {5e-6, 13e-6, 33e-6};
    EXPECT_FALSE(color_error(listed, 0, kHalf));
}

TEST(ColorError, IsNotToldWhereNothingIsLit)
{
    EXPECT_FALSE(color_error(earth_at({680, 550, 440}), 0, -0.9));
    AtmosphereDescription none = earth_at({680, 550, 440});
    none.rayleigh.scattering = none.ozone.absorption = none.mie.scattering = none.mie.extinction =
        none.planet.ground_albedo = {0};
    EXPECT_FALSE(color_error(none, 0, kHalf));
}

TEST(ColorError, IsToldFromSpaceToo)
{
    const auto error = color_error(earth_at({680, 550, 440}), 1e7, 0.9);
    ASSERT_TRUE(error);
    EXPECT_GT(error->sky, 0.01);
    EXPECT_LT(error->sky, 0.5);
    EXPECT_LT(error->sun, 1e-6); // above the air
}
