// Every form of picture gives the pattern that was written, and every broken one its exact fault.
#include "renderer/description/image_formats.h"
#include "renderer/io/import_image.h"
#include "tests/assets/write_images.h"
#include "tests/support/places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>

namespace {

using renderer::Image;
using renderer::ImageResult;
using renderer::ImportFault;
using renderer::PixelType;

std::string asset(const std::string& name)
{
    std::ifstream file(tests::asset_dir() + "/images/" + name, std::ios::binary);
    EXPECT_TRUE(file) << name;
    return {std::istreambuf_iterator<char>(file), {}};
}

ImageResult read(const std::string& name, const std::string& bytes, const renderer::Limits& limits = {})
{
    return renderer::import_image(name, std::as_bytes(std::span(bytes)), limits);
}

Image image(const std::string& name)
{
    auto result = read(name, asset(name));
    if (const auto* fault = std::get_if<ImportFault>(&result)) {
        ADD_FAILURE() << name << ": " << fault->code << ": " << fault->detail;
        return {};
    }
    Image found = std::move(std::get<renderer::ImportedImage>(result).image);
    EXPECT_EQ(renderer::validate_image(found), std::nullopt) << name;
    return found;
}

std::string code_of(const ImageResult& result)
{
    const auto* fault = std::get_if<ImportFault>(&result);
    return fault ? fault->code : "ok";
}

int code_at(const Image& image, std::size_t number)
{
    if (image.type == PixelType::whole_8) return std::to_integer<int>(image.bytes[number]);
    std::uint16_t code = 0;
    std::memcpy(&code, image.bytes.data() + 2 * number, sizeof code);
    return code;
}

float light_at(const Image& image, std::size_t number)
{
    float value = 0;
    std::memcpy(&value, image.bytes.data() + 4 * number, sizeof value);
    return value;
}

// `first` channels of the pattern, or 3 with the fourth for alpha.
void expect_pattern(const std::string& name, std::uint32_t channels, int tolerance = 0)
{
    const Image found = image(name);
    ASSERT_EQ(found.width, tests::kPatternWidth) << name;
    ASSERT_EQ(found.height, tests::kPatternHeight) << name;
    ASSERT_EQ(found.channels, channels) << name;
    std::size_t i = 0;
    for (std::uint32_t y = 0; y < found.height; ++y)
        for (std::uint32_t x = 0; x < found.width; ++x)
            for (std::uint32_t c = 0; c < channels; ++c, ++i) {
                const int wanted = tests::pattern(x, y, c);
                const int expected = found.type == PixelType::whole_16 ? wanted * 256 + 17 : wanted;
                EXPECT_NEAR(code_at(found, i), expected, tolerance)
                    << name << ' ' << x << ' ' << y << ' ' << c;
            }
}

TEST(ImportImage, ReadsEveryFormOfPng)
{
    expect_pattern("grey.png", 1);
    expect_pattern("rgb.png", 3);
    expect_pattern("grey_alpha.png", 2);
    expect_pattern("rgba.png", 4);
    expect_pattern("palette.png", 3);
    expect_pattern("palette_alpha.png", 4);
    expect_pattern("interlaced.png", 3);
}

TEST(ImportImage, KeepsSixteenBitsOfAPng)
{
    EXPECT_EQ(image("rgb_16.png").type, PixelType::whole_16);
    expect_pattern("grey_16.png", 1);
    expect_pattern("rgb_16.png", 3);
    expect_pattern("rgba_16.png", 4);
}

TEST(ImportImage, SpreadsSingleBitsOverAllCodes)
{
    const Image found = image("bits.png");
    ASSERT_EQ(found.pixels(), 6u);
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_EQ(code_at(found, i), i % 2 == 0 ? 255 : 0) << i;
}

TEST(ImportImage, ReadsJpeg)
{
    expect_pattern("rgb.jpg", 3, 8);
    const Image grey = image("grey.jpg");
    ASSERT_EQ(grey.channels, 1u);
    ASSERT_EQ(grey.pixels(), 64u);
    for (std::size_t i = 0; i < 64; ++i)
        EXPECT_EQ(code_at(grey, i), 128) << i;
}

TEST(ImportImage, RefusesAJpegWhoseHuffmanTableHasMoreCodesThanThereAre)
{
    const std::string whole = asset("rgb.jpg");
    const std::size_t table = whole.find("\xff\xc4");
    ASSERT_NE(table, std::string::npos);
    for (const std::size_t of_length : {0u, 7u, 15u}) {
        std::string bytes = whole;
        bytes[table + 5 + of_length] = '\xff';
        EXPECT_EQ(code_of(read("rgb.jpg", bytes)), "malformed") << of_length;
    }
    // A table as long as it says, with 300 codes.
    std::string counts(16, '\0');
    counts[14] = '\xff';
    counts[15] = 45;
    const std::size_t length = 2 + 17 + 300;
    const std::string segment = std::string("\xff\xc4") + static_cast<char>(length >> 8) +
                                static_cast<char>(length & 0xff) + '\0' + counts + std::string(300, '\1');
    EXPECT_EQ(code_of(read("rgb.jpg", whole.substr(0, table) + segment + whole.substr(table))), "malformed");
}

TEST(ImportImage, ReadsTgaOfEitherKind)
{
    expect_pattern("rgb.tga", 3);
    expect_pattern("rgba_runs.tga", 4);
    const Image palette = image("palette.tga");
    ASSERT_EQ(palette.bytes.size(), 3u);
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_EQ(code_at(palette, c), static_cast<int>(c) + 1);
}

TEST(ImportImage, ReadsTgaByItsHeaderWhereItHasNoName)
{
    EXPECT_EQ(code_of(read("", asset("rgb.tga"))), "ok");
}

TEST(ImportImage, ReadsTheLightOfHdr)
{
    const Image light = image("light.hdr");
    ASSERT_EQ(light.type, PixelType::real_32);
    ASSERT_EQ(light.channels, 3u);
    std::size_t i = 0;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 16; ++x)
            for (const float scale : {1.0f, 2.0f, 4.0f})
                EXPECT_EQ(light_at(light, i++), static_cast<float>((x + 1) * (y + 1)) / 8 * scale) << x << y;
}

