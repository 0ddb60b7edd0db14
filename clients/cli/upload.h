// Upload: the files that a job needs, found beside the scene and given to the service.
//
// Which   every mesh that the scene names by a file, and what those meshes name themselves (MTL, glTF
//         buffers): told by importing here those meshes that can name any, with the service's own importer.
// Errors  faults with pointers, as for a local render; UserError for refusals of the service.
#pragma once

#include "api/job_request.h"
#include "clients/cli/http_client.h"

#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace clients {

struct JobFile {
    std::string name; // as the scene or the mesh says it
    std::filesystem::path path;
    std::string digest;
};

// Either all files of the job or every fault. A mesh that the job's own `files` or a digest names and that is
// not here is taken to be at the service.
std::variant<std::vector<JobFile>, std::vector<api::Problem>>
find_job_files(const api::JobRequest& request, const std::filesystem::path& folder);

// HEAD, and PUT where the service does not have it; true if it was sent.
bool upload(HttpClient& client, const JobFile& file);

} // namespace clients
