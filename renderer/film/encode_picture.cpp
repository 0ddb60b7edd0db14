#include "renderer/film/encode_picture.h"

#include "renderer/film/develop.h"
#include "renderer/film/encode_exr.h"
#include "renderer/film/encode_hdr.h"
#include "renderer/film/encode_jpeg.h"
#include "renderer/film/encode_pfm.h"
#include "renderer/film/encode_png.h"

namespace renderer {

std::vector<std::uint8_t> encode_picture(const Picture& picture, const PictureEncoding& encoding)
{
    const LinearImage& image = picture.image;
    switch (encoding.format) {
    case PictureFormat::png:
        if (encoding.bits == 16)
            return encode_png(develop_16(image, picture.exposure_ev, picture.tone), picture.texts);
        return encode_png(develop_8(image, picture.exposure_ev, picture.tone), picture.texts);
    case PictureFormat::jpeg:
        return encode_jpeg(develop_8(image, picture.exposure_ev, picture.tone), picture.texts);
    case PictureFormat::hdr:
        return encode_hdr(image, picture.texts);
    case PictureFormat::exr:
        return encode_exr(image.width_px, image.height_px, exr_channels(picture), picture.texts);
    case PictureFormat::pfm:
        return encode_pfm(image);
    }
    return {};
}

} // namespace renderer
