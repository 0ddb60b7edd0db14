#include "clients/cli/picture_file.h"

#include "clients/cli/exr_file.h"
#include "clients/cli/files.h"
#include "clients/cli/user_error.h"
#include "renderer/color/srgb.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 32768
#include <stb_image.h>
#pragma GCC diagnostic pop

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>

namespace clients {
namespace {

constexpr std::uint32_t kLongestSidePx = 32768;

[[noreturn]] void refuse(const std::string& name, const std::string& why)
{
    throw UserError(ExitCode::usage, name + ": " + why);
}

struct FreePixels {
    void operator()(void* pixels) const { stbi_image_free(pixels); }
};

template <typename T>
renderer::LinearImage
from_channels(const T* channels, int width, int height, const std::vector<float>& linear)
{
    renderer::LinearImage image{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
    image.pixels.resize(std::size_t{image.width_px} * image.height_px);
    for (renderer::Rgb& pixel : image.pixels) {
        pixel = {linear[channels[0]], linear[channels[1]], linear[channels[2]]};
        channels += 3;
    }
    return image;
}

std::vector<float> srgb_table(std::size_t steps)
{
    std::vector<float> table(steps);
    for (std::size_t i = 0; i < steps; ++i)
        table[i] = renderer::linear_from_srgb(
            static_cast<float>(static_cast<double>(i) / static_cast<double>(steps - 1)));
    return table;
}

renderer::LinearImage read_png_jpeg_or_hdr(const std::string& bytes, const std::string& name)
{
    if (bytes.size() > std::size_t{std::numeric_limits<int>::max()}) refuse(name, "larger than 2 GiB");
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    if (stbi_is_hdr_from_memory(data, size) != 0) {
        const std::unique_ptr<float, FreePixels> pixels(
            stbi_loadf_from_memory(data, size, &width, &height, &channels, 3));
        if (!pixels) refuse(name, std::string("not a readable HDR picture: ") + stbi_failure_reason());
        renderer::LinearImage image{
            static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
        image.pixels.resize(std::size_t{image.width_px} * image.height_px);
        const float* channel = pixels.get();
        for (renderer::Rgb& pixel : image.pixels) {
            pixel = {channel[0], channel[1], channel[2]};
            channel += 3;
        }
        return image;
    }
    if (stbi_is_16_bit_from_memory(data, size) != 0) {
        const std::unique_ptr<stbi_us, FreePixels> pixels(
            stbi_load_16_from_memory(data, size, &width, &height, &channels, 3));
        if (!pixels) refuse(name, std::string("not a readable PNG: ") + stbi_failure_reason());
        return from_channels(pixels.get(), width, height, srgb_table(65536));
    }
    const std::unique_ptr<stbi_uc, FreePixels> pixels(
        stbi_load_from_memory(data, size, &width, &height, &channels, 3));
    if (!pixels)
        refuse(name, std::string("not a PNG, JPEG, HDR, EXR or PFM picture: ") + stbi_failure_reason());
    return from_channels(pixels.get(), width, height, srgb_table(256));
}

// The next word of a PFM header; moves `bytes` behind it and the one blank that ends it.
std::string_view take_word(std::string_view& bytes)
{
    const std::size_t start = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
    const std::size_t end = std::min(bytes.find_first_of(" \t\r\n", start), bytes.size());
    const std::string_view word = bytes.substr(start, end - start);
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
    return word;
}

template <typename T>
T take_number(std::string_view& bytes, const std::string& name)
{
    const std::string_view word = take_word(bytes);
    T number{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size())
        refuse(name, "the PFM header has no number where one must be");
    return number;
}

} // namespace

renderer::LinearImage read_pfm(std::string_view bytes, const std::string& name)
{
    const std::string_view magic = take_word(bytes);
    if (magic != "PF" && magic != "Pf") refuse(name, "not a PFM picture");
    const std::size_t channels = magic == "PF" ? 3 : 1;
    const auto width = take_number<std::uint32_t>(bytes, name);
    const auto height = take_number<std::uint32_t>(bytes, name);
    const auto scale = take_number<double>(bytes, name);
    if (width == 0 || height == 0 || width > kLongestSidePx || height > kLongestSidePx)
        refuse(name, "a side of the picture is 0 or over 32768 pixels");
    if (scale == 0 || !std::isfinite(scale)) refuse(name, "the PFM scale is 0 or not finite");
    if (bytes.size() != std::size_t{width} * height * channels * 4)
        refuse(name,
               "the PFM has " + std::to_string(bytes.size()) + " bytes of pixels instead of " +
                   std::to_string(std::size_t{width} * height * channels * 4));
    renderer::LinearImage image{width, height, std::vector<renderer::Rgb>(std::size_t{width} * height)};
    const auto number_at = [&](std::size_t index) {
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const auto byte = static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[index * 4 + i]));
            bits |= byte << (8 * (scale < 0 ? i : 3 - i)); // a negative scale means little-endian
        }
        return std::bit_cast<float>(bits);
    };
    for (std::size_t y = 0; y < height; ++y) {
        renderer::Rgb* row =
            image.pixels.data() + (height - 1 - y) * width; // the file begins with the lowest row
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t first = (y * width + x) * channels;
            row[x] = channels == 3
                         ? renderer::Rgb{number_at(first), number_at(first + 1), number_at(first + 2)}
                         : renderer::Rgb{number_at(first), number_at(first), number_at(first)};
        }
    }
    return image;
}

renderer::LinearImage read_picture(const std::filesystem::path& path)
{
    const std::string bytes = read_file(path);
    if (bytes.starts_with("PF") || bytes.starts_with("Pf")) return read_pfm(bytes, path.string());
    if (is_exr(bytes)) return read_exr(bytes, path.string());
    return read_png_jpeg_or_hdr(bytes, path.string());
}

} // namespace clients
