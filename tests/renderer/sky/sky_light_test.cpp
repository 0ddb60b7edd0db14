#include "renderer/math/transcendental.h"
#include "renderer/sky/optical_depth.h"
#include "renderer/sky/sky_light.h"
#include "tests/support/random_numbers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

using namespace renderer;

namespace {

AtmosphereDescription single(double elevation_deg)
{
    AtmosphereDescription d = atmosphere_preset(AtmospherePreset::reference_b);
    d.scattering = SkyScattering::single;
    d.sun.elevation_deg = elevation_deg;
    d.sun.irradiance = {1, 1, 1};
    return d;
}

Vec3d direction(double elevation_deg, double azimuth_deg)
{
    const auto [sine, cosine] = sin_cos_deg(elevation_deg);
    const auto [east, north] = sin_cos_deg(azimuth_deg);
    return {cosine * east, sine, -cosine * north};
}

} // namespace

TEST(SkyLight, IsTheSkyAsQuadratureHasIt)
{
    ThreadPool pool(2);
    for (const double altitude : {0.0, 3000.0, 1e6}) {
        AtmosphereDescription d = single(25);
        d.sun.azimuth_deg = 70;
        d.altitude_m = altitude;
        const SkyLight light(d, pool);
        tests::RandomNumbers random(5);
        double sum2 = 0, mean = 0;
        const int count = 200;
        for (int i = 0; i < count; ++i) {
            const double elevation = random.between(-90, 90), azimuth = random.between(0, 360);
            const Rgb found = light.radiance(direction(elevation, azimuth));
            const Spectrum exact =
                light.sky()
                    .radiance(SkyGeometry::from_angles_deg(altitude, 65, 90 - elevation, azimuth - 70))
                    .single;
            sum2 += (static_cast<double>(found.b) - exact[2]) * (static_cast<double>(found.b) - exact[2]);
            mean += exact[2] / count;
        }
        EXPECT_LT(std::sqrt(sum2 / count), 0.01 * mean) << altitude;
    }
}

TEST(SkyLight, SunsDiskHoldsItsIrradiance)
{
    ThreadPool pool(1);
    for (const bool darkened : {false, true}) {
        AtmosphereDescription d = single(60);
        d.sun.limb_darkening = darkened;
        const SkyLight light(d, pool);
        const double radius = light.sun_radius_rad();
        EXPECT_NEAR(radius, 0.004675, 1e-6);
        // Rings of equal solid angle about the sun, eight places on each.
        const int rings = 400;
        double sum = 0;
        const Vec3d side{1, 0, 0}, other = cross(light.sun_direction(), side);
        for (int i = 0; i < rings; ++i) {
            const double off = sin_cos(radius).first * std::sqrt((i + 0.5) / rings);
            for (int k = 0; k < 8; ++k) {
                const auto [s, c] = sin_cos_deg(45.0 * k);
                const Vec3d at =
                    light.sun_direction() * std::sqrt(1 - off * off) + side * (off * c) + other * (off * s);
                sum += static_cast<double>(light.sun_radiance(at).g) / (8 * rings);
            }
        }
        const double solid_angle = kPi * sin_cos(radius).first * sin_cos(radius).first;
        EXPECT_NEAR(sum * solid_angle / static_cast<double>(light.sun_irradiance().g), 1, 1e-4);
        const Air air = make_air(d);
        const double through = air.transmittance(1, columns_to_top(air, 0, sin_cos_deg(30).second).columns);
        EXPECT_NEAR(sum * solid_angle / (static_cast<double>(d.sun.irradiance.g) * through), 1, 1e-4);
        EXPECT_EQ(light.sun_radiance(direction(60.3, 0)).g, 0);
        EXPECT_EQ(light.sun_radiance(direction(-60, 180)).g, 0);
    }
}

TEST(SkyLight, TurnsWithItsSun)
{
    ThreadPool pool(1);
    AtmosphereDescription d = single(20);
    const SkyLight north(d, pool);
    d.sun.azimuth_deg = 123;
    const SkyLight turned(d, pool);
    const Rgb a = north.radiance(direction(10, 40)), b = turned.radiance(direction(10, 163));
    EXPECT_NEAR(a.r / b.r, 1, 1e-5);
    const Rgb mirrored = north.radiance(direction(10, -40));
    EXPECT_NEAR(a.b / mirrored.b, 1, 1e-5);
}

