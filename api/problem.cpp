#include "api/problem.h"

#include "api/json/json.h"
#include "api/json/parse_json.h"
#include "api/words/sentences.h"
#include "api/write/problem_json.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace api {

namespace {

struct Title {
    std::string_view code;
    std::string_view title;
};

constexpr std::array kTitles{
    Title{"asset_damaged", "Asset is damaged"},
    Title{"bad_request", "Request cannot be read"},
    Title{"busy", "Service is busy"},
    Title{"digest_mismatch", "Bytes do not match their digest"},
    Title{"draining", "Service is shutting down"},
    Title{"duplicate_name", "Two files have one name"},
    Title{"empty_body", "Body is empty"},
    Title{"expectation_failed", "Expectation cannot be met"},
    Title{"expired", "Result is no longer kept"},
    Title{"headers_too_large", "Headers are too large"},
    Title{"http_version", "HTTP version is not spoken"},
    Title{"idempotency_key_reuse", "Idempotency key belongs to another request"},
    Title{"internal", "Service failed"},
    Title{"invalid_digest", "Digest is not valid"},
    Title{"invalid_name", "File's name is not valid"},
    Title{"invalid_query", "Query is not valid"},
    Title{"invalid_scene", "Scene is not valid"},
    Title{"length_required", "Length is missing"},
    Title{"malformed_json", "Body is not valid JSON"},
    Title{"method_not_allowed", "Method is not allowed here"},
    Title{"missing_scene", "Scene is missing"},
    Title{"non_finite", "Picture has samples that are not finite"},
    Title{"not_acceptable", "No such representation"},
    Title{"not_found", "Not found"},
    Title{"out_of_memory", "Out of memory"},
    Title{"over_limit", "Over a limit"},
    Title{"queue_full", "Queue is full"},
    Title{"range_not_satisfiable", "Range lies outside"},
    Title{"render_failed", "Render failed"},
    Title{"request_timeout", "Request came too slowly"},
    Title{"result_damaged", "Result is damaged"},
    Title{"still_ending", "Job is still ending"},
    Title{"still_running", "Render is not finished"},
    Title{"storage_full", "Storage is full"},
    Title{"target_too_long", "Path is too long"},
    Title{"time_limit", "Time limit reached"},
    Title{"too_many_attempts", "Tried too often"},
    Title{"too_many_bodies", "Too many bodies at the same time"},
    Title{"too_many_connections", "Too many connections"},
    Title{"too_many_parts", "Too many files"},
    Title{"too_many_waiters", "Too many waiting requests"},
    Title{"unsupported_encoding", "Content encoding is not supported"},
    Title{"unsupported_media_type", "Content type is not supported"},
};

// Codes outside the table (a job's own failures) read as words: "import_crashed" -> "Import crashed".
std::string title_of(std::string_view code)
{
    for (const Title& entry : kTitles)
        if (entry.code == code) return std::string(entry.title);
    std::string title(code);
    std::replace(title.begin(), title.end(), '_', ' ');
    if (!title.empty() && title[0] >= 'a' && title[0] <= 'z')
        title[0] = static_cast<char>(title[0] - 'a' + 'A');
    return title.empty() ? "Error" : title;
}

std::string string_member(const Json& json, const char* name)
{
    const auto found = json.find(name);
    return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

bool read_fault(const Json& json, Problem& out)
{
    if (!json.is_object() || !json.contains("code")) return false;
    out = {string_member(json, "pointer"), string_member(json, "code"), string_member(json, "detail")};
    return true;
}

} // namespace

bool has_title(std::string_view code)
{
    return std::any_of(
        kTitles.begin(), kTitles.end(), [&](const Title& entry) { return entry.code == code; });
}

Json fault_json(const Problem& fault)
{
    return {{"pointer", fault.pointer}, {"code", fault.code}, {"detail", fault.detail}};
}

Json problem_json(const ProblemDetails& problem)
{
    Json json{{"type", "/problems/" + problem.code},
              {"title", title_of(problem.code)},
              {"status", problem.status},
              {"code", problem.code},
              {"detail", problem.detail},
              {"retryable", problem.retryable},
              {"request_id", problem.request_id},
              {"errors", Json::array()}};
    for (const Problem& fault : problem.errors)
        json["errors"].push_back(fault_json(fault));
    return json;
}

std::string write_problem(const ProblemDetails& problem)
{
    return text_of(problem_json(problem));
}

bool read_problem(const std::string& text, ProblemDetails& out)
{
    const auto parsed = parse_json(text, renderer::Limits::none());
    const Json* json = std::get_if<Json>(&parsed);
    if (!json || !json->is_object()) return false;
    const auto status = json->find("status"), code = json->find("code"), errors = json->find("errors");
    if (status == json->end() || !status->is_number_unsigned() || code == json->end() || !code->is_string())
        return false;
    if (status->get<std::uint64_t>() < 100 || status->get<std::uint64_t>() > 599) return false;
    ProblemDetails problem;
    problem.status = status->get<int>();
    problem.code = code->get<std::string>();
    problem.detail = string_member(*json, "detail");
    problem.request_id = string_member(*json, "request_id");
    const auto retryable = json->find("retryable");
    problem.retryable = retryable != json->end() && retryable->is_boolean() && retryable->get<bool>();
    if (errors != json->end()) {
        if (!errors->is_array()) return false;
        for (const Json& fault : *errors)
            if (!read_fault(fault, problem.errors.emplace_back())) return false;
    }
    out = std::move(problem);
    return true;
}

ProblemDetails problem_from_faults(int status, std::string code, std::vector<Problem> errors)
{
    ProblemDetails problem;
    problem.status = status;
    problem.code = std::move(code);
    if (!errors.empty()) {
        const Problem& first = errors.front();
        const std::string said = (first.pointer.empty() ? "" : shortened(first.pointer, 200) + ": ") +
                                 shortened(first.detail, 400);
        // The last line of a long list is no fault: it counts those that are not in it.
        const bool more = errors.back().code == "more_faults";
        const std::string count =
            more ? "more than " + std::to_string(errors.size() - 1) : std::to_string(errors.size());
        problem.detail = errors.size() == 1 ? said : count + " faults; first: " + said;
    }
    problem.errors = std::move(errors);
    return problem;
}

} // namespace api
