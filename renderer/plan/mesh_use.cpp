#include "renderer/plan/mesh_use.h"

#include "renderer/description/textured_values.h"

#include <variant>

namespace renderer {

std::vector<MeshUse> uses_of(const SceneDescription& scene, std::span<const MeshFacts> meshes)
{
    std::vector<MeshUse> uses(meshes.size());
    for (const ObjectDescription& object : scene.objects) {
        const auto* const shape = std::get_if<MeshShape>(&object.shape);
        if (shape == nullptr || shape->mesh >= meshes.size()) continue;
        MeshUse& use = uses[shape->mesh];
        use.normals = use.normals || object.shading != Shading::flat;
        const bool has_own = !object.material;
        use.materials = use.materials || has_own;
        const bool is_looked_up = has_own ? meshes[shape->mesh].images > 0
                                          : *object.material < scene.materials.size() &&
                                                is_textured(scene.materials[*object.material].material);
        use.uvs = use.uvs || is_looked_up;
    }
    return uses;
}

void drop_unused(Mesh& mesh, const MeshUse& use)
{
    if (!use.normals) mesh.normals = {};
    if (!use.uvs) mesh.uvs = {};
    if (use.materials) return;
    mesh.triangle_materials = {};
    mesh.materials.clear();
    mesh.images.clear();
}

std::uint64_t array_bytes(const MeshFacts& mesh, const MeshUse& use)
{
    std::uint64_t vertex = sizeof(Vec3f), triangle = sizeof(Triangle);
    if (mesh.has_residuals) vertex += sizeof(Vec3f);
    if (mesh.has_normals && use.normals) vertex += sizeof(Vec3f);
    if (mesh.has_uvs && use.uvs) vertex += sizeof(Vec2f);
    if (mesh.has_materials && use.materials) triangle += sizeof(std::uint16_t);
    return mesh.vertices * vertex + mesh.triangles * triangle;
}

} // namespace renderer
