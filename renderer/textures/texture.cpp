#include "renderer/textures/texture.h"

#include "renderer/color/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace renderer {

namespace {

const std::array<float, 256>& linear_of_8()
{
    static const auto table = [] {
        std::array<float, 256> values{};
        for (std::size_t code = 0; code < values.size(); ++code)
            values[code] = linear_from_srgb(static_cast<float>(code) / 255.0f);
        return values;
    }();
    return table;
}

const std::vector<float>& linear_of_16()
{
    static const auto table = [] {
        std::vector<float> values(65536);
        for (std::size_t code = 0; code < values.size(); ++code)
            values[code] = linear_from_srgb(static_cast<float>(code) / 65535.0f);
        return values;
    }();
    return table;
}

// Into [0, 1], as the wrapping says.
double wrapped(double x, TextureWrap wrap)
{
    if (!std::isfinite(x)) return 0;
    switch (wrap) {
    case TextureWrap::repeat:
        return x - std::floor(x);
    case TextureWrap::clamp:
        return std::clamp(x, 0.0, 1.0);
    case TextureWrap::mirror: {
        const double in_two = x - 2 * std::floor(x / 2);
        return in_two <= 1 ? in_two : 2 - in_two;
    }
    }
    return 0;
}

// A texel beside the last one: of a mirrored picture it is the last one again.
std::size_t neighbour(std::int64_t i, std::uint32_t count, TextureWrap wrap)
{
    const auto last = static_cast<std::int64_t>(count) - 1;
    if (i < 0) return static_cast<std::size_t>(wrap == TextureWrap::repeat ? last : 0);
    if (i > last) return static_cast<std::size_t>(wrap == TextureWrap::repeat ? 0 : last);
    return static_cast<std::size_t>(i);
}

Rgba mix(const Rgba& a, const Rgba& b, float share)
{
    // So that two that are the same give the same, to the bit.
    const auto between = [share](float x, float y) { return x + (y - x) * share; };
    return {{between(a.color.r, b.color.r), between(a.color.g, b.color.g), between(a.color.b, b.color.b)},
            between(a.alpha, b.alpha)};
}

// log2 as the exponent and the mantissa have it, straight between powers of two: within 0.09 of it, and the same
// everywhere.
double level_for(double texels)
{
    if (!(texels > 1)) return 0;
    int exponent = 0;
    const double mantissa = std::frexp(texels, &exponent);
    return exponent - 1 + (2 * mantissa - 1);
}

double length_in(const TexturePoint& axis, double width, double height)
{
    const double x = axis.u * width, y = axis.v * height;
    return std::sqrt(x * x + y * y);
}

// The part of source texel `s` that lies in what destination texel `d` covers, in source texels.
struct Cover {
    std::uint32_t first, count;
    std::array<float, 4> weights; // their sum is 1
};

// Each destination texel covers from 2 to 3 source texels, or 1 where there is but one.
Cover cover(std::uint32_t d, std::uint32_t destinations, std::uint32_t sources)
{
    const double scale = static_cast<double>(sources) / destinations;
    const double begin = d * scale, end = d + 1 == destinations ? sources : (d + 1) * scale;
    Cover c{static_cast<std::uint32_t>(begin), 0, {}};
    for (std::uint32_t s = c.first; s < sources && s < end && c.count < 4; ++s)
        c.weights[c.count++] =
            static_cast<float>((std::min<double>(s + 1.0, end) - std::max<double>(s, begin)) / (end - begin));
    return c;
}

// A level while the next one is made of it: floats, `channels` a texel.
struct Plane {
    std::uint32_t width, height;
    std::vector<float> values;
};

Plane halved(const Plane& from, std::uint32_t channels)
{
    Plane wide{std::max(from.width / 2, 1u), from.height, {}};
    wide.values.resize(std::size_t{wide.width} * wide.height * channels);
    for (std::uint32_t x = 0; x < wide.width; ++x) {
        const Cover c = cover(x, wide.width, from.width);
        for (std::uint32_t y = 0; y < wide.height; ++y)
            for (std::uint32_t channel = 0; channel < channels; ++channel) {
                const float* const in =
                    &from.values[(std::size_t{y} * from.width + c.first) * channels + channel];
                float sum = 0;
                for (std::uint32_t i = 0; i < c.count; ++i)
                    sum += in[std::size_t{i} * channels] * c.weights[i];
                wide.values[(std::size_t{y} * wide.width + x) * channels + channel] = sum;
            }
    }
    Plane small{wide.width, std::max(from.height / 2, 1u), {}};
    const std::size_t row = std::size_t{small.width} * channels;
    small.values.resize(row * small.height);
    for (std::uint32_t y = 0; y < small.height; ++y) {
        const Cover c = cover(y, small.height, wide.height);
        for (std::size_t x = 0; x < row; ++x) {
            float sum = 0;
            for (std::uint32_t i = 0; i < c.count; ++i)
                sum += wide.values[(std::size_t{c.first} + i) * row + x] * c.weights[i];
            small.values[y * row + x] = sum;
        }
    }
    return small;
}

} // namespace

