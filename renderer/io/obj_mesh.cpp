#include "renderer/io/obj_mesh.h"

#include "renderer/geometry/mesh_frame.h"
#include "renderer/io/triangulate.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace renderer {

namespace {

constexpr std::uint32_t kNone = ObjCorner::kNone;

// One more of what most files have none of: the array begins with the first that is something.
void add_sparsely(Array<std::uint32_t>& array, std::size_t before, std::uint32_t value)
{
    if (array.empty()) {
        if (value == kNone) return;
        array.resize(before, kNone);
    }
    array.push_back(value);
}

} // namespace

void ObjMesh::add_triangle(const ObjCorner& a, const ObjCorner& b, const ObjCorner& c)
{
    const std::size_t before = triangles();
    add_sparsely(triangle_parts, before, part);
    add_sparsely(triangle_materials, before, material);
    for (std::size_t kind = 1; kind < 3; ++kind) {
        add_sparsely(corners[kind], 3 * before, a.at[kind]);
        add_sparsely(corners[kind], 3 * before + 1, b.at[kind]);
        add_sparsely(corners[kind], 3 * before + 2, c.at[kind]);
    }
    corners[0].append({a.at[0], b.at[0], c.at[0]});
}

void ObjMesh::forget_parts()
{
    part = kNone;
    part_names.clear();
    triangle_parts.clear();
}

void ObjMesh::make_parts_contiguous(std::vector<MeshPart>& parts)
{
    const auto slot = [](std::uint32_t p) { return p == kNone ? 0 : std::size_t(p) + 1; };
    if (triangle_parts.empty()) return;
    const Array<std::uint32_t>& part_of = triangle_parts;
    std::vector<std::uint32_t> begin(part_names.size() + 2, 0);
    for (const std::uint32_t p : part_of)
        ++begin[slot(p) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (std::size_t i = 0; i < part_names.size(); ++i)
        if (begin[i + 2] > begin[i + 1])
            parts.push_back({part_names[i], begin[i + 1], begin[i + 2] - begin[i + 1]});
    if (std::is_sorted(part_of.begin(), part_of.end(), [&](std::uint32_t a, std::uint32_t b) {
            return slot(a) < slot(b);
        }))
        return;
    std::vector<std::uint32_t> place(part_of.size()); // of each triangle
    for (std::size_t i = 0; i < place.size(); ++i)
        place[i] = begin[slot(part_of[i])]++;
    const auto sort = [&](Array<std::uint32_t>& values, std::size_t each) {
        if (values.empty()) return;
        Array<std::uint32_t> sorted;
        sorted.resize_for_overwrite(values.size());
        for (std::size_t i = 0; i < place.size(); ++i)
            std::copy_n(std::as_const(values).begin() + each * i, each, sorted.begin() + each * place[i]);
        values.swap(sorted);
    };
    for (auto& values : corners)
        sort(values, 3);
    sort(triangle_materials, 1);
}

// Corners without a normal, or with a zero one, get their face's normal as one of their own. False if no
// corner has any.
bool ObjMesh::complete_normals()
{
    Array<std::uint32_t>& used = corners[2];
    const auto lacks = [&](std::uint32_t n) {
        return n == kNone || !(max_component(abs(std::as_const(normals)[n])) > 0);
    };
    if (std::all_of(std::as_const(used).begin(), std::as_const(used).end(), lacks)) return false;
    const std::size_t given = normals.size();
    for (std::size_t i = 0; i < used.size(); i += 3) {
        if (!lacks(used[i]) && !lacks(used[i + 1]) && !lacks(used[i + 2])) continue;
        const std::array outline{
            positions[corners[0][i]], positions[corners[0][i + 1]], positions[corners[0][i + 2]]};
        const auto flat = static_cast<std::uint32_t>(normals.size());
        normals.push_back(polygon_normal(outline));
        for (std::size_t k = i; k < i + 3; ++k)
            if (lacks(used[k])) used[k] = flat;
    }
    for (std::size_t i = 0; i < given; ++i)
        if (max_component(abs(normals[i])) > 0) normals[i] = to_float(normalize(to_double(normals[i])));
    return true;
}

// Vertices in the order of their first use.
Array<Vec3d> ObjMesh::build_from_positions(Mesh& mesh) const
{
    Array<Vec3d> places;
    Array<std::uint32_t> vertex_of;
    vertex_of.resize(positions.size(), kNone);
    places.reserve(positions.size());
    mesh.triangles.resize_for_overwrite(triangles());
    const std::uint32_t* corner = corners[0].data();
    std::uint32_t* const vertices = vertex_of.data();
    for (Triangle& triangle : mesh.triangles)
        for (std::uint32_t& index : triangle) {
            std::uint32_t& vertex = vertices[*corner];
            if (vertex == kNone) {
                vertex = static_cast<std::uint32_t>(places.size());
                places.push_back(positions[*corner]);
            }
            index = vertex;
            ++corner;
        }
    return places;
}

// The same, one for every (position, texture coordinate, normal) there is.
Array<Vec3d> ObjMesh::build_from_corners(Mesh& mesh) const
{
    Array<Vec3d> places;
    const bool with_uvs = !corners[1].empty(), with_normals = !corners[2].empty();
    struct Made {
        std::uint32_t uv, normal, next; // another one made of the same position
    };
    Array<Made> made;
    Array<std::uint32_t> first;
    first.resize(positions.size(), kNone);
    std::uint32_t* const firsts = first.data();
    places.reserve(positions.size());
    mesh.triangles.resize_for_overwrite(triangles());
    std::uint32_t* out = mesh.triangles.data()->data();
    for (std::size_t i = 0; i < corners[0].size(); ++i) {
        const std::uint32_t position = corners[0][i], uv = with_uvs ? corners[1][i] : kNone,
                            normal = with_normals ? corners[2][i] : kNone;
        std::uint32_t vertex = firsts[position], last = kNone;
        while (vertex != kNone && !(made[vertex].uv == uv && made[vertex].normal == normal)) {
            last = vertex;
            vertex = made[vertex].next;
        }
        if (vertex == kNone) {
            vertex = static_cast<std::uint32_t>(made.size());
            (last == kNone ? firsts[position] : made[last].next) = vertex;
            made.push_back({uv, normal, kNone});
            places.push_back(positions[position]);
            if (with_uvs) mesh.uvs.push_back(uv == kNone ? Vec2f{} : uvs[uv]);
            if (with_normals) mesh.normals.push_back(normals[normal]);
        }
        out[i] = vertex;
    }
    return places;
}

void ObjMesh::build(Mesh& mesh)
{
    if (!complete_normals()) corners[2].clear();
    if (corners[0].empty()) return;
    const bool plain = corners[1].empty() && corners[2].empty();
    const Array<Vec3d> places = plain ? build_from_positions(mesh) : build_from_corners(mesh);
    *this = {};
    set_positions(mesh, places);
}

} // namespace renderer
