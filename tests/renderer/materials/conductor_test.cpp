#include "renderer/description/metals.h"
#include "renderer/materials/fresnel.h"
#include "tests/renderer/materials/every_bsdf.h"

#include <gtest/gtest.h>

using renderer::Metal;
using renderer::Rgb;

namespace {

Rgb at_normal(Metal metal)
{
    renderer::ConductorMaterial m;
    m.ior = metal;
    return delta_lobes(make_bsdf(m), {0, 0, 1}).lobes[0].weight;
}

} // namespace

TEST(Conductor, OfNamedMetalReflectsWhatWasMeasured)
{
    // ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2) of the measured figures nearest to green.
    EXPECT_NEAR(at_normal(Metal::aluminium).g, 0.915f, 0.01f);
    EXPECT_NEAR(at_normal(Metal::silver).g, 0.982f, 0.01f);
    EXPECT_NEAR(at_normal(Metal::gold).g, 0.79f, 0.02f);
    EXPECT_NEAR(at_normal(Metal::copper).g, 0.62f, 0.02f);
    EXPECT_NEAR(at_normal(Metal::iron).g, 0.51f, 0.02f);
    EXPECT_NEAR(at_normal(Metal::chromium).g, 0.555f, 0.02f);
    EXPECT_NEAR(at_normal(Metal::tungsten).g, 0.496f, 0.02f);
    // Gold and copper are red, the others grey to a tenth.
    for (const Metal red : {Metal::gold, Metal::copper}) {
        EXPECT_GT(at_normal(red).r, at_normal(red).g);
        EXPECT_GT(at_normal(red).g, at_normal(red).b);
    }
    for (const Metal grey : {Metal::aluminium,
                             Metal::chromium,
                             Metal::iron,
                             Metal::nickel,
                             Metal::platinum,
                             Metal::silver,
                             Metal::titanium,
                             Metal::tungsten})
        EXPECT_NEAR(at_normal(grey).r, at_normal(grey).b, 0.1f);
}

TEST(Conductor, IsItsFresnelTermWhereItIsSmooth)
{
    const renderer::Bsdf smooth = tests::conductor(0.4f, 2.5f, 0);
    for (const double angle : {0.0, 30.0, 70.0, 89.0}) {
        const renderer::Vec3f wo = tests::at_angle(angle);
        const renderer::BsdfSample drawn = sample(smooth, wo, 0.7f, {0.2f, 0.3f});
        EXPECT_EQ(drawn.wi, (renderer::Vec3f{-wo.x, -wo.y, wo.z}));
        EXPECT_TRUE(drawn.is_delta);
        EXPECT_NEAR(drawn.weight.r,
                    renderer::fresnel_conductor(static_cast<double>(wo.z), static_cast<double>(0.4f), 2.5),
                    1e-6);
    }
}

TEST(Mirror, ReflectsExactlyItsColour)
{
    const renderer::Bsdf mirror = make_bsdf(renderer::MirrorMaterial{{{0.25f, 0.5f, 0.75f}}});
    const renderer::BsdfSample drawn = sample(mirror, tests::at_angle(40), 0.7f, {0.2f, 0.3f});
    EXPECT_EQ(drawn.weight, (Rgb{0.25f, 0.5f, 0.75f}));
    EXPECT_EQ(drawn.pdf, 1);
    EXPECT_EQ(sample(mirror, tests::at_angle(91), 0.7f, {0.2f, 0.3f}).pdf, 0);
}
