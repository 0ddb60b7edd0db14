#include "renderer/io/gltf_tree.h"

#include "renderer/io/text.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace renderer {

namespace {

constexpr std::size_t kDeepestNode = 256; // assimp and our flattening call themselves once a level

// Extensions that change no geometry, so that a file which requires them is still read right.
constexpr std::array<std::string_view, 3> kHarmlessPrefixes{"KHR_materials_", "KHR_texture_", "EXT_texture_"};
constexpr std::array<std::string_view, 2> kHarmless{"KHR_lights_punctual", "KHR_xmp_json_ld"};

bool is_readable(std::string_view extension)
{
    return std::find(kHarmless.begin(), kHarmless.end(), extension) != kHarmless.end() ||
           std::any_of(kHarmlessPrefixes.begin(), kHarmlessPrefixes.end(), [&](std::string_view prefix) {
               return extension.starts_with(prefix);
           });
}

ImportFault node_fault(std::uint64_t node, const std::string& what)
{
    return {"malformed", "node " + std::to_string(node) + " of the glTF " + what};
}

// Every node has one parent at most: from there, a chain upwards either ends or is a cycle.
std::optional<ImportFault> check_chains(const std::vector<std::uint32_t>& parents)
{
    constexpr std::uint32_t kRoot = 0xffffffff;
    std::vector<std::uint32_t> depths(parents.size(), 0); // 0: not yet known
    std::vector<std::uint32_t> chain;
    for (std::uint32_t start = 0; start < parents.size(); ++start) {
        chain.clear();
        std::uint32_t node = start;
        while (node != kRoot && depths[node] == 0) {
            chain.push_back(node);
            if (chain.size() > kDeepestNode + 1) break;
            node = parents[node];
        }
        std::size_t depth = node == kRoot ? 0 : depths[node];
        if (depth + chain.size() > kDeepestNode)
            return ImportFault{"over_limit",
                               "node " + std::to_string(start) + " of the glTF is more than " +
                                   std::to_string(kDeepestNode) + " levels deep, or its own ancestor"};
        for (auto up = chain.rbegin(); up != chain.rend(); ++up)
            depths[*up] = static_cast<std::uint32_t>(++depth);
    }
    return std::nullopt;
}

} // namespace

std::optional<ImportFault> check_gltf_tree(const GltfOutline& outline)
{
    if (!outline.version.starts_with("2."))
        return ImportFault{"unsupported", "glTF version " + in_quotes(outline.version) + "; 2.0 is read"};
    for (const std::string_view extension : outline.required_extensions)
        if (!is_readable(extension))
            return ImportFault{"unsupported",
                               "the glTF requires extension " + in_quotes(extension) + ": export without it"};
    constexpr std::uint32_t kRoot = 0xffffffff;
    std::vector<std::uint32_t> parents(outline.children.size(), kRoot);
    for (std::uint32_t node = 0; node < outline.children.size(); ++node)
        for (const std::uint32_t child : outline.children[node]) {
            if (child >= parents.size())
                return node_fault(node, "names child " + std::to_string(child) + ", which is not there");
            if (parents[child] != kRoot)
                return node_fault(child, "is the child of two nodes, or of one twice: nodes must form trees");
            parents[child] = node;
        }
    for (const auto& roots : outline.scene_roots) {
        std::set<std::uint32_t> seen;
        for (const std::uint32_t root : roots) {
            if (root >= parents.size()) return node_fault(root, "is named by a scene but not there");
            if (parents[root] != kRoot)
                return node_fault(root, "is the root of a scene and a child: nodes must form trees");
            if (!seen.insert(root).second) return node_fault(root, "is named twice by a scene");
        }
    }
    return check_chains(parents);
}

} // namespace renderer
