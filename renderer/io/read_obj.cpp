#include "renderer/io/read_obj.h"

#include "renderer/io/import_bounds.h"
#include "renderer/io/obj_mesh.h"
#include "renderer/io/read_mtl.h"
#include "renderer/io/text.h"
#include "renderer/io/triangulate.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace renderer {

namespace {

constexpr std::array<std::string_view, 3> kKinds{"v", "vt", "vn"};

class ObjReader {
public:
    ObjReader(std::string_view text, CompanionFiles& files, const Limits& limits)
        : text_(text), lines_(text, true), files_(files), limits_(limits)
    {
    }
    ImportResult read();

private:
    using Check = std::optional<ImportFault>;

    Check statement(std::string_view word, std::string_view rest);
    Check vertex(std::string_view rest);
    Check texture_coordinates(std::string_view rest);
    Check normal(std::string_view rest);
    Check face(std::string_view rest);
    bool plain_triangle(std::string_view rest);
    Check polygon();
    Check corner(std::string_view word, ObjCorner& corner);
    Check few_enough() const;
    Check references() const;
    void group(bool object, std::string_view name);
    void use_material(std::string_view name);
    Check material_files(std::string_view names);
    Check material_file(std::string_view name, std::string_view text);
    void finish_materials();
    void finish_notes();

    ImportFault fault(std::string code, const std::string& what) const
    {
        return {std::move(code), "line " + std::to_string(lines_.number()) + ": " + what};
    }
    // A line that cannot be read: the last one without a newline was most likely cut off.
    ImportFault unreadable(const std::string& what) const
    {
        if (!lines_.cut_off()) return fault("malformed", what);
        return fault("truncated", what + ", and the file ends there: send it whole");
    }

