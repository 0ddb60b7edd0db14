#include "renderer/plan/world_bounds.h"

#include <variant>

namespace renderer {

namespace {

Bounds3d around_origin(Vec3d half)
{
    return {{-half.x, -half.y, -half.z}, half};
}

const Bounds3d& bounds_of_part(const MeshFacts& facts, const std::string& part)
{
    const auto named = part.empty() ? facts.parts.end() : facts.parts.find(part);
    return named == facts.parts.end() ? facts.bounds : named->second.bounds;
}

struct OwnBounds {
    std::span<const MeshFacts> meshes;

    Bounds3d operator()(const MeshShape& s) const
    {
        if (s.mesh >= meshes.size()) return {};
        const MeshFacts& facts = meshes[s.mesh];
        return bounds_of_part(facts, s.part);
    }
    Bounds3d operator()(const RectangleShape& s) const
    {
        return around_origin({s.width_m / 2, s.height_m / 2, 0});
    }
    Bounds3d operator()(const DiskShape& s) const { return around_origin({s.radius_m, s.radius_m, 0}); }
    Bounds3d operator()(const BoxShape& s) const { return around_origin(s.size_m / 2.0); }
    Bounds3d operator()(const SphereShape& s) const
    {
        return around_origin({s.radius_m, s.radius_m, s.radius_m});
    }
};

} // namespace

Bounds3d object_bounds(const Shape& shape, std::span<const MeshFacts> meshes)
{
    return std::visit(OwnBounds{meshes}, shape);
}

std::array<Vec3d, 8> world_corners(const ObjectDescription& object, std::span<const MeshFacts> meshes)
{
    const Bounds3d own = object_bounds(object.shape, meshes);
    std::array<Vec3d, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3d corner{(i & 1) != 0 ? own.upper.x : own.lower.x,
                           (i & 2) != 0 ? own.upper.y : own.lower.y,
                           (i & 4) != 0 ? own.upper.z : own.lower.z};
        corners[i] = object.world_from_object.point(corner);
    }
    return corners;
}

Bounds3d world_bounds(const SceneDescription& scene, std::span<const MeshFacts> meshes)
{
    Bounds3d all;
    for (const ObjectDescription& object : scene.objects) {
        if (object_bounds(object.shape, meshes).empty()) continue;
        for (const Vec3d& corner : world_corners(object, meshes))
            all.extend(corner);
    }
    return all;
}

} // namespace renderer
