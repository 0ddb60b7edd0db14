// A fault that the renderer found in a description or a mesh: the client's doing, told as a value.
#pragma once

#include <string>

namespace renderer {

struct Fault {
    std::string pointer; // JSON Pointer into the job, "/scene/objects/0/mesh"
    std::string code;    // "no_triangles", "over_limit", ...
    std::string detail;  // what is wrong and how to mend it, one sentence
    friend bool operator==(const Fault&, const Fault&) = default;
};

} // namespace renderer
