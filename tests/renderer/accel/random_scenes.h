// Random numbers, meshes and rays for the tests of geometry and acceleration; the same on every machine.
#pragma once

#include "renderer/geometry/mesh.h"
#include "renderer/geometry/ray.h"
#include "renderer/math/transcendental.h"

#include <cmath>
#include <cstdint>

namespace renderer::random_scenes {

// splitmix64: S. Vigna, public domain; std distributions differ between libraries.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits()
    {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(bits() % n); }
    // +-10^U(-decades, decades): what pbrt's tests call pExp.
    double exponential(double decades)
    {
        const double size = std::pow(10.0, uniform(-decades, decades));
        return bits() & 1 ? size : -size;
    }
    Vec3d direction()
    {
        for (;;) {
            const Vec3d v{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
            const double l = length(v);
            if (l > 1e-3 && l <= 1) return v / l;
        }
    }
    Vec3d in_box(Vec3d low, Vec3d high)
    {
        return {uniform(low.x, high.x), uniform(low.y, high.y), uniform(low.z, high.z)};
    }

private:
    std::uint64_t state_;
};

// A closed mesh around `center`: a sphere of rings x segments whose radii are drawn from [low, high].
inline Mesh closed_sphere(
    Random& random, Vec3d center, double low, double high, std::uint32_t rings, std::uint32_t segments)
{
    Mesh mesh;
    const auto add = [&](double polar, double turn) {
        const double r = random.uniform(low, high);
        const Vec3d p{
            r * std::sin(polar) * std::cos(turn), r * std::cos(polar), r * std::sin(polar) * std::sin(turn)};
        mesh.positions.push_back(to_float(center + p));
    };
    add(0, 0);
    for (std::uint32_t i = 1; i < rings; ++i)
        for (std::uint32_t j = 0; j < segments; ++j)
            add(kPi * i / rings, 2 * kPi * j / segments);
    add(kPi, 0);
    const auto last = static_cast<std::uint32_t>(mesh.positions.size()) - 1;
    for (std::uint32_t j = 0; j < segments; ++j) {
        const std::uint32_t k = (j + 1) % segments;
        mesh.triangles.push_back({0, 1 + k, 1 + j});
        for (std::uint32_t i = 0; i + 2 < rings; ++i) {
            const std::uint32_t a = 1 + i * segments, b = a + segments;
            mesh.triangles.push_back({a + j, a + k, b + k});
            mesh.triangles.push_back({a + j, b + k, b + j});
        }
        mesh.triangles.push_back({last, last - segments + j, last - segments + k});
    }
    return mesh;
}

// Triangles strewn in a box of the given size, edges up to `edge` long.
inline Mesh soup(Random& random, std::uint32_t triangles, double size, double edge)
{
    Mesh mesh;
    const Vec3d s{size, size, size}, e{edge, edge, edge};
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const Vec3d p = random.in_box(-s, s);
        for (int k = 0; k < 3; ++k)
            mesh.positions.push_back(to_float(p + random.in_box(-e, e)));
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

// A square of n x n cells in the plane y = 0, from -size/2 to size/2, facing up.
inline Mesh grid(std::uint32_t n, double size)
{
    Mesh mesh;
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t j = 0; j <= n; ++j)
            mesh.positions.push_back(to_float(Vec3d{
                size * (static_cast<double>(j) / n - 0.5), 0, size * (static_cast<double>(i) / n - 0.5)}));
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
            mesh.triangles.push_back({a, b, b + 1});
            mesh.triangles.push_back({a, b + 1, a + 1});
        }
    return mesh;
}

} // namespace renderer::random_scenes
