#include "renderer/sky/sky_cache.h"

#include <gtest/gtest.h>

using namespace renderer;

namespace {

AtmosphereDescription air(double scale_height_m)
{
    AtmosphereDescription d;
    d.scattering = SkyScattering::single;
    d.rayleigh.scale_height_m = scale_height_m;
    return d;
}

} // namespace

TEST(SkyCache, GivesOneAirForEverySunAndPlace)
{
    ThreadPool pool(1);
    SkyCache cache;
    AtmosphereDescription d = air(8000);
    const auto first = cache.get(d, pool);
    d.sun.elevation_deg = 3;
    d.sun.irradiance = {9, 9, 9};
    d.altitude_m = 1000;
    d.aerial_perspective = false;
    EXPECT_EQ(cache.get(d, pool), first);
    EXPECT_NE(cache.get(air(7000), pool), first);
}

TEST(SkyCache, ForgetsTheAirThatWasAskedForLongestAgo)
{
    ThreadPool pool(1);
    SkyCache cache(2);
    const auto a = cache.get(air(8000), pool), b = cache.get(air(7000), pool);
    EXPECT_EQ(cache.get(air(8000), pool), a);
    cache.get(air(6000), pool);
    EXPECT_EQ(cache.get(air(8000), pool), a);
    EXPECT_NE(cache.get(air(7000), pool), b);
}

TEST(SkyCache, KeepsNothingOfAnAirThatWasGivenUp)
{
    ThreadPool pool(1);
    SkyCache cache;
    std::stop_source stop;
    stop.request_stop();
    EXPECT_EQ(cache.get(air(8000), pool, stop.get_token()), nullptr);
    EXPECT_NE(cache.get(air(8000), pool), nullptr);
}
