// PreparedMesh: an imported mesh with its BVH, ready for rays; immutable, shared by scenes and jobs.
//
// Frame   rays are given in the mesh's own coordinates (object space).
// Errors  prepare_mesh returns nullptr only when `stop` was requested; it throws std::bad_alloc like any builder.
#pragma once

#include "renderer/description/settings.h"
#include "renderer/geometry/mesh.h"
#include "renderer/parallel/thread_pool.h"

#include <cstdint>
#include <memory>
#include <stop_token>

namespace renderer {

class PreparedMesh;

// Builds the BVH; deterministic: the same mesh and split give the same tree on any number of threads.
std::shared_ptr<const PreparedMesh> prepare_mesh(Mesh mesh, BvhSplit split, ThreadPool& pool, std::stop_token stop = {});

const Mesh& mesh_of(const PreparedMesh& prepared);
std::uint64_t size_bytes(const PreparedMesh& prepared);          // all memory it holds: what a cache counts
std::uint64_t bvh_bytes(const PreparedMesh& prepared);           // nodes + leaves, without the vertices
std::uint64_t degenerate_triangles(const PreparedMesh& prepared); // zero area: kept in the count, never hit

} // namespace renderer