Texture::Texture(std::shared_ptr<const Image> image, TextureEncoding encoding, bool with_levels)
    : image_(std::move(image)), encoding_(encoding)
{
    levels_.push_back({image_->width, image_->height, image_->type, image_->bytes.data()});
    if (with_levels) build_levels();
}

void Texture::build_levels()
{
    const std::uint32_t channels = image_->channels;
    const std::uint32_t colors = channels <= 2 ? 1 : 3;
    const PixelType type = image_->type == PixelType::whole_8 ? PixelType::whole_8 : PixelType::real_32;
    Plane plane{image_->width, image_->height, std::vector<float>(image_->pixels() * channels)};
    float* to = plane.values.data();
    for (std::size_t y = 0; y < plane.height; ++y)
        for (std::size_t x = 0; x < plane.width; ++x) {
            const Rgba texel = fetch(levels_[0], x, y);
            *to++ = texel.color.r;
            if (colors == 3) *to++ = texel.color.g;
            if (colors == 3) *to++ = texel.color.b;
            if (image_->has_alpha()) *to++ = texel.alpha;
        }
    while (plane.width > 1 || plane.height > 1) {
        plane = halved(plane, channels);
        Array<std::byte>& bytes = made_.emplace_back();
        bytes.resize_for_overwrite(plane.values.size() * bytes_of(type));
        if (type == PixelType::real_32) {
            std::memcpy(bytes.data(), plane.values.data(), bytes.size());
        } else {
            std::byte* const codes = bytes.data();
            const bool srgb = encoding_ == TextureEncoding::srgb;
            for (std::size_t i = 0; i < plane.values.size(); ++i) {
                const bool is_color = i % channels < colors;
                codes[i] = std::byte{srgb && is_color ? srgb_8_from_linear(plane.values[i])
                                                      : quantise_8(plane.values[i])};
            }
        }
        levels_.push_back({plane.width, plane.height, type, std::as_const(bytes).data()});
    }
}

Rgba Texture::fetch(const Level& level, std::size_t x, std::size_t y) const
{
    const std::size_t channels = image_->channels;
    const std::byte* const at = level.bytes + (y * level.width + x) * channels * bytes_of(level.type);
    std::array<float, 4> values{};
    const std::size_t colors = channels <= 2 ? 1 : 3;
    const bool srgb = encoding_ == TextureEncoding::srgb;
    switch (level.type) {
    case PixelType::whole_8: {
        const std::array<float, 256>& table = linear_of_8();
        for (std::size_t i = 0; i < channels; ++i) {
            const auto code = std::to_integer<std::uint8_t>(at[i]);
            values[i] = srgb && i < colors ? table[code] : static_cast<float>(code) / 255.0f;
        }
        break;
    }
    case PixelType::whole_16:
        for (std::size_t i = 0; i < channels; ++i) {
            std::uint16_t code = 0;
            std::memcpy(&code, at + 2 * i, sizeof code);
            values[i] = srgb && i < colors ? linear_of_16()[code] : static_cast<float>(code) / 65535.0f;
        }
        break;
    case PixelType::real_32:
        std::memcpy(values.data(), at, channels * sizeof(float));
        // What came as floats may be encoded all the same; levels that were made hold light.
        if (srgb && level.bytes == image_->bytes.data())
            for (std::size_t i = 0; i < colors; ++i)
                values[i] = linear_from_srgb(values[i]);
        break;
    }
    const float alpha = image_->has_alpha() ? values[channels - 1] : 1;
    if (colors == 1) return {{values[0], values[0], values[0]}, alpha};
    return {{values[0], values[1], values[2]}, alpha};
}

