// ImportFailure: why a mesh could not be imported, as a value for the client.
#pragma once

#include <string>

namespace server {

struct ImportFailure {
    std::string code;   // "truncated", "no_triangles", "import_timeout", "import_crashed", "over_limit", ...
    std::string detail; // a sentence for the client
    friend bool operator==(const ImportFailure&, const ImportFailure&) = default;
};

} // namespace server
