#include "renderer/io/read_ply.h"

#include "renderer/geometry/mesh_frame.h"
#include "renderer/io/import_bounds.h"
#include "renderer/io/ply_header.h"
#include "renderer/io/ply_values.h"
#include "renderer/io/triangulate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace renderer {

namespace {

constexpr std::size_t kUnused = 8; // slots: x y z nx ny nz u v

std::size_t slot_of(const PlyProperty& property)
{
    static constexpr std::array<std::array<std::string_view, 4>, 8> kNames{{{"x"},
                                                                            {"y"},
                                                                            {"z"},
                                                                            {"nx"},
                                                                            {"ny"},
                                                                            {"nz"},
                                                                            {"u", "s", "texture_u", "tx"},
                                                                            {"v", "t", "texture_v", "ty"}}};
    for (std::size_t slot = 0; slot < kNames.size(); ++slot)
        for (std::string_view name : kNames[slot])
            if (!property.is_list && !name.empty() && property.name == name) return slot;
    return kUnused;
}

bool is_index_list(const PlyProperty& property)
{
    return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
}

// One of an element, for messages.
struct Item {
    const PlyElement& element;
    std::uint64_t number;
    friend std::string operator+(const Item& item, std::string_view text)
    {
        return clean_utf8(item.element.name, 40) + " " + std::to_string(item.number).append(text);
    }
};

class PlyReader {
public:
    PlyReader(std::string_view file, PlyHeader header, const Limits& limits)
        : header_(std::move(header)), values_(file, header_), limits_(limits)
    {
    }
    ImportResult read();

private:
    using Check = std::optional<ImportFault>;
    using Build = Check (PlyReader::*)(const Item& who); // what a list of indices becomes

    bool has_float_places(const PlyElement& element) const;
    Vec3d place_of(std::size_t vertex) const
    {
        return in_file_.empty() ? to_double(result_.mesh.positions[vertex]) : in_file_[vertex];
    }
    Check promises_fit() const;
    Check vertices(const PlyElement& element);
    Check
    vertex(const PlyElement& element, const std::vector<std::size_t>& slots, std::array<double, 8>& out);
    Check faces(const PlyElement& element, Build build);
    Check skip(const PlyElement& element);
    Check list(const PlyProperty& property, const Item& who, bool keep);
    Check polygon(const Item& who);
    Check strips(const Item& who);
    Check add(const Triangle& triangle);
    bool plain_vertices(const PlyElement& element, const std::vector<std::size_t>& slots, Check& bad);
    void plain_triangles(const PlyElement& element, std::uint64_t& done);

    ImportFault no_value(const Item& who) const
    {
        if (values_.ended())
            return {"truncated", who + ": the data ends at " + values_.place() + ": send the file whole"};
        return {"malformed", who + ", " + values_.place() + ": not a number"};
    }

