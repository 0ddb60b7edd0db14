#include "renderer/film/encode_exr.h"

#include "renderer/film/append_bytes.h"

#include <algorithm>
#include <cstring>
#include <new>
#include <string_view>
#include <utility>
#include <zlib.h>

namespace renderer {

namespace {

constexpr std::uint32_t kMagic = 20000630;
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kLongNames = 0x400; // of channels or attributes, over 31 bytes
constexpr std::size_t kShortName = 31;
constexpr std::uint32_t kFloat = 2;
constexpr std::uint8_t kZip = 3;
constexpr std::uint32_t kBlockLines = 16; // of ZIP compression
constexpr int kLevel = 4;                 // as the OpenEXR library's

void append_name(Bytes& bytes, std::string_view name)
{
    append_text(bytes, name);
    bytes.push_back(0);
}

void append_attribute(Bytes& bytes, std::string_view name, std::string_view type, const Bytes& value)
{
    append_name(bytes, name);
    append_name(bytes, type);
    append_u32(bytes, static_cast<std::uint32_t>(value.size()));
    bytes.insert(bytes.end(), value.begin(), value.end());
}

Bytes channel_list(const std::vector<ExrChannel>& channels)
{
    Bytes list;
    for (const ExrChannel& channel : channels) {
        append_name(list, channel.name);
        append_u32(list, kFloat);
        append_u32(list, 0); // not perceptually linear, and three bytes reserved
        append_u32(list, 1); // a value for every column
        append_u32(list, 1); // and row
    }
    list.push_back(0);
    return list;
}

Bytes floats(std::initializer_list<float> values)
{
    Bytes bytes;
    for (const float value : values)
        append_float(bytes, value);
    return bytes;
}

Bytes window(std::uint32_t width_px, std::uint32_t height_px)
{
    Bytes bytes;
    for (const std::uint32_t corner : {0u, 0u, width_px - 1, height_px - 1})
        append_u32(bytes, corner);
    return bytes;
}

// Attributes begin with a small letter.
std::string attribute_name(std::string keyword)
{
    if (!keyword.empty() && keyword[0] >= 'A' && keyword[0] <= 'Z')
        keyword[0] = static_cast<char>(keyword[0] - 'A' + 'a');
    return keyword;
}

bool has_long_name(const std::vector<ExrChannel>& channels, const PictureTexts& texts)
{
    return std::any_of(channels.begin(),
                       channels.end(),
                       [](const ExrChannel& channel) { return channel.name.size() > kShortName; }) ||
           std::any_of(texts.begin(), texts.end(), [](const PictureText& text) {
               return text.keyword.size() > kShortName;
           });
}

Bytes header(std::uint32_t width_px,
             std::uint32_t height_px,
             const std::vector<ExrChannel>& channels,
             const PictureTexts& texts)
{
    Bytes bytes;
    append_u32(bytes, kMagic);
    append_u32(bytes, kVersion | (has_long_name(channels, texts) ? kLongNames : 0));
    append_attribute(bytes, "channels", "chlist", channel_list(channels));
    append_attribute(bytes,
                     "chromaticities",
                     "chromaticities",
                     floats({0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f}));
    append_attribute(bytes, "compression", "compression", {kZip});
    append_attribute(bytes, "dataWindow", "box2i", window(width_px, height_px));
    append_attribute(bytes, "displayWindow", "box2i", window(width_px, height_px));
    append_attribute(bytes, "lineOrder", "lineOrder", {0}); // from the top
    append_attribute(bytes, "pixelAspectRatio", "float", floats({1}));
    append_attribute(bytes, "screenWindowCenter", "v2f", floats({0, 0}));
    append_attribute(bytes, "screenWindowWidth", "float", floats({1}));
    for (const PictureText& text : texts)
        append_attribute(
            bytes, attribute_name(text.keyword), "string", Bytes(text.text.begin(), text.text.end()));
    bytes.push_back(0);
    return bytes;
}

// A line's values of one channel, then of the next.
void gather(Bytes& raw,
            const std::vector<ExrChannel>& channels,
            std::size_t width,
            std::uint32_t first_line,
            std::uint32_t end_line)
{
    raw.clear();
    for (std::size_t y = first_line; y < end_line; ++y)
        for (const ExrChannel& channel : channels)
            for (std::size_t x = 0; x < width; ++x)
                append_float(raw, channel.values[(y * width + x) * channel.stride]);
}

// Bytes at even places, then those at odd ones; each as its difference from the one before, and 128.
void reorder(const Bytes& raw, Bytes& ordered)
{
    ordered.resize(raw.size());
    const std::size_t half = (raw.size() + 1) / 2;
    for (std::size_t i = 0; i < raw.size(); ++i)
        ordered[(i & 1 ? half : 0) + i / 2] = raw[i];
    for (std::size_t i = ordered.size(); i-- > 1;)
        ordered[i] = static_cast<std::uint8_t>(ordered[i] - ordered[i - 1] + 128);
}

// False: it would not get smaller.
bool deflate_block(const Bytes& ordered, Bytes& packed)
{
    packed.resize(compressBound(static_cast<uLong>(ordered.size())));
    uLongf size = packed.size();
    const int result =
        compress2(packed.data(), &size, ordered.data(), static_cast<uLong>(ordered.size()), kLevel);
    if (result != Z_OK) throw std::bad_alloc(); // the buffer has room for the worst
    packed.resize(size);
    return packed.size() < ordered.size();
}

} // namespace

std::vector<std::uint8_t> encode_exr(std::uint32_t width_px,
                                     std::uint32_t height_px,
                                     std::vector<ExrChannel> channels,
                                     const PictureTexts& texts)
{
    std::sort(channels.begin(), channels.end(), [](const ExrChannel& a, const ExrChannel& b) {
        return a.name < b.name; // as the format wants
    });
    Bytes file = header(width_px, height_px, channels, texts);
    const std::size_t blocks = (height_px + kBlockLines - 1) / kBlockLines;
    const std::size_t table = file.size();
    file.resize(table + blocks * sizeof(std::uint64_t));
    Bytes offsets, raw, ordered, packed;
    for (std::uint32_t y = 0; y < height_px; y += kBlockLines) {
        append_u64(offsets, file.size());
        gather(raw, channels, width_px, y, std::min(y + kBlockLines, height_px));
        reorder(raw, ordered);
        const Bytes& block = deflate_block(ordered, packed) ? packed : raw;
        append_u32(file, y);
        append_u32(file, static_cast<std::uint32_t>(block.size()));
        file.insert(file.end(), block.begin(), block.end());
    }
    std::memcpy(file.data() + table, offsets.data(), offsets.size());
    return file;
}

std::vector<ExrChannel> exr_channels(const LinearImage& image)
{
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    const auto* first = reinterpret_cast<const float*>(image.pixels.data());
    return {{"R", first, 3}, {"G", first + 1, 3}, {"B", first + 2, 3}};
}

std::vector<ExrChannel> exr_channels(const LayerImage& layer, std::string_view prefix)
{
    const LayerEntry& entry = entry_of(layer.layer);
    std::vector<ExrChannel> channels;
    for (std::size_t c = 0; c < entry.channel_count(); ++c)
        channels.push_back(
            {std::string(prefix).append(entry.channels[c]), layer.values.data() + c, entry.channel_count()});
    return channels;
}

std::vector<ExrChannel> exr_channels(const Picture& picture)
{
    std::vector<ExrChannel> channels = exr_channels(picture.image);
    for (const LayerImage& layer : picture.layers)
        for (ExrChannel& channel : exr_channels(layer, entry_of(layer.layer).prefix))
            channels.push_back(std::move(channel));
    return channels;
}

} // namespace renderer
