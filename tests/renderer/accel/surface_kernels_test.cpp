// Every kernel that this processor can run: the same points of triangles as worked out one by one.
#include "renderer/accel/surface_kernels.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace {

using namespace renderer;

struct Case {
    Vec3d corners[3], weights;
};

// Of all sizes, some along the axes, some hit at an edge or a corner.
std::vector<Case> cases()
{
    std::vector<Case> cases{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {1, 0, 0}},
                            {{{0, 0, -0.0}, {0, -1, 0}, {0, 0, 1}}, {0, 0.5, 0.5}},
                            {{{-1, 2, 3}, {-1, 2, 4}, {-1, 3, 3}}, {0.25, 0.25, 0.5}},
                            {{{1e15, 0, 0}, {1e15, 1e15, 0}, {0, 0, 1e15}}, {0.5, 0.25, 0.25}}};
    auto uniform = [n = 0u]() mutable {
        n = n * 1664525u + 1013904223u;
        return static_cast<double>(n >> 8) * 0x1p-24;
    };
    while (cases.size() < 400) {
        const double size = std::pow(10.0, 12 * uniform() - 6);
        Case made{};
        for (Vec3d& corner : made.corners)
            corner = Vec3d{2 * uniform() - 1, 2 * uniform() - 1, 2 * uniform() - 1} * size;
        const double a = uniform(), b = uniform() * (1 - a);
        made.weights = {a, b, 1 - a - b};
        cases.push_back(made);
    }
    return cases;
}

std::vector<Placement> placements()
{
    const Affine3 turned = Affine3::rotate_deg(33, {1, 2, -0.5});
    std::vector<Placement> placements;
    for (const Affine3& at : {Affine3{},
                              Affine3::translate({1e6, -2e-3, 5}),
                              Affine3::scale({-1, 1, 1}),
                              Affine3::scale({1e-6, 1e-6, 1e-6}) * turned,
                              Affine3::translate({0, -3, 1e9}) * turned * Affine3::scale({1e6, 1, 2e-3})})
        placements.push_back(Placement::at(at).value());
    return placements;
}

void put(SurfaceLanes::Vectors& to, std::size_t lane, Vec3d v)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
        to[axis][lane] = v[axis];
}

// Zeros by their signs too.
std::vector<std::uint64_t> bits_of(const SurfaceLanes::Vectors& of, std::size_t lane)
{
    return {std::bit_cast<std::uint64_t>(of[0][lane]),
            std::bit_cast<std::uint64_t>(of[1][lane]),
            std::bit_cast<std::uint64_t>(of[2][lane])};
}
std::vector<std::uint64_t> bits_of(Vec3d v)
{
    return {std::bit_cast<std::uint64_t>(v.x),
            std::bit_cast<std::uint64_t>(v.y),
            std::bit_cast<std::uint64_t>(v.z)};
}

} // namespace

TEST(SurfaceKernels, FindAsOneByOneToTheBit)
{
    const std::vector<Case> hits = cases();
    for (const FindSurfaces kernel : all_find_surfaces())
        for (const Placement& placement : placements())
            for (std::size_t first = 0; first < hits.size(); first += SurfaceLanes::kHits) {
                SurfaceLanes lanes;
                for (std::size_t i = 0; i < SurfaceLanes::kHits; ++i) {
                    for (std::size_t k = 0; k < 3; ++k)
                        put(lanes.corner[k], i, hits[first + i].corners[k]);
                    put(lanes.weights, i, hits[first + i].weights);
                }
                kernel(placement, lanes);
                for (std::size_t i = 0; i < SurfaceLanes::kHits; ++i) {
                    const Case& hit = hits[first + i];
                    const SurfacePoint on_mesh =
                        triangle_point(hit.corners[0], hit.corners[1], hit.corners[2], hit.weights);
                    const SurfacePoint expected = placement.to_world(on_mesh);
                    ASSERT_EQ(bits_of(lanes.object_position, i), bits_of(on_mesh.position)) << first + i;
                    ASSERT_EQ(bits_of(lanes.position, i), bits_of(expected.position)) << first + i;
                    ASSERT_EQ(bits_of(lanes.error, i), bits_of(expected.error)) << first + i;
                    ASSERT_EQ(bits_of(lanes.normal, i), bits_of(expected.normal)) << first + i;
                }
            }
}
