#include "renderer/materials/bsdf.h"
#include "renderer/math/transcendental.h"
#include "renderer/sampling/warp.h"
#include "tests/renderer/materials/every_bsdf.h"
#include "tests/support/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using renderer::Bsdf;
using renderer::BsdfSample;
using renderer::PhongForm;
using renderer::PixelSampler;
using renderer::Rgb;
using renderer::Vec3f;
using tests::at_angle;
using tests::diffuse;
using tests::NamedBsdf;
using tests::phong;

namespace {

// Reflected share of light from everywhere, by stratified quadrature around the lobe or the normal.
double albedo(const Bsdf& bsdf, Vec3f wo, int n)
{
    // Quadrature in the lobe's own coordinates, u -> cos = u^(1/(e+1)), whose density cancels all but the
    // cosine.
    double sum = 0;
    PixelSampler sampler(1, 2, 3);
    for (int i = 0; i < n; ++i) {
        const auto s = static_cast<std::uint32_t>(i);
        const BsdfSample draw = sample(bsdf, wo, sampler.sample_1d(s, 0), sampler.sample_2d(s, 1));
        sum += static_cast<double>(draw.weight.r);
    }
    return sum / n;
}

} // namespace

TEST(Bsdf, SamplesAsItsDensitySays)
{
    std::vector<NamedBsdf> wide = tests::phong_bsdfs();
    wide.push_back({"diffuse", diffuse(0.7f)});
    for (const auto& [name, bsdf] : wide)
        for (const double angle : {0.0, 45.0, 80.0, 89.9}) {
            const Vec3f wo = at_angle(angle);
            const auto draw = [&](std::size_t i) {
                const PixelSampler sampler(3, static_cast<std::uint32_t>(i), 8);
                return sample(bsdf, wo, sampler.sample_1d(0, 0), sampler.sample_2d(0, 1)).wi;
            };
            // Around the mirror direction, where bins are fine.
            const renderer::Frame lobe(Vec3f{-wo.x, -wo.y, wo.z});
            const auto result = tests::chi_square(
                200000,
                [&](std::size_t i) { return lobe.to_local(draw(i)); },
                [&](Vec3f w) { return static_cast<double>(pdf(bsdf, wo, lobe.to_world(w))); },
                40);
            EXPECT_NEAR(result.expected_share, 1, 4e-3) << name << " at " << angle;
            EXPECT_GT(result.p_value, 0.01 / 36)
                << name << " at " << angle << ": " << result.statistic << " for " << result.degrees;
        }
}

TEST(Bsdf, WeighsASampleByEvalOverPdf)
{
    for (const auto& [name, bsdf] : tests::every_bsdf())
        for (std::uint32_t i = 0; i < 2000; ++i) {
            const PixelSampler sampler(4, i, 9);
            const Vec3f wo = at_angle(i % 90);
            const BsdfSample draw = sample(bsdf, wo, sampler.sample_1d(0, 0), sampler.sample_2d(0, 1));
            if (!(draw.pdf > 0) || draw.is_delta) continue;
            const float want = eval(bsdf, wo, draw.wi).r / pdf(bsdf, wo, draw.wi);
            ASSERT_NEAR(draw.weight.r, want, 1e-5f * want) << name;
            ASSERT_FLOAT_EQ(draw.pdf, pdf(bsdf, wo, draw.wi)) << name;
            ASSERT_NEAR(length(draw.wi), 1, 1e-6) << name;
        }
}

