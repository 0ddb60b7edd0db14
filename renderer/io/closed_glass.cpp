#include "renderer/io/closed_glass.h"

#include "renderer/io/import_bounds.h"
#include "renderer/io/text.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>

namespace renderer {

namespace {

using Corner = std::tuple<float, float, float>;

// An edge by its ends in their order, and whether it is passed from the first to the second.
struct Edge {
    Corner first, second;
    bool forwards = true;
};

Corner corner_at(const Mesh& mesh, std::uint32_t vertex)
{
    const Vec3f p = mesh.positions[vertex] + Vec3f{0, 0, 0}; // no two zeros
    return {p.x, p.y, p.z};
}

bool is_closed(const Mesh& mesh, std::size_t material)
{
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::size_t of = mesh.triangle_materials.empty() ? 0 : mesh.triangle_materials[i];
        if (of != material) continue;
        std::array<Corner, 3> corners;
        for (std::size_t c = 0; c < 3; ++c)
            corners[c] = corner_at(mesh, mesh.triangles[i][c]);
        for (std::size_t c = 0; c < 3; ++c) {
            const Corner &a = corners[c], &b = corners[(c + 1) % 3];
            if (a < b) edges.push_back({a, b, true});
            if (b < a) edges.push_back({b, a, false});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return std::tie(a.first, a.second) < std::tie(b.first, b.second);
    });
    for (std::size_t i = 0; i < edges.size();) {
        std::ptrdiff_t balance = 0;
        const std::size_t begin = i;
        for (; i < edges.size() && edges[i].first == edges[begin].first &&
               edges[i].second == edges[begin].second;
             ++i)
            balance += edges[i].forwards ? 1 : -1;
        if (balance != 0) return false;
    }
    return true;
}

} // namespace

void keep_closed_glass(Mesh& mesh, std::vector<std::string>& notes)
{
    for (std::size_t i = 0; i < mesh.materials.size(); ++i) {
        MeshMaterial& material = mesh.materials[i];
        if (!material.is_glass || is_closed(mesh, i)) continue;
        material.is_glass = false;
        material.is_transparent = true;
        if (notes.size() < kMostNotes)
            notes.push_back("material " + in_quotes(material.name) +
                            " is of glass, but its triangles do not close a body: it is opaque");
    }
}

} // namespace renderer
