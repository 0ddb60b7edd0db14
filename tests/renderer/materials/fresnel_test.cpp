#include "renderer/materials/fresnel.h"
#include "renderer/math/transcendental.h"

#include <gtest/gtest.h>

#include <cmath>

using renderer::fresnel_conductor;
using renderer::fresnel_dielectric;
using renderer::meet_dielectric;

namespace {

double cosine_of(double degrees)
{
    return renderer::sin_cos_deg(degrees).second;
}

// Midpoint rule in double, apart from the closed forms.
template <typename F>
double average(const F& reflected)
{
    constexpr int kSteps = 200000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double c = (i + 0.5) / kSteps;
        sum += 2 * c * reflected(c);
    }
    return sum / kSteps;
}

} // namespace

TEST(Fresnel, HasTheKnownValues)
{
    EXPECT_NEAR(fresnel_dielectric(1, 1.5), 0.04, 1e-8);
    EXPECT_NEAR(fresnel_dielectric(cosine_of(60), 1.5), 0.08918671, 1e-8);
    EXPECT_NEAR(fresnel_dielectric(0, 1.5), 1, 1e-8);
    EXPECT_NEAR(fresnel_dielectric(1, 1.33), 0.02005931, 1e-8);
    EXPECT_NEAR(fresnel_dielectric(1, 2.4), 0.16955017, 1e-8);
    EXPECT_NEAR(fresnel_dielectric(1, 1e3), 0.996008, 1e-6);
    EXPECT_NEAR(fresnel_dielectric(1, 1e-3), 0.996008, 1e-6);
    EXPECT_NEAR(renderer::normal_reflectance(1.5), 0.04, 1e-12);
}

TEST(Fresnel, ReflectsOnlyOnePolarisationAtBrewstersAngle)
{
    // There the parallel part vanishes and the other is half of twice the whole: ((1 - n^2) / (1 + n^2))^2.
    const double c = cosine_of(56.309932474020213), n2 = 2.25;
    const double perpendicular = (1 - n2) / (1 + n2);
    EXPECT_NEAR(fresnel_dielectric(c, 1.5), 0.5 * perpendicular * perpendicular, 1e-8);
}

TEST(Fresnel, IsNothingWhereThereIsNoBoundary)
{
    for (const double c : {0.0, 1e-7, 0.3, 1.0}) {
        EXPECT_EQ(fresnel_dielectric(c, 1), 0);
        EXPECT_EQ(meet_dielectric(c, 1).cos_transmitted, c);
    }
}

TEST(Fresnel, ReflectsAllBeyondTheCriticalAngleAndGoesThereContinuously)
{
    const std::pair<double, double> known[] = {{1.5, 41.810315}, {1.33, 48.753467}};
    for (const auto& [n, degrees] : known) {
        const double exact = std::asin(1 / n);
        EXPECT_NEAR(exact * 180 / renderer::kPi, degrees, 1e-6);
        EXPECT_EQ(fresnel_dielectric(std::cos(exact + 1e-12), 1 / n), 1);
        // Near it 1 - F falls as the root of the angle.
        EXPECT_NEAR(fresnel_dielectric(std::cos(exact - 1e-12), 1 / n), 1, 1e-5);
        EXPECT_LT(fresnel_dielectric(std::cos(exact - 1e-12), 1 / n), 1);
        EXPECT_EQ(meet_dielectric(std::cos(exact + 1e-12), 1 / n).cos_transmitted, 0);
    }
}

TEST(Fresnel, IsTheSameFromBothSides)
{
    for (const double n : {1.01, 1.33, 1.5, 2.4, 40.0})
        for (double c = 0.01; c <= 1; c += 0.01) {
            const auto [reflected, cos_t] = meet_dielectric(c, n);
            // What a double can say: cos_t is known to 4 roundings, n's inverse to one, and of the way back,
            // c^2 = 1 - n^2 (1 - cos_t^2), each rounding weighs n^2: 12 n^2 of them on c^2, 6 n^2 / c on c. They
            // never come all at once and one way: a third is the limit.
            const double known = 2 * 0x1p-53 * n * n / c, h = 1e-4 * c;
            const double slope =
                std::abs(fresnel_dielectric(c + h, n) - fresnel_dielectric(c - h, n)) / (2 * h);
            EXPECT_NEAR(meet_dielectric(cos_t, 1 / n).cos_transmitted, c, known) << n << " " << c;
            EXPECT_NEAR(fresnel_dielectric(cos_t, 1 / n), reflected, slope * known + 4 * 0x1p-53)
                << n << " " << c;
        }
}

TEST(Fresnel, AveragesToTheKnownValues)
{
    EXPECT_NEAR(renderer::average_fresnel_dielectric(1.5), 0.091778, 1e-5);
    EXPECT_NEAR(renderer::average_fresnel_dielectric(1 / 1.5), 0.596346, 1e-5);
    for (const double n : {1e-3, 0.5, 0.999, 1.0, 1.001, 1.01, 1.33, 10.0, 1e3})
        EXPECT_NEAR(renderer::average_fresnel_dielectric(n),
                    average([&](double c) { return fresnel_dielectric(c, n); }),
                    1e-5)
            << n;
    for (const auto& [n, k] :
         {std::pair{0.15, 4.8}, {1.4, 1.6}, {4.4, 5.2}, {0.2, 3.9}, {1e-3, 0.0}, {1e3, 1e3}})
        EXPECT_NEAR(renderer::average_fresnel_conductor(n, k),
                    average([&, n = n, k = k](double c) { return fresnel_conductor(c, n, k); }),
                    k == 0 ? 0.05 : 2e-4) // total reflection from a kink
            << n << " " << k;
}

TEST(Fresnel, OfAConductorWithoutAbsorptionIsADielectrics)
{
    for (const double n : {0.3, 1.2, 1.5, 100.0})
        for (double c = 0; c <= 1; c += 0.01)
            EXPECT_NEAR(fresnel_conductor(c, n, 0), fresnel_dielectric(c, n), 1e-9) << n << " " << c;
}

TEST(Fresnel, StaysAShareAtEveryExtreme)
{
    for (const double n : {1e-3, 1.0, 1e3})
        for (const double k : {0.0, 1e-3, 1.0, 1e3})
            for (const double c : {-1.0, -0.0, 0.0, 1e-300, 1e-7, 0.5, 1.0, 1 + 1e-7}) {
                const double conductor = fresnel_conductor(c, n, k), dielectric = fresnel_dielectric(c, n);
                EXPECT_TRUE(conductor >= 0 && conductor <= 1 + 1e-12) << n << " " << k << " " << c;
                EXPECT_TRUE(dielectric >= 0 && dielectric <= 1 + 1e-12) << n << " " << c;
            }
}

TEST(Fresnel, IsNearSchlicksApproximationWhereThatIsUsed)
{
    // Known as 0.036, 0.060 and 0.074, which are rounded: the last is more than it says.
    const std::pair<double, double> bounds[] = {{1.5, 0.0356926}, {1.33, 0.0599237}, {2.4, 0.0740356}};
    for (const auto& [n, most] : bounds) {
        double worst = 0;
        const double f0 = renderer::normal_reflectance(n);
        for (double c = 0; c <= 1; c += 1e-4)
            worst = std::max(
                worst, std::abs(f0 + (1 - f0) * renderer::schlick_weight(c) - fresnel_dielectric(c, n)));
        EXPECT_NEAR(worst, most, 1e-6) << n;
    }
}
