// triangulate: a polygon of a file as triangles, convex or not, so that none sticks out of its outline.
//
// Cost    linear for convex polygons, quadratic (at worst cubic) for others; no allocation up to four
//         corners.
// Source  ear clipping, Meisters 1975, on the projection along the polygon's Newell normal.
#pragma once

#include "renderer/geometry/mesh.h"
#include "renderer/math/vec3.h"

#include <cstddef>
#include <span>
#include <vector>

namespace renderer {

// A polygon with more corners than this must be convex: ear clipping takes their square, their cube at worst.
constexpr std::size_t kMostConcaveCorners = 1024;

// Appends corners.size() - 2 triangles of indices into `corners` (three at least), wound as the polygon is. A
// degenerate or self-crossing polygon gives as many, some of them degenerate. False, and nothing appended, if
// it is concave and has too many corners.
bool triangulate(std::span<const Vec3d> corners, std::vector<Triangle>& out);

// Unit normal of the polygon; +z if it has no area.
Vec3f polygon_normal(std::span<const Vec3d> corners);

} // namespace renderer
