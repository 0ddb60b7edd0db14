#include "renderer/io/read_stl.h"

#include "renderer/geometry/mesh_frame.h"
#include "renderer/io/import_bounds.h"
#include "renderer/io/text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace renderer {

namespace {

constexpr std::size_t kHeadBytes = 84, kFacetBytes = 50, kNormalBytes = 12;

// The 32-bit little-endian word at `offset`.
std::uint32_t word_at(std::string_view bytes, std::size_t offset)
{
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i)
        word |= std::uint32_t(static_cast<unsigned char>(bytes[offset + i])) << (8 * i);
    return word;
}

// Vertices by position: open addressing with linear probing, never more than half full.
template <typename T>
class VertexTable {
public:
    // `expected` vertices fit without growing.
    explicit VertexTable(Array<Vec3<T>>& positions, std::size_t expected = 0)
        : positions_(positions), slots_(std::bit_ceil(std::max<std::size_t>(2 * expected, 1024)), kEmpty)
    {
    }
    // Fetches what add() will look at first, which lies anywhere in memory.
    void expect(Vec3<T> p) const { __builtin_prefetch(&slots_[slot_of(p + Vec3<T>{})]); }

    std::uint32_t add(Vec3<T> p)
    {
        p = p + Vec3<T>{}; // -0 becomes 0
        std::size_t slot = slot_of(p);
        while (slots_[slot] != kEmpty && !(positions_[slots_[slot]] == p))
            slot = (slot + 1) & (slots_.size() - 1);
        if (slots_[slot] != kEmpty) return slots_[slot];
        const auto vertex = static_cast<std::uint32_t>(positions_.size());
        slots_[slot] = vertex;
        positions_.push_back(p);
        if (positions_.size() * 2 > slots_.size()) grow();
        return vertex;
    }

private:
    static constexpr std::uint32_t kEmpty = 0xffffffff;

    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;

    std::size_t slot_of(Vec3<T> p) const
    {
        std::uint64_t hash = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            hash = (hash ^ std::bit_cast<Bits>(p[axis])) * 0x9e3779b97f4a7c15u;
            hash ^= hash >> 29;
        }
        return hash & (slots_.size() - 1);
    }

    void grow()
    {
        slots_.assign(slots_.size() * 2, kEmpty);
        for (std::uint32_t vertex = 0; vertex < positions_.size(); ++vertex) {
            std::size_t slot = slot_of(positions_[vertex]);
            while (slots_[slot] != kEmpty)
                slot = (slot + 1) & (slots_.size() - 1);
            slots_[slot] = vertex;
        }
    }

    Array<Vec3<T>>& positions_;
    std::vector<std::uint32_t> slots_;
};

// Words of the text, across lines.
class Words {
public:
    explicit Words(std::string_view text) : lines_(text) {}
    std::string_view next()
    {
        while (true) {
            const std::string_view word = take_word(line_);
            if (!word.empty()) return word;
            const auto line = lines_.next();
            if (!line) return {};
            line_ = *line;
        }
    }
    void skip_line() { line_ = {}; }
    std::uint64_t line() const { return lines_.number(); }

private:
    Lines lines_;
    std::string_view line_;
};

class AsciiStl {
public:
    AsciiStl(std::string_view text, const Limits& limits) : words_(text), limits_(limits) {}

    ImportResult read()
    {
        if (!expect("solid")) return std::move(fault_);
        words_.skip_line(); // its name
        for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
            const std::string keyword = lower_case(word.substr(0, 16));
            if (keyword == "facet") {
                if (!facet()) return std::move(fault_);
            } else if (keyword == "endsolid") {
                closed_ = true;
                words_.skip_line();
            } else if (keyword == "solid") {
                closed_ = false;
                words_.skip_line();
            } else {
                unexpected(word, "facet or endsolid");
                return std::move(fault_);
            }
        }
        if (!closed_) return ImportFault{"truncated", "the STL ends without endsolid: send the file whole"};
        set_positions(result_.mesh, in_file_);
        result_.format = "stl";
        return std::move(result_);
    }

