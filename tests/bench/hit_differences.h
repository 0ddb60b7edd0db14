// compare_hits: how many rays of a set two engines answer differently, and why.
//
// The test in double of renderer/geometry/triangle.h, asked about the very triangle, says who is right.
#pragma once

#include "renderer/geometry/mesh.h"
#include "tests/bench/ray_engine.h"

#include <cstdint>
#include <span>

namespace bench {

// Rays, by what was answered and by why.
struct HitDifferences {
    std::uint64_t only_ours = 0, only_theirs = 0, other_triangle = 0;

    std::uint64_t same_t =
        0; // another triangle, at the same t to float rounding: a shared edge, or two in one place
    std::uint64_t at_edge = 0; // decided within kRoundings roundings of a float from an edge of the triangle
    std::uint64_t at_end = 0;  // within as much of where the ray begins or ends
    std::uint64_t unexplained = 0;
    std::uint64_t ours_wrong = 0; // the test accepts the triangle that only they found: a fault of ours

    std::uint64_t total() const { return only_ours + only_theirs + other_triangle; }
    static constexpr double kRoundings = 64;
};

// One answer a ray. Where any hit will do, the triangles are asked for again, as closest hits.
struct Answers {
    const RayEngine& engine;
    std::span<const FoundHit> hits;
};
HitDifferences
compare_hits(const renderer::Mesh& mesh, const RaySet& set, const Answers& ours, const Answers& theirs);

} // namespace bench
