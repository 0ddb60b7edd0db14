#include "renderer/io/gltf_outline.h"

#include "renderer/io/json_scan.h"
#include "renderer/io/text.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

namespace renderer {

namespace {

constexpr std::size_t kDeepestNode = 256; // assimp and our flattening call themselves once a level

// Extensions that change no geometry, so that a file which requires them is still read right.
constexpr std::array<std::string_view, 3> kHarmlessPrefixes{"KHR_materials_", "KHR_texture_", "EXT_texture_"};
constexpr std::array<std::string_view, 2> kHarmless{"KHR_lights_punctual", "KHR_xmp_json_ld"};

bool is_readable(const std::string& extension)
{
    return std::find(kHarmless.begin(), kHarmless.end(), extension) != kHarmless.end() ||
           std::any_of(kHarmlessPrefixes.begin(), kHarmlessPrefixes.end(), [&](std::string_view prefix) {
               return extension.starts_with(prefix);
           });
}

class OutlineReader {
public:
    explicit OutlineReader(std::string_view json) : json_(json), scan_(json) {}

    std::variant<GltfOutline, ImportFault> read()
    {
        const bool good =
            scan_.object([this](std::string_view key) { return top_member(key); }) && scan_.at_end();
        if (good) return std::move(outline_);
        const std::string place = "the glTF's JSON, byte " + std::to_string(scan_.fault_offset());
        if (!why_.empty()) return ImportFault{"malformed", place + ": " + why_};
        if (scan_.too_deep()) return ImportFault{"malformed", place + ": nested more than 64 deep"};
        if (scan_.fault_offset() >= json_.size())
            return ImportFault{"truncated", place + ": the text ends there: send it whole"};
        return ImportFault{"malformed", place + ": not what should stand there"};
    }

private:
    // A key that is escaped, or there twice, may mean one thing to us and another to assimp.
    bool is_once(std::set<std::string, std::less<>>& seen, std::string_view key)
    {
        if (key.empty())
            why_ = "a member's name is empty or escaped";
        else if (!seen.emplace(key).second)
            why_ = "member " + quoted(key) + " stands there twice";
        return why_.empty();
    }
    bool indices(std::vector<std::uint32_t>& out)
    {
        return scan_.array([&] { return scan_.index(out.emplace_back()); });
    }
    // Objects of an array; the member `wanted` of each is a list of indices.
    bool lists(std::vector<std::vector<std::uint32_t>>& out, std::string_view wanted)
    {
        return scan_.array([&] {
            std::vector<std::uint32_t>& list = out.emplace_back();
            std::set<std::string, std::less<>> seen;
            return scan_.object([&](std::string_view key) {
                return is_once(seen, key) && (key == wanted ? indices(list) : scan_.skip());
            });
        });
    }
    bool top_member(std::string_view key)
    {
        if (!is_once(top_seen_, key)) return false;
        if (key == "nodes") return lists(outline_.children, "children");
        if (key == "scenes") return lists(outline_.scene_roots, "nodes");
        if (key == "extensionsRequired")
            return scan_.array([&] { return scan_.string(outline_.required_extensions.emplace_back()); });
        if (key == "asset")
            return scan_.object([&](std::string_view k) {
                return k == "version" ? scan_.string(outline_.version) : scan_.skip();
            });
        return scan_.skip();
    }

    std::string_view json_;
    JsonScan scan_;
    GltfOutline outline_;
    std::set<std::string, std::less<>> top_seen_;
    std::string why_;
};

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

std::variant<GltfOutline, ImportFault> read_gltf_outline(std::string_view json)
{
    return OutlineReader(json).read();
}

std::optional<ImportFault> check_gltf_outline(const GltfOutline& outline)
{
    if (!outline.version.starts_with("2."))
        return ImportFault{"unsupported", "glTF version " + quoted(outline.version) + "; 2.0 is read"};
    for (const std::string& extension : outline.required_extensions)
        if (!is_readable(extension))
            return ImportFault{"unsupported",
                               "the glTF requires extension " + quoted(extension) + ": export without it"};
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
