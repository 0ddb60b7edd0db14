#include "renderer/sky/gauss_legendre.h"
#include "renderer/sky/phase.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace renderer;

namespace {

// Over the sphere, in pieces that shrink towards either pole as peaks do.
template <typename F>
double over_sphere(const F& f)
{
    const GaussLegendre rule(32);
    double sum = 0, edge = 1;
    for (int piece = 0; piece < 40; ++piece) {
        const double next = piece == 39 ? 0 : edge / 2;
        for (std::size_t i = 0; i < rule.x.size(); ++i) {
            const double from_pole = next + (edge - next) * rule.x[i];
            sum += 2 * kPi * (edge - next) * rule.weight[i] * (f(1 - from_pole) + f(from_pole - 1));
        }
        edge = next;
    }
    return sum;
}

} // namespace

TEST(PhaseFunctions, IntegrateToOne)
{
    EXPECT_NEAR(over_sphere(rayleigh_phase), 1, 1e-12);
    for (const MiePhase phase : {MiePhase::cornette_shanks, MiePhase::henyey_greenstein})
        for (const double g : {-0.999, -0.5, 0.0, 0.76, 0.999})
            EXPECT_NEAR(over_sphere([&](double nu) { return mie_phase(phase, g, nu); }), 1, 1e-8) << g;
}

// E27: Cornette-Shanks's parameter is not its mean cosine.
TEST(PhaseFunctions, HaveTheirMeanCosine)
{
    const auto mean = [](MiePhase phase, double g) {
        return over_sphere([&](double nu) { return nu * mie_phase(phase, g, nu); });
    };
    for (const double g : {-0.5, 0.2, 0.76}) {
        EXPECT_NEAR(mean(MiePhase::henyey_greenstein, g), g, 1e-9);
        EXPECT_NEAR(mean(MiePhase::cornette_shanks, g), 3 * g * (4 + g * g) / (5 * (2 + g * g)), 1e-9);
    }
}

TEST(PhaseFunctions, WithoutAsymmetryCornetteShanksIsRayleigh)
{
    for (const double nu : {-1.0, -0.3, 0.0, 0.7, 1.0})
        EXPECT_NEAR(mie_phase(MiePhase::cornette_shanks, 0, nu), rayleigh_phase(nu), 1e-15);
}

TEST(GaussLegendre, IsExactForPolynomials)
{
    for (const std::size_t n : {1u, 2u, 5u, 16u, 48u}) {
        const GaussLegendre rule(n);
        for (std::size_t power = 0; power < 2 * n; ++power) {
            double sum = 0;
            for (std::size_t i = 0; i < n; ++i)
                sum += rule.weight[i] * std::pow(rule.x[i], static_cast<double>(power));
            EXPECT_NEAR(sum * static_cast<double>(power + 1), 1, 1e-13) << n << ' ' << power;
        }
    }
}
