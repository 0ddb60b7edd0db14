// Film: the linear picture while it is made: a sum of radiance and a count for every pixel of the image's
// region, and the sums of the layers beside it.
//
// Frame    row-major, top row first; pixel (0,0) is the region's top left corner.
// Units    radiance, linear Rec. 709, W/(m^2 sr).
// Threads  not synchronised: one thread merges.
// Order    floating sums depend on their order, so there is one: samples within a slice, then slices.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/description/settings.h"
#include "renderer/film/layer_sums.h"

#include <cstdint>
#include <vector>

namespace renderer {

// A finished linear picture.
struct LinearImage {
    std::uint32_t width_px = 0, height_px = 0;
    std::vector<Rgb> pixels; // row-major, top row first
};

// What one slice of samples adds to one tile.
struct TileSums {
    PixelRect tile;           // of the full picture
    std::vector<RgbSum> sums; // row-major within the tile
    LayerSums layers{};       // of the same pixels
};

struct Film {
    PixelRect region;          // of the full picture
    std::uint32_t samples = 0; // merged into every pixel so far
    std::vector<RgbSum> sums;  // row-major within region
    LayerSums layers;

    explicit Film(PixelRect region = {}, LayerSet layers = {}); // black
    void merge(const TileSums& part); // the tile lies within the region, and has the same layers
    LinearImage mean() const;         // black before the first sample
};

struct FinishedFilm {
    LinearImage image;
    std::vector<LayerImage> layers;
};

// The sums are given back as soon as they are divided: they are twice as large as what they become.
FinishedFilm finish(Film film);

} // namespace renderer
