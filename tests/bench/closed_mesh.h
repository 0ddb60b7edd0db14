// ClosedMesh: triangles without a rim, and the places where a ray could slip through them: edges and corners.
//
// Leak    a ray at a point of an edge or corner whose triangles all face the same way along it crosses the surface
//         there, from outside or from inside: it must hit something by then. At an outline it might rightly miss, so
//         such rays are not made.
#pragma once

#include "renderer/geometry/mesh.h"
#include "renderer/geometry/ray.h"
#include "tests/renderer/accel/random_scenes.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bench {

// As it is modelled, in double, around the origin.
struct Model {
    std::string name;
    std::vector<renderer::Vec3d> places;
    std::vector<renderer::Triangle> triangles;
};
Model icosphere(unsigned subdivisions, double radius);
Model torus_knot(unsigned rings, unsigned sides);
Model wrinkled_sphere(std::uint64_t seed, double low, double high, unsigned rings, unsigned segments);
// The mesh of a file, vertices at one place made one; scaled to a size of 4 around the origin.
Model model_of(const renderer::Mesh& mesh, std::string name);

// A ray in the mesh's own frame; t is 1 at the target and ends a little behind it.
struct AimedRay {
    renderer::Ray ray;
    renderer::Vec3d target;
};

class ClosedMesh {
public:
    // Only edges with two triangles and corners all of whose edges have two are aimed at. `slack` is what places
    // may be off by, in the mesh's units.
    ClosedMesh(const renderer::Mesh& mesh, double slack);

    // Sixteen rays; those of a beam come from one place to one triangle. The ray's origin is rounded as one in the
    // file's coordinates is.
    void aim(renderer::random_scenes::Random& random, bool beam, std::array<AimedRay, 16>& rays) const;
    const renderer::Mesh& mesh() const { return mesh_; }

private:
    struct Target {
        renderer::Vec3d place;
        std::vector<std::uint32_t> triangles; // that meet there
    };
    Target target_on(renderer::random_scenes::Random& random, std::uint32_t triangle) const;
    std::optional<AimedRay> ray_at(const Target& target, renderer::Vec3d origin) const;

    const renderer::Mesh& mesh_;
    double slack_, size_;
    std::vector<renderer::Vec3d> normals_;                  // one a triangle
    std::vector<double> edges_;                             // the shortest of each triangle
    std::vector<std::vector<std::uint32_t>> around_corner_; // one a vertex; empty: open
    std::vector<std::array<std::uint32_t, 3>> across_;      // one an edge of a triangle; kOpen: none
    static constexpr std::uint32_t kOpen = 0xffffffff;
};

} // namespace bench
