// joined_objects: which objects of a scene are put together as one mesh with one tree (accel/joined_mesh.h).
//
// Why     a ray that is taken to each of a handful of rectangles and boxes pays for the trip, not for what it meets there.
// Rule    of meshes, boxes and rectangles, lights among them, that every ray sees: those of at most 4096 triangles in all
//         the places where the same shape stands, with corners that are floats, and no smaller than 2^-12 of the largest
//         coordinate of all of them, so that floats in the common frame are fine enough to tell their triangles apart; two
//         at least, and 65,536 triangles at most: of more, none are.
#pragma once

#include "renderer/description/scene_description.h"
#include "renderer/plan/plan.h"

#include <cstdint>
#include <span>

namespace renderer {

// Of an object; those of a mesh that is not known yet are not counted.
std::uint64_t triangles_of(const Shape& shape, std::span<const MeshFacts> meshes);

// The scene has passed check_description; `world_origin` is the plan's.
JoinedObjects
choose_joined(const SceneDescription& scene, std::span<const MeshFacts> meshes, Vec3d world_origin);

// At most so many are joined, wherever the frame is: for estimates before there is one.
std::uint64_t most_joined_triangles(const SceneDescription& scene, std::span<const MeshFacts> meshes);

} // namespace renderer
