#include "tests/assets/shapes.h"

#include <cmath>

namespace tests {
namespace {

using Vec = std::array<double, 3>;
constexpr double kTau = 6.283185307179586477;

Vec cross(const Vec& a, const Vec& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vec unit(const Vec& v)
{
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}

std::array<float, 3> to_float(const Vec& v)
{
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

void add_vertex(AssetMesh& mesh, const Vec& position, const Vec& normal, double u, double v)
{
    mesh.positions.push_back(to_float(position));
    mesh.normals.push_back(to_float(normal));
    mesh.uvs.push_back({static_cast<float>(u), static_cast<float>(v)});
}

// Two triangles for every cell of a grid of (columns + 1) x (rows + 1) vertices, row by row;
// counter-clockwise where going along a row, then to the next row, turns left.
void add_grid(AssetMesh& mesh, std::uint32_t columns, std::uint32_t rows)
{
    for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t a = row * (columns + 1) + column;
            const std::uint32_t b = a + columns + 1;
            mesh.triangles.push_back({a, a + 1, b + 1});
            mesh.triangles.push_back({a, b + 1, b});
        }
    }
}

} // namespace

std::pair<double, double> sin_cos_turns(double turns)
{
    // To within an eighth of a turn of a multiple of a quarter, where the series are short; whole quarters
    // exact.
    const double quarters = std::floor(turns * 4 + 0.5);
    const double x = (turns - quarters / 4) * kTau;
    double sine = x, cosine = 1, sine_term = x, cosine_term = 1;
    for (int n = 1; n < 12; ++n) {
        cosine_term *= -x * x / ((2 * n - 1) * (2 * n));
        sine_term *= -x * x / ((2 * n) * (2 * n + 1));
        cosine += cosine_term;
        sine += sine_term;
    }
    switch (static_cast<std::int64_t>(quarters) & 3) {
    case 0:
        return {sine, cosine};
    case 1:
        return {cosine, -sine};
    case 2:
        return {-sine, -cosine};
    default:
        return {-cosine, sine};
    }
}

AssetMesh make_knot(std::uint32_t segments, std::uint32_t sides)
{
    constexpr double kScale = 1.0 / 3.0;
    constexpr double kTube = 0.11;
    AssetMesh mesh;
    for (std::uint32_t i = 0; i <= segments; ++i) {
        const double along = static_cast<double>(i) / segments;
        const auto [s2, c2] = sin_cos_turns(2 * along);
        const auto [s3, c3] = sin_cos_turns(3 * along);
        const double r = c3 + 2;
        const Vec centre{r * c2 * kScale, r * s2 * kScale, -s3 * kScale};
        const Vec tangent = unit({-3 * s3 * c2 - 2 * r * s2, -3 * s3 * s2 + 2 * r * c2, -3 * c3});
        // The knot lies on a torus, whose normal is therefore perpendicular to the tangent: no frame to carry
        // along.
        const Vec across{c2 * c3, s2 * c3, -s3};
        const Vec up = cross(tangent, across);
        for (std::uint32_t j = 0; j <= sides; ++j) {
            const double around = static_cast<double>(j) / sides;
            const auto [s, c] = sin_cos_turns(around);
            const Vec normal{across[0] * c + up[0] * s, across[1] * c + up[1] * s, across[2] * c + up[2] * s};
            const Vec position{
                centre[0] + normal[0] * kTube, centre[1] + normal[1] * kTube, centre[2] + normal[2] * kTube};
            add_vertex(mesh, position, normal, along, around);
        }
    }
    add_grid(mesh, sides, segments);
    return mesh;
}

AssetMesh make_sphere(double radius, std::uint32_t columns, std::uint32_t rows)
{
    AssetMesh mesh;
    for (std::uint32_t row = 0; row <= rows; ++row) {
        const double v = static_cast<double>(row) / rows; // 0 at the south pole
        const auto [sin_latitude, cos_latitude] = sin_cos_turns(v / 2 - 0.25);
        for (std::uint32_t column = 0; column <= columns; ++column) {
            const double u = static_cast<double>(column) / columns;
            const auto [s, c] = sin_cos_turns(u);
            const Vec normal{cos_latitude * s, sin_latitude, cos_latitude * c};
            add_vertex(mesh, {normal[0] * radius, normal[1] * radius, normal[2] * radius}, normal, u, v);
        }
    }
    for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t a = row * (columns + 1) + column;
            const std::uint32_t b = a + columns + 1;
            if (row > 0) mesh.triangles.push_back({a, a + 1, b + 1});
            if (row + 1 < rows) mesh.triangles.push_back({a, b + 1, b});
        }
    }
    return mesh;
}

AssetMesh make_box(double width, double height, double depth)
{
    struct Face {
        Vec normal, right, up; // right x up = normal
    };
    static constexpr std::array<Face, 6> kFaces{{
        {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
        {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}},
        {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
        {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
        {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
        {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
    }};
    static constexpr std::array<std::array<int, 2>, 4> kCorners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    const Vec half{width / 2, height / 2, depth / 2};
    AssetMesh mesh;
    for (const Face& face : kFaces) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const auto& [x, y] : kCorners) {
            Vec position{};
            for (std::size_t axis = 0; axis < 3; ++axis)
                position[axis] = half[axis] * (face.normal[axis] + x * face.right[axis] + y * face.up[axis]);
            add_vertex(mesh, position, face.normal, (x + 1) / 2, (y + 1) / 2);
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    }
    return mesh;
}

AssetMesh make_terrain(std::uint32_t cells)
{
    struct Wave {
        double x, z, height; // waves along x and z over the square
    };
    static constexpr std::array<Wave, 5> kWaves{
        {{1, 1, 0.10}, {2, -1, 0.06}, {3, 4, 0.03}, {-7, 5, 0.012}, {17, 13, 0.004}}};
    AssetMesh mesh;
    for (std::uint32_t row = 0; row <= cells; ++row) {
        for (std::uint32_t column = 0; column <= cells; ++column) {
            const double u = static_cast<double>(column) / cells, v = static_cast<double>(row) / cells;
            double height = 0, slope_u = 0, slope_v = 0;
            for (const Wave& wave : kWaves) {
                const auto [s, c] = sin_cos_turns(wave.x * u + wave.z * v);
                height += wave.height * s;
                slope_u += wave.height * kTau * wave.x * c;
                slope_v += wave.height * kTau * wave.z * c;
            }
            // x = 2u - 1 and z = 1 - 2v: slopes along x and z are halves of those along u and -v.
            add_vertex(mesh, {2 * u - 1, height, 1 - 2 * v}, unit({-slope_u / 2, 1, slope_v / 2}), u, v);
        }
    }
    add_grid(mesh, cells, cells);
    return mesh;
}

} // namespace tests
