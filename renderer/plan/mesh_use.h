// mesh_use: what a scene asks of a mesh beside its triangles.
//
// Usage  who holds a mesh for one scene alone drops the rest before trees are built; who shares it among scenes keeps it whole
//        and says so (MeshFacts::is_shared), for the memory to be foretold as it will be.
#pragma once

#include "renderer/description/scene_description.h"
#include "renderer/geometry/mesh.h"
#include "renderer/plan/plan.h"

#include <cstdint>
#include <span>
#include <vector>

namespace renderer {

struct MeshUse {
    bool normals = false;
    bool uvs = false;       // texture coordinates
    bool materials = false; // its own, the pictures that came with them among them

    bool operator==(const MeshUse&) const = default;
};

// One for each mesh, whether it has them or not. From the scene's words alone: an object that no ray meets counts.
std::vector<MeshUse> uses_of(const SceneDescription& scene, std::span<const MeshFacts> meshes);

void drop_unused(Mesh& mesh, const MeshUse& use);

// Of what `use` leaves of the mesh, in memory: vertices, indices, materials' numbers; neither pictures nor trees.
std::uint64_t array_bytes(const MeshFacts& mesh, const MeshUse& use);

} // namespace renderer
