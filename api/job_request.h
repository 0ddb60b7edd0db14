// JobRequest: a job's words, read and checked completely; and read_job, which turns bytes into one or into
// faults.
#pragma once

#include "api/problem.h"
#include "renderer/description/limits.h"
#include "renderer/description/scene_description.h"
#include "renderer/description/settings.h"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace api {

struct JobRequest {
    renderer::SceneDescription scene;
    renderer::RenderSettings settings;
    std::map<std::string, std::string> files; // name -> "sha256:<64 hex>", multipart parts included
    std::optional<double> time_limit_s;       // limits.time_s: the job fails when it takes longer
    int priority = 50;                        // 0 to 100, larger first
    std::map<std::string, std::string> labels;
    std::vector<std::string> fail_on; // "non_finite"
    bool provenance = true;
    friend bool operator==(const JobRequest&, const JobRequest&) = default;
};

// What read_job must know of the world around the request.
struct ReadContext {
    renderer::Limits limits{};
    std::map<std::string, std::string> files{};               // parts of a multipart request: name -> digest
    std::function<bool(std::string_view digest)> has_asset{}; // empty: every digest counts as there
    bool local = false; // CLI: a mesh name that is not in `files` is a path, and no fault
};

// Either the request or the answer that refuses it (400 malformed_json, 413, 422 invalid_scene with every
// fault).
std::variant<JobRequest, ProblemDetails> read_job(std::string_view json, const ReadContext& context);

// The job as JSON with every default written out and its keys sorted; read_job reads it back to an equal
// request, under limits that leave room for what the defaults add.
std::string write_job(const JobRequest& request, bool pretty = true);

// What render_key is the digest of: scene, image, quality, seed, mesh digests (with the names and digests of
// `files`, which an MTL or glTF may open), build. Two requests with the same text have the same picture.
std::string canonical_render_text(const JobRequest& request);

} // namespace api
