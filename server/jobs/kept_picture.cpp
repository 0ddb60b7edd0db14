#include "server/jobs/kept_picture.h"

#include "renderer/film/pack_floats.h"
#include "server/store/store.h"

#include <bit>
#include <cstring>
#include <string>
#include <string_view>

namespace server {

namespace {

constexpr std::string_view kMagic = "HGPIC\2", kMagicBeforeLayers = "HGPIC\1";
static_assert(kMagic.size() == kMagicBeforeLayers.size());

static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(renderer::Rgb) == 3 * sizeof(float));

void append(std::vector<std::byte>& blob, const void* bytes, std::size_t count)
{
    const std::size_t at = blob.size();
    blob.resize(at + count);
    if (count != 0) std::memcpy(blob.data() + at, bytes, count);
}

template <typename T>
void append(std::vector<std::byte>& blob, T number)
{
    append(blob, &number, sizeof number);
}

void append_counted(std::vector<std::byte>& blob, const void* bytes, std::size_t count)
{
    append(blob, std::uint64_t{count});
    append(blob, bytes, count);
}

[[noreturn]] void broken()
{
    throw StoreError("a kept picture is not of the form that it is written in", false);
}

// Takes the parts off the front.
class Parts {
public:
    explicit Parts(std::span<const std::byte> bytes) : rest_(bytes) {}

    template <typename T>
    T number()
    {
        T number{};
        const auto bytes = take(sizeof number);
        std::memcpy(&number, bytes.data(), sizeof number);
        return number;
    }
    std::span<const std::byte> counted() { return take(number<std::uint64_t>()); }
    std::string text()
    {
        const auto bytes = counted();
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
    std::span<const std::byte> take(std::uint64_t count)
    {
        if (count > rest_.size()) broken();
        const auto taken = rest_.first(static_cast<std::size_t>(count));
        rest_ = rest_.subspan(taken.size());
        return taken;
    }
    std::size_t left() const { return rest_.size(); }

private:
    std::span<const std::byte> rest_;
};

bool begins_with(std::span<const std::byte> blob, std::string_view magic)
{
    return blob.size() >= magic.size() && std::memcmp(blob.data(), magic.data(), magic.size()) == 0;
}

bool is_packed(std::span<const std::byte> blob)
{
    return begins_with(blob, kMagic) || begins_with(blob, kMagicBeforeLayers);
}

renderer::Tone tone_of(std::uint8_t number)
{
    if (number > static_cast<std::uint8_t>(renderer::Tone::filmic)) broken();
    return static_cast<renderer::Tone>(number);
}

// Where nothing gets smaller: see pack_floats.
std::size_t most_packed_bytes(const renderer::Picture& picture)
{
    constexpr std::size_t kHead = 64;
    std::size_t bytes = picture.image.pixels.size() * sizeof(renderer::Rgb) + kHead;
    for (const renderer::LayerImage& layer : picture.layers)
        bytes += layer.values.size() * sizeof(float) + kHead;
    return bytes;
}

void append_floats(std::vector<std::byte>& blob, std::span<const float> values)
{
    const auto packed = renderer::pack_floats(values);
    append_counted(blob, packed.data(), packed.size());
}

void take_floats(Parts& parts, std::span<float> values)
{
    const auto packed = parts.counted();
    if (!renderer::unpack_floats({reinterpret_cast<const std::uint8_t*>(packed.data()), packed.size()},
                                 values))
        broken();
}

renderer::LayerImage take_layer(Parts& parts, std::size_t pixels)
{
    const auto number = parts.number<std::uint8_t>();
    if (number >= renderer::kLayers.size()) broken();
    renderer::LayerImage layer{static_cast<renderer::Layer>(number), {}};
    layer.values.resize(pixels * entry_of(layer.layer).channel_count());
    take_floats(parts, layer.values);
    return layer;
}

} // namespace

std::vector<std::byte> pack_picture(const renderer::Picture& picture, std::span<const std::uint8_t> png)
{
    const renderer::LinearImage& image = picture.image;
    std::vector<std::byte> blob;
    blob.reserve(png.size() + most_packed_bytes(picture) + 4096);
    append(blob, kMagic.data(), kMagic.size());
    append_counted(blob, png.data(), png.size());
    append(blob, picture.exposure_ev);
    append(blob, static_cast<std::uint8_t>(picture.tone));
    append(blob, std::uint64_t{picture.texts.size()});
    for (const renderer::PictureText& text : picture.texts) {
        append_counted(blob, text.keyword.data(), text.keyword.size());
        append_counted(blob, text.text.data(), text.text.size());
    }
    append(blob, image.width_px);
    append(blob, image.height_px);
    append_floats(blob, {reinterpret_cast<const float*>(image.pixels.data()), image.pixels.size() * 3});
    append(blob, static_cast<std::uint8_t>(picture.layers.size()));
    for (const renderer::LayerImage& layer : picture.layers) {
        append(blob, static_cast<std::uint8_t>(layer.layer));
        append_floats(blob, layer.values);
    }
    return blob;
}

std::span<const std::byte> png_of(std::span<const std::byte> blob)
{
    if (!is_packed(blob)) return blob;
    return Parts(blob.subspan(kMagic.size())).counted();
}

std::optional<renderer::Picture> unpack_picture(std::span<const std::byte> blob)
{
    if (!is_packed(blob)) return std::nullopt;
    Parts parts(blob.subspan(kMagic.size()));
    parts.counted(); // the PNG
    renderer::Picture picture;
    picture.exposure_ev = parts.number<double>();
    picture.tone = tone_of(parts.number<std::uint8_t>());
    const auto texts = parts.number<std::uint64_t>();
    for (std::uint64_t i = 0; i < texts; ++i) {
        std::string keyword = parts.text();
        picture.texts.push_back({std::move(keyword), parts.text()});
    }
    renderer::LinearImage& image = picture.image;
    image.width_px = parts.number<std::uint32_t>();
    image.height_px = parts.number<std::uint32_t>();
    image.pixels.resize(std::size_t{image.width_px} * image.height_px);
    take_floats(parts, {reinterpret_cast<float*>(image.pixels.data()), image.pixels.size() * 3});
    const std::size_t layers = begins_with(blob, kMagic) ? parts.number<std::uint8_t>() : 0;
    for (std::size_t i = 0; i < layers; ++i)
        picture.layers.push_back(take_layer(parts, image.pixels.size()));
    if (parts.left() != 0) broken();
    return picture;
}

} // namespace server
