#include "renderer/materials/fresnel.h"
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
    // Every way through two boundaries at normal incidence, followed to its end by the lobes' own weights.
    const Bsdf outside = glass(1.5, 0), inside = glass_from_within(1.5, 0);
    const renderer::DeltaLobes in = delta_lobes(outside, {0, 0, 1}), out = delta_lobes(inside, {0, 0, 1});
    ASSERT_EQ(in.count + out.count, 4u);
    const auto share = [](const renderer::DeltaLobe& lobe) { return static_cast<double>(lobe.weight.r); };
    const double r = share(in.lobes[0]);
    double reflected = r, passed = 0, within = share(in.lobes[1]);
    for (int k = 0; k < 40; ++k) {
        const double partial = r + (1 - r) * (1 - r) * r * (1 - std::pow(r, 2 * k)) / (1 - r * r);
        EXPECT_NEAR(reflected, partial, 1e-7) << k; // the lobes are floats
        passed += within * share(out.lobes[1]);
        within *= share(out.lobes[0]);
        reflected += within * share(out.lobes[1]);
        within *= share(out.lobes[0]);
    }
    EXPECT_NEAR(reflected, 0.07692308, 1e-7);
    EXPECT_NEAR(passed, 0.92307692, 1e-7);
}
