#include "renderer/io/image_bounds.h"
#include "renderer/io/read_images.h"

#include <array>
#include <vector>

namespace renderer {

namespace {

constexpr std::size_t kHeadBytes = 18;

struct Head {
    std::uint32_t id_bytes, has_palette, type;
    std::uint32_t first_color, colors, color_bits;
    std::uint32_t width, height, bits;
    bool from_top, from_right;

    std::uint32_t kind() const { return type & 7u; } // 1 palette, 2 colour, 3 grey
    bool has_runs() const { return (type & 8u) != 0; }
    std::uint32_t bytes_per_pixel() const { return bits / 8; }
};

Head head_of(std::span<const std::byte> bytes)
{
    const auto one = [&](std::size_t at) { return std::to_integer<std::uint32_t>(bytes[at]); };
    const auto two = [&](std::size_t at) { return one(at) | one(at + 1) << 8; };
    return {one(0),
            one(1),
            one(2),
            two(3),
            two(5),
            one(7),
            two(12),
            two(14),
            one(16),
            (one(17) & 0x20u) != 0,
            (one(17) & 0x10u) != 0};
}

bool is_true_color(std::uint32_t bits)
{
    return bits == 24 || bits == 32;
}

bool is_readable(const Head& head)
{
    if (head.has_palette > 1 || (head.type & ~11u) != 0) return false;
    switch (head.kind()) {
    case 1:
        return head.has_palette == 1 && head.bits == 8 && head.colors > 0 && is_true_color(head.color_bits);
    case 2:
        return is_true_color(head.bits);
    case 3:
        return head.bits == 8;
    default:
        return false;
    }
}

// Pixels as they are stored, runs resolved; false if the bytes end before.
bool unpack(std::span<const std::byte> from, const Head& head, std::vector<std::byte>& to)
{
    const std::size_t each = head.bytes_per_pixel();
    std::size_t at = 0, done = 0;
    if (!head.has_runs()) {
        if (from.size() < to.size()) return false;
        std::copy_n(from.begin(), to.size(), to.begin());
        return true;
    }
    while (done < to.size()) {
        if (at >= from.size()) return false;
        const auto packet = std::to_integer<std::size_t>(from[at++]);
        const bool is_run = (packet & 0x80u) != 0;
        // A packet may pass the end of the last row: what is beyond is not of the picture.
        const std::size_t count = std::min((packet & 0x7fu) + 1, (to.size() - done) / each);
        if (from.size() - at < (is_run ? each : count * each)) return false;
        for (std::size_t i = 0; i < count * each; ++i)
            to[done++] = from[at + (is_run ? i % each : i)];
        at += is_run ? each : count * each;
    }
    return true;
}

// Blue, green, red as stored; the palette's in the same order.
void put(std::span<const std::byte> stored, std::byte* to)
{
    if (stored.size() == 1) {
        to[0] = stored[0];
        return;
    }
    to[0] = stored[2];
    to[1] = stored[1];
    to[2] = stored[0];
    if (stored.size() == 4) to[3] = stored[3];
}

} // namespace

bool is_tga(std::span<const std::byte> bytes)
{
    return bytes.size() >= kHeadBytes && is_readable(head_of(bytes));
}

ImageResult read_tga(std::span<const std::byte> bytes, const Limits& limits)
{
    if (bytes.size() < kHeadBytes)
        return ImportFault{"truncated",
                           "a TGA has at least 18 bytes, this file has " + std::to_string(bytes.size())};
    const Head head = head_of(bytes);
    if (!is_readable(head))
        return ImportFault{"unsupported",
                           "a TGA of type " + std::to_string(head.type) + " and " +
                               std::to_string(head.bits) +
                               " bits a pixel: 8 bits grey or palette, 24 and 32 bits colour are read"};
    bytes = bytes.subspan(kHeadBytes);
    const std::size_t color_bytes = head.color_bits / 8;
    const std::size_t palette_bytes = head.has_palette != 0 ? head.colors * color_bytes : 0;
    if (bytes.size() < head.id_bytes + palette_bytes)
        return ImportFault{"truncated", "the TGA ends within its palette: send the file whole"};
    const auto palette = bytes.subspan(head.id_bytes, palette_bytes);
    bytes = bytes.subspan(head.id_bytes + palette_bytes);
    const std::uint64_t each = head.bytes_per_pixel();
    const std::uint64_t most =
        head.has_runs() ? (bytes.size() + each) / (each + 1) * 128 : bytes.size() / each;
    if (auto bad = over_image_bounds("TGA", head.width, head.height, most, limits)) return std::move(*bad);

    std::vector<std::byte> stored(std::size_t{head.width} * head.height * each);
    if (!unpack(bytes, head, stored))
        return ImportFault{"truncated", "the TGA ends before its last pixel: send the file whole"};
    const std::size_t channels = head.kind() == 1 ? color_bytes : each;
    Image image =
        empty_image(head.width, head.height, static_cast<std::uint32_t>(channels), PixelType::whole_8);
    std::byte* to = image.bytes.data();
    for (std::size_t y = 0; y < head.height; ++y) {
        for (std::size_t x = 0; x < head.width; ++x, to += channels) {
            const std::size_t row = head.from_top ? y : head.height - 1 - y;
            const std::size_t column = head.from_right ? head.width - 1 - x : x;
            const auto pixel = std::span(stored).subspan((row * head.width + column) * each, each);
            if (head.kind() != 1) {
                put(pixel, to);
                continue;
            }
            const std::size_t color = std::to_integer<std::size_t>(pixel[0]) - head.first_color;
            if (color >= head.colors)
                return ImportFault{"index_out_of_range",
                                   "a pixel of the TGA names colour " +
                                       std::to_string(std::to_integer<unsigned>(pixel[0])) +
                                       ", which its palette does not have"};
            put(palette.subspan(color * color_bytes, color_bytes), to);
        }
    }
    return ImportedImage{std::move(image), "tga"};
}

} // namespace renderer
