// Picture: what there is to write down: the linear picture, how it is to be shown, where it comes from.
//
// Frame   row-major, top row first.
// Units   radiance W/(m^2 sr), linear Rec. 709.
#pragma once

#include "renderer/description/settings.h"
#include "renderer/film/film.h"

#include <string>
#include <vector>

namespace renderer {

// A line of text that a file carries, UTF-8 on one line: keyword of 1 to 79 Latin letters.
struct PictureText {
    std::string keyword;
    std::string text;
};
using PictureTexts = std::vector<PictureText>;

struct Picture {
    LinearImage image;
    std::vector<LayerImage> layers{}; // of the same pixels
    double exposure_ev = 0;           // of what a display shows; formats that hold radiance hold it as it is
    Tone tone = Tone::srgb;
    PictureTexts texts;
};

} // namespace renderer
