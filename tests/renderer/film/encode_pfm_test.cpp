#include "renderer/film/encode_pfm.h"

#include <gtest/gtest.h>

#include <string>

TEST(Pfm, StoresRowsFromTheBottom)
{
    const renderer::LinearImage image{1, 2, {{1, 2, 3}, {4, 5, 6}}};
    const auto bytes = encode_pfm(image);
    const std::string header = "PF\n1 2\n-1.0\n";
    ASSERT_EQ(bytes.size(), header.size() + 24);
    EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(header.size())), header);
    // 4.0f little-endian first: the lower row.
    const std::vector<std::uint8_t> four{0, 0, 0x80, 0x40};
    EXPECT_EQ(std::vector<std::uint8_t>(bytes.begin() + static_cast<std::ptrdiff_t>(header.size()),
                                        bytes.begin() + static_cast<std::ptrdiff_t>(header.size()) + 4),
              four);
}

TEST(Pfm, StoresOneChannelAsGrey)
{
    const std::vector<float> values{1, 2, 3, 4};
    const auto bytes = renderer::encode_pfm(2, 2, values);
    const std::string header = "Pf\n2 2\n-1.0\n";
    ASSERT_EQ(bytes.size(), header.size() + 16);
    EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(header.size())), header);
    EXPECT_EQ(bytes[header.size() + 3], 0x40) << "3.0f is the first of the lower row";
    EXPECT_EQ(bytes[header.size() + 2], 0x40);
}
