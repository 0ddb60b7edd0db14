#include "renderer/math/floating_point_mode.h"
#include "renderer/plan/plan.h"

namespace renderer {

namespace {

Bounds3d part_bounds(const Mesh& mesh, const MeshPart& part)
{
    Bounds3d bounds;
    for (std::size_t i = 0; i < part.triangle_count; ++i)
        for (const std::uint32_t vertex : mesh.triangles[part.first_triangle + i])
            bounds.extend(mesh.position(vertex) + mesh.origin);
    return bounds;
}

std::vector<bool> used_materials(const Mesh& mesh)
{
    std::vector<bool> used(mesh.materials.size());
    if (mesh.triangle_materials.empty() && !used.empty()) used[0] = true;
    for (const std::uint16_t material : mesh.triangle_materials)
        if (material < used.size()) used[material] = true;
    return used;
}

bool is_rough(const MeshMaterial& material)
{
    return material.is_physical &&
           (static_cast<double>(material.roughness) >= kSmoothBelow || material.physical_map);
}

std::uint64_t shining_triangles(const Mesh& mesh)
{
    const auto shines = [&](std::size_t material) {
        return material < mesh.materials.size() && !is_black(mesh.materials[material].emission);
    };
    if (mesh.triangle_materials.empty()) return shines(0) ? mesh.triangles.size() : 0;
    std::uint64_t count = 0;
    for (const std::uint16_t material : mesh.triangle_materials)
        count += shines(material);
    return count;
}

} // namespace

MeshFacts facts_of(const Mesh& mesh)
{
    const DefaultFloatingPoint whatever_the_caller_has;
    MeshFacts facts;
    facts.bounds = mesh.bounds_in_file();
    facts.origin = mesh.origin;
    facts.has_residuals = !mesh.residuals.empty();
    facts.triangles = mesh.triangles.size();
    facts.vertices = mesh.positions.size();
    facts.has_normals = !mesh.normals.empty();
    facts.has_materials = !mesh.materials.empty();
    for (const MeshMaterial& material : mesh.materials) {
        facts.has_textures = facts.has_textures || !material.textures.empty();
        facts.has_specular = facts.has_specular || (!is_black(material.specular) && material.shininess > 0);
    }
    const std::vector<bool> used = used_materials(mesh);
    std::uint32_t opaque = 0;
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) continue;
        const MeshMaterial& material = mesh.materials[i];
        facts.emissive_materials += material.emits;
        facts.transparent_materials += material.is_transparent;
        facts.metal_materials += material.is_metal && !material.is_physical;
        facts.rough_materials += material.has_roughness && !material.is_physical;
        facts.physical_materials += material.is_physical && !material.is_glass;
        ++(material.is_glass ? facts.glass_materials : opaque);
        facts.rough_glass_materials += material.is_glass && is_rough(material);
        facts.shining_materials += !is_black(material.emission);
        facts.cutouts += material.cutoff > 0;
        facts.normal_mapped += material.normal_map.has_value();
    }
    facts.is_all_glass = facts.glass_materials > 0 && opaque == 0;
    facts.shining_triangles = shining_triangles(mesh);
    facts.has_uvs = !mesh.uvs.empty();
    facts.images = static_cast<std::uint32_t>(mesh.images.size());
    for (const MeshImage& named : mesh.images)
        facts.image_bytes += named.image.bytes.size();
    for (const auto& [name, part] : mesh.parts_by_name())
        facts.parts.emplace(name,
                            PartFacts{part->first_triangle, part->triangle_count, part_bounds(mesh, *part)});
    return facts;
}

ImageFacts facts_of(const Image& image)
{
    return {
        image.width, image.height, image.bytes.size(), image.has_alpha(), image.type == PixelType::real_32};
}

} // namespace renderer