TEST(Bsdf, GivesDeltaLobesThatAddUpToWhatIsDrawn)
{
    for (const auto& [name, bsdf] : tests::every_bsdf())
        for (const double angle : {0.0, 30.0, 60.0, 89.0, 89.99}) {
            const Vec3f wo = at_angle(angle);
            const renderer::DeltaLobes all = delta_lobes(bsdf, wo);
            Rgb drawn[2] = {};
            constexpr int kDraws = 4096;
            for (int i = 0; i < kDraws; ++i) {
                const float u_lobe = (static_cast<float>(i) + 0.5f) / kDraws;
                const BsdfSample draw = sample(bsdf, wo, u_lobe, {0.3f, 0.6f});
                if (!draw.is_delta) continue;
                ASSERT_TRUE(draw.pdf > 0 && draw.pdf <= 1) << name;
                ASSERT_EQ(draw.is_transmission, draw.wi.z < 0) << name;
                bool found = false;
                for (std::size_t k = 0; k < all.count; ++k)
                    if (all.lobes[k].wi == draw.wi) {
                        found = true;
                        drawn[k] += draw.weight / kDraws;
                    }
                ASSERT_TRUE(found) << name << " at " << angle;
            }
            for (std::size_t k = 0; k < all.count; ++k) {
                const float radiance = all.lobes[k].is_transmission ? 1 / (bsdf.eta * bsdf.eta) : 1;
                const double share = static_cast<double>(all.lobes[k].weight.r / radiance);
                EXPECT_NEAR(static_cast<double>(drawn[k].r / radiance), share, 1e-3)
                    << name << " at " << angle << ", lobe " << k;
            }
        }
}

TEST(Bsdf, HasNoEvalAndNoPdfWhereItIsDeltaOnly)
{
    for (const auto& [name, bsdf] : tests::delta_bsdfs()) {
        EXPECT_TRUE(is_delta_only(bsdf)) << name;
        const Vec3f wo = at_angle(30);
        for (std::size_t k = 0; k < delta_lobes(bsdf, wo).count; ++k) {
            EXPECT_EQ(eval(bsdf, wo, delta_lobes(bsdf, wo).lobes[k].wi), Rgb{}) << name;
            EXPECT_EQ(pdf(bsdf, wo, delta_lobes(bsdf, wo).lobes[k].wi), 0) << name;
        }
    }
    for (const double roughness : {1e-3, 0.5})
        for (const auto& [name, bsdf] : tests::rough_bsdfs(roughness))
            EXPECT_FALSE(is_delta_only(bsdf)) << name;
}

TEST(Diffuse, ReflectsExactlyItsColour)
{
    const Bsdf white = diffuse(1);
    for (std::uint32_t i = 0; i < 10000; ++i) {
        const PixelSampler sampler(1, i, 0);
        EXPECT_EQ(sample(white, at_angle(30), 0.5f, sampler.sample_2d(0, 0)).weight, (Rgb{1, 1, 1}));
    }
}

TEST(PhongNormalized, IsReciprocal)
{
    const Bsdf bsdf = phong(40, PhongForm::normalized);
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const Vec3f a = renderer::sample_cosine_hemisphere(PixelSampler(1, i, 0).sample_2d(0, 0));
        const Vec3f b = renderer::sample_cosine_hemisphere(PixelSampler(2, i, 0).sample_2d(0, 0));
        const double ab = static_cast<double>(eval(bsdf, a, b).r) / static_cast<double>(b.z);
        const double ba = static_cast<double>(eval(bsdf, b, a).r) / static_cast<double>(a.z);
        // Float directions carry 1e-7; the lobe multiplies a relative error by its exponent.
        ASSERT_NEAR(ab, ba, 1e-6 * std::max(1.0, ab) * 10);
    }
}

TEST(PhongNormalized, NeverReflectsMoreThanItGets)
{
    for (const double n : {0.0, 1.0, 10.0, 1e3, 1e6})
        for (const double angle : {0.0, 20.0, 50.0, 80.0, 89.0}) {
            const double specular = albedo(phong(n, PhongForm::normalized, 0, 1), at_angle(angle), 1 << 16);
            EXPECT_LE(specular, 1 + 1e-4) << n << " at " << angle;
            if (angle == 0) {
                EXPECT_NEAR(specular, 1, 1e-4) << n; // full at normal incidence
            }
        }
}