Rgba Texture::bilinear(const Level& level, TexturePoint at, TextureWrap wrap) const
{
    const double x = at.u * level.width - 0.5, y = (1 - at.v) * level.height - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    const auto column = static_cast<std::int64_t>(left), row = static_cast<std::int64_t>(top);
    const std::size_t x0 = neighbour(column, level.width, wrap),
                      x1 = neighbour(column + 1, level.width, wrap), y0 = neighbour(row, level.height, wrap),
                      y1 = neighbour(row + 1, level.height, wrap);
    const auto right_share = static_cast<float>(x - left), lower_share = static_cast<float>(y - top);
    return mix(mix(fetch(level, x0, y0), fetch(level, x1, y0), right_share),
               mix(fetch(level, x0, y1), fetch(level, x1, y1), right_share),
               lower_share);
}

Rgba Texture::between_levels(double level, TexturePoint at, TextureWrap wrap) const
{
    at = {wrapped(at.u, wrap), wrapped(at.v, wrap)};
    const double most = static_cast<double>(levels_.size() - 1);
    if (!(level > 0)) return bilinear(levels_[0], at, wrap);
    if (level >= most) return bilinear(levels_.back(), at, wrap);
    const double below = std::floor(level);
    const auto number = static_cast<std::size_t>(below);
    return mix(bilinear(levels_[number], at, wrap),
               bilinear(levels_[number + 1], at, wrap),
               static_cast<float>(level - below));
}

Rgba Texture::lookup(TexturePoint at,
                     TextureWrap wrap,
                     TextureFilter filter,
                     const TextureFootprint& footprint) const
{
    const Level& finest = levels_[0];
    if (filter == TextureFilter::nearest) {
        const double u = wrapped(at.u, wrap), v = wrapped(at.v, wrap);
        const auto x = static_cast<std::uint32_t>(u * finest.width),
                   y = static_cast<std::uint32_t>((1 - v) * finest.height);
        return fetch(finest, std::min(x, finest.width - 1), std::min(y, finest.height - 1));
    }
    double longer = length_in(footprint.long_axis, finest.width, finest.height),
           shorter = length_in(footprint.short_axis, finest.width, finest.height);
    const bool is_turned = shorter > longer;
    if (is_turned) std::swap(longer, shorter);
    if (!(longer > 1) || !std::isfinite(longer)) return between_levels(longer > 1 ? 1e3 : 0, at, wrap);
    shorter = std::max({shorter, longer / kMostProbes, 1.0});
    const int probes = static_cast<int>(std::ceil(longer / shorter));
    const double level = level_for(shorter);
    const TexturePoint axis = is_turned ? footprint.short_axis : footprint.long_axis;
    Rgba sum{{}, 0};
    for (int i = 0; i < probes; ++i) {
        const double along = (i + 0.5) / probes - 0.5;
        const Rgba probe = between_levels(level, {at.u + axis.u * along, at.v + axis.v * along}, wrap);
        sum.color += probe.color;
        sum.alpha += probe.alpha;
    }
    const float share = 1 / static_cast<float>(probes);
    return {sum.color * share, sum.alpha * share};
}

std::uint64_t Texture::size_bytes() const
{
    std::uint64_t bytes = 0;
    for (const Array<std::byte>& level : made_)
        bytes += level.capacity();
    return bytes;
}

TextureEncoding encoding_of(const TextureUse& use, const Image& image, bool is_color)
{
    if (use.encoding) return *use.encoding;
    return is_color && image.type != PixelType::real_32 ? TextureEncoding::srgb : TextureEncoding::linear;
}

} // namespace renderer
