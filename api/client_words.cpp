#include "api/client_words.h"

#include "api/json/json.h"
#include "api/json/parse_json.h"
#include "renderer/description/limits.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace api {
namespace {

std::optional<Json> parse_object(std::string_view text)
{
    auto parsed = parse_json(text, renderer::Limits::none());
    Json* json = std::get_if<Json>(&parsed);
    if (!json || !json->is_object()) return std::nullopt;
    return std::move(*json);
}

std::string string_of(const Json& json, const char* name)
{
    const auto found = json.find(name);
    return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

double number_of(const Json& json, const char* name)
{
    const auto found = json.find(name);
    return found != json.end() && found->is_number() ? found->get<double>() : 0;
}

std::uint32_t count_of(const Json& json, const char* name)
{
    const double number = number_of(json, name);
    return number >= 0 && number < 4294967296.0 ? static_cast<std::uint32_t>(number) : 0;
}

// RFC 3339 in UTC, as write_job_view writes it: "2025-01-31T12:00:00.000Z".
std::optional<std::int64_t> time_of(const Json& json, const char* name)
{
    int year = 0, month = 0, day = 0, hour = 0, minute = 0;
    double second = 0;
    const std::string text = string_of(json, name);
    if (std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%lfZ", &year, &month, &day, &hour, &minute, &second) !=
        6)
        return std::nullopt;
    const std::chrono::year_month_day date{std::chrono::year(year),
                                           std::chrono::month(static_cast<unsigned>(month)),
                                           std::chrono::day(static_cast<unsigned>(day))};
    if (!date.ok() || !(second >= 0 && second < 61)) return std::nullopt;
    const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
    return ((days * 24 + hour) * 60 + minute) * 60'000 + std::llround(second * 1000);
}

std::optional<JobView> view_of(const Json& json)
{
    if (!json.is_object()) return std::nullopt;
    JobView view;
    view.id = string_of(json, "id");
    const auto state = job_state_from_name(string_of(json, "state"));
    if (view.id.empty() || !state) return std::nullopt;
    view.state = *state;
    view.created_ms = time_of(json, "created").value_or(0);
    view.started_ms = time_of(json, "started");
    view.finished_ms = time_of(json, "finished");
    view.progress = number_of(json, "progress");
    view.samples_done = count_of(json, "samples_done");
    if (json.contains("queue_position") && json["queue_position"].is_number())
        view.queue_position = count_of(json, "queue_position");
    view.reused = json.contains("reused") && json["reused"].is_boolean() && json["reused"].get<bool>();
    view.render_key = string_of(json, "render_key");
    view.priority = static_cast<int>(count_of(json, "priority"));
    view.attempts = count_of(json, "attempts");
    if (json.contains("labels") && json["labels"].is_object())
        for (const auto& [name, value] : json["labels"].items())
            if (value.is_string()) view.labels[name] = value.get<std::string>();
    ProblemDetails error;
    if (json.contains("error") && read_problem(text_of(json["error"]), error)) view.error = std::move(error);
    return view;
}

} // namespace

std::optional<JobView> read_job_view(std::string_view json)
{
    const auto object = parse_object(json);
    return object ? view_of(*object) : std::nullopt;
}

std::optional<JobPage> read_job_list(std::string_view json)
{
    const auto object = parse_object(json);
    if (!object || !object->contains("jobs") || !(*object)["jobs"].is_array()) return std::nullopt;
    JobPage page;
    page.next_cursor = string_of(*object, "next_cursor");
    for (const Json& job : (*object)["jobs"]) {
        auto view = view_of(job);
        if (!view) return std::nullopt;
        page.jobs.push_back(*std::move(view));
    }
    return page;
}

std::string add_to_job(std::string_view json, const JobAdditions& additions)
{
    auto object = parse_object(json);
    if (!object) throw std::invalid_argument("add_to_job: not a job");
    for (const auto& [name, digest] : additions.files)
        (*object)["files"][name] = digest;
    if (additions.priority) (*object)["priority"] = *additions.priority;
    for (const auto& [name, value] : additions.labels)
        (*object)["labels"][name] = value;
    for (const renderer::LayerEntry& entry : renderer::kLayers) {
        if (!additions.layers.has(entry.layer)) continue;
        Json& names = (*object)["image"]["layers"];
        if (std::find(names.begin(), names.end(), std::string(entry.name)) == names.end())
            names.push_back(entry.name);
    }
    return text_of(*object);
}

} // namespace api
