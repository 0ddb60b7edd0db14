#include "renderer/math/floating_point_mode.h"
#include "renderer/math/transcendental.h"
#include "renderer/plan/plan.h"
#include "renderer/plan/world_bounds.h"

#include <algorithm>

namespace renderer {

namespace {

constexpr Vec3d kViewFrom{0.35, 0.3, 1}; // from the scene's centre towards the assumed camera
constexpr double kFovDeg = 40;
constexpr double kFill = 0.96; // share of the frame that the bounds may fill

// With these a diffuse white surface that faces the sun stays below 1: L = sky + sun / pi, so nothing clips.
constexpr Rgb kSkyRadiance{0.24f, 0.26f, 0.29f};
constexpr Rgb kSunIrradiance{2.3f, 2.2f, 2.05f};
constexpr Vec3d kSunTravels{0.45, -1, -0.65}; // from the upper left, in front

// How far from `center` a camera must stand for every corner to be in its frame.
double framing_distance(const SceneDescription& scene,
                        std::span<const MeshFacts> meshes,
                        Vec3d center,
                        Vec3d toward_camera,
                        double aspect)
{
    const Vec3d right = normalize(cross(Vec3d{0, 1, 0}, toward_camera));
    const Vec3d up = cross(toward_camera, right);
    const double tan_y = kFill * tan_deg(kFovDeg / 2), tan_x = tan_y * aspect;
    double distance = 0;
    for (const ObjectDescription& object : scene.objects) {
        if (object_bounds(object.shape, meshes).empty()) continue;
        for (const Vec3d& corner : world_corners(object, meshes)) {
            const Vec3d c = corner - center;
            const double nearer = dot(c, toward_camera);
            distance = std::max(
                {distance, nearer + std::abs(dot(c, right)) / tan_x, nearer + std::abs(dot(c, up)) / tan_y});
        }
    }
    return distance;
}

CameraDescription
framing_camera(const SceneDescription& scene, std::span<const MeshFacts> meshes, double aspect)
{
    CameraDescription camera;
    camera.fov_deg = kFovDeg;
    const Bounds3d bounds = world_bounds(scene, meshes);
    if (bounds.empty() || !is_finite(bounds.lower) || !is_finite(bounds.upper)) return camera;
    const Vec3d center = bounds.center();
    const Vec3d toward_camera = normalize(kViewFrom);
    double distance = framing_distance(scene, meshes, center, toward_camera, aspect);
    // A scene that is a point still needs a place to be seen from.
    const double least = std::max(max_component(abs(center)) * 1e-6, 1e-30);
    if (!(distance > least)) distance = std::max(1.0, least);
    camera.position = center + toward_camera * distance;
    camera.aim = center;
    return camera;
}

} // namespace

AssumedScene assume_defaults(SceneDescription description, std::span<const MeshFacts> meshes, double aspect)
{
    const DefaultFloatingPoint whatever_the_caller_has;
    AssumedScene out{std::move(description), {}};
    SceneDescription& scene = out.description;
    if (!scene.camera) {
        scene.camera = framing_camera(scene, meshes, aspect > 0 ? aspect : 1);
        out.assumed.push_back({"assumed_camera",
                               "the scene names no camera: one that frames the bounds of all objects from "
                               "(0.35, 0.3, 1), 40 degrees high"});
    }
    if (!scene.environment && scene.lights.empty()) {
        scene.environment = ColorEnvironment{kSkyRadiance};
        scene.lights.emplace_back(DirectionalLight{kSunTravels, kSunIrradiance});
        out.assumed.push_back(
            {"assumed_sky", "the scene has no light and no environment: a neutral sky colour"});
        out.assumed.push_back(
            {"assumed_sun", "the scene has no light and no environment: one sun, high on the left"});
    }
    if (!scene.environment) scene.environment = NoEnvironment{};
    return out;
}

} // namespace renderer
