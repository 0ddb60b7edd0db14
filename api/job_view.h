// JobView: what a client may know of a job, and its JSON. The server fills it from its own records.
#pragma once

#include "api/problem.h"
#include "renderer/description/layers.h"
#include "renderer/description/report.h"
#include "renderer/description/settings.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace api {

enum class JobState : std::uint8_t {
    queued,
    preparing,
    running,
    canceling,
    succeeded,
    failed,
    canceled,
    expired
};

bool is_final(JobState state);
const char* name_of(JobState state);
std::optional<JobState> job_state_from_name(const std::string& name);
std::vector<std::string> job_state_names();

struct JobView {
    std::string id;
    JobState state = JobState::queued;
    std::int64_t created_ms = 0; // Unix time; written as RFC 3339 with milliseconds
    std::optional<std::int64_t> started_ms, finished_ms;
    double progress = 0; // 0 to 1
    std::uint32_t samples_done = 0;
    std::optional<std::uint32_t> queue_position; // 0: next; while queued
    bool reused = false;
    std::string render_key; // "sha256:..."
    int priority = 50;
    std::map<std::string, std::string> labels;
    std::uint32_t attempts = 0;
    renderer::LayerSet layers;           // that it was asked for
    std::optional<ProblemDetails> error; // when failed
};

// The job object: fields above, and `links` {self, image, report, scene, cancel}, where layers were asked for
// also layers {name: link}.
std::string write_job_view(const JobView& view);
// A failed job's list of faults is left out: write_job_view has it.
std::string write_job_list(const std::vector<JobView>& views, const std::string& next_cursor);

// What a dry run answers: the plan's choices and what it predicts.
std::string write_plan(const renderer::PlanReport& plan, bool pretty = true);

// report.json: accuracy, models, numerics, timing, geometry. `requested`: the request's settings.quality.
std::string write_report(const renderer::RenderReport& report,
                         const std::string& job_id,
                         const std::string& render_key,
                         const renderer::QualitySettings& requested,
                         bool pretty = true);
// A report as another job's, which shares the render: the same but for its name. Throws std::invalid_argument
// if it is none.
std::string readdress_report(const std::string& report, const std::string& job_id);
// JSON text as people read it, a member a line; other text as it is.
std::string indented(const std::string& json);

// Asset answers.
struct AssetInfo {
    std::string digest;
    std::uint64_t bytes = 0;
    // Engaged where the bytes are a mesh that imports by itself.
    struct MeshInfo {
        std::string format;
        std::uint64_t triangles = 0, vertices = 0, degenerate_triangles = 0;
        double lower[3]{}, upper[3]{};
        std::vector<std::string> materials, textures, parts, notes;
        bool has_normals = false, has_uvs = false;
    };
    std::optional<MeshInfo> mesh;
    // Engaged where they are a picture.
    struct ImageInfo {
        std::string format; // its name in image_formats.h
        std::uint32_t width = 0, height = 0;
        std::uint32_t channels = 0; // 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA
        std::uint32_t bits = 0;     // of a channel; 32: floats
    };
    std::optional<ImageInfo> image;
    std::optional<Problem> fault; // why it does not import
};
std::string write_asset(const std::string& digest, std::uint64_t bytes);
std::string write_asset_info(const AssetInfo& info);

} // namespace api