TEST(PhongNormalized, ReflectsAllThatItsHighlightGetsAtNormalIncidenceAndNoMoreElsewhere)
{
    // By a midpoint rule over the lobe's own samples.
    constexpr int kRings = 16384, kSectors = 8;
    for (const double n : {0.0, 1.0, 1e6})
        for (const double angle : {0.0, 45.0, 85.0}) {
            const Bsdf bsdf = phong(n, PhongForm::normalized, 0, 1);
            double sum = 0;
            for (int i = 0; i < kRings; ++i)
                for (int j = 0; j < kSectors; ++j) {
                    const renderer::Sample2 u{(static_cast<float>(i) + 0.5f) / kRings,
                                              (static_cast<float>(j) + 0.5f) / kSectors};
                    sum += static_cast<double>(sample(bsdf, at_angle(angle), 0, u).weight.r);
                }
            const double energy = sum / kRings / kSectors;
            EXPECT_LE(energy, 1 + 1e-6) << n << " at " << angle;
            if (angle == 0) {
                EXPECT_NEAR(energy, 1, 1e-6) << n;
            }
        }
}

TEST(PhongNormalized, MatchesTheIntegralAtNormalIncidence)
{
    // Midpoint rule of f cos over the hemisphere, apart from the sampler.
    for (const double n : {0.0, 1.0, 20.0}) {
        const Bsdf bsdf = phong(n, PhongForm::normalized, 0.3f, 0.7f);
        constexpr int kSteps = 20000;
        double sum = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double theta = (i + 0.5) / kSteps * renderer::kPi / 2;
            const Vec3f wi = renderer::to_float({std::sin(theta), 0, std::cos(theta)});
            sum += static_cast<double>(eval(bsdf, {0, 0, 1}, wi).r) * std::sin(theta);
        }
        EXPECT_NEAR(sum * renderer::kPi / 2 / kSteps * 2 * renderer::kPi, 1, 1e-5) << n;
    }
}

TEST(PhongClassic, IsTheFormulaWithItsClamps)
{
    const Bsdf bsdf = phong(10, PhongForm::classic, 0.5f, 0.25f);
    const Vec3f wi = at_angle(30, 0), mirror = at_angle(30, 180);
    EXPECT_NEAR(eval(bsdf, mirror, wi).r, 0.5f * wi.z + 0.25f, 1e-6f);
    const Vec3f off = at_angle(50, 180); // 20 degrees from the mirror direction
    EXPECT_NEAR(eval(bsdf, off, wi).r,
                0.5 * static_cast<double>(wi.z) + 0.25 * std::pow(std::cos(20 * renderer::kPi / 180), 10),
                1e-6);
    // More than 90 degrees off the mirror direction: no highlight, though the power is even.
    EXPECT_NEAR(eval(bsdf, at_angle(80, 0), wi).r, 0.5f * wi.z, 1e-6f);
}

TEST(Bsdf, IsBlackAtAndBelowTheHorizonAndFiniteAtGrazing)
{
    for (const auto& [name, bsdf] : tests::every_bsdf()) {
        EXPECT_EQ(eval(bsdf, at_angle(30), {1, 0, 0}), Rgb{}) << name;
        EXPECT_EQ(eval(bsdf, at_angle(30), {1, 0, -0.0f}), Rgb{}) << name;
        if (!transmits(bsdf)) {
            EXPECT_EQ(eval(bsdf, at_angle(30), at_angle(120)), Rgb{}) << name;
        }
        for (const float z : {1e-3f, 1e-7f, 0.0f, -0.0f, -1e-3f, -1.0f}) {
            const Vec3f wo = normalize(Vec3f{1, 0, z});
            for (std::uint32_t i = 0; i < 500; ++i) {
                const PixelSampler sampler(5, i, 1);
                const BsdfSample draw = sample(bsdf, wo, sampler.sample_1d(0, 0), sampler.sample_2d(0, 1));
                ASSERT_TRUE(std::isfinite(draw.weight.r) && draw.weight.r >= 0 && std::isfinite(draw.pdf))
                    << name << " at " << z;
                for (const float below : {1e-3f, 1e-7f, 0.0f, -0.0f, -1e-3f}) {
                    const renderer::BsdfValue value = evaluate(bsdf, wo, normalize(Vec3f{-1, 0.1f, below}));
                    ASSERT_TRUE(std::isfinite(value.f.r) && value.f.r >= 0 && std::isfinite(value.pdf))
                        << name << " at " << z;
                }
            }
        }
    }
}