TEST(SkyLight, PutsThePanoramasPixelsWhereTheyLook)
{
    ThreadPool pool(2);
    AtmosphereDescription d = single(30);
    d.sun.azimuth_deg = -40;
    const SkyLight light(d, pool);
    const SkyPanorama picture = light.panorama(32, 16, pool);
    for (const std::size_t y : {0u, 6u, 9u})
        for (const std::size_t x : {0u, 13u, 31u}) {
            const Rgb expected = light.radiance(direction(90 - 180 * (static_cast<double>(y) + 0.5) / 16,
                                                          360 * ((static_cast<double>(x) + 0.5) / 32 - 0.5)));
            EXPECT_NEAR(picture.pixels[y * 32 + x].r / expected.r, 1, 1e-4) << x << ' ' << y;
        }
}

TEST(SkyLight, OfFinerRowsAPanoramaHasTheMeanByTheirSolidAngles)
{
    ThreadPool pool(2);
    const SkyLight light(single(30), pool);
    const SkyPanorama coarse = light.panorama(8, 4, pool, 3), fine = light.panorama(8, 12, pool);
    for (const std::size_t y : {0u, 1u, 3u}) {
        double mean = 0, weights = 0;
        for (std::size_t row = 3 * y; row < 3 * y + 3; ++row) {
            const double weight = std::sin((static_cast<double>(row) + 0.5) / 12 * std::numbers::pi);
            mean += weight * static_cast<double>(fine.pixels[row * 8 + 5].b);
            weights += weight;
        }
        EXPECT_NEAR(static_cast<double>(coarse.pixels[y * 8 + 5].b) / (mean / weights), 1, 1e-5) << y;
    }
}

