// ObjMesh: what an OBJ file says, in its own terms: arrays and corners that index each apart; and its way to
// a Mesh with one index a corner.
//
// Cost  12 bytes a triangle; as much again for texture coordinates and for normals, 4 for parts and for
//       materials, but only in a file that has them.
#pragma once

#include "renderer/geometry/mesh.h"
#include "renderer/math/array.h"

#include <array>
#include <cstddef>
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
    Array<Vec3d> positions;
    Array<Vec3f> normals;
    Array<Vec2f> uvs;
    // Three a triangle, as ObjCorner's `at`; of texture coordinates and normals none until a corner has one.
    std::array<Array<std::uint32_t>, 3> corners;
    // The state that statements set and triangles take; kNone: none.
    std::uint32_t part = ObjCorner::kNone, material = ObjCorner::kNone;
    std::vector<std::string> part_names, material_names;
    Array<std::uint32_t> triangle_parts,
        triangle_materials; // one a triangle, as `part`; none while all kNone

    std::size_t triangles() const { return corners[0].size() / 3; }
    void add_triangle(const ObjCorner& a, const ObjCorner& b, const ObjCorner& c);
    void forget_parts();
    // Stable: triangles of no part first, then part by part; fills `parts`, leaving out empty ones.
    void make_parts_contiguous(std::vector<MeshPart>& parts);
    // Frame, positions, normals, uvs and triangles of `mesh`. Every corner must be in range. Empties this.
    void build(Mesh& mesh);

private:
    bool complete_normals();
    // The places of the mesh's vertices, whose other arrays are filled.
    Array<Vec3d> build_from_positions(Mesh& mesh) const;
    Array<Vec3d> build_from_corners(Mesh& mesh) const;
};

} // namespace renderer
