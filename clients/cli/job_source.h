// JobSource: the SCENE argument of a command: a job's JSON, from a file, standard input, or made for a bare
// mesh.
//
// Files that a scene names are looked for from the folder of the scene; what a mesh names, from the mesh's
// folder and never above it.
// Errors  UserError: usage for files that cannot be read, faults (after printing them all) for what they say.
#pragma once

#include "api/job_request.h"
#include "renderer/description/limits.h"

#include <filesystem>
#include <string>
#include <vector>

namespace clients {

struct JobSource {
    std::string name; // for messages
    std::string json;
    std::filesystem::path folder;
};

// "-" is standard input, with files named from the working folder. A mesh, of any format of mesh_formats.h,
// stands for the scene of that mesh alone.
JobSource read_job_source(const std::string& scene);

// Every fault on stderr, one a line: source, pointer, what is wrong and the remedy. Then throws
// UserError(faults).
[[noreturn]] void refuse_faults(const std::string& source, const std::vector<api::Problem>& faults);

// The job's words, checked under no limits but what cannot be; the names of meshes are paths.
api::JobRequest read_request(const JobSource& source);

} // namespace clients
