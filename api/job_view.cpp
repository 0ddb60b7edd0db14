#include "api/job_view.h"

#include "api/json/json.h"
#include "api/words/time_words.h"
#include "api/write/problem_json.h"

#include <array>

namespace api {

namespace {

constexpr std::array kStateNames{
    "queued", "preparing", "running", "canceling", "succeeded", "failed", "canceled", "expired"};

Json links_of(const JobView& view)
{
    const std::string self = "/v1/jobs/" + view.id;
    Json links{{"self", self},
               {"image", self + "/image"},
               {"report", self + "/report"},
               {"scene", self + "/scene"},
               {"cancel", self + "/cancel"}};
    for (const renderer::LayerEntry& entry : renderer::kLayers)
        if (view.layers.has(entry.layer))
            links["layers"][std::string(entry.name)] = self + "/layers/" + std::string(entry.name);
    return links;
}

Json job_json(const JobView& view)
{
    Json json{{"id", view.id},
              {"state", name_of(view.state)},
              {"created", rfc3339(view.created_ms)},
              {"progress", view.progress},
              {"samples_done", view.samples_done},
              {"reused", view.reused},
              {"render_key", view.render_key},
              {"priority", view.priority},
              {"labels", view.labels},
              {"attempts", view.attempts},
              {"links", links_of(view)}};
    if (view.started_ms) json["started"] = rfc3339(*view.started_ms);
    if (view.finished_ms) json["finished"] = rfc3339(*view.finished_ms);
    if (view.queue_position) json["queue_position"] = *view.queue_position;
    if (view.error) json["error"] = problem_json(*view.error);
    return json;
}

} // namespace

bool is_final(JobState state)
{
    switch (state) {
    case JobState::queued:
    case JobState::preparing:
    case JobState::running:
    case JobState::canceling:
        return false;
    case JobState::succeeded:
    case JobState::failed:
    case JobState::canceled:
    case JobState::expired:
        return true;
    }
    return true;
}

const char* name_of(JobState state)
{
    return kStateNames.at(static_cast<std::size_t>(state));
}

std::optional<JobState> job_state_from_name(const std::string& name)
{
    for (std::size_t i = 0; i < kStateNames.size(); ++i)
        if (name == kStateNames[i]) return static_cast<JobState>(i);
    return std::nullopt;
}

std::vector<std::string> job_state_names()
{
    return {kStateNames.begin(), kStateNames.end()};
}

std::string write_job_view(const JobView& view)
{
    return text_of(job_json(view));
}

std::string write_job_list(const std::vector<JobView>& views, const std::string& next_cursor)
{
    Json json{{"jobs", Json::array()}};
    for (const JobView& view : views) {
        Json& job = json["jobs"].emplace_back(job_json(view));
        if (view.error)
            job["error"]["errors"] = Json::array(); // its summary tells how many: the job itself has them
    }
    if (!next_cursor.empty()) json["next_cursor"] = next_cursor;
    return text_of(json);
}

} // namespace api