    PlyHeader header_;
    PlyValues values_;
    const Limits& limits_;
    ImportedMesh result_;
    Array<Vec3d> in_file_; // positions that are more than floats
    std::vector<std::int64_t> indices_;
    std::vector<Vec3d> outline_;
    std::vector<Triangle> pieces_;
    std::uint64_t vertex_count_ = 0, left_out_ = 0;
};

bool PlyReader::has_float_places(const PlyElement& element) const
{
    if (header_.encoding == PlyHeader::Encoding::ascii) return false;
    return std::all_of(element.properties.begin(), element.properties.end(), [](const PlyProperty& property) {
        return slot_of(property) > 2 || property.type == PlyType::float32 || size_of(property.type) < 4;
    });
}

// A count that cannot be true is refused before anything is allocated for it.
PlyReader::Check PlyReader::promises_fit() const
{
    const bool ascii = header_.encoding == PlyHeader::Encoding::ascii;
    std::uint64_t room = values_.bytes_left() + (ascii ? 1 : 0); // the last number needs no blank after it
    for (const PlyElement& element : header_.elements) {
        const std::uint64_t each = element.least_bytes(ascii);
        if (each == 0 || element.count == 0) continue;
        if (element.count > room / each)
            return ImportFault{"truncated",
                               "the header promises " + std::to_string(element.count) + " of element " +
                                   in_quotes(element.name) + ", at least " + std::to_string(each) +
                                   " bytes each, but only " + std::to_string(room) +
                                   " bytes are left for them"};
        room -= element.count * each;
    }
    std::uint64_t vertices = 0, faces = 0;
    for (const PlyElement& element : header_.elements) {
        if (element.name == "vertex" && vertices == 0) vertices = element.count;
        if (element.name == "face") faces += element.count;
    }
    if (faces > limits_.triangles) return over_triangle_limit(faces, limits_, false);
    return over_output_limit(vertices, faces, limits_);
}

PlyReader::Check PlyReader::list(const PlyProperty& property, const Item& who, bool keep)
{
    const auto count = values_.next(property.count_type);
    if (!count) return no_value(who);
    if (!(*count >= 0) || *count > 4294967295.0 || *count != std::floor(*count))
        return ImportFault{"malformed",
                           who + ", " + values_.place() + ": a list cannot have " + std::to_string(*count) +
                               " entries"};
    const auto entries = static_cast<std::uint64_t>(*count);
    if (entries > values_.bytes_left())
        return ImportFault{"truncated",
                           who + ", " + values_.place() + ": a list of " + std::to_string(entries) +
                               " entries, but only " + std::to_string(values_.bytes_left()) +
                               " bytes are left"};
    if (keep) indices_.clear();
    for (std::uint64_t i = 0; i < entries; ++i) {
        const auto value = values_.next(property.type);
        if (!value) return no_value(who);
        if (!keep) continue;
        if (!(std::abs(*value) < 9e15) || *value != std::floor(*value))
            return ImportFault{"malformed",
                               who + ", " + values_.place() + ": an index is not a whole number"};
        indices_.push_back(static_cast<std::int64_t>(*value));
    }
    return std::nullopt;
}

PlyReader::Check PlyReader::vertex(const PlyElement& element,
                                   const std::vector<std::size_t>& slots,
                                   std::array<double, 8>& out)
{
    for (std::size_t i = 0; i < slots.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (property.is_list) {
            if (auto bad = list(property, {element, vertex_count_}, false)) return bad;
            continue;
        }
        const auto value = values_.next(property.type);
        if (!value) return no_value(Item{element, vertex_count_});
        if (slots[i] == kUnused) continue;
        out[slots[i]] = *value;
        if (!std::isfinite(static_cast<float>(*value)))
            return ImportFault{"non_finite",
                               "vertex " + std::to_string(vertex_count_) + ", before " + values_.place() +
                                   ": " + clean_utf8(property.name, 40) + " is not finite"};
    }
    return std::nullopt;
}

// Vertices of x, y, z as floats of this machine, whatever numbers stand beside them: most files. False where
// they are not that.
bool PlyReader::plain_vertices(const PlyElement& element, const std::vector<std::size_t>& slots, Check& bad)
{
    const char* at = values_.as_they_stand();
    std::size_t stride = 0, position = 0, next = 0; // slot
    for (std::size_t i = 0; i < slots.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (!at || property.is_list) return false;
        if (slots[i] == 0) position = stride;
        if (slots[i] != kUnused && (slots[i] != next || slots[i] > 2 || property.type != PlyType::float32 ||
                                    stride != position + next++ * sizeof(float)))
            return false;
        stride += size_of(property.type);
    }
    if (next != 3 || element.count > values_.bytes_left() / stride) return false;
    Array<Vec3f>& positions = result_.mesh.positions;
    positions.resize_for_overwrite(element.count);
    for (Vec3f& p : positions) {
        std::memcpy(static_cast<void*>(&p), at + position, sizeof p);
        if (!is_finite(p)) {
            std::size_t axis = 0;
            while (std::isfinite(p[axis]))
                ++axis;
            values_.skip_bytes(position + (axis + 1) * sizeof(float));
            bad = ImportFault{"non_finite",
                              "vertex " + std::to_string(vertex_count_) + ", before " + values_.place() +
                                  ": " + std::string(1, "xyz"[axis]) + " is not finite"};
            return true;
        }
        at += stride;
        values_.skip_bytes(stride);
        ++vertex_count_;
    }
    return true;
}

PlyReader::Check PlyReader::vertices(const PlyElement& element)
{
    std::vector<std::size_t> slots;
    std::array<bool, 9> has{};
    for (const PlyProperty& property : element.properties)
        has[slots.emplace_back(slot_of(property))] = true;
    if (!has[0] || !has[1] || !has[2])
        return ImportFault{"malformed", "element vertex has no properties x, y and z"};
    const bool normals = has[3] && has[4] && has[5], uvs = has[6] && has[7];
    Check bad_number;
    if (plain_vertices(element, slots, bad_number)) return bad_number;
    const bool floats = has_float_places(element);
    Mesh& mesh = result_.mesh;
    if (floats)
        mesh.positions.reserve(element.count);
    else
        in_file_.reserve(element.count);
    if (normals) mesh.normals.reserve(element.count);
    if (uvs) mesh.uvs.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i, ++vertex_count_) {
        std::array<double, 8> v{};
        if (auto bad = vertex(element, slots, v)) return bad;
        const Vec3d place{v[0], v[1], v[2]};
        if (floats)
            mesh.positions.push_back(to_float(place));
        else
            in_file_.push_back(place);
        const Vec3d n{v[3], v[4], v[5]};
        // A zero normal of a vertex that faces may share has no better stand-in than some direction.
        if (normals)
            mesh.normals.push_back(max_component(abs(n)) > 0 ? to_float(normalize(n)) : Vec3f{0, 0, 1});
        if (uvs) mesh.uvs.push_back({static_cast<float>(v[6]), static_cast<float>(v[7])});
    }
    return std::nullopt;
}

