// LayerSums: what the samples of pixels found first, added up for each layer that was asked for.
//
// Frame    row-major, as the sums of the picture that they stand beside.
// Units    metres; normals in the world.
// Threads  not synchronised.
// Order    as of the film: samples within a slice, then slices.
// Memory   nothing for a layer that was not asked for.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/description/layers.h"
#include "renderer/math/vec3.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace renderer {

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

struct DepthSum {
    double metres = 0;
    std::uint64_t hits = 0;
    friend bool operator==(const DepthSum&, const DepthSum&) = default;
};

// A finished layer: as many floats a pixel as its entry has channels, top row first.
struct LayerImage {
    Layer layer = Layer::depth;
    std::vector<float> values;
};

class LayerSums {
public:
    LayerSums() = default;
    LayerSums(LayerSet asked, std::size_t pixels);

    // One sample that hit something. What is not finite adds nothing.
    void add(std::size_t pixel, double distance_m, Vec3f normal, Rgb albedo);
    // `count` pixels of another's, from `from` on, to those from `to` on. It has the same layers.
    void add(const LayerSums& part, std::size_t from, std::size_t to, std::size_t count);
    // Of pixels that had `samples` samples each: one for each layer that was asked for, in the table's order.
    std::vector<LayerImage> mean(std::uint32_t samples) const;

    friend bool operator==(const LayerSums&, const LayerSums&) = default;

private:
    LayerSet asked_{};
    std::size_t pixels_ = 0;
    std::vector<DepthSum> depth_; // these are empty where they were not asked for
    std::vector<RgbSum> normal_, albedo_;
};

// What sums and finished layers take, a pixel.
std::size_t layer_sum_bytes(LayerSet asked);
std::size_t layer_image_bytes(LayerSet asked);

} // namespace renderer
