#include "renderer/geometry/mesh_frame.h"

#include "renderer/geometry/rounding.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace renderer {

namespace {

constexpr double kFar = 1e4;           // sizes from the origin
constexpr double kLeastEdge = 0x1p-20; // of the coordinates beside it
constexpr int kSizesApart = 3;         // origins are multiples of 2^this, of the size's power of two

// At this distance from a multiple of `step` or more, p - origin is exact for floats and doubles alike.
double snapped(double middle, double step)
{
    return std::abs(middle) < step ? 0 : std::floor(middle / step + 0.5) * step;
}

Vec3d origin_for(const Bounds3d& box)
{
    if (box.empty()) return {};
    const double size = max_component(box.extent());
    const double largest = std::max(max_abs(box.lower), max_abs(box.upper));
    if (!(size > 0) || largest < kFar * size) return {};
    int exponent = 0;
    std::frexp(size, &exponent);
    const double step = std::ldexp(1.0, exponent + kSizesApart);
    const Vec3d middle = box.center();
    return {snapped(middle.x, step), snapped(middle.y, step), snapped(middle.z, step)};
}

template <typename PositionOf>
Bounds3d bounds_of(const Mesh& mesh, const PositionOf& position_of)
{
    Bounds3d box;
    for (const Triangle& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle)
            box.extend(position_of(vertex));
    return box;
}

// True where rounding moves the triangle's corners by a visible share of it.
bool is_spoiled(const Mesh& mesh, const Triangle& triangle)
{
    double edge = 0, largest = 0;
    bool rounds = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d from = mesh.position(triangle[i]), to = mesh.position(triangle[i == 2 ? 0 : i + 1]);
        edge = std::max(edge, max_abs(to - from));
        largest = std::max(largest, max_abs(from));
        rounds = rounds || mesh.residuals[triangle[i]] != Vec3f{};
    }
    return rounds && edge > 0 && edge < kLeastEdge * largest;
}

} // namespace

void set_positions(Mesh& mesh, std::span<const Vec3d> in_file)
{
    mesh.origin = origin_for(bounds_of(mesh, [&](std::uint32_t vertex) { return in_file[vertex]; }));
    mesh.positions.resize(in_file.size());
    mesh.residuals.resize(in_file.size());
    for (std::size_t i = 0; i < in_file.size(); ++i) {
        const Vec3d exact = in_file[i] - mesh.origin;
        mesh.positions[i] = to_float(exact);
        mesh.residuals[i] = to_float(exact - to_double(mesh.positions[i]));
    }
    const auto spoiled = [&](const Triangle& triangle) { return is_spoiled(mesh, triangle); };
    if (std::none_of(mesh.triangles.begin(), mesh.triangles.end(), spoiled)) mesh.residuals = {};
}

void choose_origin(Mesh& mesh)
{
    mesh.origin =
        origin_for(bounds_of(mesh, [&](std::uint32_t vertex) { return to_double(mesh.positions[vertex]); }));
    if (mesh.origin == Vec3d{}) return;
    for (Vec3f& position : mesh.positions)
        position = to_float(to_double(position) - mesh.origin);
}

} // namespace renderer
