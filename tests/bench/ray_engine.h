// RayEngine: what the ray benchmark asks of an engine: build over a mesh, then trace rays; one class an
// engine, one object a mode.
#pragma once

#include "renderer/geometry/mesh.h"
#include "tests/bench/ray_sets.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace bench {

struct FoundHit {
    static constexpr std::uint32_t kMiss = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t triangle = kMiss; // where any hit will do: not kMiss, and nothing more
    double t = 0;                   // of the closest hit
};

class RayEngine {
public:
    virtual ~RayEngine() = default;
    virtual std::string name() const = 0;
    // Engines of one tree build the same; the first of them is timed.
    virtual std::string tree() const = 0;
    virtual bool high_quality() const = 0;
    // Builds in a process of its own and times it there. Called while the process has one thread.
    struct BuildCost {
        double wall_s, cpu_s; // of all threads
    };
    virtual BuildCost time_build(unsigned threads) const = 0;

    virtual void build() = 0; // to be traced, on every core
    // Memory that traversal reads: nodes and leaves; vertices apart where they are stored apart.
    virtual std::uint64_t bytes() const = 0;
    virtual std::uint64_t vertex_bytes() const = 0;
    // The number of rays that hit, and what each hit where `found` is not null. Called from several threads at
    // once, on runs of 16 rays but for the last.
    virtual std::uint64_t
    trace(const RaySet& set, std::span<const FloatRay> rays, FoundHit* found = nullptr) const = 0;
};

// Of a word of the contract.
renderer::BvhSplit split_named(const std::string& name);

// With the best kernel of this processor, or one engine a kernel, the best first. The mesh outlives them.
std::vector<std::unique_ptr<RayEngine>>
make_heliograph_engines(const renderer::Mesh& mesh, renderer::BvhSplit split, bool every_kernel);

// Every mode of Embree; none where this program was built without it. The mesh outlives them.
std::vector<std::unique_ptr<RayEngine>> make_embree_engines(const renderer::Mesh& mesh);

} // namespace bench
