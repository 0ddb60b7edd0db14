// Pictures for tests: a small pattern in every form that is read, and broken files that are to be refused.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tests {

// What a PNG's header says of its numbers.
struct PngForm {
    std::uint8_t bits = 8;
    std::uint8_t color_type = 2; // 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGBA
    std::uint8_t interlace = 0;
};

// A PNG of raw rows, each with its filter byte, not compressed; `chunks` stand before the pixels.
std::string png_bytes(std::uint32_t width,
                      std::uint32_t height,
                      const PngForm& form,
                      std::string_view rows,
                      std::string_view chunks = "");
std::string png_chunk(std::string_view name, std::string_view content);

// The pattern: 5 x 4 pixels, channel c of pixel (x, y), from the top: (40 x + 20 y + 10 c + 5) of 255.
inline constexpr std::uint32_t kPatternWidth = 5, kPatternHeight = 4;
constexpr std::uint8_t pattern(std::uint32_t x, std::uint32_t y, std::uint32_t c)
{
    return static_cast<std::uint8_t>(40 * x + 20 * y + 10 * c + 5);
}

// FOLDER/NAME.EXT of the pattern, and FOLDER/broken with manifest.tsv: name, codes, what is wrong.
void write_images(const std::filesystem::path& folder);

} // namespace tests
