#include "api/json/json.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace {

TEST(ShortestDouble, WritesAFloatAsPeopleDo)
{
    EXPECT_EQ(api::text_of(api::shortest_double(0.6f)), "0.6");
    EXPECT_EQ(api::text_of(api::shortest_double(0.1f)), "0.1");
    EXPECT_EQ(api::text_of(api::shortest_double(1e30f)), "1e+30");
}

TEST(ShortestDouble, ReadsBackToTheSameFloat)
{
    std::mt19937 random(1);
    for (int i = 0; i < 200'000; ++i) {
        const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        if (!std::isfinite(value)) continue;
        ASSERT_EQ(static_cast<float>(api::shortest_double(value)), value);
    }
    for (const float value : {std::numeric_limits<float>::max(),
                              std::numeric_limits<float>::min(),
                              std::numeric_limits<float>::denorm_min()})
        EXPECT_EQ(static_cast<float>(api::shortest_double(value)), value);
}

TEST(JsonText, ReplacesWhatIsNotUtf8)
{
    EXPECT_EQ(api::text_of(api::Json("caf\xe9")), "\"caf\xef\xbf\xbd\"");
}

} // namespace
