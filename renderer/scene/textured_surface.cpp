// What Scene does where a surface has pictures: materials and normals at a point, rays that pass holes.
#include "renderer/scene/scene.h"

#include <algorithm>
#include <bit>
#include <new>

namespace renderer {

namespace {

// A tilted normal keeps at least this cosine to the viewer, who sees the surface after all.
constexpr double kLeastCosine = 1e-3;

// A ray that met so many holes ends there: leaves lie in layers, not in thousands.
constexpr int kMostHoles = 1000;

Vec3d facing(Vec3d normal, Vec3d toward_viewer)
{
    const double cosine = dot(normal, toward_viewer);
    if (cosine >= kLeastCosine) return normal;
    return normalize(normal + toward_viewer * (kLeastCosine - cosine));
}

} // namespace

const Bsdf* Scene::dress(const SceneHit& hit,
                         const TexturedMaterial& textured,
                         Vec3d toward_viewer,
                         BsdfRoom& room,
                         double width,
                         Vec3d& shading) const
{
    const auto at = coordinates_at(hit, parts_.tree.instances()[hit.instance]);
    // make_plan refuses it, or the mesh's own material goes by its mean.
    if (!at) return &parts_.bsdfs[material_at(hit)];
    const Vec3d viewer = normalize(toward_viewer);
    const TextureFootprint footprint = footprint_of(*at, hit.point.normal, viewer, width);
    const Bsdf* const bsdf =
        new (room.bytes) Bsdf(parts_.textures.bsdf_at(textured, at->uv, footprint, width > 0));
    if (!textured.normal_map) return bsdf;
    // The map is of the surface's outside; from behind its bumps are dents.
    const double side = dot(hit.point.normal, toward_viewer) < 0 ? -1 : 1;
    const Vec3d tilt = parts_.textures.tilt_at(*textured.normal_map, at->uv, footprint);
    shading = facing(tilted_normal(*at, shading * side, tilt) * side, viewer);
    return bsdf;
}

bool Scene::is_hole(const SceneHit& hit) const
{
    const TexturedMaterial* const textured = parts_.textures.find(material_at(hit));
    if (textured == nullptr) return false;
    const auto at = coordinates_at(hit, parts_.tree.instances()[hit.instance]);
    return at && parts_.textures.is_hole(*textured, at->uv);
}

std::uint64_t
Scene::past_holes(std::span<const Ray> rays, std::span<SceneHit> hits, RayKind kind, std::uint64_t hit) const
{
    for (std::uint64_t left = hit; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        double way = 0; // to the origin of the ray at hand
        for (int holes = 0; is_hole(hits[i]); ++holes) {
            way += hits[i].t;
            const Ray on{
                offset_origin(hits[i].point, rays[i].direction), rays[i].direction, 0, rays[i].t_max - way};
            const bool goes_on = holes < kMostHoles && on.t_max > 0 &&
                                 parts_.tree.closest_hits({&on, 1}, {&hits[i], 1}, kind) != 0;
            if (!goes_on) {
                hit &= ~(std::uint64_t{1} << i);
                break;
            }
        }
        hits[i].t += way;
    }
    return hit;
}

std::uint64_t Scene::behind_holes(std::span<const Ray> rays, std::uint64_t hit) const
{
    for (std::uint64_t left = hit; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        SceneHit first;
        const std::uint64_t bit = std::uint64_t{1} << i;
        const bool is_hit = parts_.tree.closest_hits({&rays[i], 1}, {&first, 1}, RayKind::other) != 0;
        if (!is_hit || past_holes({&rays[i], 1}, {&first, 1}, RayKind::other, 1) == 0) hit &= ~bit;
    }
    return hit;
}

} // namespace renderer
