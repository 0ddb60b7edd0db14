#include "renderer/scene/scene.h"

namespace renderer {

namespace {

// Interpolated normals shorter than this have cancelled one another: what is left is noise.
constexpr double kShortestNormal = 1e-4;

const Bsdf kBlack = make_bsdf(EmitterMaterial{.radiance = {}}); // the back of what has one side

Vec3d corner_normal(const Mesh& mesh, const Triangle& triangle, std::size_t corner)
{
    return to_double(mesh.normals[triangle[corner]]);
}

} // namespace

// The zero vector where the mesh's normals say nothing.
Vec3d Scene::shading_normal(const SceneHit& hit, const Mesh& mesh) const
{
    const Triangle& triangle = mesh.triangles[hit.primitive];
    const Vec3d normal = corner_normal(mesh, triangle, 0) * hit.barycentrics.x +
                         corner_normal(mesh, triangle, 1) * hit.barycentrics.y +
                         corner_normal(mesh, triangle, 2) * hit.barycentrics.z;
    if (!(length(normal) > kShortestNormal)) return {};
    const Vec3d world = parts_.tree.instances()[hit.instance].object_from_world().transposed_vector(normal);
    return is_finite(world) && max_component(abs(world)) > 0 ? normalize(world) : Vec3d{};
}

std::uint32_t Scene::material_at(const SceneHit& hit) const
{
    return parts_.looks[hit.instance].bsdf_of(hit.primitive);
}

Surface Scene::surface_at(const SceneHit& hit, Vec3d toward_viewer, BsdfRoom* room, double width) const
{
    const Parts::Look& look = parts_.looks[hit.instance];
    const Vec3d outward = hit.point.normal;
    const Vec3d geometric = dot(outward, toward_viewer) < 0 ? -outward : outward;
    Vec3d shading = look.normals_of != nullptr ? shading_normal(hit, *look.normals_of) : Vec3d{};
    const double agreement = dot(shading, geometric);
    if (agreement == 0)
        shading = geometric; // none, or at right angles: it cannot be told which side it means
    else if (agreement < 0)
        shading = -shading;
    const std::uint32_t material = material_at(hit);
    const bool is_outside = dot(outward, toward_viewer) >= 0;
    const Bsdf* bsdf = &parts_.bsdfs[material];
    const TexturedMaterial* const textured =
        room != nullptr && !parts_.textures.empty() ? parts_.textures.find(material) : nullptr;
    if (textured != nullptr) bsdf = dress(hit, *textured, toward_viewer, *room, width, shading);
    if (!bsdf->two_sided && !is_outside) bsdf = &kBlack;
    return {hit.point, to_float(geometric), shading, Frame(to_float(shading)), is_outside, bsdf};
}

} // namespace renderer
