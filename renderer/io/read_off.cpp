#include "renderer/io/read_off.h"

#include "renderer/geometry/mesh_frame.h"
#include "renderer/io/import_bounds.h"
#include "renderer/io/text.h"
#include "renderer/io/triangulate.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace renderer {

namespace {

// Lines that say something: neither blank nor a comment; what follows a # is none of it.
class Statements {
public:
    explicit Statements(std::string_view text) : lines_(text) {}
    std::optional<std::string_view> next()
    {
        while (const auto line = lines_.next()) {
            const std::string_view said = trimmed(line->substr(0, line->find('#')));
            if (!said.empty()) return said;
        }
        return std::nullopt;
    }
    std::uint64_t line() const { return lines_.number(); }

private:
    Lines lines_;
};

struct Kind {
    bool has_uvs = false, has_colors = false, has_normals = false;
};

// [ST][C][N][4][n]OFF; nothing if the word is none of that.
std::optional<std::string_view> prefix_of(std::string_view word)
{
    if (!word.ends_with("OFF") || word.size() > 8) return std::nullopt;
    return word.substr(0, word.size() - 3);
}

class OffReader {
public:
    OffReader(std::string_view text, const Limits& limits) : text_(text), statements_(text), limits_(limits)
    {
    }
    ImportResult read();

private:
    using Check = std::optional<ImportFault>;

    Check head();
    Check vertex(std::string_view line);
    Check face(std::string_view line);
    Check add(const Triangle& triangle);

    ImportFault fault(std::string code, const std::string& what) const
    {
        return {std::move(code), "line " + std::to_string(statements_.line()) + ": " + what};
    }

