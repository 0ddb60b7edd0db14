#include "renderer/math/fast_exp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

TEST(FastExp, IsWithinTwoUlpOfTheExactValue)
{
    for (int i = -70'800; i <= 70'900; ++i) {
        const double x = i * 0.00999999;
        const long double exact = std::exp(static_cast<long double>(x));
        const double error = static_cast<double>(std::abs((renderer::fast_exp(x) - exact) / exact));
        ASSERT_LE(error, 2 * std::numeric_limits<double>::epsilon()) << x;
    }
}

TEST(FastExp, HasItsEnds)
{
    EXPECT_EQ(renderer::fast_exp(0), 1);
    EXPECT_EQ(renderer::fast_exp(-0.0), 1);
    EXPECT_EQ(renderer::fast_exp(-1e4), 0);
    EXPECT_EQ(renderer::fast_exp(-std::numeric_limits<double>::infinity()), 0);
    EXPECT_EQ(renderer::fast_exp(1e4), std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan(renderer::fast_exp(std::numeric_limits<double>::quiet_NaN())));
}
