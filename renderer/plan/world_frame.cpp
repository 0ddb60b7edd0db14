#include "renderer/plan/world_frame.h"

#include "renderer/plan/world_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace renderer {

namespace {

constexpr int kScalesApart = 10; // origins are multiples of 2^this scales

Bounds3d box_of(const ObjectDescription& object, std::span<const MeshFacts> meshes)
{
    Bounds3d box;
    for (const Vec3d& corner : world_corners(object, meshes))
        box.extend(corner);
    return box;
}

double distance_to(const Bounds3d& box, Vec3d p)
{
    const auto outside = [](double low, double x, double high) { return std::max({low - x, 0.0, x - high}); };
    return length(Vec3d{outside(box.lower.x, p.x, box.upper.x),
                        outside(box.lower.y, p.y, box.upper.y),
                        outside(box.lower.z, p.z, box.upper.z)});
}

} // namespace

double camera_distance(const CameraDescription& camera,
                       const ObjectDescription& object,
                       std::span<const MeshFacts> meshes)
{
    return distance_to(box_of(object, meshes), camera.position);
}

Vec3d choose_world_origin(const SceneDescription& scene, std::span<const MeshFacts> meshes)
{
    const Vec3d eye = scene.camera->position;
    double scale = std::numeric_limits<double>::infinity();
    for (const ObjectDescription& object : scene.objects) {
        if (object_bounds(object.shape, meshes).empty()) continue;
        const Bounds3d box = box_of(object, meshes);
        scale = std::min(scale, std::max(distance_to(box, eye), length(box.extent())));
    }
    if (!std::isfinite(scale) || !(scale > 0)) return {};
    int exponent = 0;
    std::frexp(scale, &exponent);
    const double step = std::ldexp(1.0, exponent + kScalesApart);
    const auto snapped = [step](double x) { return std::floor(x / step + 0.5) * step; };
    const Vec3d origin{snapped(eye.x), snapped(eye.y), snapped(eye.z)};
    return is_finite(origin) ? origin : Vec3d{};
}

} // namespace renderer
