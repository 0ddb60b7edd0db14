// Film: the linear picture while it is made: a sum of radiance and a count for every pixel of the image's region.
//
// Frame    row-major, top row first; pixel (0,0) is the region's top left corner.
// Units    radiance, linear Rec. 709, W/(m^2 sr).
// Threads  not synchronised: one thread merges.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/description/settings.h"

#include <cstdint>
#include <vector>

namespace renderer {

// A finished linear picture.
struct LinearImage {
    std::uint32_t width_px = 0, height_px = 0;
    std::vector<Rgb> pixels; // row-major, top row first
};

struct Film {
    PixelRect region;        // of the full picture
    std::uint32_t samples = 0; // merged into every pixel so far
    std::vector<Rgb> sums;   // row-major within region

    LinearImage mean() const; // black before the first sample
};

} // namespace renderer
