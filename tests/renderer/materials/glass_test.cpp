#include "renderer/materials/fresnel.h"
#include "renderer/sampling/warp.h"
#include "tests/renderer/materials/every_bsdf.h"

#include <gtest/gtest.h>

#include <cmath>

using renderer::Bsdf;
using renderer::BsdfSample;
using renderer::Rgb;
using renderer::Vec3f;
using tests::at_angle;
using tests::glass;
using tests::glass_from_within;

TEST(Glass, OfIndexOneIsNotThere)
{
    for (const Bsdf& none : {glass(1, 0), glass(1, 0.5)})
        for (const double angle : {0.0, 30.0, 89.999, 90.0})
            for (const float u : {0.0f, 0.5f, 0.99999994f}) {
                const Vec3f wo = at_angle(angle);
                const BsdfSample through = sample(none, wo, u, {0.1f, 0.9f});
                EXPECT_EQ(through.wi, -wo);
                EXPECT_EQ(through.weight, (Rgb{1, 1, 1}));
                EXPECT_EQ(through.pdf, 1);
                EXPECT_TRUE(through.is_transmission);
            }
}

TEST(Glass, BendsBySnellsLawAndCarriesRadianceBySquareOfIndex)
{
    for (const double n : {1e-3, 0.5, 1.33, 1.5, 2.4, 1e3})
        for (const double angle : {0.0, 1e-2, 10.0, 40.0, 80.0, 89.9}) {
            const Vec3f wo = at_angle(angle);
            const renderer::DeltaLobes all = delta_lobes(glass(n, 0), wo);
            const double sine = std::sin(angle * renderer::kPi / 180) / n;
            if (sine > 1) {
                ASSERT_EQ(all.count, 1u) << n << " at " << angle;
                EXPECT_EQ(all.lobes[0].weight, (Rgb{1, 1, 1}));
                continue;
            }
            ASSERT_EQ(all.count, 2u) << n << " at " << angle;
            const Vec3f t = all.lobes[1].wi;
            EXPECT_NEAR(std::hypot(t.x, t.y), sine, 2e-7 * std::max(1.0, 1 / n)) << n << " at " << angle;
            EXPECT_LE(dot(Vec3f{t.x, t.y, 0}, Vec3f{wo.x, wo.y, 0}), 0);
            const double energy = static_cast<double>(all.lobes[1].weight.r) * n * n;
            EXPECT_NEAR(energy + static_cast<double>(all.lobes[0].weight.r), 1, 1e-6);
        }
}

TEST(Glass, ReflectsAllFromWithinBeyondTheCriticalAngle)
{
    const Bsdf within = glass_from_within(1.5, 0);
    EXPECT_EQ(delta_lobes(within, at_angle(41.8)).count, 2u);
    for (const double angle : {41.82, 60.0, 89.9}) {
        const BsdfSample back = sample(within, at_angle(angle), 0.9999f, {});
        EXPECT_FALSE(back.is_transmission);
        EXPECT_EQ(back.weight, (Rgb{1, 1, 1}));
    }
}

TEST(Glass, OfAThinSlabReflectsAndPassesWhatTheSeriesSays)
{
    // Every way through two boundaries at normal incidence, followed to its end.
    const double r = renderer::fresnel_dielectric(1, 1.5), back = renderer::fresnel_dielectric(1, 1 / 1.5);
    double reflected = r, passed = 0, within = 1 - r;
    for (int k = 0; k < 40; ++k) {
        EXPECT_NEAR(reflected, r + (1 - r) * (1 - r) * r * (1 - std::pow(r, 2 * k)) / (1 - r * r), 1e-12)
            << k;
        passed += within * (1 - back);
        within *= back;
        reflected += within * (1 - back);
        within *= back;
    }
    EXPECT_NEAR(reflected, 2 * r / (1 + r), 1e-12);
    EXPECT_NEAR(reflected, 0.07692308, 1e-8);
    EXPECT_NEAR(passed, 0.92307692, 1e-8);
    // The lobes carry these very shares, in floats; the factors of radiance cancel over both boundaries.
    const renderer::DeltaLobes in = delta_lobes(glass(1.5, 0), {0, 0, 1});
    const renderer::DeltaLobes out = delta_lobes(glass_from_within(1.5, 0), {0, 0, 1});
    ASSERT_EQ(in.count + out.count, 4u);
    EXPECT_NEAR(in.lobes[0].weight.r, r, 1e-8);
    EXPECT_NEAR(out.lobes[0].weight.r, r, 1e-7);
    EXPECT_NEAR(in.lobes[1].weight.r * out.lobes[1].weight.r, (1 - r) * (1 - r), 3e-7);
}

TEST(Glass, PlateShiftsARayWithoutTurningIt)
{
    for (const double n : {1.1, 1.5, 2.4})
        for (const double angle : {5.0, 30.0, 60.0, 85.0}) {
            const Vec3f wo = at_angle(angle, 0);
            const Vec3f within = delta_lobes(glass(n, 0), wo).lobes[1].wi;
            const renderer::DeltaLobes out = delta_lobes(glass_from_within(n, 0), -within);
            const double theta = angle * renderer::kPi / 180, sine = std::sin(theta);
            const double cos_t = renderer::meet_dielectric(std::cos(theta), n).cos_transmitted;
            // What floats can say: the direction within is one, which the way out spreads by n cos_t / cos; so
            // are n and its inverse, which turn it by tan; and what comes out is one.
            const double spread = 1 + n * cos_t / std::cos(theta) + std::tan(theta);
            EXPECT_NEAR(length(out.lobes[1].wi + wo), 0, 0x1p-24 * spread) << n << " " << angle;
            // Of thickness 1, by the exact Fresnel boundary: in double.
            const double shift = std::sin(theta - std::asin(sine / n)) / cos_t;
            EXPECT_NEAR(shift, sine * (1 - std::cos(theta) / std::sqrt(n * n - sine * sine)), 1e-12);
        }
}

TEST(Glass, BallGathersParallelLightInItsFocus)
{
    // Diameter 2, height 0.01: n D / (4 (n - 1)) from the centre.
    constexpr double kIor = 1.5, kHeight = 0.01;
    const renderer::Vec3d in_normal{-std::sqrt(1 - kHeight * kHeight), kHeight, 0};
    renderer::Vec3d place = in_normal, way{1, 0, 0};
    const auto bend = [&](renderer::Vec3d normal, const Bsdf& bsdf) {
        const renderer::Frame frame(renderer::to_float(normal));
        const Vec3f wo = frame.to_local(renderer::to_float(-way));
        way = renderer::to_double(frame.to_world(delta_lobes(bsdf, wo).lobes[1].wi));
    };
    bend(in_normal, glass(kIor, 0));
    place = place + way * (-2 * dot(place, way)); // the chord
    bend(-place, glass_from_within(kIor, 0));
    const double focus = place.x - place.y * way.x / way.y;
    EXPECT_NEAR(focus, 1.5, 1e-4);
}
