#include "api/words/digest.h"
#include "api/words/limit_words.h"
#include "api/words/time_words.h"
#include "api/words/word_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>

namespace {

TEST(LimitWords, NameFlagAndEnvironment)
{
    EXPECT_EQ(api::flag_of("image_side_px"), "--limit-image-side-px");
    EXPECT_EQ(api::environment_of("image_side_px"), "HELIOGRAPH_LIMIT_IMAGE_SIDE_PX");
}

TEST(LimitWords, FaultNamesLimitValueAndFlag)
{
    renderer::Limits limits;
    limits.image_side_px = 100;
    const api::Problem fault = api::over_limit("/image/width", "image_side_px", 101, limits);
    EXPECT_EQ(fault.pointer, "/image/width");
    EXPECT_EQ(fault.code, "over_limit");
    EXPECT_EQ(fault.detail,
              "101 pixels is over the limit image_side_px, 100 pixels; the service raises it with "
              "--limit-image-side-px");
}

TEST(Digest, IsSixtyFourLowerCaseHexDigits)
{
    EXPECT_TRUE(api::is_digest("sha256:" + std::string(64, 'f')));
    EXPECT_FALSE(api::is_digest("sha256:" + std::string(64, 'F')));
    EXPECT_FALSE(api::is_digest("sha256:" + std::string(63, 'f')));
    EXPECT_FALSE(api::is_digest("sha256:" + std::string(64, 'g')));
    EXPECT_FALSE(api::is_digest("sha1:" + std::string(64, 'f')));
    EXPECT_FALSE(api::is_digest(""));
    EXPECT_TRUE(api::names_digest("sha256:x"));
}

TEST(Rfc3339, WritesUtcWithMilliseconds)
{
    EXPECT_EQ(api::rfc3339(0), "1970-01-01T00:00:00.000Z");
    EXPECT_EQ(api::rfc3339(1'709'164'800'250), "2024-02-29T00:00:00.250Z");
    EXPECT_EQ(api::rfc3339(-1), "1969-12-31T23:59:59.999Z");
    EXPECT_EQ(api::rfc3339(4'102'444'799'999), "2099-12-31T23:59:59.999Z");
    EXPECT_EQ(api::rfc3339(INT64_MAX), "9999-12-31T23:59:59.999Z");
}

template <typename T>
void expect_a_word_for_each(std::size_t alternatives, int first)
{
    std::set<int> values;
    for (const api::Word& word : api::words_for<T>())
        if (word.value != api::kNotBuilt) values.insert(word.value);
    EXPECT_EQ(values.size(), alternatives);
    EXPECT_EQ(*values.begin(), first);
    EXPECT_EQ(*values.rbegin(), static_cast<int>(alternatives) - 1 + first);
}

TEST(WordTables, HaveAWordForEachAlternative)
{
    expect_a_word_for_each<renderer::Material>(std::variant_size_v<renderer::Material>, 0);
    expect_a_word_for_each<renderer::Shape>(std::variant_size_v<renderer::Shape> - 1, 1); // mesh is a member
    expect_a_word_for_each<renderer::Light>(std::variant_size_v<renderer::Light>, 0);
    expect_a_word_for_each<renderer::Environment>(std::variant_size_v<renderer::Environment>, 0);
    expect_a_word_for_each<renderer::PhongForm>(2, 0);
    expect_a_word_for_each<renderer::Multiscatter>(3, 0);
    expect_a_word_for_each<renderer::Metal>(10, 0);
    expect_a_word_for_each<renderer::Shading>(3, 0);
    expect_a_word_for_each<renderer::TransportType>(6, 0);
    expect_a_word_for_each<renderer::Projection>(4, 0);
    expect_a_word_for_each<renderer::MeterQuantity>(2, 0);
    expect_a_word_for_each<renderer::Tone>(3, 0);
    expect_a_word_for_each<renderer::BvhSplit>(3, 0);
    expect_a_word_for_each<renderer::BvhWidth>(2, 0);
    expect_a_word_for_each<renderer::BvhLevels>(3, 0);
}

TEST(WordTables, TellBuiltFromKnown)
{
    EXPECT_FALSE(api::find_word(api::fail_on_words(), "target_missed")->built());
    EXPECT_EQ(api::find_word(api::words_for<renderer::Environment>(), "fog"), nullptr);
    const std::vector<std::string> built = api::names_of(api::fail_on_words());
    EXPECT_EQ(std::count(built.begin(), built.end(), "non_finite"), 1);
    EXPECT_EQ(std::count(built.begin(), built.end(), "target_missed"), 0);
}

} // namespace
