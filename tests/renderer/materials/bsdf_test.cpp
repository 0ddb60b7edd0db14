#include "renderer/materials/bsdf.h"
#include "renderer/math/transcendental.h"
#include "tests/support/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using renderer::Bsdf;
using renderer::BsdfSample;
using renderer::PhongForm;
using renderer::PhongMaterial;
using renderer::PixelSampler;
using renderer::Rgb;
using renderer::Vec3f;

namespace {

Vec3f at_angle(double degrees, double phi_deg = 20)
{
    const auto [s, c] = renderer::sin_cos_deg(degrees);
    const auto [sp, cp] = renderer::sin_cos_deg(phi_deg);
    return renderer::to_float({s * cp, s * sp, c});
}

Bsdf phong(double shininess, PhongForm form, float kd = 0.4f, float ks = 0.6f)
{
    PhongMaterial m;
    m.diffuse = {kd, kd, kd};
    m.specular = {ks, ks, ks};
    m.shininess = shininess;
    m.form = form;
    return make_bsdf(m);
}

Bsdf diffuse(float albedo)
{
    return make_bsdf(renderer::DiffuseMaterial{{albedo, albedo, albedo}});
}

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

std::vector<Bsdf> every_bsdf()
{
    std::vector<Bsdf> all{diffuse(0.7f)};
    for (const double n : {0.0, 1.0, 30.0, 500.0}) {
        all.push_back(phong(n, PhongForm::normalized));
        all.push_back(phong(n, PhongForm::classic));
    }
    return all;
}

} // namespace

TEST(Bsdf, SamplesAsItsDensitySays)
{
    for (const Bsdf& bsdf : every_bsdf())
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
            EXPECT_NEAR(result.expected_share, 1, 4e-3) << bsdf.shininess << " at " << angle;
            EXPECT_GT(result.p_value, 0.01 / 36)
                << bsdf.shininess << " at " << angle << ": " << result.statistic << " for " << result.degrees;
        }
}

TEST(Bsdf, WeighsASampleByEvalOverPdf)
{
    for (const Bsdf& bsdf : every_bsdf())
        for (std::uint32_t i = 0; i < 2000; ++i) {
            const PixelSampler sampler(4, i, 9);
            const Vec3f wo = at_angle(i % 90);
            const BsdfSample draw = sample(bsdf, wo, sampler.sample_1d(0, 0), sampler.sample_2d(0, 1));
            if (!(draw.pdf > 0)) continue;
            const float want = eval(bsdf, wo, draw.wi).r / pdf(bsdf, wo, draw.wi);
            ASSERT_NEAR(draw.weight.r, want, 1e-5f * want);
            ASSERT_FLOAT_EQ(draw.pdf, pdf(bsdf, wo, draw.wi));
        }
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
    for (const Bsdf& bsdf : every_bsdf()) {
        EXPECT_EQ(eval(bsdf, at_angle(30), {1, 0, 0}), Rgb{});
        EXPECT_EQ(eval(bsdf, at_angle(30), {1, 0, -0.0f}), Rgb{});
        EXPECT_EQ(eval(bsdf, at_angle(30), at_angle(120)), Rgb{});
        for (const float z : {1e-3f, 1e-7f, 0.0f, -0.0f, -1e-3f}) {
            const Vec3f wo = normalize(Vec3f{1, 0, z});
            for (std::uint32_t i = 0; i < 500; ++i) {
                const PixelSampler sampler(5, i, 1);
                const BsdfSample draw = sample(bsdf, wo, sampler.sample_1d(0, 0), sampler.sample_2d(0, 1));
                ASSERT_TRUE(std::isfinite(draw.weight.r) && draw.weight.r >= 0 && std::isfinite(draw.pdf));
            }
        }
    }
}
