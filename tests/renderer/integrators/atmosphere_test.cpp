// Scenes under an atmosphere, against the sky itself.
#include "renderer/math/transcendental.h"
#include "renderer/sky/air.h"
#include "renderer/sky/sky_light.h"
#include "tests/support/render_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

using namespace renderer;
using tests::render_description;
using tests::TestScene;

namespace {

AtmosphereDescription atmosphere(double elevation_deg, SkyScattering scattering = SkyScattering::single)
{
    AtmosphereDescription a;
    a.scattering = scattering;
    a.mode = SkyMode::fast;
    a.sun.elevation_deg = elevation_deg;
    a.sun.azimuth_deg = 30;
    return a;
}

TestScene metered(const AtmosphereDescription& air, Vec3d eye, Vec3d direction)
{
    TestScene test;
    test.description.environment = air;
    test.description.camera.emplace();
    test.description.camera->projection = Projection::meter;
    test.description.camera->position = eye;
    test.description.camera->aim = direction;
    test.description.camera->aim_is_direction = true;
    test.settings.image.width_px = test.settings.image.height_px = 4;
    test.settings.quality.samples = 512;
    return test;
}

void add_plate(TestScene& test, Vec3d center, double rotate_deg, double size, Rgb color)
{
    DiffuseMaterial matt;
    matt.color.value = color;
    test.description.materials.push_back({"plate", matt});
    ObjectDescription& plate = test.description.objects.emplace_back();
    plate.shape = RectangleShape{size, size};
    plate.material = static_cast<std::uint32_t>(test.description.materials.size() - 1);
    const auto [s, c] = sin_cos_deg(rotate_deg);
    plate.world_from_object.rows[1] = {0, c, -s}; // about x
    plate.world_from_object.rows[2] = {0, s, c};
    plate.world_from_object.translation = center;
}

} // namespace

TEST(Atmosphere, LightsAHorizontalPlateByItsIrradiance)
{
    ThreadPool pool(2);
    for (const SkyScattering scattering : {SkyScattering::single, SkyScattering::multiple})
        for (const double elevation : {50.0, 3.0}) {
            const AtmosphereDescription air = atmosphere(elevation, scattering);
            TestScene test = metered(air, {0, 1, 0}, {0, -1, 0});
            add_plate(test, {0, 0, 0}, -90, 4, {0.5f, 0.5f, 0.5f});
            const MeterReading got = render_description(test).report.meter.value();
            const Sky sky(air, pool);
            const SkyIrradiance e = sky.irradiance(0, sin_cos_deg(elevation).first);
            const auto expected = [&](std::size_t w, float irradiance) {
                return 0.5 * (e.sun[w] + e.single[w] + e.multiple[w]) * static_cast<double>(irradiance) / kPi;
            };
            const Rgb sun = air.sun.irradiance;
            EXPECT_NEAR(got.value.r / expected(0, sun.r), 1, 0.005) << elevation;
            EXPECT_NEAR(got.value.g / expected(1, sun.g), 1, 0.005) << elevation;
            EXPECT_NEAR(got.value.b / expected(2, sun.b), 1, 0.005) << elevation;
        }
}

TEST(Atmosphere, OfASmallPlanetInTheSkyLightsByItsIrradiance)
{
    // From ten radii away the planet is eleven degrees wide.
    ThreadPool pool(2);
    const AtmosphereDescription air = atmosphere(60);
    const double away = 10 * make_air(air).radius_m;
    const SkyLight light(air, std::make_shared<const Sky>(air, pool), {0, away, 0}, 0, pool);
    TestScene test = metered(
        air, {0, away - 1, 0}, {0, 1, 0}); // at the underside of a plate, which the sun does not reach
    add_plate(test, {0, away, 0}, 90, 4, {0.5f, 0.5f, 0.5f});
    const MeterReading got = render_description(test).report.meter.value();
    double irradiance = 0; // of rings about the vertical, and spokes
    constexpr int kRings = 2000, kSpokes = 90;
    const double widest = 0.01; // 1 - cosine, half a degree beyond the air's edge
    for (int ring = 0; ring < kRings; ++ring)
        for (int spoke = 0; spoke < kSpokes; ++spoke) {
            const double down = 1 - widest * (ring + 0.5) / kRings, side = std::sqrt(1 - down * down);
            const auto [s, c] = sin_cos_deg(360 * (spoke + 0.5) / kSpokes);
            irradiance += down * static_cast<double>(light.radiance({side * c, -down, side * s}).g);
        }
    irradiance *= 2 * kPi * widest / (kRings * kSpokes);
    EXPECT_NEAR(got.value.g / (0.5 * irradiance / kPi), 1, 0.01);
}

