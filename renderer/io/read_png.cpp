#include "renderer/io/image_bounds.h"
#include "renderer/io/read_images.h"
#include "renderer/io/text.h"

#include <bit>
#include <csetjmp>
#include <cstring>
#include <png.h>
#include <vector>

namespace renderer {

namespace {

constexpr std::size_t kMark = 8;        // of the file
constexpr std::size_t kChunkFrame = 12; // length, name, checksum

// Deflate's best is 1032 bytes for one; a row has a byte more than its pixels.
constexpr std::uint64_t kMostInflated = 1032;

std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t at)
{
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i)
        word = word << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
    return word;
}

struct Outline {
    std::uint32_t width = 0, height = 0, bits = 0, color_type = 0;
    std::uint64_t data_bytes = 0;
    bool has_palette = false;
};

std::uint32_t channels_of(std::uint32_t color_type)
{
    switch (color_type) {
    case PNG_COLOR_TYPE_GRAY:
    case PNG_COLOR_TYPE_PALETTE:
        return 1;
    case PNG_COLOR_TYPE_GRAY_ALPHA:
        return 2;
    case PNG_COLOR_TYPE_RGB:
        return 3;
    case PNG_COLOR_TYPE_RGB_ALPHA:
        return 4;
    default:
        return 0;
    }
}

std::optional<ImportFault> read_header(std::span<const std::byte> header, Outline& out)
{
    if (header.size() != 13)
        return ImportFault{"malformed", "the PNG's header has " + std::to_string(header.size()) + " bytes"};
    out.width = word_at(header, 0);
    out.height = word_at(header, 4);
    out.bits = std::to_integer<std::uint32_t>(header[8]);
    out.color_type = std::to_integer<std::uint32_t>(header[9]);
    const bool is_depth = std::has_single_bit(out.bits) && out.bits <= 16;
    if (channels_of(out.color_type) == 0 || !is_depth)
        return ImportFault{"malformed",
                           "the PNG's header asks for " + std::to_string(out.bits) + " bits of colour type " +
                               std::to_string(out.color_type) + ", which there is not"};
    return std::nullopt;
}

// Every chunk lies within the file, the last one is the mark of the end.
std::optional<ImportFault> walk(std::span<const std::byte> bytes, Outline& out)
{
    for (std::size_t at = kMark;;) {
        if (bytes.size() - at < kChunkFrame || word_at(bytes, at) > bytes.size() - at - kChunkFrame)
            return ImportFault{"truncated",
                               "byte " + std::to_string(at) +
                                   ": a chunk of the PNG passes the end of the file: send it whole"};
        const std::size_t length = word_at(bytes, at);
        const std::string_view name = text_of(bytes.subspan(at + 4, 4));
        const auto content = bytes.subspan(at + 8, length);
        if ((at == kMark) != (name == "IHDR"))
            return ImportFault{"malformed",
                               "byte " + std::to_string(at) + ": the PNG does not begin with its header"};
        if (name == "IHDR")
            if (auto bad = read_header(content, out)) return bad;
        if (name == "acTL") return ImportFault{"unsupported", "the PNG is animated: send one picture of it"};
        if (name == "IDAT") out.data_bytes += length;
        if (name == "PLTE") out.has_palette = true;
        if (name == "IEND") break;
        at += kChunkFrame + length;
    }
    if (out.color_type == PNG_COLOR_TYPE_PALETTE && !out.has_palette)
        return ImportFault{"malformed", "the PNG has palette numbers and no palette"};
    return std::nullopt;
}

struct Decoder {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::span<const std::byte> rest;
    std::string error;
    Image image;
    std::vector<png_bytep> rows;
    bool out_of_memory = false; // no exception may pass through the library

    ~Decoder() { png_destroy_read_struct(&png, &info, nullptr); }
};

[[noreturn]] void on_error(png_structp png, png_const_charp what)
{
    static_cast<Decoder*>(png_get_error_ptr(png))->error = what;
    png_longjmp(png, 1);
}

void on_warning(png_structp /*png*/, png_const_charp /*what*/) {}

void on_read(png_structp png, png_bytep to, std::size_t size)
{
    auto& rest = static_cast<Decoder*>(png_get_io_ptr(png))->rest;
    if (size > rest.size()) png_error(png, "the file ends too early");
    std::memcpy(to, rest.data(), size);
    rest = rest.subspan(size);
}

bool make_room(Decoder& decoder)
try {
    png_structp png = decoder.png;
    const bool is_wide = png_get_bit_depth(png, decoder.info) == 16;
    decoder.image = empty_image(png_get_image_width(png, decoder.info),
                                png_get_image_height(png, decoder.info),
                                png_get_channels(png, decoder.info),
                                is_wide ? PixelType::whole_16 : PixelType::whole_8);
    const std::size_t row_bytes = decoder.image.bytes.size() / decoder.image.height;
    if (png_get_rowbytes(png, decoder.info) != row_bytes) return false;
    auto* const first = reinterpret_cast<png_bytep>(decoder.image.bytes.data());
    decoder.rows.resize(decoder.image.height);
    for (std::size_t y = 0; y < decoder.rows.size(); ++y)
        decoder.rows[y] = first + y * row_bytes;
    return true;
} catch (const std::bad_alloc&) {
    decoder.out_of_memory = true;
    return false;
}

// False after an error of the library's. Nothing with a destructor lives in here: the library jumps.
bool decode(Decoder& decoder)
{
    if (setjmp(png_jmpbuf(decoder.png)) != 0) return false; // NOLINT(cert-err52-cpp): the library's way
    png_set_user_limits(decoder.png, 1u << 24, 1u << 24);
    png_set_chunk_malloc_max(decoder.png, 8u << 20);
    png_set_read_fn(decoder.png, &decoder, on_read);
    png_read_info(decoder.png, decoder.info);
    png_set_expand(decoder.png);
    if (std::endian::native == std::endian::little) png_set_swap(decoder.png);
    png_set_interlace_handling(decoder.png);
    png_read_update_info(decoder.png, decoder.info);
    if (!make_room(decoder)) return false;
    png_read_image(decoder.png, decoder.rows.data());
    png_read_end(decoder.png, nullptr);
    return true;
}

} // namespace

ImageResult read_png(std::span<const std::byte> bytes, const Limits& limits)
{
    Outline outline;
    if (auto bad = walk(bytes, outline)) return std::move(*bad);
    const std::uint64_t bits = std::uint64_t{outline.bits} * channels_of(outline.color_type);
    if (auto bad = over_image_bounds(
            "PNG", outline.width, outline.height, outline.data_bytes * kMostInflated * 8 / bits, limits))
        return std::move(*bad);
    Decoder decoder;
    decoder.rest = bytes;
    decoder.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &decoder, on_error, on_warning);
    decoder.info = decoder.png != nullptr ? png_create_info_struct(decoder.png) : nullptr;
    if (decoder.info == nullptr) throw std::bad_alloc();
    const bool good = decode(decoder);
    if (decoder.out_of_memory) throw std::bad_alloc();
    if (!good)
        return ImportFault{"malformed",
                           "the PNG cannot be read: " + clean_utf8(decoder.error) + ": export it again"};
    return ImportedImage{std::move(decoder.image), "png"};
}

} // namespace renderer
