#include "renderer/plan/budget.h"

#include "renderer/description/textured_values.h"
#include "renderer/parallel/thread_pool.h"
#include "renderer/plan/joined_objects.h"
#include "renderer/plan/mesh_trees.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

namespace renderer {

namespace {

// Sums, and the mean that is made of them.
constexpr std::uint64_t kSumBytes = 3 * sizeof(double), kMeanBytes = 12;
// The same of each layer: see film/layer_sums.h.
constexpr std::array<std::uint64_t, kLayers.size()> kLayerSumBytes{16, 24, 24, 0},
    kLayerMeanBytes{4, 12, 12, 4};
// 47 to 52 in meshes of many kinds, more where triangles are strewn points.
constexpr std::uint64_t kTreeBytesPerTriangle = 50;
// Items twice and the binary tree, less what is there in the end.
constexpr std::uint64_t kBuildingBytesPerTriangle = 28;
// The scene's own words, as they came, as they were read and with every default filled in; and how an object is shaded.
constexpr std::uint64_t kBytesPerObject = kInstanceBytes + 90 + 2 * sizeof(ObjectDescription) + 96;
constexpr std::uint64_t kResidualBytesPerVertex = 12, kResidualBytesPerTriangle = 48; // joined; in leaves
// Three corners of their own, indices, and where it came from; residuals.
constexpr std::uint64_t kJoinedBytesPerTriangle =
    3 * 12 + 12 + 32 + 3 * kResidualBytesPerVertex + kResidualBytesPerTriangle;

std::uint64_t most_references(std::uint64_t triangles, MeshTree tree)
{
    if (tree != MeshTree::wide_spatial) return triangles;
    return static_cast<std::uint64_t>(static_cast<double>(triangles) * kMostReferences);
}

// Sums are given back before the layers' means are made (film/film.h: finish), and what is encoded and kept of a picture afterwards
// takes less than they did.
std::uint64_t film_bytes_per_pixel(LayerSet layers)
{
    std::uint64_t sums = 0, means = 0;
    for (const LayerEntry& entry : kLayers) {
        if (!layers.has(entry.layer)) continue;
        sums += kLayerSumBytes[static_cast<std::size_t>(entry.layer)];
        means += kLayerMeanBytes[static_cast<std::size_t>(entry.layer)];
    }
    return kMeanBytes + sums + std::max(kSumBytes, means);
}

// Of what shines: itself, where it is found again, its two nodes of the tree of lights, and what that is built from.
constexpr std::uint64_t kEmitterBytes = 176 + 40 + 2 * 104 + 92;

std::uint64_t
emitters_of(const ObjectDescription& object, const SceneDescription& scene, std::span<const MeshFacts> meshes)
{
    const std::uint64_t triangles = triangles_of(object.shape, meshes);
    if (object.material && *object.material < scene.materials.size()) {
        const Material& material = scene.materials[*object.material].material;
        return std::holds_alternative<EmitterMaterial>(material) ? std::max<std::uint64_t>(triangles, 1) : 0;
    }
    const auto* const mesh = std::get_if<MeshShape>(&object.shape);
    if (mesh == nullptr || mesh->mesh >= meshes.size()) return 0;
    return std::min(meshes[mesh->mesh].shining_triangles, triangles);
}

// Parts that name the same triangles share a tree; one that names all has the mesh's own.
std::uint64_t triangles_of_parts(const SceneDescription& scene, std::span<const MeshFacts> meshes)
{
    std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> runs;
    std::uint64_t triangles = 0;
    for (const ObjectDescription& object : scene.objects) {
        const auto* const shape = std::get_if<MeshShape>(&object.shape);
        if (shape == nullptr || shape->part.empty() || shape->mesh >= meshes.size()) continue;
        const MeshFacts& facts = meshes[shape->mesh];
        const auto part = facts.parts.find(shape->part);
        if (part == facts.parts.end() || part->second.triangle_count == facts.triangles) continue;
        const PartFacts& run = part->second;
        if (runs.emplace(shape->mesh, run.first_triangle, run.triangle_count).second)
            triangles += run.triangle_count;
    }
    return triangles;
}

std::string refused(std::uint64_t value, const std::string& what, const char* limit_name, std::uint64_t limit)
{
    return std::to_string(value) + " " + what + ", the limit `" + limit_name + "` is " +
           std::to_string(limit);
}

// Radiance and running sums: see lights/environment_map.h.
constexpr std::uint64_t kEnvironmentBytesPerPixel = 12 + 4;

// Tables of an air, a group of four wavelengths each, and of the views from the eye; and what the orders of scattering take
// while they are added up, once for all groups. Measured, as all that mallocs leave behind: what a second group is made in
// stays with the process.
struct SkyBytes {
    std::uint64_t kept, building;
};
SkyBytes sky_bytes(const AtmosphereDescription& a)
{
    const std::uint64_t groups = (a.wavelengths_nm.size() + 3) / 4;
    if (a.scattering == SkyScattering::single) return {groups * 1'000'000, 0};
    const bool is_exact = a.mode == SkyMode::exact;
    const std::uint64_t tables = groups * (is_exact ? 5'000'000 : 4'500'000);
    const std::uint64_t orders = is_exact ? 85'000'000 : 21'000'000;
    if (groups < 2) return {tables, orders};
    return {tables + orders, groups * (is_exact ? 14'000'000 : 4'000'000)};
}

} // namespace

std::uint64_t tree_bytes(std::uint64_t triangles, MeshTree tree)
{
    return most_references(triangles, tree) * kTreeBytesPerTriangle;
}

std::uint64_t tree_building_bytes(std::uint64_t triangles, MeshTree tree)
{
    return most_references(triangles, tree) * kBuildingBytesPerTriangle;
}

std::uint64_t rendered_pixels(const ImageSettings& image)
{
    return image.region ? std::uint64_t{image.region->width} * image.region->height
                        : std::uint64_t{image.width_px} * image.height_px;
}

void add_mesh(Budget& budget, const MeshFacts& mesh, const MeshUse& use, MeshTree tree)
{
    const MeshUse kept = mesh.is_shared ? MeshUse{true, true, true} : use;
    budget.triangles += mesh.triangles;
    budget.mesh_bytes += array_bytes(mesh, kept) + tree_bytes(mesh.triangles, tree);
    if (mesh.has_residuals)
        budget.mesh_bytes += most_references(mesh.triangles, tree) * kResidualBytesPerTriangle;
    budget.building_bytes = std::max(budget.building_bytes, tree_building_bytes(mesh.triangles, tree));
    if (kept.materials) budget.texture_bytes += mesh.image_bytes;
    if (use.materials) budget.texture_bytes += mesh.image_bytes / 3; // the levels, which are made for a scene
}

namespace {

// Of each image: a picture of the surroundings alone has no levels.
std::vector<bool> are_on_surfaces(const SceneDescription& scene, std::size_t images)
{
    std::vector<bool> found(images);
    const auto find = [&](std::uint32_t image) {
        if (image < images) found[image] = true;
    };
    for (const NamedMaterial& named : scene.materials) {
        if (const TextureUse* const tilt = normal_map_of(named.material)) find(tilt->image);
        for_each_textured(named.material, [&](const auto& value) {
            if (value.texture) find(value.texture->image);
        });
    }
    return found;
}

// Results wait for an older one, seldom more than render() has in hand at once: see kMergeBytes for the most.
std::uint64_t merge_bytes(const AccelerationSettings& settings)
{
    const std::uint64_t side = settings.tile_px;
    return std::min(kMergeBytes,
                    std::uint64_t{threads_of(settings)} * kUnitsAThread * side * side * kSumBytes);
}

} // namespace

unsigned threads_of(const AccelerationSettings& settings)
{
    return settings.threads != 0 ? settings.threads : usable_cores();
}

void add_image(Budget& budget, const ImageFacts& image)
{
    // Of the level at hand, as numbers, and of the next.
    constexpr std::uint64_t kPlaneBytesPerPixel = 4 * sizeof(float) + sizeof(float);
    budget.texture_bytes += image.bytes + image.bytes / 3;
    budget.building_bytes =
        std::max(budget.building_bytes, std::uint64_t{image.width} * image.height * kPlaneBytesPerPixel);
}

Budget predict(const SceneDescription& scene,
               std::span<const MeshFacts> meshes,
               const RenderSettings& settings,
               std::span<const ImageFacts> images)
{
    Budget b;
    const ImageSettings& image = settings.image;
    b.pixels = rendered_pixels(image);
    b.film_bytes = b.pixels * film_bytes_per_pixel(image.layers) + merge_bytes(settings.acceleration);
    b.mesh_bytes = scene.objects.size() * kBytesPerObject + tree_bytes(triangles_of_parts(scene, meshes));
    const std::uint64_t joined = most_joined_triangles(scene, meshes);
    b.mesh_bytes += tree_bytes(joined) + joined * kJoinedBytesPerTriangle;
    for (const ObjectDescription& object : scene.objects)
        b.mesh_bytes += emitters_of(object, scene, meshes) * kEmitterBytes;
    b.building_bytes = std::max(scene.objects.size() * kInstanceBuildingBytes, tree_building_bytes(joined));
    if (!meshes.empty()) {
        const std::vector<MeshUse> uses = uses_of(scene, meshes);
        const MeshTrees trees(scene, settings);
        for (std::size_t i = 0; i < meshes.size(); ++i)
            add_mesh(b, meshes[i], uses[i], trees.of(meshes[i].triangles));
    }
    if (const auto* const sky =
            scene.environment ? std::get_if<ImageEnvironment>(&*scene.environment) : nullptr;
        sky != nullptr && sky->image < images.size())
        b.texture_bytes +=
            std::uint64_t{images[sky->image].width} * images[sky->image].height * kEnvironmentBytesPerPixel;
    if (const auto* const air =
            scene.environment ? std::get_if<AtmosphereDescription>(&*scene.environment) : nullptr) {
        const SkyBytes sky = sky_bytes(*air);
        b.texture_bytes += sky.kept;
        b.building_bytes = std::max(b.building_bytes, sky.building);
    }
    const std::vector<bool> on_surfaces = are_on_surfaces(scene, images.size());
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (on_surfaces[i])
            add_image(b, images[i]);
        else
            b.texture_bytes += images[i].bytes;
    }
    if (settings.acceleration.levels == BvhLevels::none)
        for (const ObjectDescription& object : scene.objects)
            b.listed_triangles += triangles_of(object.shape, meshes);
    return b;
}

