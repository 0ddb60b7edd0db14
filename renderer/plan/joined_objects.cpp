#include "renderer/plan/joined_objects.h"

#include "renderer/geometry/shapes.h"
#include "renderer/plan/light_shapes.h"
#include "renderer/plan/world_bounds.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <variant>

namespace renderer {

namespace {

constexpr std::uint64_t kMostOfAShape = 4096, kMostInAll = 65536;
constexpr double kLeastShareOfReach = 0x1p-12;
// Beyond these a residual could not be held by a float, or a product by the kernels.
constexpr double kLeastReach = 0x1p-60, kMostReach = 0x1p60;

// An object that can be joined, or a light's shape.
struct Small {
    std::vector<bool>* list; // of the choices, and its place there
    std::size_t number;
    ObjectDescription object;
    std::uint64_t triangles;
};

using ShapeKey =
    std::tuple<std::size_t, std::uint32_t, std::uint32_t, std::uint64_t>; // kind, mesh, its run of triangles

ShapeKey key_of(const Shape& shape, std::span<const MeshFacts> meshes)
{
    const auto* const mesh = std::get_if<MeshShape>(&shape);
    if (mesh == nullptr) return {shape.index(), 0, 0, 0};
    std::uint32_t first = 0;
    if (mesh->mesh < meshes.size()) {
        const auto& parts = meshes[mesh->mesh].parts;
        if (const auto part = parts.find(mesh->part); !mesh->part.empty() && part != parts.end())
            first = part->second.first_triangle;
    }
    return {shape.index(), mesh->mesh, first, triangles_of(shape, meshes)};
}

bool has_float_corners(const Shape& shape, std::span<const MeshFacts> meshes)
{
    const auto* const mesh = std::get_if<MeshShape>(&shape);
    return mesh == nullptr || (mesh->mesh < meshes.size() && !meshes[mesh->mesh].has_residuals);
}

std::vector<Small>
small_ones(const SceneDescription& scene, std::span<const MeshFacts> meshes, JoinedObjects& joined)
{
    std::vector<Small> small;
    std::map<ShapeKey, std::uint64_t> placed;
    const auto consider = [&](std::vector<bool>& list, std::size_t number, const ObjectDescription& object) {
        const std::uint64_t triangles = triangles_of(object.shape, meshes);
        if (triangles == 0 || !object.visible_to_camera || !has_float_corners(object.shape, meshes)) return;
        placed[key_of(object.shape, meshes)] += triangles;
        small.push_back({&list, number, object, triangles});
    };
    joined.objects.resize(scene.objects.size());
    joined.lights.resize(scene.lights.size());
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
        consider(joined.objects, i, scene.objects[i]);
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        if (const std::optional<LightShape> shaped = shape_of(scene.lights[i]))
            consider(joined.lights, i, shaped->object);
    std::erase_if(small,
                  [&](const Small& s) { return placed[key_of(s.object.shape, meshes)] > kMostOfAShape; });
    return small;
}

std::uint64_t triangles_in(std::span<const Small> small)
{
    std::uint64_t sum = 0;
    for (const Small& s : small)
        sum += s.triangles;
    return sum;
}

// In the frame that is traced in: the diagonal of the object's box, and its largest coordinate.
struct Extent {
    double size = 0, reach = 0;
};
Extent extent_of(const ObjectDescription& object, std::span<const MeshFacts> meshes, Vec3d world_origin)
{
    Bounds3d box;
    for (const Vec3d& corner : world_corners(object, meshes))
        box.extend(corner - world_origin);
    return {length(box.extent()), std::max(max_component(abs(box.lower)), max_component(abs(box.upper)))};
}

} // namespace

std::uint64_t triangles_of(const Shape& shape, std::span<const MeshFacts> meshes)
{
    if (std::holds_alternative<BoxShape>(shape)) return unit_box().triangles.size();
    if (std::holds_alternative<RectangleShape>(shape)) return unit_rectangle().triangles.size();
    const auto* const mesh = std::get_if<MeshShape>(&shape);
    if (mesh == nullptr || mesh->mesh >= meshes.size()) return 0;
    const MeshFacts& facts = meshes[mesh->mesh];
    if (mesh->part.empty()) return facts.triangles;
    const auto part = facts.parts.find(mesh->part);
    return part == facts.parts.end() ? 0 : part->second.triangle_count;
}

JoinedObjects
choose_joined(const SceneDescription& scene, std::span<const MeshFacts> meshes, Vec3d world_origin)
{
    JoinedObjects joined;
    const std::vector<Small> small = small_ones(scene, meshes, joined);
    std::vector<Extent> extents;
    double reach = 0;
    for (const Small& s : small) {
        extents.push_back(extent_of(s.object, meshes, world_origin));
        reach = std::max(reach, extents.back().reach);
    }
    if (!(reach >= kLeastReach && reach <= kMostReach)) return joined;
    std::vector<Small> chosen;
    for (std::size_t i = 0; i < small.size(); ++i)
        if (extents[i].size >= kLeastShareOfReach * reach) chosen.push_back(small[i]);
    const std::uint64_t triangles = triangles_in(chosen);
    if (chosen.size() < 2 || triangles > kMostInAll) return joined;
    for (const Small& s : chosen)
        (*s.list)[s.number] = true;
    joined.count = chosen.size();
    joined.triangles = triangles;
    return joined;
}

std::uint64_t most_joined_triangles(const SceneDescription& scene, std::span<const MeshFacts> meshes)
{
    JoinedObjects nobody;
    return std::min(triangles_in(small_ones(scene, meshes, nobody)), kMostInAll);
}

} // namespace renderer