PlyReader::Check PlyReader::add(const Triangle& triangle)
{
    result_.mesh.triangles.push_back(triangle);
    if (result_.mesh.triangles.size() > limits_.triangles)
        return over_triangle_limit(result_.mesh.triangles.size(), limits_, true);
    return std::nullopt;
}

PlyReader::Check PlyReader::polygon(const Item& who)
{
    const auto vertices = static_cast<std::int64_t>(vertex_count_);
    for (const std::int64_t index : indices_)
        if (index < 0 || index >= vertices)
            return ImportFault{"index_out_of_range",
                               who + ", before " + values_.place() + ": vertex " + std::to_string(index) +
                                   "; the file has " + std::to_string(vertices)};
    if (indices_.size() < 3) {
        ++left_out_;
        return std::nullopt;
    }
    const auto at = [&](std::size_t corner) { return static_cast<std::uint32_t>(indices_[corner]); };
    if (indices_.size() == 3) return add({at(0), at(1), at(2)});
    outline_.clear();
    pieces_.clear();
    for (const std::int64_t index : indices_)
        outline_.push_back(place_of(static_cast<std::size_t>(index)));
    if (!triangulate(outline_, pieces_))
        return ImportFault{"over_limit",
                           who + ": a concave polygon of " + std::to_string(indices_.size()) +
                               " corners, the limit is " + std::to_string(kMostConcaveCorners) +
                               ": export triangles"};
    for (const Triangle& t : pieces_)
        if (auto bad = add({at(t[0]), at(t[1]), at(t[2])})) return bad;
    return std::nullopt;
}

// A strip goes on until -1; every second triangle is wound the other way. A repeated vertex joins strips: the
// triangles there have no area by design and are not taken.
PlyReader::Check PlyReader::strips(const Item& who)
{
    const auto vertices = static_cast<std::int64_t>(vertex_count_);
    std::size_t begin = 0;
    for (std::size_t i = 0; i < indices_.size(); ++i) {
        const std::int64_t index = indices_[i];
        if (index == -1) {
            begin = i + 1;
            continue;
        }
        if (index < 0 || index >= vertices)
            return ImportFault{"index_out_of_range",
                               who + ", entry " + std::to_string(i) + ": vertex " + std::to_string(index) +
                                   "; the file has " + std::to_string(vertices)};
        if (i < begin + 2) continue;
        Triangle t{static_cast<std::uint32_t>(indices_[i - 2]),
                   static_cast<std::uint32_t>(indices_[i - 1]),
                   static_cast<std::uint32_t>(index)};
        if (t[0] == t[1] || t[1] == t[2] || t[0] == t[2]) continue;
        if ((i - begin) % 2 == 1) std::swap(t[0], t[1]);
        if (auto bad = add(t)) return bad;
    }
    return std::nullopt;
}

