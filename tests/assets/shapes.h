// Shapes: the triangle meshes that the asset files are written from; all made by formula.
//
// Frame    right-handed, y up, metres; counter-clockwise seen from outside.
// Promise  the same bits on every machine: sine and cosine are series of +, - and * here, not libm.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace tests {

struct AssetMesh {
    std::vector<std::array<float, 3>> positions;
    std::vector<std::array<float, 3>> normals; // one a position
    std::vector<std::array<float, 2>> uvs;     // one a position
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

// {sin, cos} of 2 pi * turns.
std::pair<double, double> sin_cos_turns(double turns);

// A tube of radius 0.11 along the (2,3) torus knot of radius 2/3; the seams in both directions have doubled
// vertices, for the sake of uv.
AssetMesh make_knot(std::uint32_t segments, std::uint32_t sides);

// Closed sphere about the origin; poles and seam are doubled for uv, yet the surface has no hole.
AssetMesh make_sphere(double radius, std::uint32_t columns, std::uint32_t rows);

// Axis-aligned box about the origin, 24 vertices, every face with the whole of uv.
AssetMesh make_box(double width, double height, double depth);

// Hills over the xz square of side 2, `cells` x `cells` quads.
AssetMesh make_terrain(std::uint32_t cells);

} // namespace tests
