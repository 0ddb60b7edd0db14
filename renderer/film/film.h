// Film: the linear picture while it is made: a sum of radiance and a count for every pixel of the image's
// region.
//
// Frame    row-major, top row first; pixel (0,0) is the region's top left corner.
// Units    radiance, linear Rec. 709, W/(m^2 sr).
// Threads  not synchronised: one thread merges.
// Order    floating sums depend on their order, so there is one: samples within a slice, then slices.
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

// Many samples added up: double, so that 65,536 of them lose nothing that a picture shows.
struct RgbSum {
    double r{}, g{}, b{};

    RgbSum& operator+=(Rgb c)
    {
        r += static_cast<double>(c.r);
        g += static_cast<double>(c.g);
        b += static_cast<double>(c.b);
        return *this;
    }
    RgbSum& operator+=(const RgbSum& o)
    {
        r += o.r;
        g += o.g;
        b += o.b;
        return *this;
    }
    friend bool operator==(const RgbSum&, const RgbSum&) = default;
};

// What one slice of samples adds to one tile.
struct TileSums {
    PixelRect tile;           // of the full picture
    std::vector<RgbSum> sums; // row-major within the tile
};

struct Film {
    PixelRect region;          // of the full picture
    std::uint32_t samples = 0; // merged into every pixel so far
    std::vector<RgbSum> sums;  // row-major within region

    explicit Film(PixelRect region = {}); // black
    void merge(const TileSums& part);     // the tile lies within the region
    LinearImage mean() const;             // black before the first sample
};

} // namespace renderer
