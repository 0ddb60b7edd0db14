#include "renderer/io/gltf_outline.h"

#include "renderer/io/json_scan.h"
#include "renderer/io/text.h"

#include <set>
#include <utility>

namespace renderer {

namespace {

class OutlineReader {
public:
    explicit OutlineReader(std::string_view json) : json_(json), scan_(json) {}

    std::variant<GltfOutline, ImportFault> read()
    {
        const bool good = members([this](std::string_view key) { return top_member(key); }) && scan_.at_end();
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
            why_ = "member " + in_quotes(key) + " stands there twice";
        return why_.empty();
    }
    // An object's members, each once; `member` consumes the value.
    template <typename Member>
    bool members(const Member& member)
    {
        std::set<std::string, std::less<>> seen;
        return scan_.object([&](std::string_view key) { return is_once(seen, key) && member(key); });
    }
    // An array of objects: one entry of `out` each.
    template <typename Entry, typename Member>
    bool entries(std::vector<Entry>& out, const Member& member)
    {
        return scan_.array([&] {
            out.emplace_back();
            return members([&](std::string_view key) { return member(out.back(), key); });
        });
    }
    bool indices(std::vector<std::uint32_t>& out)
    {
        return scan_.array([&] { return scan_.index(out.emplace_back()); });
    }
    // Objects of which one member is a list of indices.
    bool lists(std::vector<std::vector<std::uint32_t>>& out, std::string_view wanted)
    {
        return entries(out, [&](std::vector<std::uint32_t>& list, std::string_view key) {
            return key == wanted ? indices(list) : scan_.skip();
        });
    }
    bool buffer_member(GltfBuffer& buffer, std::string_view key)
    {
        if (key == "uri") return scan_.string(buffer.uri.emplace());
        if (key == "byteLength") return scan_.index(buffer.length);
        return scan_.skip();
    }
    bool view_member(GltfView& view, std::string_view key)
    {
        if (key == "buffer") return scan_.index(view.buffer);
        if (key == "byteOffset") return scan_.index(view.offset);
        if (key == "byteLength") return scan_.index(view.length);
        if (key == "byteStride") return scan_.index(view.stride);
        return scan_.skip();
    }
    bool accessor_member(GltfAccessor& accessor, std::string_view key)
    {
        if (key == "bufferView") return scan_.index(accessor.view.emplace());
        if (key == "byteOffset") return scan_.index(accessor.offset);
        if (key == "count") return scan_.index(accessor.count);
        if (key == "componentType") return scan_.index(accessor.component_type);
        if (key == "type") return scan_.string(accessor.type);
        accessor.sparse = accessor.sparse || key == "sparse";
        return scan_.skip();
    }
    bool attributes(GltfPrimitive& primitive)
    {
        return members([&](std::string_view key) {
            std::uint32_t& accessor = primitive.attributes.emplace_back();
            if (!scan_.index(accessor)) return false;
            if (key == "POSITION" && !primitive.positions) primitive.positions = accessor;
            return true;
        });
    }
    bool primitive_member(GltfPrimitive& primitive, std::string_view key)
    {
        if (key == "mode") return scan_.index(primitive.mode);
        if (key == "indices") return scan_.index(primitive.indices.emplace());
        if (key == "attributes") return attributes(primitive);
        if (key != "targets") return scan_.skip();
        GltfPrimitive morph; // its attributes count as the primitive's, its positions do not
        const bool good = scan_.array([&] { return attributes(morph); });
        primitive.attributes.insert(
            primitive.attributes.end(), morph.attributes.begin(), morph.attributes.end());
        return good;
    }
    bool mesh_member(std::uint32_t mesh, std::string_view key)
    {
        if (key != "primitives") return scan_.skip();
        return entries(outline_.primitives, [&](GltfPrimitive& primitive, std::string_view member) {
            primitive.mesh = mesh;
            return primitive_member(primitive, member);
        });
    }
    bool meshes()
    {
        std::uint32_t mesh = 0;
        return scan_.array([&] {
            const bool good = members([&](std::string_view key) { return mesh_member(mesh, key); });
            ++mesh;
            return good;
        });
    }
    bool top_member(std::string_view key)
    {
        if (key == "nodes") return lists(outline_.children, "children");
        if (key == "scenes") return lists(outline_.scene_roots, "nodes");
        if (key == "meshes") return meshes();
        if (key == "buffers")
            return entries(outline_.buffers,
                           [this](GltfBuffer& b, std::string_view k) { return buffer_member(b, k); });
        if (key == "bufferViews")
            return entries(outline_.views,
                           [this](GltfView& v, std::string_view k) { return view_member(v, k); });
        if (key == "accessors")
            return entries(outline_.accessors,
                           [this](GltfAccessor& a, std::string_view k) { return accessor_member(a, k); });
        if (key == "extensionsRequired")
            return scan_.array([&] { return scan_.string(outline_.required_extensions.emplace_back()); });
        if (key == "asset")
            return members([&](std::string_view k) {
                return k == "version" ? scan_.string(outline_.version) : scan_.skip();
            });
        return scan_.skip();
    }

    std::string_view json_;
    JsonScan scan_;
    GltfOutline outline_;
    std::string why_;
};

} // namespace

std::variant<GltfOutline, ImportFault> read_gltf_outline(std::string_view json)
{
    return OutlineReader(json).read();
}

} // namespace renderer
