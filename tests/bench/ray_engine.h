// RayEngine: what the ray benchmark asks of an engine: build over a mesh, then trace rays; one class an
// engine and mode.
#pragma once

#include "renderer/geometry/mesh.h"
#include "tests/bench/ray_sets.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace bench {

class RayEngine {
public:
    virtual ~RayEngine() = default;
    virtual std::string name() const = 0;
    virtual void build() = 0; // again, from nothing, on one thread
    // Memory that traversal reads: nodes and leaves; vertices apart where they are stored apart.
    virtual std::uint64_t bytes() const = 0;
    virtual std::uint64_t vertex_bytes() const = 0;
    // The number of rays that hit. Called from several threads at once, on runs of 16 rays but for the last.
    virtual std::uint64_t trace(const RaySet& set, std::span<const FloatRay> rays) const = 0;
};

// With the best kernel of this processor, or one engine a kernel, the best first. The mesh outlives them.
std::vector<std::unique_ptr<RayEngine>>
make_heliograph_engines(const renderer::Mesh& mesh, renderer::BvhSplit split, bool every_kernel);

// Every mode of Embree; none where this program was built without it. The mesh outlives them.
std::vector<std::unique_ptr<RayEngine>> make_embree_engines(const renderer::Mesh& mesh);

} // namespace bench
