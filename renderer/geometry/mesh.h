// Mesh: triangles as they came out of a file, checked: the imported form, before any BVH.
//
// Frame    the mesh's own: the file's coordinates less `origin`, which is zero unless the mesh lies far away
//          (mesh_frame.h); `part`s of a scene-graph file are already placed.
// Promise  of a Mesh that validate_mesh() passed: every index is in range, every number finite, at least one
//          triangle, every residual less than what its position was rounded by.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/description/texture.h"
#include "renderer/math/array.h"
#include "renderer/math/bounds.h"
#include "renderer/textures/image.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace renderer {

inline constexpr float kGreatestMeshIor = 10;

// A material that the file itself carries (MTL, glTF), as far as it is modelled.
struct MeshMaterial {
    std::string name;
    Rgb diffuse{0.5f, 0.5f, 0.5f};
    Rgb specular{0, 0, 0};
    float shininess = 0;
    // Not yet modelled, and reported as left out.
    std::vector<std::string> textures; // names of images it uses
    bool emits = false;                // by a picture
    bool is_transparent = false;
    bool is_metal = false;
    bool has_roughness = false; // a physically based one, which is less than 1

    // glTF's model: `diffuse` is the base colour, and these count instead of specular and shininess.
    bool is_physical = false;
    float metallic = 0, roughness = 1;
    float ior = 1.5f; // 1 to kGreatestMeshIor
    // A closed body of glass, of that index; beside roughness, normal map, these two and, of a physical one, the colour's
    // picture, which multiplies `transmission`, nothing else counts.
    bool is_glass = false;
    Rgb absorption{};          // of light within it, 1/m
    Rgb transmission{1, 1, 1}; // share of light that a boundary lets pass, of what it does not reflect
    float opacity = 1;
    float cutoff = 0; // where alpha is below it there is nothing; 0: alpha makes no holes
    Rgb emission{};   // radiance of the whole surface, W/(m^2 sr)
    bool two_sided = true;
    // Pictures, by their number in Mesh::images; each is multiplied by the value above. Alpha is the colour's,
    // or has a picture of its own; roughness is the green of its picture, metallic the blue.
    std::optional<TextureUse> color_map{}, specular_map{}, alpha_map{}, physical_map{}, emission_map{},
        normal_map{};
};

// A picture that materials of the mesh use: embedded, or a file that came along.
struct MeshImage {
    std::string name;
    Image image;
};

// A named node of the file: a run of triangles.
struct MeshPart {
    std::string name;
    std::uint32_t first_triangle = 0;
    std::uint32_t triangle_count = 0;
};

using Triangle = std::array<std::uint32_t, 3>; // vertex indices, counter-clockwise seen from outside

struct Mesh {
    Vec3d origin{};
    Array<Vec3f> positions;
    Array<Vec3f> residuals; // one a vertex, to be added to its position: what a float cannot hold; or none
    Array<Vec3f> normals;   // one a vertex, unit; or none
    Array<Vec2f> uvs;       // one a vertex; or none
    Array<Triangle> triangles;
    Array<std::uint16_t> triangle_materials; // one a triangle; or none: all material 0
    std::vector<MeshMaterial> materials;     // may be empty
    std::vector<MeshPart> parts;             // may be empty
    std::vector<MeshImage> images;           // may be empty

    // As exactly as it is known: 48 bits where there are residuals.
    Vec3d position(std::uint32_t vertex) const
    {
        const Vec3d rounded = to_double(positions[vertex]);
        return residuals.empty() ? rounded : rounded + to_double(residuals[vertex]);
    }

    Bounds3f bounds() const;          // of the positions that triangles use
    Bounds3d bounds_in_file() const;  // the same in the file's coordinates, residuals counted
    std::uint64_t size_bytes() const; // of the arrays
    // Of several parts of one name, the first. Valid as long as `parts` is.
    std::map<std::string_view, const MeshPart*> parts_by_name() const;
};

} // namespace renderer
