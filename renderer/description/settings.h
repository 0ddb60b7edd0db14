// How to render a scene: picture, quality, seed and measuring switches. Input, like SceneDescription.
#pragma once

#include "renderer/description/layers.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace renderer {

// Half-open pixel rectangle, x to the right and y down from the picture's top left corner.
struct PixelRect {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
    friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

enum class Tone : std::uint8_t { srgb, linear, filmic };

struct ImageSettings {
    std::uint32_t width_px = 800, height_px = 600;
    std::optional<PixelRect> region; // crop: the same pixels as the full picture has there
    // Radiance is multiplied by 2^exposure_ev before the tone curve; nothing: the plan chooses (0 without an atmosphere).
    std::optional<double> exposure_ev;
    Tone tone = Tone::srgb;
    LayerSet layers{}; // what is kept beside the picture
    friend bool operator==(const ImageSettings&, const ImageSettings&) = default;
};

struct QualitySettings {
    std::optional<std::uint32_t> samples; // exactly this many a pixel
    std::optional<double> time_s;         // the best picture in this time, in whole passes
    std::uint32_t max_samples = 65536;    // ceiling for time_s
    friend bool operator==(const QualitySettings&, const QualitySettings&) = default;
};
inline constexpr std::uint32_t kDefaultSamples = 64; // where quality names neither samples nor time

// Where a run of triangles is cut in two: spatial also through triangles, which then lie on both sides.
enum class BvhSplit : std::uint8_t { sah, midpoint, spatial };
enum class BvhWidth : std::uint8_t { wide, binary };     // children of a node within a mesh: eight, or two
enum class BvhLevels : std::uint8_t { two, mesh, none }; // trees over objects and within meshes, or fewer

// For measuring only; no member changes the picture.
struct AccelerationSettings {
    std::optional<BvhSplit> split; // none: as pays, mesh by mesh
    BvhWidth width = BvhWidth::wide;
    BvhLevels levels = BvhLevels::two;
    bool bounds = false;       // where no tree is over the objects: ask each one's box first
    std::uint32_t threads = 0; // 0: every core
    std::uint32_t tile_px = 16;
    friend bool operator==(const AccelerationSettings&, const AccelerationSettings&) = default;
};

// What is built over the triangles of a mesh.
enum class MeshTree : std::uint8_t {
    wide_sah,
    wide_midpoint,
    wide_spatial,
    binary_sah,
    binary_midpoint,
    none
};
inline constexpr std::size_t kMeshTrees = 6;

// Leaves of wide_spatial hold at most so many times as many triangles as there are.
inline constexpr double kMostReferences = 1.3;

constexpr MeshTree mesh_tree(const AccelerationSettings& acceleration)
{
    if (acceleration.levels == BvhLevels::none) return MeshTree::none;
    const bool sah = acceleration.split != BvhSplit::midpoint;
    if (acceleration.width == BvhWidth::binary) return sah ? MeshTree::binary_sah : MeshTree::binary_midpoint;
    if (acceleration.split == BvhSplit::spatial) return MeshTree::wide_spatial;
    return sah ? MeshTree::wide_sah : MeshTree::wide_midpoint;
}

struct RenderSettings {
    ImageSettings image;
    QualitySettings quality;
    std::uint64_t seed = 1; // 0 to 2^53-1
    AccelerationSettings acceleration;
    friend bool operator==(const RenderSettings&, const RenderSettings&) = default;
};

} // namespace renderer
