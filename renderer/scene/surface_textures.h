// SurfaceTextures: the pictures on a scene's surfaces: what a material is at a point, where its normal is tilted,
// where there is a hole.
//
// Materials  are made again at every hit from values that were looked up; those without a picture are not here,
//            and cost nothing. A picture's colours are brought into [0, 1] but where they shine.
// Holes      are where alpha is below the cut-off: of a colour's picture (1/2), or as a mesh's file says.
// Emission   is a picture only where the camera sees it: lights are sampled by its mean.
// Threads    immutable after prepare().
#pragma once

#include "renderer/description/material.h"
#include "renderer/geometry/mesh.h"
#include "renderer/materials/bsdf.h"
#include "renderer/scene/surface_coordinates.h"
#include "renderer/textures/texture.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

namespace renderer {

using SharedImage = std::shared_ptr<const Image>;

// A material's pictures, by their numbers among all.
struct TexturedMaterial {
    Material material;
    bool values_are_factors = false; // a mesh's own: pictures are multiplied by the values
    std::optional<TextureUse> normal_map{};
    std::optional<TextureUse> alpha_map{};
    float opacity = 1, cutoff = 0; // no hole where alpha times opacity is at least the cut-off
    Rgb emission{};                // radiance beside what the material gives
};

class SurfaceTextures {
public:
    static constexpr std::uint32_t kNone = 0xffffffff;

    // Of material number `material`, by which hits name it: takes its pictures from `images`, and returns it with
    // each value that has one replaced by the picture's mean. One without pictures comes back as it is.
    Material
    add(std::uint32_t material, const TexturedMaterial& textured, std::span<const SharedImage> images);

    bool empty() const { return of_material_.empty(); }
    bool has_holes() const { return has_holes_; }
    const TexturedMaterial* find(std::uint32_t material) const
    {
        const std::uint32_t entry = material < of_material_.size() ? of_material_[material] : kNone;
        return entry == kNone ? nullptr : &entries_[entry];
    }

    // `from_camera`: emission is looked up too.
    Bsdf bsdf_at(const TexturedMaterial& textured,
                 TexturePoint at,
                 const TextureFootprint& footprint,
                 bool from_camera) const;
    // Right, up, out: what the normal map says there.
    Vec3d tilt_at(const TextureUse& use, TexturePoint at, const TextureFootprint& footprint) const;
    bool is_hole(const TexturedMaterial& textured, TexturePoint at) const;

    std::uint64_t size_bytes() const;

private:
    std::uint32_t texture(const SharedImage& image, TextureEncoding encoding, TextureFilter filter);
    bool take(std::optional<TextureUse>& use, std::span<const SharedImage> images, bool is_color);
    Rgba lookup(const TextureUse& use, TexturePoint at, const TextureFootprint& footprint) const;
    float number_of(const TextureUse& use, const Rgba& found) const;

    std::vector<Texture> textures_;
    std::map<std::tuple<const Image*, TextureEncoding, TextureFilter>, std::uint32_t> known_;
    std::vector<TexturedMaterial> entries_;
    std::vector<std::uint32_t> of_material_;
    bool has_holes_ = false;
};

} // namespace renderer
