// FbxModels: the nodes of an FBX and how they are connected, gathered by who reads the file's records.
#pragma once

#include "renderer/io/node_graph.h"

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace renderer {

class FbxModels {
public:
    void add_model(std::int64_t id) { numbers_.try_emplace(id, numbers_.size()); }
    void connect(std::int64_t child, std::int64_t parent) { connections_.emplace_back(child, parent); }

    // Only what connects two models makes a tree of nodes.
    std::optional<ImportFault> check() const
    {
        NodeGraph graph;
        for (std::size_t i = 0; i < numbers_.size(); ++i)
            graph.add_node();
        for (const auto& [child, parent] : connections_) {
            const auto below = numbers_.find(child), above = numbers_.find(parent);
            if (below != numbers_.end() && above != numbers_.end())
                graph.add_child(above->second, below->second);
        }
        return graph.check("FBX");
    }

private:
    std::map<std::int64_t, std::size_t> numbers_; // by the file's identifiers
    std::vector<std::pair<std::int64_t, std::int64_t>> connections_;
};

} // namespace renderer
