// The formats of pictures that are read, as textures and as environments: the one table that the importer, the
// service's words, the CLI and the documents take them from.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace renderer {

struct ImageFormat {
    std::string_view name;  // as in answers
    std::string_view title; // for sentences
    std::string_view what;  // of it is read
};

inline constexpr std::array kImageFormats{
    ImageFormat{"png", "PNG", "1 to 16 bits, grey, colour or palette, with or without alpha; not animated"},
    ImageFormat{"jpeg", "JPEG", "baseline or progressive, 8 bits"},
    ImageFormat{"hdr", "Radiance HDR", "RGBE, top row first or last, run lengths or none"},
    ImageFormat{"tga", "TGA", "8 bits grey, 24 or 32 bits colour or palette, run lengths or none"},
};

// "PNG, JPEG, ..."
inline std::string image_format_titles()
{
    std::string titles;
    for (const ImageFormat& format : kImageFormats)
        (titles += titles.empty() ? "" : ", ") += format.title;
    return titles;
}

} // namespace renderer
