#include "renderer/film/encode_hdr.h"

#include "renderer/film/append_bytes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

namespace renderer {

namespace {

constexpr float kLargest = 255 * 0x1p119f;
constexpr int kBias = 128;
// Lines of other widths are written pixel by pixel: old readers take the first bytes for those of a run.
constexpr std::uint32_t kLeastRunWidth = 8, kMostRunWidth = 0x7fff;
constexpr std::size_t kLeastRun = 4, kMostRun = 127, kMostLiteral = 128;

using Rgbe = std::array<std::uint8_t, 4>;

float in_range(float x)
{
    return x > 0 ? std::min(x, kLargest) : 0.0f; // NaN fails the comparison
}

// frexp and ldexp are exact.
Rgbe rgbe_of(Rgb colour)
{
    const float r = in_range(colour.r), g = in_range(colour.g), b = in_range(colour.b);
    const float most = std::max({r, g, b});
    int exponent = 0;
    std::frexp(most, &exponent); // most is below 2^exponent
    if (std::lround(std::ldexp(most, 8 - exponent)) > 255) ++exponent;
    if (most == 0 || exponent + kBias < 1) return {0, 0, 0, 0};
    const auto mantissa = [&](float x) {
        return static_cast<std::uint8_t>(std::lround(std::ldexp(x, 8 - exponent)));
    };
    return {mantissa(r), mantissa(g), mantissa(b), static_cast<std::uint8_t>(exponent + kBias)};
}

std::size_t run_length(std::span<const std::uint8_t> bytes)
{
    std::size_t length = 1;
    while (length < bytes.size() && length < kMostRun && bytes[length] == bytes[0])
        ++length;
    return length;
}

// One byte above 128 and the value for a run, one of 1 to 128 and as many values for what is none.
void append_runs(Bytes& out, std::span<const std::uint8_t> bytes)
{
    std::size_t literal = 0; // bytes at the front that belong to no run
    const auto flush = [&] {
        for (std::size_t at = 0; at < literal; at += kMostLiteral) {
            const auto part = bytes.subspan(at, std::min(literal - at, kMostLiteral));
            out.push_back(static_cast<std::uint8_t>(part.size()));
            out.insert(out.end(), part.begin(), part.end());
        }
        bytes = bytes.subspan(literal);
        literal = 0;
    };
    while (literal < bytes.size()) {
        const std::size_t run = run_length(bytes.subspan(literal));
        if (run < kLeastRun) {
            literal += run;
            continue;
        }
        flush();
        out.push_back(static_cast<std::uint8_t>(128 + run));
        out.push_back(bytes[0]);
        bytes = bytes.subspan(run);
    }
    flush();
}

void append_line(Bytes& out, std::span<const Rgb> line, std::vector<Rgbe>& pixels)
{
    pixels.clear();
    for (const Rgb& colour : line)
        pixels.push_back(rgbe_of(colour));
    const auto width = static_cast<std::uint32_t>(line.size());
    if (width < kLeastRunWidth || width > kMostRunWidth) {
        for (const Rgbe& pixel : pixels)
            out.insert(out.end(), pixel.begin(), pixel.end());
        return;
    }
    const std::uint8_t head[]{
        2, 2, static_cast<std::uint8_t>(width >> 8), static_cast<std::uint8_t>(width & 255)};
    out.insert(out.end(), head, head + 4);
    Bytes channel(line.size());
    for (std::size_t c = 0; c < 4; ++c) {
        for (std::size_t x = 0; x < line.size(); ++x)
            channel[x] = pixels[x][c];
        append_runs(out, channel);
    }
}

std::string upper(std::string text)
{
    for (char& c : text)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return text;
}

} // namespace

std::vector<std::uint8_t> encode_hdr(const LinearImage& image, const PictureTexts& texts)
{
    Bytes out;
    append_text(out, "#?RADIANCE\n");
    for (const PictureText& text : texts)
        append_text(out, upper(text.keyword) + "=" + text.text + "\n");
    append_text(out, "PRIMARIES=0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329\nFORMAT=32-bit_rle_rgbe\n\n");
    append_text(out,
                "-Y " + std::to_string(image.height_px) + " +X " + std::to_string(image.width_px) + "\n");
    std::vector<Rgbe> pixels;
    for (std::size_t y = 0; y < image.height_px; ++y)
        append_line(out, std::span(image.pixels).subspan(y * image.width_px, image.width_px), pixels);
    return out;
}

} // namespace renderer
