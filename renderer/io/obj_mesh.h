// ObjMesh: what an OBJ file says, in its own terms: arrays and corners that index each apart; and its way to
// a Mesh with one index a corner.
#pragma once

#include "renderer/geometry/mesh.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace renderer {

struct ObjCorner {
    static constexpr std::uint32_t kNone = 0xffffffff;
    std::array<std::uint32_t, 3> at{kNone, kNone, kNone}; // position, texture coordinate, normal; from 0
    friend bool operator==(const ObjCorner&, const ObjCorner&) = default;
};

struct ObjMesh {
    std::vector<Vec3d> positions;
    std::vector<Vec3f> normals;
    std::vector<Vec2f> uvs;
    std::vector<std::array<ObjCorner, 3>> triangles;
    // The state that statements set and triangles take; kNone: none.
    std::uint32_t part = ObjCorner::kNone, material = ObjCorner::kNone;
    std::vector<std::string> part_names, material_names;
    std::vector<std::uint32_t> triangle_parts, triangle_materials; // one a triangle, index of name or kNone

    void add_triangle(const std::array<ObjCorner, 3>& corners);
    void forget_parts();
    // Stable: triangles of no part first, then part by part; fills `parts`, leaving out empty ones.
    void make_parts_contiguous(std::vector<MeshPart>& parts);
    // Frame, positions, normals, uvs and triangles of `mesh`. Every corner must be in range. Empties this.
    void build(Mesh& mesh);

private:
    bool complete_normals();
};

} // namespace renderer
