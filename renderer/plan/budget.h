// budget: what a render will hold in memory, estimated before its film and the trees of its parts are made.
//
// Units   bytes; an estimate from the counts, not a bound: trees differ in their leaves, allocators in what
//         they keep.
// Usage   predict() knows the whole; a caller that gets its meshes one after the other adds each to the budget
//         of the scene without meshes, and so need not hold more than the limits allow.
#pragma once

#include "renderer/description/fault_list.h"
#include "renderer/description/limits.h"
#include "renderer/description/scene_description.h"
#include "renderer/description/settings.h"
#include "renderer/plan/mesh_use.h"
#include "renderer/plan/plan.h"

#include <cstdint>
#include <span>

namespace renderer {

// Results that wait to be merged in their order: render() keeps below this, whatever threads and tiles.
inline constexpr std::uint64_t kMergeBytes = 32u << 20;
// As many units may wait for each thread in any case, or it would sleep while another one's takes long.
inline constexpr unsigned kUnitsAThread = 4;

unsigned
threads_of(const AccelerationSettings& settings); // that a render takes: as asked, or every usable core

std::uint64_t rendered_pixels(const ImageSettings& image); // of its region

// A tree over so many triangles: its nodes and leaves, and what is held beside them at most while it is built.
std::uint64_t tree_bytes(std::uint64_t triangles, MeshTree tree = MeshTree::wide_sah);
std::uint64_t tree_building_bytes(std::uint64_t triangles, MeshTree tree = MeshTree::wide_sah);
// The same for each object of the upper level.
inline constexpr std::uint64_t kInstanceBytes = 468, kInstanceBuildingBytes = 150;

struct Budget {
    std::uint64_t pixels = 0;           // of the region that is rendered
    std::uint64_t triangles = 0;        // each mesh counted once
    std::uint64_t listed_triangles = 0; // that every ray is tested against, where no tree is asked for
    // Sums, results on their way to them, the finished picture and its layers, its PNG, what is kept of all.
    std::uint64_t film_bytes = 0;
    // Vertices, indices, a BVH for each mesh and each different part, what shines of them.
    std::uint64_t mesh_bytes = 0;
    std::uint64_t texture_bytes = 0;  // pictures as decoded, and their levels; those of meshes too
    std::uint64_t building_bytes = 0; // for the largest of the trees, before there is a film
};

Budget predict(const SceneDescription& scene,
               std::span<const MeshFacts> meshes,
               const RenderSettings& settings,
               std::span<const ImageFacts> images = {});

// One mesh with its tree, without those of its parts; of a shared one all, of another what the scene asks of it.
void add_mesh(Budget& budget, const MeshFacts& mesh, const MeshUse& use, MeshTree tree);

// One picture of the scene's, with its levels.
void add_image(Budget& budget, const ImageFacts& image);

// What is held at once, at most.
std::uint64_t memory_bytes(const Budget& budget);

// One fault for each limit that the budget passes, with the number and the limit.
void check_budget(const Budget& budget, const Limits& limits, FaultList& faults);

} // namespace renderer
