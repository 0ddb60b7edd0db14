// What `heliograph-bench evaluation` renders and what it found: the same picture with ever more of what makes it
// fast.
#pragma once

#include "renderer/description/scene_description.h"
#include "renderer/description/settings.h"
#include "renderer/geometry/mesh.h"
#include "tests/bench/spread.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace bench {

// How the work of a picture reaches the threads.
enum class Scheduler : std::uint8_t { pool, async_a_tile, async_a_pixel };

struct Variant {
    std::string name;
    renderer::AccelerationSettings acceleration; // threads 0: every core
    Scheduler scheduler = Scheduler::pool;
};

struct Subject {
    std::string name;
    renderer::SceneDescription scene;
    std::vector<renderer::Mesh> meshes; // of scene.meshes
    renderer::RenderSettings settings;  // without acceleration
};

struct Row {
    std::string variant;
    renderer::AccelerationSettings acceleration;
    Scheduler scheduler = Scheduler::pool;
    unsigned threads = 1;
    Spread wall_s, cpu_s;       // of one picture
    Spread prepare_cpu_s;       // trees and tables
    std::uint32_t pictures = 1; // one measurement: several, where one is over too soon
    bool same_picture = true;   // bit for bit as the first row's
};

// One scene in one figure.
struct Comparison {
    std::string subject;
    std::uint64_t triangles = 0, objects = 0; // triangles of all objects, instances counted
    std::uint32_t width_px = 0, height_px = 0, samples = 0;
    double relative_rmse = 0; // to the same picture of many samples: what the time bought
    std::vector<Row> rows;
};

struct Figure {
    std::string name, title, note; // name: of its file
    bool wall = false;             // what its chart shows: time on the wall, or of the processor
    std::vector<Comparison> comparisons;
};

// Variants take turns within every repeat.
Comparison compare(const Subject& subject, const std::vector<Variant>& variants, int repeats);

struct EvaluationReport {
    int repeats = 0;
    std::vector<Figure> figures; // the last one holds the headline: its first row against its last
};
nlohmann::json to_json(const EvaluationReport& report);
void print_table(const EvaluationReport& report);
void write_charts(const EvaluationReport& report, const std::filesystem::path& folder); // NAME.svg each

} // namespace bench