TEST(Atmosphere, IsSeenAsTheSkyHasIt)
{
    ThreadPool pool(2);
    const AtmosphereDescription air = atmosphere(20);
    const Vec3d eye{0, 3000, 0};
    const auto sky = std::make_shared<const Sky>(air, pool);
    const SkyLight light(air, sky, eye, 0, pool);
    for (const Vec3d way : {Vec3d{0.3, 0.8, -0.2}, Vec3d{1, 0.02, 0}, Vec3d{-0.4, -0.3, 0.5}}) {
        const MeterReading got = render_description(metered(air, eye, way)).report.meter.value();
        const Rgb expected = light.radiance(normalize(way));
        EXPECT_NEAR(got.value.b / expected.b, 1, 1e-5);
        EXPECT_LE(got.standard_error.b, 1e-6f * expected.b);
    }
}

TEST(Atmosphere, ItsSunIsSeenInItsPlaceAndAddsNothingBesideIt)
{
    ThreadPool pool(2);
    const AtmosphereDescription air = atmosphere(40);
    const SkyLight light(air, pool);
    const Vec3d sun = light.sun_direction();
    const MeterReading got = render_description(metered(air, {}, sun)).report.meter.value();
    EXPECT_NEAR(got.value.g / (light.radiance(sun).g + light.sun_radiance(sun).g), 1, 1e-5);
    EXPECT_GT(got.value.g, 1000 * light.radiance(sun).g);
}

