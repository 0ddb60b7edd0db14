#include "renderer/io/obj_mesh.h"

#include "renderer/geometry/mesh_frame.h"
#include "renderer/io/triangulate.h"

#include <algorithm>
#include <numeric>

namespace renderer {

void ObjMesh::add_triangle(const std::array<ObjCorner, 3>& corners)
{
    triangles.push_back(corners);
    triangle_parts.push_back(part);
    triangle_materials.push_back(material);
}

void ObjMesh::forget_parts()
{
    part = ObjCorner::kNone;
    part_names.clear();
    std::fill(triangle_parts.begin(), triangle_parts.end(), ObjCorner::kNone);
}

void ObjMesh::make_parts_contiguous(std::vector<MeshPart>& parts)
{
    const auto slot = [](std::uint32_t p) { return p == ObjCorner::kNone ? 0 : std::size_t(p) + 1; };
    if (part_names.empty()) return;
    std::vector<std::uint32_t> begin(part_names.size() + 2, 0);
    for (const std::uint32_t p : triangle_parts)
        ++begin[slot(p) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (std::size_t i = 0; i < part_names.size(); ++i)
        if (begin[i + 2] > begin[i + 1])
            parts.push_back({part_names[i], begin[i + 1], begin[i + 2] - begin[i + 1]});
    if (std::is_sorted(triangle_parts.begin(), triangle_parts.end(), [&](std::uint32_t a, std::uint32_t b) {
            return slot(a) < slot(b);
        }))
        return;
    std::vector<std::array<ObjCorner, 3>> sorted(triangles.size());
    std::vector<std::uint32_t> sorted_materials(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const std::uint32_t to = begin[slot(triangle_parts[i])]++;
        sorted[to] = triangles[i];
        sorted_materials[to] = triangle_materials[i];
    }
    triangles = std::move(sorted);
    triangle_materials = std::move(sorted_materials);
}

// Corners without a normal, or with a zero one, get their face's normal as one of their own. False if no
// corner has any.
bool ObjMesh::complete_normals()
{
    const auto lacks = [&](const ObjCorner& c) {
        return c.at[2] == ObjCorner::kNone || !(max_component(abs(normals[c.at[2]])) > 0);
    };
    const auto has_any = [&](const auto& t) { return !std::all_of(t.begin(), t.end(), lacks); };
    if (normals.empty() || std::none_of(triangles.begin(), triangles.end(), has_any)) return false;
    const std::size_t given = normals.size();
    for (auto& triangle : triangles) {
        if (std::none_of(triangle.begin(), triangle.end(), lacks)) continue;
        const std::array outline{
            positions[triangle[0].at[0]], positions[triangle[1].at[0]], positions[triangle[2].at[0]]};
        normals.push_back(polygon_normal(outline));
        for (ObjCorner& c : triangle)
            if (lacks(c)) c.at[2] = static_cast<std::uint32_t>(normals.size() - 1);
    }
    for (std::size_t i = 0; i < given; ++i)
        if (max_component(abs(normals[i])) > 0) normals[i] = to_float(normalize(to_double(normals[i])));
    return true;
}

void ObjMesh::build(Mesh& mesh)
{
    const bool with_normals = complete_normals();
    const bool with_uvs = std::any_of(triangles.begin(), triangles.end(), [](const auto& t) {
        return std::any_of(
            t.begin(), t.end(), [](const ObjCorner& c) { return c.at[1] != ObjCorner::kNone; });
    });
    std::vector<std::uint32_t> first(positions.size(),
                                     ObjCorner::kNone); // vertex made of a position: a list of its kinds
    std::vector<std::uint32_t> next;
    std::vector<Vec3d> in_file;
    std::vector<ObjCorner> made;
    mesh.triangles.reserve(triangles.size());
    for (const auto& triangle : triangles) {
        Triangle& indices = mesh.triangles.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) {
            ObjCorner c = triangle[i];
            if (!with_normals) c.at[2] = ObjCorner::kNone;
            std::uint32_t* link = &first[c.at[0]];
            while (*link != ObjCorner::kNone && !(made[*link] == c))
                link = &next[*link];
            if (*link == ObjCorner::kNone) {
                *link = static_cast<std::uint32_t>(made.size());
                indices[i] = *link; // before next grows: link may point into it
                made.push_back(c);
                next.push_back(ObjCorner::kNone);
                in_file.push_back(positions[c.at[0]]);
                if (with_uvs) mesh.uvs.push_back(c.at[1] == ObjCorner::kNone ? Vec2f{} : uvs[c.at[1]]);
                if (with_normals) mesh.normals.push_back(normals[c.at[2]]);
            } else {
                indices[i] = *link;
            }
        }
    }
    *this = {};
    set_positions(mesh, in_file);
}

} // namespace renderer
