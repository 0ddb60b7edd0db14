// What a client reads of answers and writes into requests: the other side of job_view.h and job_request.h.
#pragma once

#include "api/job_view.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace api {

// The job object that write_job_view wrote. Nothing if the text is not one: id and state must be there, all
// else may be absent or unknown, so that a client outlives a newer service.
std::optional<JobView> read_job_view(std::string_view json);

struct JobPage {
    std::vector<JobView> jobs;
    std::string next_cursor; // empty: the last page
};
std::optional<JobPage> read_job_list(std::string_view json);

// Members that a client adds to the user's own words; what is there under the same name gives way.
struct JobAdditions {
    std::map<std::string, std::string> files; // name -> digest
    std::optional<int> priority;
    std::map<std::string, std::string> labels;
    renderer::LayerSet layers{}; // beside those that it asks for
};
// The job text with them; all else stays as it was. `json` is a job that read_job accepts.
std::string add_to_job(std::string_view json, const JobAdditions& additions);

} // namespace api
