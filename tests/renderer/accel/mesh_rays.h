// What the tests of meshes and their kernels share: ten meshes of all kinds, rays of all kinds, and what it means
// that two answers agree.
#pragma once

#include "renderer/accel/mesh_bvh.h"
#include "renderer/geometry/mesh_frame.h"
#include "tests/renderer/accel/random_scenes.h"
#include "tests/support/thinning.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <optional>
#include <vector>

namespace renderer::mesh_rays {

using namespace random_scenes;

using tests::kThinning;

inline MeshBvh build(const Mesh& mesh, BvhSplit split = BvhSplit::sah)
{
    static ThreadPool pool(1);
    return *MeshBvh::build(
        mesh, TriangleRun{0, static_cast<std::uint32_t>(mesh.triangles.size())}, split, pool);
}

inline bool same_bits(double a, double b)
{
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

// The two answers agree to the last bit.
inline ::testing::AssertionResult same(const std::optional<MeshHit>& a, const std::optional<MeshHit>& b)
{
    if (a.has_value() != b.has_value())
        return ::testing::AssertionFailure() << (a ? "only the first hits" : "only the second hits");
    if (!a) return ::testing::AssertionSuccess();
    if (a->primitive == b->primitive && same_bits(a->t, b->t) && a->barycentrics == b->barycentrics)
        return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure()
           << "primitive " << a->primitive << " t " << a->t << " against " << b->primitive << " t " << b->t;
}

// Rays of every kind against one mesh: from afar and from within, along axes, at corners and at edges.
inline Ray random_ray(Random& random, const Mesh& mesh)
{
    const auto corner = [&] {
        const auto& v = mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
        return mesh.position(v[random.below(3)]);
    };
    const auto box = mesh.bounds();
    const Vec3d low = to_double(box.lower), high = to_double(box.upper);
    const Vec3d center = (low + high) * 0.5;
    const double size = length(high - low);
    Ray ray;
    ray.origin = random.below(2) ? random.in_box(low, high)
                                 : center + random.direction() * (size * std::pow(10, random.uniform(0, 5)));
    const Vec3d target = random.below(3) == 0 ? corner()
                         : random.below(2)    ? (corner() + corner()) * 0.5
                                              : random.in_box(low, high);
    ray.direction = target - ray.origin;
    if (random.below(8) == 0) ray.direction[random.below(3)] = random.below(2) ? 0.0 : -0.0;
    if (random.below(8) == 0) ray.t_max = random.uniform(0, 2);
    if (random.below(8) == 0) ray.t_min = random.uniform(0, 1);
    return ray;
}

// Ten meshes: strewn, closed, flat, far from the origin, tiny, huge, with duplicates and without area.
inline std::vector<Mesh> ten_meshes()
{
    Random random(19);
    std::vector<Mesh> meshes{soup(random, 2000, 1, 0.3),
                             soup(random, 300, 1, 1),
                             soup(random, 2000, 1, 0.01),
                             closed_sphere(random, {0, 0, 0}, 1, 6, 16, 16),
                             closed_sphere(random, {148376, 1234, -223423}, 2, 2, 30, 30),
                             grid(30, 1e6),
                             soup(random, 1000, 1e-6, 3e-7),
                             soup(random, 1000, 1e6, 3e5),
                             soup(random, 500, 1, 0.2),
                             soup(random, 1, 1, 1)};
    Mesh& doubled = meshes[8];
    const auto once = doubled.triangles;
    for (const auto& t : once)
        doubled.triangles.push_back({t[0], t[1], t[2]});
    for (const auto& t : once)
        doubled.triangles.push_back({t[0], t[1], t[0]});
    return meshes;
}

// What only doubles tell apart: small triangles in a mesh a million million times their size, strewn and closed, with
// residuals.
inline std::vector<Mesh> fine_meshes()
{
    Random random(20);
    std::vector<Mesh> meshes;
    for (const double small : {1e-2, 1e-5, 1e-7}) {
        Mesh mesh = soup(random, 300, 1e5, 1e5);
        std::vector<Vec3d> places;
        for (const Vec3f& p : mesh.positions)
            places.push_back(to_double(p));
        const auto add = [&](const Mesh& part, Vec3d at) {
            const auto first = static_cast<std::uint32_t>(places.size());
            for (const Vec3f& p : part.positions)
                places.push_back(to_double(p) * small + at);
            for (const Triangle& t : part.triangles)
                mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
        };
        add(soup(random, 300, 1, 0.3), {51234.56789, -71234.56789, 30303.030303});
        add(closed_sphere(random, {0, 0, 0}, 1, 2, 16, 16), {-80123.123456, 40404.040404, 98765.4321});
        set_positions(mesh, places);
        meshes.push_back(std::move(mesh));
    }
    return meshes;
}

} // namespace renderer::mesh_rays