TEST(ImportImage, ReadsHdrWithoutRunsAndWithOldOnes)
{
    const Image flat = image("flat.hdr");
    ASSERT_EQ(flat.bytes.size(), 4u * 3 * sizeof(float));
    EXPECT_EQ(light_at(flat, 0), 1.0f); // 128 / 256 * 2^1
    EXPECT_EQ(light_at(flat, 1), 0.5f);
    EXPECT_EQ(light_at(flat, 3), 0.5f);
    EXPECT_EQ(light_at(flat, 6), 0.0f);
    EXPECT_EQ(light_at(flat, 11), 48.0f);
    const Image runs = image("old_runs.hdr");
    ASSERT_EQ(runs.pixels(), 3u);
    for (std::size_t x = 0; x < 3; ++x)
        EXPECT_EQ(light_at(runs, 3 * x), 1.0f);
}

TEST(ImportImage, TurnsRowsThatComeFromTheBottom)
{
    std::string bytes = asset("flat.hdr");
    bytes.replace(bytes.find("-Y"), 2, "+Y");
    const auto result = read("a.hdr", bytes);
    ASSERT_EQ(code_of(result), "ok");
    EXPECT_EQ(light_at(std::get<renderer::ImportedImage>(result).image, 6), 1.0f);
}

TEST(ImportImage, TellsWhatIsWrongWithEveryBrokenFile)
{
    std::istringstream manifest(asset("broken/manifest.tsv"));
    std::size_t files = 0;
    for (std::string line; std::getline(manifest, line); ++files) {
        const std::string name = line.substr(0, line.find('\t'));
        const std::size_t begin = name.size() + 1;
        const std::string code = line.substr(begin, line.find('\t', begin) - begin);
        const auto result = read(name, asset("broken/" + name));
        EXPECT_EQ(code_of(result), code) << line;
        if (const auto* fault = std::get_if<ImportFault>(&result)) {
            EXPECT_GT(fault->detail.size(), 15u) << line;
        }
    }
    EXPECT_GE(files, 30u);
}

TEST(ImportImage, HoldsTheLimitOfPixels)
{
    renderer::Limits limits;
    limits.texture_pixels = 19;
    for (const char* name : {"rgb.png", "rgb.jpg", "light.hdr", "rgb.tga"})
        EXPECT_EQ(code_of(read(name, asset(name), limits)), "over_limit") << name;
}

// Whatever a file is cut to or has a byte of changed to: an answer, and a picture only if it is a sound one.
TEST(ImportImage, ComesToAnEndOnEveryCutAndEveryChange)
{
    for (const std::string name : {"rgb.png",
                                   "palette_alpha.png",
                                   "interlaced.png",
                                   "rgb.jpg",
                                   "light.hdr",
                                   "old_runs.hdr",
                                   "rgba_runs.tga"}) {
        const std::string whole = asset(name);
        for (std::size_t size = 0; size < whole.size(); ++size)
            EXPECT_NE(code_of(read(name, whole.substr(0, size))), "ok") << name << " cut to " << size;
        for (std::size_t at = 0; at < whole.size(); ++at)
            for (const unsigned change : {1u, 0x80u, 0xffu}) {
                std::string bytes = whole;
                bytes[at] = static_cast<char>(static_cast<unsigned char>(bytes[at]) ^ change);
                const auto result = read(name, bytes);
                if (const auto* good = std::get_if<renderer::ImportedImage>(&result)) {
                    EXPECT_EQ(renderer::validate_image(good->image), std::nullopt) << name << ' ' << at;
                }
            }
    }
}

TEST(ImportImage, NamesOnlyFormatsOfTheTable)
{
    std::set<std::string> formats;
    for (const char* name : {"rgb.png", "rgb.jpg", "light.hdr", "rgb.tga"})
        formats.insert(std::get<renderer::ImportedImage>(read(name, asset(name))).format);
    std::set<std::string> table;
    for (const renderer::ImageFormat& format : renderer::kImageFormats)
        table.insert(std::string(format.name));
    EXPECT_EQ(formats, table);
}

} // namespace
