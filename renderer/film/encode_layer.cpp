#include "renderer/film/encode_layer.h"

#include "renderer/film/develop.h"
#include "renderer/film/encode_exr.h"
#include "renderer/film/encode_pfm.h"
#include "renderer/film/encode_png.h"

namespace renderer {

namespace {

// As a picture of numbers from 0 to 1; of a layer of three channels.
LinearImage shown(const LinearImage& image, const LayerImage& layer)
{
    LinearImage out{image.width_px, image.height_px, {}};
    out.pixels.reserve(image.pixels.size());
    const bool is_signed = layer.layer == Layer::normal;
    for (std::size_t i = 0; i + 2 < layer.values.size(); i += 3) {
        const Rgb value{layer.values[i], layer.values[i + 1], layer.values[i + 2]};
        out.pixels.push_back(is_signed ? (value + Rgb{1, 1, 1}) * 0.5f : value);
    }
    return out;
}

} // namespace

std::vector<std::uint8_t>
encode_layer(const Picture& picture, const LayerImage& layer, const PictureEncoding& encoding)
{
    const LinearImage& image = picture.image;
    switch (encoding.format) {
    case PictureFormat::png: {
        const LinearImage linear = shown(image, layer);
        const Tone tone = layer.layer == Layer::normal ? Tone::linear : Tone::srgb;
        if (encoding.bits == 16) return encode_png(develop_16(linear, 0, tone), picture.texts);
        return encode_png(develop_8(linear, 0, tone), picture.texts);
    }
    case PictureFormat::exr:
        return encode_exr(image.width_px, image.height_px, exr_channels(layer, ""), picture.texts);
    case PictureFormat::pfm:
        return encode_pfm(image.width_px, image.height_px, layer.values);
    case PictureFormat::jpeg:
    case PictureFormat::hdr:
        break; // they hold none
    }
    return {};
}

} // namespace renderer
