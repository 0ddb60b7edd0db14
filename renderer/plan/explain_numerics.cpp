#include "renderer/plan/explain_numerics.h"

#include "renderer/geometry/rounding.h"
#include "renderer/math/transcendental.h"
#include "renderer/plan/number_in_words.h"
#include "renderer/plan/placement.h"
#include "renderer/plan/world_frame.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <variant>

namespace renderer {

namespace {

std::string place(Vec3d p)
{
    const auto whole = [](double x) {
        std::array<char, 32> text{};
        const auto end = std::to_chars(text.data(), text.data() + text.size(), x);
        return std::string(text.data(), end.ptr);
    };
    return "(" + whole(p.x) + ", " + whole(p.y) + ", " + whole(p.z) + ")";
}

std::string meshes_in_words(std::size_t count)
{
    return std::to_string(count) + (count == 1 ? " mesh" : " meshes");
}

// What floats may move a corner by, in the world, and an eighth of a pixel where the object is nearest.
struct Rounding {
    double moves_m = 0, eighth_of_a_pixel_m = 0;
    double excess() const { return eighth_of_a_pixel_m > 0 ? moves_m / eighth_of_a_pixel_m : 0; }
};

Rounding rounding_of(const SceneDescription& scene,
                     const ObjectDescription& object,
                     std::span<const MeshFacts> meshes,
                     const ImageSettings& image)
{
    const MeshFacts& facts = meshes[std::get<MeshShape>(object.shape).mesh];
    const double largest =
        std::max(max_abs(facts.bounds.lower - facts.origin), max_abs(facts.bounds.upper - facts.origin));
    const auto& rows = object.world_from_object.rows;
    const double stretch = std::max({length(rows[0]), length(rows[1]), length(rows[2])});
    const double pixel = 2 * tan_deg(scene.camera->fov_deg / 2) / image.height_px;
    return {largest * stretch * 0x1p-24, camera_distance(*scene.camera, object, meshes) * pixel / 8};
}

struct Found {
    std::map<std::uint32_t, bool> has_residuals; // of the meshes that objects name
    std::size_t moved = 0;                       // meshes that have an origin of their own
    Rounding worst;                              // of those kept in float, against their pixels
};

Found look_through(const SceneDescription& scene,
                   std::span<const MeshFacts> meshes,
                   const ImageSettings& image)
{
    Found found;
    for (const ObjectDescription& object : scene.objects) {
        const auto* const shape = std::get_if<MeshShape>(&object.shape);
        if (shape == nullptr) continue;
        const MeshFacts& facts = meshes[shape->mesh];
        if (found.has_residuals.emplace(shape->mesh, facts.has_residuals).second)
            found.moved += facts.origin == Vec3d{} ? 0u : 1u;
        if (facts.has_residuals) continue;
        const Rounding rounding = rounding_of(scene, object, meshes, image);
        if (rounding.excess() > found.worst.excess()) found.worst = rounding;
    }
    return found;
}

std::size_t in_double(const Found& found)
{
    return static_cast<std::size_t>(std::count_if(found.has_residuals.begin(),
                                                  found.has_residuals.end(),
                                                  [](const auto& mesh) { return mesh.second; }));
}

} // namespace

void explain_numerics(const SceneDescription& scene,
                      std::span<const MeshFacts> meshes,
                      const ImageSettings& image,
                      Vec3d world_origin,
                      ModelReport& models)
{
    const Found found = look_through(scene, meshes, image);
    const std::size_t doubles = in_double(found), floats = found.has_residuals.size() - doubles;
    if (world_origin != Vec3d{})
        models.used.push_back(
            {"recentred_scene",
             "the camera stands far from the world's origin for what it is near to: places are "
             "taken relative to " +
                 place(world_origin)});
    if (found.moved != 0)
        models.used.push_back({"recentred_meshes",
                               meshes_in_words(found.moved) +
                                   " at 10,000 times their size or more from the origin of their file: kept "
                                   "relative to one of their own"});
    if (doubles != 0)
        models.used.push_back(
            {"double_corners",
             meshes_in_words(doubles) +
                 " with triangles below 2^-20 of their coordinates: a float would move their "
                 "corners by more than a sixteenth of them"});
    if (floats == 0) return;
    std::string why = meshes_in_words(floats) +
                      " without triangles below 2^-20 of their coordinates, or whose file has floats";
    if (found.worst.excess() > 1)
        why += "; where nearest to the camera a corner may be off by " +
               number_in_words(found.worst.moves_m) + " m, an eighth of a pixel is " +
               number_in_words(found.worst.eighth_of_a_pixel_m) + " m";
    models.used.push_back({"float_corners", std::move(why)});
}

std::string corner_precision(const SceneDescription& scene, std::span<const MeshFacts> meshes)
{
    bool floats = false, doubles = false;
    for (const ObjectDescription& object : scene.objects)
        if (const auto* const shape = std::get_if<MeshShape>(&object.shape))
            (meshes[shape->mesh].has_residuals ? doubles : floats) = true;
    return !floats ? "double" : doubles ? "mixed" : "float";
}

} // namespace renderer
