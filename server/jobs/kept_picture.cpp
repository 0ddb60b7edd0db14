#include "server/jobs/kept_picture.h"

#include "renderer/film/pack_floats.h"
#include "server/store/store.h"

#include <bit>
#include <cstring>
#include <string>
#include <string_view>

namespace server {

namespace {

constexpr std::string_view kMagic = "HGPIC\1";

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

bool is_packed(std::span<const std::byte> blob)
{
    return blob.size() >= kMagic.size() && std::memcmp(blob.data(), kMagic.data(), kMagic.size()) == 0;
}

renderer::Tone tone_of(std::uint8_t number)
{
    if (number > static_cast<std::uint8_t>(renderer::Tone::filmic)) broken();
    return static_cast<renderer::Tone>(number);
}

} // namespace

std::vector<std::byte> pack_picture(const renderer::Picture& picture, std::span<const std::uint8_t> png)
{
    const renderer::LinearImage& image = picture.image;
    const auto film =
        renderer::pack_floats({reinterpret_cast<const float*>(image.pixels.data()), image.pixels.size() * 3});
    std::vector<std::byte> blob;
    blob.reserve(png.size() + film.size() + 4096);
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
    append_counted(blob, film.data(), film.size());
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
    const auto film = parts.counted();
    image.pixels.resize(std::size_t{image.width_px} * image.height_px);
    const std::span<float> values(reinterpret_cast<float*>(image.pixels.data()), image.pixels.size() * 3);
    if (!renderer::unpack_floats({reinterpret_cast<const std::uint8_t*>(film.data()), film.size()}, values) ||
        parts.left() != 0)
        broken();
    return picture;
}

} // namespace server
