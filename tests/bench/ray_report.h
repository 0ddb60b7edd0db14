// RayReport: what `heliograph-bench rays` measured, and its two forms: JSON, and tables for people.
#pragma once

#include "tests/bench/hit_differences.h"
#include "tests/bench/spread.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace bench {

struct BuildFigures {
    unsigned threads = 1;
    Spread cpu_ms, wall_ms; // cpu: of all threads
};

// One engine on one set with one number of threads.
struct RayFigures {
    unsigned threads = 1;
    // Million rays a second; cpu: rays over the mean of the threads' processor time.
    Spread cpu, wall;
    std::vector<double> cpu_repeats; // in order, so that engines can be compared repeat by repeat
    std::uint64_t hits = 0, rays = 0;
};

struct SetFigures {
    std::string set;
    std::vector<RayFigures> figures;           // one a number of threads
    std::optional<HitDifferences> differences; // of a peer from the first engine's, which is ours
};

struct EngineReport {
    std::string name, tree;
    bool ours = false, high_quality = false;
    std::vector<BuildFigures> builds; // one a number of threads; none where builds are not timed
    double bytes_per_triangle = 0, vertex_bytes_per_triangle = 0;
    std::vector<SetFigures> sets;
};

// One mesh at one size. The first engine is ours, unless only peers were asked for.
struct RayReport {
    std::string mesh, view;
    std::uint64_t triangles = 0;
    double diagonal = 0;
    bool native = true; // the diagonal that the mesh came with
    int repeats = 0;
    std::size_t every = 1; // of so many runs of rays one was traced
    std::vector<EngineReport> engines;
};

nlohmann::json to_json(const std::vector<RayReport>& reports);
void print_table(const RayReport& report, std::FILE* out);

} // namespace bench