    std::string_view text_;
    Statements statements_;
    const Limits& limits_;
    Kind kind_;
    std::uint64_t vertices_ = 0, faces_ = 0, left_out_ = 0;
    ImportedMesh result_;
    std::vector<std::uint32_t> corners_;
    Array<Vec3d> places_;
    std::vector<Vec3d> outline_;
    std::vector<Triangle> pieces_;
};

OffReader::Check OffReader::head()
{
    auto line = statements_.next();
    std::string_view rest = line.value_or("");
    std::string_view prefix = prefix_of(take_word(rest)).value_or("");
    if (prefix.find_first_of("4n") != prefix.npos)
        return fault("unsupported", "only OFF of three dimensions is read: export it as such");
    if (trimmed(rest) == "BINARY") return fault("unsupported", "binary OFF is not read: export it as text");
    kind_ = {prefix.starts_with("ST"), prefix.find('C') != prefix.npos, prefix.find('N') != prefix.npos};
    if (trimmed(rest).empty()) line = statements_.next(); // the counts may stand beside OFF or below
    rest = trimmed(rest).empty() ? line.value_or("") : rest;
    const std::string_view counts = trimmed(rest);
    const auto vertices = parse_integer(take_word(rest)), faces = parse_integer(take_word(rest));
    if (counts.empty()) return fault("truncated", "the OFF ends before its counts: send the file whole");
    if (!vertices || !faces || *vertices < 0 || *faces < 0)
        return fault("malformed",
                     in_quotes(counts) + " where the numbers of vertices and faces should stand");
    vertices_ = static_cast<std::uint64_t>(*vertices);
    faces_ = static_cast<std::uint64_t>(*faces);
    // "0 0 0\n" and "3 0 0 0\n", the last one without its end.
    if (vertices_ > text_.size() / 6 || faces_ > text_.size() / 2 ||
        vertices_ * 6 + faces_ * 2 > text_.size() + 1)
        return fault("truncated",
                     "the OFF promises " + std::to_string(vertices_) + " vertices and " +
                         std::to_string(faces_) + " faces, for which its " + std::to_string(text_.size()) +
                         " bytes are too few");
    if (faces_ > limits_.triangles) return over_triangle_limit(faces_, limits_, false);
    return over_output_limit(vertices_, faces_, limits_);
}

OffReader::Check OffReader::vertex(std::string_view line)
{
    Mesh& mesh = result_.mesh;
    const std::string number = std::to_string(places_.size());
    const std::string_view words = line;
    const auto p = take_point(line);
    const auto n = kind_.has_normals ? take_vec3(line) : Vec3f{};
    if (kind_.has_colors) // of four numbers; texture coordinates come after them
        for (int i = 0; i < 4; ++i)
            take_word(line);
    const auto u = kind_.has_uvs ? take_float(line) : 0.0f, v = kind_.has_uvs ? take_float(line) : 0.0f;
    if (!p || !n || !u || !v)
        return fault("malformed", "vertex " + number + " needs more numbers than " + in_quotes(words));
    if (!is_finite(to_float(*p)) || !is_finite(*n) || !is_finite(Vec3f{*u, *v, 0}))
        return fault("non_finite", "vertex " + number + " is not finite");
    places_.push_back(*p);
    if (kind_.has_normals)
        mesh.normals.push_back(max_component(abs(*n)) > 0 ? to_float(normalize(to_double(*n)))
                                                          : Vec3f{0, 0, 1});
    if (kind_.has_uvs) mesh.uvs.push_back({*u, *v});
    return std::nullopt;
}

OffReader::Check OffReader::add(const Triangle& triangle)
{
    result_.mesh.triangles.push_back(triangle);
    if (result_.mesh.triangles.size() > limits_.triangles)
        return over_triangle_limit(result_.mesh.triangles.size(), limits_, true);
    return std::nullopt;
}

OffReader::Check OffReader::face(std::string_view line)
{
    const auto corners = parse_integer(take_word(line));
    if (!corners || *corners < 0) return fault("malformed", "a face begins with the number of its corners");
    corners_.clear();
    for (std::int64_t i = 0; i < *corners; ++i) {
        const std::string_view word = take_word(line);
        const auto index = parse_integer(word);
        if (!index)
            return fault("malformed",
                         "a face of " + std::to_string(*corners) + " corners, but number " +
                             std::to_string(i) + " is " + in_quotes(word));
        if (*index < 0 || static_cast<std::uint64_t>(*index) >= vertices_)
            return fault("index_out_of_range",
                         "a face names vertex " + std::to_string(*index) + "; the file has " +
                             std::to_string(vertices_));
        corners_.push_back(static_cast<std::uint32_t>(*index));
    }
    if (corners_.size() < 3) {
        ++left_out_;
        return std::nullopt;
    }
    if (corners_.size() == 3) return add({corners_[0], corners_[1], corners_[2]});
    outline_.clear();
    pieces_.clear();
    for (const std::uint32_t corner : corners_)
        outline_.push_back(std::as_const(places_)[corner]);
    if (!triangulate(outline_, pieces_))
        return fault("over_limit",
                     "a concave polygon of " + std::to_string(corners_.size()) + " corners, the limit is " +
                         std::to_string(kMostConcaveCorners) + ": export triangles");
    for (const Triangle& t : pieces_)
        if (auto bad = add({corners_[t[0]], corners_[t[1]], corners_[t[2]]})) return bad;
    return std::nullopt;
}

ImportResult OffReader::read()
{
    if (auto bad = head()) return std::move(*bad);
    places_.reserve(vertices_);
    result_.mesh.triangles.reserve(faces_);
    for (std::uint64_t i = 0; i < vertices_ + faces_; ++i) {
        const auto line = statements_.next();
        if (!line)
            return ImportFault{"truncated",
                               "the OFF ends after " + std::to_string(i) + " of " +
                                   std::to_string(vertices_) + " vertices and " + std::to_string(faces_) +
                                   " faces: send the file whole"};
        if (auto bad = i < vertices_ ? vertex(*line) : face(*line)) return std::move(*bad);
    }
    set_positions(result_.mesh, places_);
    if (left_out_)
        result_.notes.push_back(std::to_string(left_out_) +
                                " faces of fewer than three corners were left out");
    if (kind_.has_colors) result_.notes.push_back("colours of vertices were left out");
    result_.format = "off";
    return std::move(result_);
}

} // namespace

bool is_off(std::string_view text)
{
    std::string_view start = text.substr(0, 64);
    start = start.substr(0, start.find('\n'));
    return prefix_of(take_word(start)).has_value();
}

ImportResult read_off(std::string_view text, const Limits& limits)
{
    return OffReader(text, limits).read();
}

} // namespace renderer