    std::string_view text_;
    Lines lines_;
    CompanionFiles& files_;
    const Limits& limits_;
    ObjMesh obj_;
    ImportedMesh result_;
    MeshImages images_{files_, limits_, result_};
    std::vector<ObjCorner> corners_; // of the face at hand
    std::vector<Vec3d> outline_;
    std::vector<Triangle> pieces_;
    std::array<std::uint64_t, 3> largest_{}, largest_line_{}; // references of each kind, checked at the end
    std::map<std::string, std::uint32_t, std::less<>> material_numbers_, part_numbers_;
    std::set<std::string, std::less<>> material_files_, missing_files_; // by the names that the file uses
    bool has_objects_ = false, found_materials_ = false;
    std::uint64_t lines_and_points_ = 0, free_form_ = 0;
};

ObjReader::Check ObjReader::vertex(std::string_view rest)
{
    const std::string_view words = trimmed(rest);
    const auto p = take_point(rest);
    if (!p) return unreadable("a vertex needs three numbers, not " + in_quotes(words));
    if (!is_finite(to_float(*p)))
        return fault("non_finite", "vertex " + std::to_string(obj_.positions.size() + 1) + " is not finite");
    obj_.positions.push_back(*p);
    return std::nullopt;
}

ObjReader::Check ObjReader::texture_coordinates(std::string_view rest)
{
    const auto u = take_float(rest);
    const auto v = trimmed(rest).empty() ? std::optional(0.0f) : take_float(rest);
    if (!u || !v) return unreadable("a texture coordinate needs one to three numbers");
    if (!is_finite(Vec3f{*u, *v, 0}))
        return fault("non_finite",
                     "texture coordinate " + std::to_string(obj_.uvs.size() + 1) + " is not finite");
    obj_.uvs.push_back({*u, *v});
    return std::nullopt;
}

ObjReader::Check ObjReader::normal(std::string_view rest)
{
    const auto n = take_vec3(rest);
    if (!n) return unreadable("a normal needs three numbers");
    if (!is_finite(*n))
        return fault("non_finite", "normal " + std::to_string(obj_.normals.size() + 1) + " is not finite");
    obj_.normals.push_back(*n);
    return std::nullopt;
}

// v, v/vt, v//vn or v/vt/vn; counted from 1, or from the last one backwards if negative.
ObjReader::Check ObjReader::corner(std::string_view word, ObjCorner& corner)
{
    const std::array<std::uint64_t, 3> known{obj_.positions.size(), obj_.uvs.size(), obj_.normals.size()};
    const char* at = word.data();
    const char* const end = at + word.size();
    for (std::size_t kind = 0; kind < 3 && !(kind && at == end); ++kind) {
        const char* const slash = std::find(at, end, '/');
        const std::string_view number(at, static_cast<std::size_t>(slash - at));
        at = slash == end ? end : slash + 1;
        if (number.empty() && kind) continue;
        const auto index = parse_integer(number);
        if (!index) return unreadable("face corner " + in_quotes(word) + " is not v, v/vt, v//vn or v/vt/vn");
        const std::int64_t from_zero =
            *index > 0 ? *index - 1 : static_cast<std::int64_t>(known[kind]) + *index;
        if (*index == 0 || from_zero < 0 || from_zero >= ObjCorner::kNone)
            return fault("index_out_of_range",
                         "face corner " + in_quotes(word) + " names " + std::string(kKinds[kind]) + " " +
                             std::to_string(*index) + "; " + std::to_string(known[kind]) + " are known here");
        corner.at[kind] = static_cast<std::uint32_t>(from_zero);
        if (*index > 0 && std::uint64_t(*index) > largest_[kind]) {
            largest_[kind] = std::uint64_t(*index);
            largest_line_[kind] = lines_.number();
        }
    }
    if (at != end) return unreadable("face corner " + in_quotes(word) + " has more than three numbers");
    return std::nullopt;
}

// A triangle of plain positive numbers, as most lines of most files are. False, and nothing is taken, where
// the line is anything else.
bool ObjReader::plain_triangle(std::string_view rest)
{
    const char* at = rest.data();
    const char* const end = at + rest.size();
    std::array<ObjCorner, 3> triangle;
    std::array<std::uint32_t, 3> largest{};
    for (ObjCorner& c : triangle) {
        while (at < end && is_blank(*at))
            ++at;
        for (std::size_t kind = 0; kind < 3; ++kind) {
            constexpr std::ptrdiff_t kMostDigits = 9; // surely less than 2^32
            std::uint32_t number = 0;
            const char* const first = at;
            for (; at < end && static_cast<unsigned char>(*at - '0') < 10; ++at)
                number = number * 10 + static_cast<std::uint32_t>(*at - '0');
            if (at - first > kMostDigits || (number == 0 && (at != first || kind != 1))) return false;
            if (number > 0) c.at[kind] = number - 1;
            largest[kind] = std::max(largest[kind], number);
            if (at == end || *at != '/') break;
            ++at;
        }
        if (at < end && !is_blank(*at)) return false;
    }
    while (at < end && is_blank(*at))
        ++at;
    if (at != end) return false;
    for (std::size_t kind = 0; kind < 3; ++kind)
        if (largest[kind] > largest_[kind]) {
            largest_[kind] = largest[kind];
            largest_line_[kind] = lines_.number();
        }
    obj_.add_triangle(triangle[0], triangle[1], triangle[2]);
    return true;
}

ObjReader::Check ObjReader::face(std::string_view rest)
{
    if (plain_triangle(rest)) {
        if (obj_.triangles() > limits_.triangles) return over_triangle_limit(obj_.triangles(), limits_, true);
        return std::nullopt;
    }
    corners_.clear();
    while (true) {
        const std::string_view word = take_word(rest);
        if (word.empty() || word.front() == '#') break;
        ObjCorner& added = corners_.emplace_back();
        if (auto bad = corner(word, added)) return bad;
    }
    if (corners_.size() < 3) {
        if (lines_.cut_off()) return unreadable("a face needs three corners");
        ++lines_and_points_;
        return std::nullopt;
    }
    if (corners_.size() == 3)
        obj_.add_triangle(corners_[0], corners_[1], corners_[2]);
    else if (auto bad = polygon())
        return bad;
    if (obj_.triangles() > limits_.triangles) return over_triangle_limit(obj_.triangles(), limits_, true);
    return std::nullopt;
}

ObjReader::Check ObjReader::polygon()
{
    outline_.clear();
    // A face may name vertices that come later: its outline is then not yet known, and a fan has to do.
    for (const ObjCorner& c : corners_)
        outline_.push_back(c.at[0] < obj_.positions.size() ? std::as_const(obj_).positions[c.at[0]]
                                                           : Vec3d{});
    pieces_.clear();
    if (!triangulate(outline_, pieces_))
        return fault("over_limit",
                     "a concave polygon of " + std::to_string(corners_.size()) + " corners, the limit is " +
                         std::to_string(kMostConcaveCorners) + ": export triangles");
    for (const Triangle& t : pieces_)
        obj_.add_triangle(corners_[t[0]], corners_[t[1]], corners_[t[2]]);
    return std::nullopt;
}

void ObjReader::group(bool object, std::string_view name)
{
    if (has_objects_ && !object) return;
    if (object && !has_objects_) { // objects outrank groups: what the groups before meant is forgotten
        has_objects_ = true;
        obj_.forget_parts();
        part_numbers_.clear();
    }
    const std::string clean = clean_utf8(trimmed(name));
    const auto [at, is_new] =
        part_numbers_.try_emplace(clean, static_cast<std::uint32_t>(obj_.part_names.size()));
    if (is_new) obj_.part_names.push_back(clean);
    obj_.part = at->second;
}

void ObjReader::use_material(std::string_view name)
{
    const std::string clean = clean_utf8(trimmed(name));
    const auto [at, is_new] =
        material_numbers_.try_emplace(clean, static_cast<std::uint32_t>(obj_.material_names.size()));
    if (is_new) obj_.material_names.push_back(clean);
    obj_.material = at->second;
}

// Tools name the same file again at every object.
ObjReader::Check ObjReader::material_file(std::string_view name, std::string_view text)
{
    found_materials_ = true;
    if (!material_files_.emplace(name).second) return std::nullopt;
    if (read_mtl(text, name, images_, result_.mesh.materials, result_.notes)) return std::nullopt;
    return ImportFault{"over_limit",
                       "the material files up to " + in_quotes(name) + " have more than " +
                           std::to_string(kMostMaterials) + " materials, which is the limit"};
}

// `mtllib` lists names; a name with blanks in it is as common, so the whole line is tried first.
ObjReader::Check ObjReader::material_files(std::string_view names)
{
    names = trimmed(names);
    if (const auto bytes = files_.open(names)) return material_file(names, text_of(*bytes));
    for (std::string_view name = take_word(names); !name.empty(); name = take_word(names)) {
        if (const auto bytes = files_.open(name)) {
            if (auto bad = material_file(name, text_of(*bytes))) return bad;
        } else if (missing_files_.size() < kMostNotes && result_.notes.size() < kMostNotes &&
                   missing_files_.emplace(name).second) {
            result_.notes.push_back(
                "material file " + in_quotes(name) +
                " did not come with the mesh (a job names it in its files); its materials are grey");
        }
    }
    return std::nullopt;
}

ObjReader::Check ObjReader::statement(std::string_view word, std::string_view rest)
{
    if (word.empty() || word.front() == '#') return std::nullopt;
    if (word == "v") return vertex(rest);
    if (word == "f" || word == "fo") return face(rest);
    if (word == "vn") return normal(rest);
    if (word == "vt") return texture_coordinates(rest);
    if (word == "l" || word == "p")
        ++lines_and_points_;
    else if (word == "o" || word == "g")
        group(word == "o", rest);
    else if (word == "usemtl")
        use_material(rest);
    else if (word == "mtllib")
        return material_files(rest);
    else if (word == "curv" || word == "curv2" || word == "surf")
        ++free_form_;
    return std::nullopt;
}

ObjReader::Check ObjReader::references() const
{
    const std::array<std::uint64_t, 3> known{obj_.positions.size(), obj_.uvs.size(), obj_.normals.size()};
    for (std::size_t kind = 0; kind < 3; ++kind)
        if (largest_[kind] > known[kind])
            return ImportFault{"index_out_of_range",
                               "line " + std::to_string(largest_line_[kind]) + ": a face names " +
                                   std::string(kKinds[kind]) + " " + std::to_string(largest_[kind]) +
                                   ", the file has " + std::to_string(known[kind])};
    return std::nullopt;
}

void ObjReader::finish_materials()
{
    if (!found_materials_) return;
    std::map<std::string_view, std::uint16_t> numbers;
    std::vector<MeshMaterial>& materials = result_.mesh.materials;
    for (std::size_t i = 0; i < materials.size() && i < kMostMaterials; ++i)
        numbers.try_emplace(materials[i].name, static_cast<std::uint16_t>(i));
    std::optional<std::uint16_t> grey;
    const auto number_of = [&](const std::string* name) {
        const auto found = name ? numbers.find(*name) : numbers.end();
        if (found != numbers.end()) return found->second;
        if (!grey) grey = static_cast<std::uint16_t>(std::min(materials.size(), kMostMaterials));
        return *grey;
    };
    std::vector<std::uint16_t> number_by_name;
    for (const std::string& name : obj_.material_names) {
        number_by_name.push_back(number_of(&name));
        if (!numbers.contains(name) && result_.notes.size() < kMostNotes)
            result_.notes.push_back("material " + in_quotes(name) + " is in no material file; it is grey");
    }
    Array<std::uint16_t>& numbered = result_.mesh.triangle_materials;
    numbered.reserve(obj_.triangles());
    for (std::uint32_t name : std::as_const(obj_).triangle_materials)
        numbered.push_back(name == ObjCorner::kNone ? number_of(nullptr) : number_by_name[name]);
    if (numbered.empty() && obj_.triangles() > 0) numbered.append(obj_.triangles(), number_of(nullptr));
    if (grey) materials.insert(materials.begin() + *grey, MeshMaterial{});
}

void ObjReader::finish_notes()
{
    if (lines_and_points_)
        result_.notes.push_back(std::to_string(lines_and_points_) +
                                " lines and points were left out: only triangles render");
    if (free_form_)
        result_.notes.push_back(std::to_string(free_form_) + " free-form curves and surfaces were left out");
}

// Of a file so large that it could have more than the limit: a corner takes two bytes at least.
ObjReader::Check ObjReader::few_enough() const
{
    if (text_.size() / 2 <= limits_.triangles) return std::nullopt;
    std::uint64_t triangles = 0;
    Lines lines(text_, true);
    while (const auto line = lines.next()) {
        std::string_view rest = *line;
        const std::string_view word = take_word(rest);
        if (word != "f" && word != "fo") continue;
        std::uint64_t corners = 0;
        for (auto next = take_word(rest); !next.empty() && next.front() != '#'; next = take_word(rest))
            ++corners;
        triangles += corners < 3 ? 0 : corners - 2;
    }
    if (triangles > limits_.triangles) return over_triangle_limit(triangles, limits_, false);
    return std::nullopt;
}

ImportResult ObjReader::read()
{
    if (auto bad = few_enough()) return std::move(*bad);
    while (const auto line = lines_.next()) {
        std::string_view rest = *line;
        const std::string_view word = take_word(rest);
        if (auto bad = statement(word, rest)) return std::move(*bad);
    }
    if (auto bad = references()) return std::move(*bad);
    obj_.make_parts_contiguous(result_.mesh.parts);
    finish_materials();
    finish_notes();
    obj_.build(result_.mesh);
    result_.format = "obj";
    return std::move(result_);
}

} // namespace

ImportResult read_obj(std::string_view text, CompanionFiles& files, const Limits& limits)
{
    return ObjReader(text, files, limits).read();
}

} // namespace renderer
