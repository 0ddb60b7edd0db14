// The picture formats that are written: the one table that the encoders, content negotiation, the CLI's
// extensions and the documents take them from.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace renderer {

enum class PictureFormat : std::uint8_t { png, jpeg, hdr, exr, pfm };

struct PictureFormatEntry {
    PictureFormat format;
    std::string_view media_type;
    std::string_view extension;       // with its dot; of files that are written
    std::string_view other_extension; // taken as well; empty: none
    bool linear;                // radiance as it is; else what a display shows: exposed, toned, quantised
    std::uint32_t most_side_px; // that the format can say
};

inline constexpr std::array kPictureFormats{
    PictureFormatEntry{PictureFormat::png, "image/png", ".png", "", false, 0x7fffffff},
    PictureFormatEntry{PictureFormat::jpeg, "image/jpeg", ".jpg", ".jpeg", false, 65500},
    PictureFormatEntry{PictureFormat::hdr, "image/vnd.radiance", ".hdr", ".pic", true, 0x7fffffff},
    PictureFormatEntry{PictureFormat::exr, "image/x-exr", ".exr", "", true, 0x7fffffff},
    PictureFormatEntry{PictureFormat::pfm, "image/x-portable-floatmap", ".pfm", "", true, 0x7fffffff},
};

constexpr const PictureFormatEntry& entry_of(PictureFormat format)
{
    return kPictureFormats[static_cast<std::size_t>(format)];
}

// Of ".png", say, in small letters; nothing if there is none.
constexpr const PictureFormatEntry* find_picture_extension(std::string_view extension)
{
    if (extension.empty()) return nullptr;
    for (const PictureFormatEntry& entry : kPictureFormats)
        if (extension == entry.extension || extension == entry.other_extension) return &entry;
    return nullptr;
}

// How a picture is written. Bits a channel: 8, or 16 where the format is PNG; others have one depth.
struct PictureEncoding {
    PictureFormat format = PictureFormat::png;
    std::uint8_t bits = 8;
    friend bool operator==(const PictureEncoding&, const PictureEncoding&) = default;
};

// ".png .jpg ..."
inline std::string picture_extensions()
{
    std::string extensions;
    for (const PictureFormatEntry& entry : kPictureFormats)
        (extensions += extensions.empty() ? "" : " ") += entry.extension;
    return extensions;
}

} // namespace renderer