TEST(Atmosphere, AddsAirBeforeADistantBlackWall)
{
    ThreadPool pool(2);
    AtmosphereDescription air = atmosphere(40);
    for (const bool counts : {true, false}) {
        air.aerial_perspective = counts;
        TestScene test = metered(air, {0, 100, 0}, {0, 0, -1});
        add_plate(test, {0, 100, -20'000}, 0, 1000, {});
        const MeterReading got = render_description(test).report.meter.value();
        const SkyLight light(air, pool);
        const Rgb added = light.between({0, 100, 0}, {0, 100, -20'000}).added;
        EXPECT_NEAR(got.value.b, counts ? added.b : 0, 0.01f * added.b);
    }
}

TEST(Atmosphere, AddsAirBeforeADistantWallThatAMirrorOrAPaneShows)
{
    ThreadPool pool(2);
    const AtmosphereDescription air = atmosphere(40);
    const Rgb added = SkyLight(air, pool).between({0, 100, 0}, {0, 100, -20'000}).added;
    for (const TransportType type : {TransportType::path, TransportType::whitted})
        for (const bool mirror : {true, false}) {
            TestScene test = metered(air, {0, 100, 0}, mirror ? Vec3d{0, -1, 0} : Vec3d{0, 0, -1});
            test.description.transport.type = type;
            add_plate(test, {0, 100, -20'000}, 0, 1000, {});
            if (mirror)
                test.description.materials.push_back({"mirror", MirrorMaterial{}});
            else
                test.description.materials.push_back({"pane", GlassMaterial{.ior = 1}});
            ObjectDescription& before = test.description.objects.emplace_back();
            before.material = 1;
            if (mirror) {
                before.shape = RectangleShape{1, 1};
                const auto [s, c] = sin_cos_deg(-135); // looked at from above it shows what lies along -z
                before.world_from_object.rows[1] = {0, c, -s};
                before.world_from_object.rows[2] = {0, s, c};
                before.world_from_object.translation = {0, 98, 0};
            } else {
                before.shape = BoxShape{{1, 1, 0.1}};
                before.world_from_object.translation = {0, 100, -2};
            }
            const MeterReading got = render_description(test).report.meter.value();
            EXPECT_NEAR(got.value.b, added.b, 0.01f * added.b) << mirror;
            EXPECT_NEAR(got.value.r, added.r, 0.01f * added.r) << mirror;
        }
}

TEST(Atmosphere, SaysHowFarTheAirIsOffBehindMirrors)
{
    ThreadPool pool(1);
    const auto why = [&](double height) {
        TestScene test = metered(atmosphere(40), {0, 100, 0}, {0, 0, -1});
        add_plate(test, {0, 100, -20'000}, 0, 1000, {});
        test.description.materials.push_back({"mirror", MirrorMaterial{}});
        ObjectDescription& mirror = test.description.objects.emplace_back();
        mirror.shape = SphereShape{1};
        mirror.material = 1;
        mirror.world_from_object.translation = {0, height, -5};
        for (const ModelChoice& model : tests::make_ready(test, pool).plan.models.used)
            if (model.name == "aerial_perspective") return model.why;
        return std::string();
    };
    EXPECT_NE(why(100).find("off by 0.08"), std::string::npos) << why(100);
    EXPECT_NE(why(219).find("off by 10.5"), std::string::npos)
        << why(219); // 120 m of a scale height of 1200 m
}

TEST(Atmosphere, ThatNobodySeesThroughFarIsLeftOutBeforeThings)
{
    ThreadPool pool(1);
    for (const double distance : {120.0, 900.0}) {
        TestScene test = metered(atmosphere(40), {0, 1, 0}, {0, 0, -1});
        add_plate(test, {0, 1, -distance}, 0, 1, {0.5f, 0.5f, 0.5f});
        const auto ready = tests::make_ready(test, pool);
        EXPECT_EQ(ready.plan.sky->far_m > 0, distance > 500);
        EXPECT_EQ(ready.scene->sky()->has_air_before(), distance > 500);
    }
}

TEST(Atmosphere, SaysThatTheCameraIsBelowTheGround)
{
    ThreadPool pool(1);
    const auto warnings = [&](double altitude_m, Vec3d eye) {
        AtmosphereDescription air = atmosphere(40);
        air.altitude_m = altitude_m;
        TestScene test = metered(air, eye, {0, 0, -1});
        std::string all;
        for (const auto& model : tests::make_ready(test, pool).plan.models.used)
            if (model.name == "sky_from_the_ground") all += model.why;
        return all;
    };
    EXPECT_NE(warnings(0, {0, -5, 0}).find(" 5 m below"), std::string::npos) << warnings(0, {0, -5, 0});
    EXPECT_NE(warnings(10, {0, -10.5, 0}), "");
    EXPECT_EQ(warnings(0, {0, 0, 0}), "");
    EXPECT_EQ(warnings(10, {0, -5, 0}), "");
    EXPECT_EQ(warnings(0, {50'000, -190, 0}), ""); // where the ground has fallen by 197 m
}

TEST(Atmosphere, OfTheNightIsFinite)
{
    for (const double elevation : {-6.0, -18.0, -90.0}) {
        TestScene test = metered(atmosphere(elevation), {0, 1, 0}, {0, -1, 0});
        add_plate(test, {0, 0, 0}, -90, 4, {0.5f, 0.5f, 0.5f});
        const RenderResult result = render_description(test);
        EXPECT_EQ(result.report.numerics.non_finite_samples, 0u);
        EXPECT_TRUE(std::isfinite(result.report.meter->value.g));
        EXPECT_GE(result.report.meter->value.g, 0);
    }
}

TEST(Atmosphere, GivesTheSameBitsOnAnyThreads)
{
    TestScene test;
    test.description.environment = atmosphere(15);
    test.description.camera.emplace();
    test.description.camera->position = {0, 2, 10};
    test.settings.image.width_px = 40;
    test.settings.image.height_px = 30;
    test.settings.quality.samples = 4;
    add_plate(test, {0, 0, 0}, -90, 5000, {0.5f, 0.4f, 0.3f});
    const std::uint64_t one = tests::digest(render_description(test, 1).film);
    EXPECT_EQ(tests::digest(render_description(test, 3).film), one);
}

TEST(Atmosphere, ChoosesAnExposureByItsSunUnlessOneIsGiven)
{
    ThreadPool pool(1);
    const auto ev = [&](double elevation, std::optional<double> asked, float irradiance = 1.5f) {
        AtmosphereDescription air = atmosphere(elevation);
        air.sun.irradiance = {irradiance, irradiance, irradiance};
        TestScene test = metered(air, {0, 1, 0}, {0, 0, -1});
        test.settings.image.exposure_ev = asked;
        return tests::make_ready(test, pool).plan.exposure_ev;
    };
    EXPECT_EQ(ev(60, -2.5), -2.5);
    EXPECT_EQ(ev(60, {}), 1);
    EXPECT_GT(ev(5, {}), ev(60, {}));
    EXPECT_GT(ev(-5, {}), ev(5, {}));
    EXPECT_NEAR(ev(60, {}, 6), -1, 1e-6);
}

TEST(Atmosphere, IsNotMadeWhereShapesAloneAreLookedAt)
{
    ThreadPool pool(1);
    for (const TransportType type : {TransportType::normals, TransportType::ambient_occlusion}) {
        TestScene test = metered(atmosphere(60), {0, 1, 0}, {0, 0, -1});
        add_plate(test, {0, 1, -900}, 0, 1, {0.5f, 0.5f, 0.5f});
        test.description.transport.type = type;
        const auto ready = tests::make_ready(test, pool);
        EXPECT_FALSE(ready.plan.sky);
        EXPECT_EQ(ready.plan.exposure_ev, 0);
        EXPECT_EQ(ready.scene->sky(), nullptr);
    }
}

TEST(Atmosphere, CountsLightsWithAShapeAmongWhatIsSeenThroughAir)
{
    ThreadPool pool(1);
    TestScene test = metered(atmosphere(40), {0, 1, 0}, {0, 0, -1});
    SphereLight lamp;
    lamp.world_from_light.translation = {0, 1, -5000};
    test.description.lights.emplace_back(lamp);
    EXPECT_NEAR(tests::make_ready(test, pool).plan.sky->far_m, 5000, 2);
}