private:
    void unexpected(std::string_view word, std::string_view wanted)
    {
        if (word.empty())
            fault_ = {"truncated",
                      "the STL ends where " + std::string(wanted) + " should stand: send the file whole"};
        else
            fault_ = {"malformed",
                      "line " + std::to_string(words_.line()) + ": " + in_quotes(word) + " where " +
                          std::string(wanted) + " should stand"};
    }
    bool expect(std::string_view wanted)
    {
        const std::string_view word = words_.next();
        if (lower_case(word.substr(0, 16)) == wanted) return true;
        unexpected(word, wanted);
        return false;
    }
    bool three_numbers(Vec3d& out)
    {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::string_view word = words_.next();
            const auto value = parse_double(word);
            if (!value) {
                unexpected(word, "a number");
                return false;
            }
            out[axis] = *value;
        }
        return true;
    }
    bool facet()
    {
        Vec3d normal; // may be anything: it is not used
        if (!expect("normal") || !three_numbers(normal) || !expect("outer") || !expect("loop")) return false;
        Triangle triangle{};
        for (std::uint32_t& index : triangle) {
            Vec3d p;
            if (!expect("vertex") || !three_numbers(p)) return false;
            if (!is_finite(to_float(p))) {
                fault_ = {"non_finite",
                          "line " + std::to_string(words_.line()) + ": a vertex of facet " +
                              std::to_string(result_.mesh.triangles.size()) + " is not finite"};
                return false;
            }
            index = vertices_.add(p);
        }
        result_.mesh.triangles.push_back(triangle);
        if (result_.mesh.triangles.size() > limits_.triangles) {
            fault_ = over_triangle_limit(result_.mesh.triangles.size(), limits_, true);
            return false;
        }
        return expect("endloop") && expect("endfacet");
    }

    Words words_;
    const Limits& limits_;
    ImportedMesh result_;
    Array<Vec3d> in_file_;
    VertexTable<double> vertices_{in_file_};
    ImportFault fault_;
    bool closed_ = false;
};

} // namespace

std::optional<std::uint32_t> binary_stl_facets(std::string_view bytes)
{
    if (bytes.size() < kHeadBytes) return std::nullopt;
    const std::uint32_t facets = word_at(bytes, kHeadBytes - 4);
    if (bytes.size() != kHeadBytes + std::uint64_t(facets) * kFacetBytes) return std::nullopt;
    return facets;
}

ImportResult read_binary_stl(std::string_view bytes, const Limits& limits)
{
    if (bytes.size() < kHeadBytes)
        return ImportFault{
            "truncated", "a binary STL has at least 84 bytes, this file has " + std::to_string(bytes.size())};
    const std::uint32_t facets = word_at(bytes, kHeadBytes - 4);
    const std::uint64_t wanted = kHeadBytes + std::uint64_t(facets) * kFacetBytes;
    if (bytes.size() != wanted)
        return ImportFault{bytes.size() < wanted ? "truncated" : "malformed",
                           "the STL's head promises " + std::to_string(facets) + " facets, which take " +
                               std::to_string(wanted) + " bytes; the file has " +
                               std::to_string(bytes.size())};
    if (facets > limits.triangles) return over_triangle_limit(facets, limits, false);
    if (auto bad = over_output_limit(0, facets, limits)) return std::move(*bad);
    ImportedMesh result;
    VertexTable<float> vertices(result.mesh.positions, facets / 2); // as many as a closed surface has
    result.mesh.triangles.resize_for_overwrite(facets);
    const auto corner = [&](std::uint32_t facet, std::size_t i) {
        Vec3f p;
        for (std::size_t axis = 0; axis < 3; ++axis)
            p[axis] = std::bit_cast<float>(
                word_at(bytes, kHeadBytes + facet * kFacetBytes + kNormalBytes + 12 * i + 4 * axis));
        return p;
    };
    constexpr std::uint32_t kAhead = 6; // facets
    for (std::uint32_t facet = 0; facet < facets; ++facet) {
        if (facets - facet > kAhead)
            for (std::size_t i = 0; i < 3; ++i)
                vertices.expect(corner(facet + kAhead, i));
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3f p = corner(facet, i);
            if (!is_finite(p))
                return ImportFault{
                    "non_finite",
                    "byte " + std::to_string(kHeadBytes + facet * kFacetBytes + kNormalBytes + 12 * i) +
                        ": vertex " + std::to_string(i) + " of facet " + std::to_string(facet) +
                        " is not finite"};
            result.mesh.triangles[facet][i] = vertices.add(p);
        }
    }
    choose_origin(result.mesh);
    result.format = "stl";
    return result;
}

ImportResult read_ascii_stl(std::string_view text, const Limits& limits)
{
    return AsciiStl(text, limits).read();
}

} // namespace renderer
