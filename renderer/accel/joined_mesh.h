// JoinedMesh: small meshes of a scene put together as one mesh in the frame that is traced in, with one tree, so that a
// ray need not be taken to each of them.
//
// Frame      the traced frame. A corner is where its instance's transform puts it in double, kept as a float and a
//            residual: within 2^-49 of its largest coordinate.
// Ties       its triangles stand in the order of (instance, primitive), so the least primitive is the least of these.
// Promise    triangles that share a vertex of one instance share it here: no ray slips through between them.
// Threads    immutable.
#pragma once

#include "renderer/accel/instance.h"
#include "renderer/accel/prepared_mesh.h"
#include "renderer/accel/triangle_items.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace renderer {

class JoinedMesh {
public:
    struct Member {
        std::uint32_t instance; // with triangles, and seen by every ray
        TriangleRun run;        // of its mesh
    };
    // `members` in the order of their instances, which are as InstanceTree gets them. Nothing if `stop` was requested.
    static std::optional<JoinedMesh> join(std::span<const Instance> instances,
                                          std::span<const Member> members,
                                          MeshTree tree,
                                          ThreadPool& pool,
                                          const std::stop_token& stop = {});

    // As one instance; its candidates' primitives are numbers of the joined triangles.
    const Instance& instance() const { return instance_; }
    std::span<const Member> members() const { return members_; }
    std::uint32_t instance_of(std::uint32_t joined) const { return triangles_[joined].instance; }
    SceneHit resolve(const Instance::Candidate& hit, std::span<const Instance> instances) const;

    std::uint64_t size_bytes() const // of the tree, and of what tells its triangles apart
    {
        return bvh_bytes(*mesh_) + triangles_.capacity() * sizeof(Origin);
    }

private:
    struct Origin {
        std::uint32_t instance, primitive;
        Vec3d normal; // to the instance's outside
    };
    JoinedMesh(std::shared_ptr<const PreparedMesh> mesh,
               std::vector<Origin> triangles,
               std::span<const Member> members);

    std::shared_ptr<const PreparedMesh> mesh_;
    std::vector<Origin> triangles_;
    std::vector<Member> members_;
    Instance instance_;
};

} // namespace renderer
