// Instance: one object of a scene as rays see it: a shape and where it stands.
#pragma once

#include "renderer/accel/baseline_mesh.h"
#include "renderer/accel/mesh_bvh.h"
#include "renderer/accel/placement.h"
#include "renderer/geometry/disk.h"
#include "renderer/geometry/sphere.h"
#include "renderer/math/bounds.h"

#include <cstdint>
#include <optional>
#include <span>
#include <variant>

namespace renderer {

// Triangles of a prepared mesh; both pointers outlive the instance (they belong to a PreparedMesh that the
// scene holds).
struct MeshGeometry {
    const Mesh* mesh;
    const MeshBvh* bvh;
};
struct BaselineGeometry {
    const Mesh* mesh;
    const BaselineMesh* search;
};
using InstanceGeometry = std::variant<MeshGeometry, Sphere, Disk, BaselineGeometry>;

// nullptr of a sphere or disk.
const Mesh* mesh_behind(const InstanceGeometry& geometry);

// What a ray is for: an object may be hidden from the camera and still cast shadows and be reflected.
enum class RayKind : std::uint8_t { camera, other };

// Where a ray met a scene; everything in the world frame but where the name says otherwise.
struct SceneHit {
    double t = 0;
    std::uint32_t instance = 0;  // as numbered in the list given to InstanceTree
    std::uint32_t primitive = 0; // triangle of the mesh; 0 of a sphere or disk
    Vec3d barycentrics;          // weights of the triangle's corners; zero of a sphere or disk
    Vec3d object_position;       // in the instance's object space
    SurfacePoint
        point; // position, error bound, geometric normal: towards the shape's outside, also when mirrored
};

class Instance {
public:
    // Nothing if `world_from_object` is singular.
    static std::optional<Instance>
    place(InstanceGeometry geometry, const Affine3& world_from_object, bool visible_to_camera = true);

    Bounds3d world_bounds() const; // no smaller than what rays can hit
    bool visible_to(RayKind kind) const { return visible_to_camera_ || kind != RayKind::camera; }
    const Affine3& world_from_object() const { return placement_.world_from_object; }
    const Affine3& object_from_world() const { return placement_.object_from_world; }
    const InstanceGeometry& geometry() const { return geometry_; }

    // A hit before it is worked out: enough to compare. The ray is in the world.
    using Candidate = MeshHit; // of a sphere or disk: t alone
    std::optional<Candidate> closest_hit(const Ray& world_ray) const;
    bool any_hit(const Ray& world_ray) const;
    // The same for a run of at most kMostRays rays: bit i of the result is set where ray i hit, and hits[i] says
    // where.
    std::uint64_t closest_hits(std::span<const Ray> world_rays, Candidate* hits) const;
    std::uint64_t any_hits(std::span<const Ray> world_rays) const;
    static constexpr unsigned kMostRays = MeshKernels::kMostRays;
    // `instance` of the result is left to the caller.
    SceneHit resolve(const Ray& world_ray, const Candidate& candidate) const;
    // The same for those of a run whose bits are set.
    void resolve(std::span<const Ray> world_rays,
                 const Candidate* candidates,
                 std::uint64_t which,
                 SceneHit* hits) const;

private:
    Instance(InstanceGeometry geometry, const Placement& placement, bool visible_to_camera);
    std::span<const Ray> to_object(std::span<const Ray> world_rays, Ray* room) const; // in `room`, if need be

    InstanceGeometry geometry_;
    Placement placement_;
    bool visible_to_camera_;
};

} // namespace renderer