// Trees are built before there is a film.
std::uint64_t memory_bytes(const Budget& budget)
{
    return std::max(budget.film_bytes, budget.building_bytes) + budget.mesh_bytes + budget.texture_bytes;
}

void check_budget(const Budget& budget, const Limits& limits, FaultList& faults)
{
    if (budget.pixels > limits.image_pixels)
        faults.add(
            {"/image", "over_limit", refused(budget.pixels, "pixels", "image_pixels", limits.image_pixels)});
    if (budget.triangles > limits.triangles)
        faults.add({"/scene/objects",
                    "over_limit",
                    refused(budget.triangles, "triangles", "triangles", limits.triangles)});
    if (budget.listed_triangles > limits.listed_triangles)
        faults.add({"/acceleration/bvh/levels",
                    "over_limit",
                    refused(budget.listed_triangles,
                            "triangles to test every ray against without a tree",
                            "listed_triangles",
                            limits.listed_triangles)});
    const bool film_is_most = budget.film_bytes >= budget.building_bytes;
    const std::uint64_t transient = film_is_most ? budget.film_bytes : budget.building_bytes;
    const std::uint64_t memory = memory_bytes(budget);
    if (memory > limits.render_memory_bytes)
        faults.add({film_is_most && budget.film_bytes > budget.mesh_bytes ? "/image" : "/scene/objects",
                    "over_limit",
                    refused(memory,
                            "bytes of memory (" + std::to_string(transient) +
                                (film_is_most ? " for the picture, " : " to build trees and tables, ") +
                                std::to_string(budget.mesh_bytes) + " for meshes" +
                                (budget.texture_bytes > 0
                                     ? ", " + std::to_string(budget.texture_bytes) + " for textures)"
                                     : ")"),
                            "render_memory_bytes",
                            limits.render_memory_bytes)});
}

} // namespace renderer
