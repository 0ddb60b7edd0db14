#include "renderer/io/read_collada.h"

#include "renderer/io/assimp_scene.h"
#include "renderer/io/import_bounds.h"
#include "renderer/io/node_graph.h"
#include "renderer/io/text.h"
#include "renderer/io/xml_scan.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace renderer {

namespace {

using Check = std::optional<ImportFault>;

bool is_array(std::string_view name)
{
    return name == "float_array" || name == "int_array" || name == "Name_array" || name == "IDREF_array" ||
           name == "bool_array";
}

bool is_primitive(std::string_view name)
{
    return name == "triangles" || name == "polylist" || name == "polygons" || name == "trifans" ||
           name == "tristrips" || name == "lines" || name == "linestrips";
}

std::uint64_t words_of(std::string_view text)
{
    std::uint64_t words = 0;
    bool in_word = false;
    for (const char c : text) {
        const bool is_gap = c == '\n' || is_blank(c);
        words += !is_gap && !in_word;
        in_word = !is_gap;
    }
    return words;
}

class ColladaCheck {
public:
    ColladaCheck(std::string_view text, const Limits& limits) : text_(text), scan_(text), limits_(limits) {}

    Check run()
    {
        while (true) {
            Check bad;
            switch (scan_.next()) {
            case XmlScan::Event::open:
                bad = open();
                break;
            case XmlScan::Event::text:
                if (in_array_) array_words_ += words_of(scan_.text());
                break;
            case XmlScan::Event::close:
                bad = close();
                break;
            case XmlScan::Event::fault:
                return ImportFault{scan_.ended_early() ? "truncated" : "malformed",
                                   "the COLLADA's XML, " + scan_.fault_words()};
            case XmlScan::Event::end:
                return finish();
            }
            if (bad) return bad;
        }
    }

private:
    static constexpr std::size_t kNoNode = ~std::size_t{0};

    ImportFault malformed(const std::string& what) const
    {
        return {"malformed", "byte " + std::to_string(scan_.offset()) + " of the COLLADA: " + what};
    }

    Check open();
    Check close();
    Check finish();
    Check open_array();

    std::string_view text_;
    XmlScan scan_;
    const Limits& limits_;
    NodeGraph graph_;
    std::vector<std::size_t> open_nodes_; // one an open element: the node that it is in
    std::multimap<std::string_view, std::size_t> nodes_by_name_; // by id and by name
    std::vector<std::pair<std::size_t, std::string_view>> instances_;
    bool in_array_ = false;
    std::uint64_t array_words_ = 0, array_count_ = 0, triangles_ = 0;
};

Check ColladaCheck::open_array()
{
    const auto count = parse_integer(trimmed(scan_.attribute("count").value_or("")));
    if (!count || *count < 0) return malformed("an array without a count");
    array_count_ = static_cast<std::uint64_t>(*count);
    if (array_count_ > text_.size() / 2)
        return ImportFault{"truncated",
                           "byte " + std::to_string(scan_.offset()) + " of the COLLADA: an array promises " +
                               std::to_string(array_count_) + " values, for which the file is too short"};
    in_array_ = true;
    array_words_ = 0;
    return std::nullopt;
}

Check ColladaCheck::open()
{
    const std::string_view name = scan_.name();
    if (open_nodes_.empty() && name != "COLLADA") return malformed("the root element is not COLLADA");
    std::size_t node = open_nodes_.empty() ? kNoNode : open_nodes_.back();
    if (name == "node") {
        const std::size_t parent = node;
        node = graph_.add_node();
        if (parent != kNoNode) graph_.add_child(parent, node);
        for (const char* key : {"id", "name"})
            if (const auto value = scan_.attribute(key)) nodes_by_name_.emplace(*value, node);
    } else if (name == "instance_node" && node != kNoNode) {
        std::string_view url = scan_.attribute("url").value_or("");
        url.remove_prefix(std::min(url.find('#') + 1, url.size()));
        instances_.emplace_back(node, url);
    } else if (is_array(name)) {
        if (Check bad = open_array()) return bad;
    } else if (is_primitive(name)) {
        const auto count = parse_integer(trimmed(scan_.attribute("count").value_or("0")));
        if (!count || *count < 0) return malformed("a primitive's count is no number");
        if (static_cast<std::uint64_t>(*count) > text_.size())
            return ImportFault{"truncated",
                               "byte " + std::to_string(scan_.offset()) +
                                   " of the COLLADA: " + std::to_string(*count) +
                                   " primitives are promised, for which the file is too short"};
        triangles_ += name == "triangles" ? static_cast<std::uint64_t>(*count) : 0;
        if (triangles_ > limits_.triangles) return over_triangle_limit(triangles_, limits_, true);
    }
    open_nodes_.push_back(node);
    return std::nullopt;
}

Check ColladaCheck::close()
{
    open_nodes_.pop_back();
    if (!in_array_) return std::nullopt;
    in_array_ = false;
    if (array_words_ >= array_count_) return std::nullopt;
    return ImportFault{"truncated",
                       "byte " + std::to_string(scan_.offset()) + " of the COLLADA: an array promises " +
                           std::to_string(array_count_) + " values and has " + std::to_string(array_words_)};
}

// A name may be the id of one node and the name of another, and which of them assimp takes is its own affair:
// what is bounded for all of them is bounded.
Check ColladaCheck::finish()
{
    for (const auto& [node, name] : instances_) {
        const auto [begin, end] = nodes_by_name_.equal_range(name);
        for (auto named = begin; named != end; ++named)
            graph_.add_child(node, named->second);
    }
    return graph_.check("COLLADA");
}

} // namespace

ImportResult read_collada(std::span<const std::byte> bytes, CompanionFiles& files, const Limits& limits)
{
    const std::string_view text = text_of(bytes);
    // assimp looks for an archive from the file's end, and reads that instead of the XML.
    if (text.find("PK\x05\x06") != text.npos)
        return ImportFault{"unsupported", "a zip archive (.zae) is not read: send the .dae in it"};
    if (auto bad = ColladaCheck(text, limits).run()) return std::move(*bad);
    return read_with_assimp(
        {.format = "dae", .importer = "Collada", .title = "COLLADA"}, bytes, files, limits);
}

} // namespace renderer
