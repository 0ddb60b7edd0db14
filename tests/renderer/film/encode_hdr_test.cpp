#include "renderer/film/encode_hdr.h"
#include "tests/support/decode_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

using renderer::LinearImage;

namespace {

const float kInf = std::numeric_limits<float>::infinity();
const float kNan = std::numeric_limits<float>::quiet_NaN();

} // namespace

// Each channel within half a step of the pixel's largest one, whose mantissa has 128 to 255 steps.
TEST(Hdr, DecodesToTheSameRadianceWithinHalfAStep)
{
    for (const std::uint32_t width : {1u, 7u, 8u, 300u}) {
        const LinearImage image = tests::some_radiance(width, 21);
        const tests::Decoded decoded = tests::decode_hdr(encode_hdr(image));
        ASSERT_EQ(decoded.values.size(), image.pixels.size() * 3) << width;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            const renderer::Rgb& p = image.pixels[i];
            const float most = std::max({p.r, p.g, p.b}), half_step = most / 255 * 1.0001f;
            EXPECT_NEAR(decoded.values[i * 3], p.r, half_step);
            EXPECT_NEAR(decoded.values[i * 3 + 1], p.g, half_step);
            EXPECT_NEAR(decoded.values[i * 3 + 2], p.b, half_step);
        }
    }
}

TEST(Hdr, RunsMakeItSmaller)
{
    const LinearImage flat{1000, 10, std::vector<renderer::Rgb>(10000, {1, 1, 1})};
    EXPECT_LT(encode_hdr(flat).size(), 1200u);
    EXPECT_EQ(tests::decode_hdr(encode_hdr(flat)).values, std::vector<float>(30000, 1.0f));
}

TEST(Hdr, RoundsUpToTheNextExponent)
{
    const float just_below_one = std::nextafter(1.0f, 0.0f);
    const LinearImage image{1, 1, {{just_below_one, just_below_one, 0}}};
    EXPECT_EQ(tests::decode_hdr(encode_hdr(image)).values, (std::vector<float>{1, 1, 0}));
}

TEST(Hdr, ClampsWhatItCannotHold)
{
    const float largest = 255 * 0x1p119f;
    const LinearImage image{2, 2, {{3e38f, kInf, 1}, {kNan, -1, 0.5f}, {largest, 0, 0}, {1e-45f, 0, 0}}};
    const auto values = tests::decode_hdr(encode_hdr(image)).values;
    EXPECT_EQ(values, (std::vector<float>{largest, largest, 0, 0, 0, 0.5f, largest, 0, 0, 0, 0, 0}));
}

TEST(Hdr, CarriesItsTextsAsVariables)
{
    const LinearImage image{8, 1, std::vector<renderer::Rgb>(8, {1, 2, 3})};
    const auto hdr = encode_hdr(image, {{"Software", "heliograph"}, {"heliograph", "{\"seed\":1}"}});
    const std::string bytes(hdr.begin(), hdr.end());
    EXPECT_EQ(bytes.rfind("#?RADIANCE\nSOFTWARE=heliograph\nHELIOGRAPH={\"seed\":1}\n", 0), 0u);
    EXPECT_EQ(tests::decode_hdr(hdr).values.size(), 24u);
}