// Takes triangles as long as one follows another as they do in most files, a byte of 3 and three sound
// indices of 32 bits: what is anything else is left to the long way.
void PlyReader::plain_triangles(const PlyElement& element, std::uint64_t& done)
{
    const PlyProperty& list = element.properties.front();
    const char* at = values_.as_they_stand();
    if (!at || element.properties.size() != 1 || size_of(list.count_type) != 1 ||
        (list.type != PlyType::int32 && list.type != PlyType::uint32))
        return;
    constexpr std::size_t kBytes = 1 + sizeof(Triangle);
    const std::uint64_t room = std::min<std::uint64_t>({element.count - done,
                                                        values_.bytes_left() / kBytes,
                                                        limits_.triangles - result_.mesh.triangles.size()});
    std::uint64_t taken = 0;
    for (; taken < room && *at == 3; ++taken, at += kBytes) {
        Triangle triangle;
        std::memcpy(&triangle, at + 1, sizeof triangle);
        // Negative ones are large here.
        if (std::max({triangle[0], triangle[1], triangle[2]}) >= vertex_count_) break;
        result_.mesh.triangles.push_back(triangle);
    }
    values_.skip_bytes(taken * kBytes);
    done += taken;
}

PlyReader::Check PlyReader::faces(const PlyElement& element, Build build)
{
    std::size_t wanted = element.properties.size();
    for (std::size_t i = 0; i < element.properties.size(); ++i)
        if (is_index_list(element.properties[i])) wanted = i;
    if (wanted == element.properties.size() && element.count > 0)
        return ImportFault{"malformed", "element " + in_quotes(element.name) + " has no list vertex_indices"};
    const bool are_polygons = build == &PlyReader::polygon;
    if (are_polygons) result_.mesh.triangles.reserve(result_.mesh.triangles.size() + element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
        if (are_polygons) plain_triangles(element, i);
        if (i == element.count) break;
        for (std::size_t p = 0; p < element.properties.size(); ++p) {
            const PlyProperty& property = element.properties[p];
            if (property.is_list) {
                if (auto bad = list(property, {element, i}, p == wanted)) return bad;
            } else if (!values_.next(property.type)) {
                return no_value(Item{element, i});
            }
        }
        if (auto bad = (this->*build)({element, i})) return bad;
    }
    return std::nullopt;
}

PlyReader::Check PlyReader::skip(const PlyElement& element)
{
    if (element.properties.empty()) return std::nullopt;
    for (std::uint64_t i = 0; i < element.count; ++i)
        for (const PlyProperty& property : element.properties) {
            if (property.is_list) {
                if (auto bad = list(property, {element, i}, false)) return bad;
            } else if (!values_.next(property.type)) {
                return no_value(Item{element, i});
            }
        }
    return std::nullopt;
}

ImportResult PlyReader::read()
{
    if (auto bad = promises_fit()) return std::move(*bad);
    bool has_vertices = false;
    for (const PlyElement& element : header_.elements) {
        Check bad;
        if (element.name == "vertex" && !std::exchange(has_vertices, true))
            bad = vertices(element);
        else if (element.name == "face")
            bad = faces(element, &PlyReader::polygon);
        else if (element.name == "tristrips")
            bad = faces(element, &PlyReader::strips);
        else
            bad = skip(element);
        if (bad) return std::move(*bad);
    }
    if (!has_vertices) return ImportFault{"malformed", "the PLY header names no element vertex"};
    if (left_out_)
        result_.notes.push_back(std::to_string(left_out_) +
                                " faces of fewer than three corners were left out");
    if (!values_.only_blanks_left())
        result_.notes.push_back(std::to_string(values_.bytes_left()) +
                                " bytes after the last element were left out");
    if (in_file_.empty())
        choose_origin(result_.mesh);
    else
        set_positions(result_.mesh, in_file_);
    result_.format = "ply";
    return std::move(result_);
}

} // namespace

ImportResult read_ply(std::string_view bytes, const Limits& limits)
{
    auto header = read_ply_header(bytes);
    if (auto* fault = std::get_if<ImportFault>(&header)) return std::move(*fault);
    return PlyReader(bytes, std::move(std::get<PlyHeader>(header)), limits).read();
}

} // namespace renderer
