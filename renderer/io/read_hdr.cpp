#include "renderer/io/image_bounds.h"
#include "renderer/io/read_images.h"
#include "renderer/io/text.h"

#include <array>
#include <cmath>
#include <vector>

namespace renderer {

namespace {

using Rgbe = std::array<std::uint8_t, 4>;

ImportFault ends_early()
{
    return {"truncated", "the HDR ends before its last row: send the file whole"};
}

// "-Y 100 +X 200": rows from the top, pixels from the left; "+Y": rows from the bottom.
struct Resolution {
    std::uint32_t width = 0, height = 0;
    bool from_bottom = false;
};

std::optional<Resolution> read_resolution(std::string_view line)
{
    const std::string_view y = take_word(line);
    const auto height = parse_integer(take_word(line));
    const std::string_view x = take_word(line);
    const auto width = parse_integer(take_word(line));
    const bool fits =
        width && height && *width > 0 && *height > 0 && *width <= 0x7fffffff && *height <= 0x7fffffff;
    if (!fits || (y != "-Y" && y != "+Y") || x != "+X" || !trimmed(line).empty()) return std::nullopt;
    return Resolution{static_cast<std::uint32_t>(*width), static_cast<std::uint32_t>(*height), y == "+Y"};
}

class HdrReader {
public:
    HdrReader(std::span<const std::byte> bytes, const Limits& limits) : bytes_(bytes), limits_(limits) {}
    ImageResult read();

private:
    std::optional<ImportFault> header();
    std::optional<ImportFault> row(std::vector<Rgbe>& pixels);
    std::optional<ImportFault> new_row(std::vector<Rgbe>& pixels);
    std::optional<ImportFault> old_row(std::vector<Rgbe>& pixels);
    std::uint8_t byte() { return std::to_integer<std::uint8_t>(bytes_[at_++]); }
    std::size_t left() const { return bytes_.size() - at_; }
    static ImportFault overrun() { return {"malformed", "a run of the HDR passes the end of its row"}; }

    std::span<const std::byte> bytes_;
    const Limits& limits_;
    std::size_t at_ = 0;
    Resolution size_;
    float exposure_ = 1; // numbers were multiplied by it
};

std::optional<ImportFault> HdrReader::header()
{
    const std::string_view text = text_of(bytes_);
    constexpr std::size_t kMostLines = 1000;
    for (std::size_t line_number = 0; line_number < kMostLines; ++line_number) {
        const std::size_t end = text.find('\n', at_);
        if (end == text.npos) return ImportFault{"truncated", "the HDR ends within its header"};
        const std::string_view line = trimmed(text.substr(at_, end - at_));
        at_ = end + 1;
        if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
            return ImportFault{"unsupported",
                               "the HDR has " + in_quotes(line.substr(7)) + "; 32-bit_rle_rgbe is read"};
        if (line.starts_with("EXPOSURE=")) {
            const auto value = parse_float(trimmed(line.substr(9)));
            if (!value || !(*value > 0) || !std::isfinite(*value))
                return ImportFault{"malformed", "the HDR's exposure is " + in_quotes(line.substr(9))};
            exposure_ *= *value;
        }
        if (!line.empty()) continue;
        const std::size_t last = text.find('\n', at_);
        if (last == text.npos) return ImportFault{"truncated", "the HDR ends within its header"};
        const auto size = read_resolution(text.substr(at_, last - at_));
        if (!size)
            return ImportFault{"unsupported",
                               "the HDR's size is " + in_quotes(text.substr(at_, last - at_)) +
                                   "; \"-Y height +X width\" and \"+Y height +X width\" are read"};
        at_ = last + 1;
        size_ = *size;
        return std::nullopt;
    }
    return ImportFault{"malformed", "the HDR's header does not end"};
}

// Four planes one after the other, each of runs and of plain stretches.
std::optional<ImportFault> HdrReader::new_row(std::vector<Rgbe>& pixels)
{
    for (std::size_t channel = 0; channel < 4; ++channel) {
        for (std::size_t x = 0; x < pixels.size();) {
            if (left() < 2) return ends_early();
            std::size_t count = byte();
            const bool is_run = count > 128;
            if (is_run) count -= 128;
            if (count == 0 || count > pixels.size() - x) return overrun();
            if (!is_run && count > left()) return ends_early();
            const std::uint8_t value = is_run ? byte() : std::uint8_t{0};
            for (std::size_t i = 0; i < count; ++i)
                pixels[x++][channel] = is_run ? value : byte();
        }
    }
    return std::nullopt;
}

// Pixel by pixel; 1, 1, 1, n repeats the one before n times, the next such one 256 n times.
std::optional<ImportFault> HdrReader::old_row(std::vector<Rgbe>& pixels)
{
    unsigned shift = 0;
    for (std::size_t x = 0; x < pixels.size();) {
        if (left() < 4) return ends_early();
        const Rgbe pixel{byte(), byte(), byte(), byte()};
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            pixels[x++] = pixel;
            shift = 0;
            continue;
        }
        const std::size_t count = shift < 32 ? std::size_t{pixel[3]} << shift : 0;
        if (x == 0 || count > pixels.size() - x || shift >= 32) return overrun();
        for (std::size_t i = 0; i < count; ++i, ++x)
            pixels[x] = pixels[x - 1];
        shift += 8;
    }
    return std::nullopt;
}

std::optional<ImportFault> HdrReader::row(std::vector<Rgbe>& pixels)
{
    const std::size_t width = pixels.size();
    const bool is_new = width >= 8 && width < 32768 && left() >= 4 && bytes_[at_] == std::byte{2} &&
                        bytes_[at_ + 1] == std::byte{2} && (bytes_[at_ + 2] & std::byte{0x80}) == std::byte{};
    if (!is_new) return old_row(pixels);
    at_ += 2;
    const std::size_t high = byte(), low = byte();
    if ((high << 8 | low) != width)
        return ImportFault{"malformed", "a row of the HDR says that it is of another width"};
    return new_row(pixels);
}

ImageResult HdrReader::read()
{
    if (auto bad = header()) return std::move(*bad);
    // The longest run takes two bytes for 127 numbers; old ones may repeat a pixel through their whole row.
    const std::uint64_t most = std::max<std::uint64_t>(left() * 64, left() / 4 * size_.width);
    if (auto bad = over_image_bounds("HDR", size_.width, size_.height, most, limits_)) return std::move(*bad);
    Image image = empty_image(size_.width, size_.height, 3, PixelType::real_32);
    auto* const out = reinterpret_cast<float*>(image.bytes.data());
    std::vector<Rgbe> pixels(size_.width);
    for (std::size_t i = 0; i < size_.height; ++i) {
        if (auto bad = row(pixels)) return std::move(*bad);
        float* to = out + (size_.from_bottom ? size_.height - 1 - i : i) * std::size_t{size_.width} * 3;
        for (const Rgbe& pixel : pixels) {
            // The mantissas' middles would be half a step brighter; the format's own reader takes them as here.
            const float scale =
                pixel[3] == 0 ? 0 : std::ldexp(1.0f, static_cast<int>(pixel[3]) - (128 + 8)) / exposure_;
            for (std::size_t c = 0; c < 3; ++c)
                *to++ = static_cast<float>(pixel[c]) * scale;
        }
    }
    if (const auto bad = validate_image(image))
        return ImportFault{"malformed", "the HDR's exposure makes its numbers too large: " + *bad};
    return ImportedImage{std::move(image), "hdr"};
}

} // namespace

ImageResult read_hdr(std::span<const std::byte> bytes, const Limits& limits)
{
    return HdrReader(bytes, limits).read();
}

} // namespace renderer
