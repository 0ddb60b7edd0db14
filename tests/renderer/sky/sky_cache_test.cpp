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
    SkyCache cache(5 * Sky(air(8000), pool).size_bytes() / 2); // two and a half
    const auto a = cache.get(air(8000), pool), b = cache.get(air(7000), pool);
    EXPECT_EQ(cache.get(air(8000), pool), a);
    cache.get(air(6000), pool);
    EXPECT_EQ(cache.get(air(8000), pool), a);
    EXPECT_NE(cache.get(air(7000), pool), b);
}

TEST(SkyCache, DoesNotKeepAnAirThatIsLargerThanItself)
{
    ThreadPool pool(1);
    AtmosphereDescription large = air(8000);
    large.scattering = SkyScattering::multiple;
    large.mode = SkyMode::fast;
    const std::size_t small = Sky(air(8000), pool).size_bytes();
    SkyCache cache(3 * small);
    const auto kept = cache.get(air(8000), pool);
    EXPECT_GT(cache.get(large, pool)->size_bytes(), 3 * small);
    EXPECT_EQ(cache.get(air(8000), pool), kept);
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
