#include "tests/bench/terrain.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace bench {

namespace {

using renderer::Triangle;
using renderer::Vec3f;

// Uniform in [-1, 1) at a corner of one octave's grid.
double corner_height(std::uint32_t octave, std::uint32_t x, std::uint32_t z)
{
    std::uint64_t hash = (std::uint64_t(octave) << 58) ^ (std::uint64_t(x) << 29) ^ z;
    hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9u; // the finaliser of SplitMix64
    hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebu;
    hash ^= hash >> 31;
    return static_cast<double>(hash >> 11) * 0x1p-52 - 1;
}

// Value noise: between the corners of a grid of 2^octave cells, smooth in both directions.
double octave_height(std::uint32_t octave, double u, double v)
{
    const double x = std::ldexp(u, static_cast<int>(octave)), z = std::ldexp(v, static_cast<int>(octave));
    const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(z);
    const auto ease = [](double t) { return t * t * (3 - 2 * t); };
    const double s = ease(x - column), t = ease(z - row);
    const double near =
        corner_height(octave, column, row) * (1 - s) + corner_height(octave, column + 1, row) * s;
    const double far =
        corner_height(octave, column, row + 1) * (1 - s) + corner_height(octave, column + 1, row + 1) * s;
    return near * (1 - t) + far * t;
}

double height(double u, double v)
{
    constexpr std::uint32_t kFirst = 2, kOctaves = 9;
    double sum = 0, weight = 0.15;
    for (std::uint32_t octave = kFirst; octave < kFirst + kOctaves; ++octave, weight *= 0.45)
        sum += weight * octave_height(octave, u, v);
    return sum;
}

} // namespace

Terrain::Terrain(std::uint64_t triangles) : triangles_(triangles)
{
    constexpr std::uint64_t kMost = 4'000'000'000; // indices have 32 bits
    if (triangles == 0 || triangles > kMost) throw std::invalid_argument("1 to 4,000,000,000 triangles");
    const std::uint64_t cells = (triangles + 1) / 2;
    columns_ = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(cells)));
    columns_ += columns_ == 0;
    rows_ = static_cast<std::uint32_t>((cells + columns_ - 1) / columns_);
}

Vec3f Terrain::vertex(std::uint32_t number) const
{
    const double u = static_cast<double>(number % (columns_ + 1)) / columns_,
                 v = static_cast<double>(number / (columns_ + 1)) / rows_;
    return {static_cast<float>(2 * u - 1), static_cast<float>(height(u, v)), static_cast<float>(1 - 2 * v)};
}

Triangle Terrain::triangle(std::uint64_t number) const
{
    const auto cell = static_cast<std::uint32_t>(number / 2);
    const std::uint32_t a = cell / columns_ * (columns_ + 1) + cell % columns_, b = a + columns_ + 1;
    return number % 2 == 0 ? Triangle{a, a + 1, b + 1} : Triangle{a, b + 1, b};
}

renderer::Mesh terrain_mesh(std::uint64_t triangles)
{
    const Terrain terrain(triangles);
    renderer::Mesh mesh;
    mesh.positions.resize(terrain.vertices());
    for (std::uint32_t i = 0; i < terrain.vertices(); ++i)
        mesh.positions[i] = terrain.vertex(i);
    mesh.triangles.resize(triangles);
    for (std::uint64_t i = 0; i < triangles; ++i)
        mesh.triangles[i] = terrain.triangle(i);
    return mesh;
}

} // namespace bench
