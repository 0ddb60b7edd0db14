// NodeGraph: the nodes of a scene file before a library follows them: does it come to an end, and how large
// does it get? A file of a few hundred bytes whose nodes name one another can stand for 2^30 of them.
#pragma once

#include "renderer/io/import_mesh.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace renderer {

class NodeGraph {
public:
    static constexpr std::uint64_t kMostPlaced = 1'000'000; // nodes, each counted as often as it is placed
    static constexpr std::size_t kDeepest = 256;

    std::size_t add_node()
    {
        below_.emplace_back();
        return below_.size() - 1;
    }
    void add_child(std::size_t node, std::size_t child) { below_[node].push_back(child); }
    std::size_t size() const { return below_.size(); }

    // "malformed" for a cycle, "over_limit" for what is too deep or too many; `title` is of the format.
    std::optional<ImportFault> check(const std::string& title) const;

private:
    std::vector<std::vector<std::size_t>> below_;
};

} // namespace renderer
