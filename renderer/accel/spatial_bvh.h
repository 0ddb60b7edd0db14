// build_spatial_bvh: a tree over the triangles of a mesh that may hold one in several leaves, for rays that have nothing
// in common: it costs more to build and, where triangles are long, more memory.
//
// Splits   as build_bvh's, and by a plane (spatial_split.h) where the boxes of both sides would overlap much.
// Promise  as build_bvh's: depth, and the same tree on any number of threads. `order` is at most
//          kMostReferences times as long as `items`, and names a triangle as often as leaves hold it; no leaf does twice.
// Errors   nothing only when `stop` was requested.
#pragma once

#include "renderer/accel/bvh.h"
#include "renderer/geometry/mesh.h"

namespace renderer {

// `items` of `mesh` as triangle_items() makes them, with its scale; they are used up.
std::optional<Bvh<float>> build_spatial_bvh(const Mesh& mesh,
                                            float scale,
                                            PlainArray<BuildItem<float>> items,
                                            const BvhOptions& options,
                                            ThreadPool& pool,
                                            const std::stop_token& stop = {});

} // namespace renderer
