// Provenance: what a picture says of its own making. Nothing in it differs between two runs of one job, so
// service and CLI write the same bytes.
#pragma once

#include "api/job_request.h"

#include <cstdint>
#include <string>
#include <vector>

namespace api {

// One text chunk of a PNG.
struct ProvenanceText {
    std::string keyword; // "Software", "heliograph"
    std::string text;    // the latter is JSON: {"render_key", "seed", "samples"}
};

// Empty where the request says `"provenance": false`. `samples` are those taken in every pixel.
std::vector<ProvenanceText>
provenance_of(const JobRequest& request, const std::string& render_key, std::uint32_t samples);

} // namespace api
