// PreparedMesh: an imported mesh, or one part of it, with its BVH, ready for rays; immutable, shared by
// scenes and jobs.
//
// Frame   rays are given in the mesh's own coordinates (object space).
// Errors  prepare_* returns nullptr only when `stop` was requested; it throws std::bad_alloc like any
// builder.
#pragma once

#include "renderer/accel/tree_bytes.h"
#include "renderer/description/settings.h"
#include "renderer/geometry/mesh.h"
#include "renderer/parallel/thread_pool.h"

#include <cstdint>
#include <memory>
#include <stop_token>

namespace renderer {

class BaselineMesh;
class MeshBvh;
class PreparedMesh;

// Builds the BVH; deterministic: the same mesh gives the same tree on any number of threads.
std::shared_ptr<const PreparedMesh>
prepare_mesh(Mesh mesh, MeshTree tree, ThreadPool& pool, const std::stop_token& stop = {});

// The same mesh with another tree; the arrays are shared.
std::shared_ptr<const PreparedMesh> prepare_again(const std::shared_ptr<const PreparedMesh>& prepared,
                                                  MeshTree tree,
                                                  ThreadPool& pool,
                                                  const std::stop_token& stop = {});

// Only the triangles of `part`, a run of the whole mesh's; the arrays stay shared with `whole`, and
// primitives keep the numbers that they have there.
std::shared_ptr<const PreparedMesh> prepare_part(const std::shared_ptr<const PreparedMesh>& whole,
                                                 const MeshPart& part,
                                                 MeshTree tree,
                                                 ThreadPool& pool,
                                                 const std::stop_token& stop = {});

const Mesh& mesh_of(const PreparedMesh& prepared); // of a part: the whole mesh
// One of the two, by the tree that was asked for; the other is nullptr.
const MeshBvh* bvh_of(const PreparedMesh& prepared);           // wide: see mesh_bvh.h
const BaselineMesh* baseline_of(const PreparedMesh& prepared); // binary, or none: see baseline_mesh.h
std::uint64_t size_bytes(
    const PreparedMesh& prepared); // all memory it holds: what a cache counts; a part: without the arrays
std::uint64_t bvh_bytes(const PreparedMesh& prepared);            // nodes + leaves, without the vertices
std::uint64_t degenerate_triangles(const PreparedMesh& prepared); // zero area: kept in the count, never hit

// Of one that has a MeshBvh, else nothing; valid as long as `prepared` is.
TreeBytes tree_bytes(const PreparedMesh& prepared);

// What tree_bytes() was of. The arrays stay where they are, which `keeper` keeps. Nothing if the sizes do not
// fit; that the bytes are what they were is for the caller to know.
std::shared_ptr<const PreparedMesh>
prepared_from(Mesh mesh, const TreeBytes& tree, const std::shared_ptr<const void>& keeper);

} // namespace renderer