TEST(SkyLight, AirBetweenPointsIsThatOfTheirWay)
{
    ThreadPool pool(1);
    const SkyLight light(single(40), pool);
    const Vec3d eye{0, 100, 0}, near{300, 250, -4000}, far = eye + (near - eye) * 2.0;
    const auto first = light.between(eye, near), second = light.between(near, far),
               whole = light.between(eye, far);
    EXPECT_NEAR(first.transmittance.b * second.transmittance.b, whole.transmittance.b, 1e-5f);
    EXPECT_NEAR(first.added.b + first.transmittance.b * second.added.b, whole.added.b, 1e-3f * whole.added.b);
    EXPECT_EQ(light.between(eye, eye).added.r, 0);
    // To the top of the air: all of the sky's light.
    const Vec3d up = direction(50, 200);
    const Rgb sky = light.radiance(up);
    EXPECT_NEAR(light.between({0, 0, 0}, up * 90'000.0).added.b / sky.b, 1, 0.02);
}

TEST(SkyLight, LooksUpTheAirBeforeThings)
{
    ThreadPool pool(2);
    AtmosphereDescription d = single(35);
    const auto sky = std::make_shared<const Sky>(d, pool);
    for (const Vec3d eye : {Vec3d{0, 2, 0}, Vec3d{500, 3000, -200}, Vec3d{0, 400'000, 0}}) {
        const double far = eye.y > 1e5 ? 2e6 : 60'000;
        const SkyLight light(d, sky, eye, far, pool);
        tests::RandomNumbers random(9);
        double sum2 = 0, mean = 0;
        const int count = 200;
        for (int i = 0; i < count; ++i) {
            const bool above_air = eye.y > 1e5;
            const Vec3d way = direction(random.between(-60, above_air ? -25 : 40), random.between(0, 360));
            const double distance = above_air ? (eye.y - random.between(0, 60'000)) / -way.y
                                              : far * std::pow(random.between(0, 1), 2);
            const auto exact = light.between(eye, eye + way * distance);
            if (eye.y + way.y * distance < 0) continue; // below the ground
            const auto found = light.air_before(way, distance);
            EXPECT_NEAR(found.transmittance.b, exact.transmittance.b, 4e-3f) << way.y << ' ' << distance;
            sum2 += std::pow(static_cast<double>(found.added.b - exact.added.b), 2);
            mean += static_cast<double>(exact.added.b) / count;
        }
        EXPECT_LT(std::sqrt(sum2 / count), 0.01 * mean) << eye.y;
    }
}

TEST(SkyLight, AirBeforeThingsEndsWhereTheyStandOnTheGround)
{
    ThreadPool pool(1);
    const AtmosphereDescription d = single(35);
    const Vec3d eye{0, 2000, 0};
    const SkyLight light(d, std::make_shared<const Sky>(d, pool), eye, 100'000, pool);
    for (const double distance : {3000.0, 12'345.0, 50'000.0}) {
        const double along = std::sqrt(distance * distance - eye.y * eye.y);
        const Vec3d place{along, -along * along / (2 * 6.36e6), 0};
        const double way = length(place - eye);
        const auto exact = light.between(eye, place);
        const auto found = light.air_before((place - eye) / way, way);
        EXPECT_NEAR(found.transmittance.b, exact.transmittance.b, 2e-3f) << distance;
        EXPECT_NEAR(found.added.b, exact.added.b, 0.01f * exact.added.b) << distance;
    }
}

TEST(SkyLight, AirBeforeThingsHasNoLightOfTheGroundThatTheyHide)
{
    // Of light that was scattered twice and more, and of the ground, which is white.
    ThreadPool pool(2);
    AtmosphereDescription d = single(35);
    d.scattering = SkyScattering::multiple;
    d.mode = SkyMode::fast;
    d.planet.ground_albedo = {1};
    const SkyLight light(d, std::make_shared<const Sky>(d, pool), {0, 100, 0}, 20'000, pool);
    const Vec3d down = direction(-30, 20);
    const float at_ground = light.air_before(down, 200).added.b,
                halfway = light.air_before(down, 100).added.b;
    EXPECT_NEAR(at_ground / halfway, 2, 0.05);
    EXPECT_LT(at_ground, 0.02f * light.radiance(down).b);
}

TEST(SkyLight, OfAnEyeFarAsideStandsOnItsOwnGround)
{
    // A tenth of the way around the planet the sun stands 36 degrees higher.
    ThreadPool pool(2);
    AtmosphereDescription here = single(20), there = single(56);
    here.sun.azimuth_deg = there.sun.azimuth_deg = 90;
    const double radius = here.planet.radius_m + 100;
    const auto [sine, cosine] = sin_cos_deg(36);
    const Vec3d eye{radius * sine, radius * cosine - here.planet.radius_m, 0};
    const auto sky = std::make_shared<const Sky>(here, pool);
    const SkyLight aside(here, sky, eye, 0, pool), upright(there, sky, {0, 100, 0}, 0, pool);
    for (const double elevation : {-20.0, 5.0, 70.0})
        for (const double azimuth : {10.0, 90.0, 200.0}) {
            const Vec3d local = direction(elevation, azimuth);
            const Vec3d turned{local.x * cosine + local.y * sine, local.y * cosine - local.x * sine, local.z};
            EXPECT_NEAR(aside.radiance(turned).b / upright.radiance(local).b, 1, 1e-4)
                << elevation << ' ' << azimuth;
        }
    EXPECT_NEAR(aside.sun_irradiance().g, upright.sun_irradiance().g, 1e-5f);
}

TEST(SkyLight, OfAnEyeBelowTheGroundIsThatOnIt)
{
    ThreadPool pool(1);
    const auto sky = std::make_shared<const Sky>(single(30), pool);
    const SkyLight on(single(30), sky, {}, 0, pool);
    for (const double below : {1e-9, 1.0, 5000.0}) {
        const SkyLight under(single(30), sky, {0, -below, 0}, 0, pool);
        for (const double elevation : {-40.0, 0.0, 3.0, 80.0})
            EXPECT_EQ(under.radiance(direction(elevation, 50)).b, on.radiance(direction(elevation, 50)).b);
    }
}

TEST(SkyLight, MeasuresItsTableAgainstQuadrature)
{
    ThreadPool pool(2);
    for (const double elevation : {60.0, 3.0, -3.0}) {
        AtmosphereDescription d = single(elevation);
        const SkyLight light(d, pool);
        EXPECT_GT(light.table_error(), 0) << elevation;
        EXPECT_LT(light.table_error(), SkyLight::kTableError) << elevation;
    }
}

TEST(SkyLight, SunThatHasHalfSetGivesHalfItsLight)
{
    ThreadPool pool(1);
    const auto sky = std::make_shared<const Sky>(single(0), pool);
    const SkyLight whole(single(0.3), sky, {}, 0, pool), half(single(0), sky, {}, 0, pool),
        none(single(-0.3), sky, {}, 0, pool);
    // Air takes more from what stands lower: less than half.
    EXPECT_GT(half.mean_sun_radiance().r, 0.2f * whole.mean_sun_radiance().r);
    EXPECT_LT(half.mean_sun_radiance().r, 0.5f * whole.mean_sun_radiance().r);
    EXPECT_EQ(none.mean_sun_radiance().r, 0);
}
