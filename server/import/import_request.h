// ImportRequest: which mesh or picture is wanted, and what is made of it.
#pragma once

#include "renderer/description/settings.h"
#include "renderer/plan/plan.h"

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace server {

struct ImportRequest {
    std::string name;                         // as the scene calls it: its extension may tell the format
    std::string digest;                       // of the main file
    std::map<std::string, std::string> files; // the job's files, name -> digest: the only names that resolve
    bool is_picture = false;                  // is wanted; then files and tree do not count
    // Of a mesh of so many triangles. None: wide_sah.
    std::function<renderer::MeshTree(std::uint64_t triangles)> tree_for = nullptr;
    // Asked before a tree is built; where it says no there is none. None: always.
    std::function<bool(const renderer::MeshFacts&)> may_build = nullptr;
};

// The extension as a hint, if it is one that a format goes by.
std::string extension_of(const std::string& name);

// What is known of it goes by this. The same bytes may be wanted as one thing or another, with another answer.
std::string main_key(const ImportRequest& request);

// Of a mesh of so many triangles.
renderer::MeshTree tree_for(const ImportRequest& request, std::uint64_t triangles);

} // namespace server
