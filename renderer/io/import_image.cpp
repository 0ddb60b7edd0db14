#include "renderer/io/import_image.h"

#include "renderer/description/image_formats.h"
#include "renderer/io/read_images.h"
#include "renderer/io/text.h"

#include <array>

namespace renderer {

namespace {

using namespace std::string_view_literals;

// Formats that a picture may well come in and that are not read.
struct Stranger {
    std::string_view mark;
    std::string_view title;
};
constexpr std::array kStrangers{Stranger{"GIF8"sv, "GIF"},
                                Stranger{"BM"sv, "BMP"},
                                Stranger{"8BPS"sv, "PSD"},
                                Stranger{"DDS "sv, "DDS"},
                                Stranger{"II*\0"sv, "TIFF"},
                                Stranger{"MM\0*"sv, "TIFF"},
                                Stranger{"v/1\1"sv, "OpenEXR"},
                                Stranger{"\xabKTX"sv, "KTX"},
                                Stranger{"P5\n"sv, "PNM"},
                                Stranger{"P6\n"sv, "PNM"}};

std::string_view stranger(std::string_view text)
{
    if (text.starts_with("RIFF") && text.substr(0, 12).ends_with("WEBP")) return "WebP";
    for (const Stranger& format : kStrangers)
        if (text.starts_with(format.mark)) return format.title;
    return {};
}

bool is_png(std::string_view text)
{
    return text.starts_with("\x89PNG\r\n\x1a\n");
}

bool is_jpeg(std::string_view text)
{
    return text.starts_with("\xff\xd8\xff");
}

bool is_hdr(std::string_view text)
{
    return text.starts_with("#?RADIANCE") || text.starts_with("#?RGBE");
}

bool is_named_tga(std::string_view name)
{
    const std::size_t dot = name.rfind('.');
    return dot != name.npos && lower_case(name.substr(dot)) == ".tga";
}

} // namespace

ImageResult import_image(std::string_view name, std::span<const std::byte> bytes, const Limits& limits)
{
    const std::string_view text = text_of(bytes);
    if (is_png(text)) return read_png(bytes, limits);
    if (is_jpeg(text)) return read_jpeg(bytes, limits);
    if (is_hdr(text)) return read_hdr(bytes, limits);
    if (const std::string_view title = stranger(text); !title.empty())
        return ImportFault{"unsupported",
                           "the picture is a " + std::string(title) + ", which is not read: send one of " +
                               image_format_titles()};
    if (is_named_tga(name) || is_tga(bytes)) return read_tga(bytes, limits);
    return ImportFault{"unknown_format",
                       bytes.empty() ? "the file is empty"
                                     : "the file begins with " + in_quotes(text.substr(0, 16)) +
                                           ", which is no picture of what is read: " + image_format_titles()};
}

bool looks_like_image(std::string_view name, std::span<const std::byte> bytes)
{
    const std::string_view text = text_of(bytes);
    return is_png(text) || is_jpeg(text) || is_hdr(text) || !stranger(text).empty() || is_named_tga(name);
}

} // namespace renderer
