// Which build this is: part of every `--version`, /v1/version, and of the render key, since only the same
// build promises the same bytes.
#pragma once

#include <string>

namespace api {

struct BuildInfo {
    std::string version;    // of the project, "0.1.0"
    std::string commit;     // short git commit, "-dirty" when the tree was changed, "unknown" without git
    std::string compiler;   // "GNU 12.2.0"
    std::string build_type; // "Release"
};

const BuildInfo& build_info();

} // namespace api
