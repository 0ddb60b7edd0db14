#include "renderer/geometry/validate_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

namespace renderer {

namespace {

using Found = std::optional<Fault>;

std::string text(std::size_t number)
{
    return std::to_string(number);
}

Found inconsistent(std::string detail)
{
    return Fault{"", "inconsistent", std::move(detail)};
}

Found check_counts(const Mesh& mesh)
{
    if (mesh.triangles.empty())
        return Fault{"", "no_triangles", "the mesh has no triangles: export it with its faces"};
    constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max() - 1;
    if (mesh.triangles.size() > most || mesh.positions.size() > most)
        return inconsistent("the mesh has more than " + text(most) + " triangles or vertices: split it");
    const auto per_vertex = [&](std::size_t count, const char* what) -> Found {
        if (count == 0 || count == mesh.positions.size()) return std::nullopt;
        return inconsistent("the mesh has " + text(count) + " " + what + " for " +
                            text(mesh.positions.size()) +
                            " vertices: there must be one for every vertex, or none");
    };
    if (Found f = per_vertex(mesh.residuals.size(), "residuals")) return f;
    if (Found f = per_vertex(mesh.normals.size(), "normals")) return f;
    if (Found f = per_vertex(mesh.uvs.size(), "texture coordinates")) return f;
    if (!mesh.triangle_materials.empty() && mesh.triangle_materials.size() != mesh.triangles.size())
        return inconsistent("the mesh has " + text(mesh.triangle_materials.size()) +
                            " material numbers for " + text(mesh.triangles.size()) +
                            " triangles: there must be one for every triangle, or none");
    return std::nullopt;
}

Found not_finite(const char* what, std::size_t vertex)
{
    return Fault{"",
                 "non_finite",
                 std::string("the ") + what + " of vertex " + text(vertex) +
                     " is not a finite number (vertices are counted from 0): repair or remove it"};
}

// Rounding to nearest leaves 2^-24 of a number at most, and the kernels count on that.
bool is_rest(Vec3f residual, Vec3f position)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!(std::abs(residual[axis]) <= 0x1p-24f * std::abs(position[axis]))) return false;
    return true;
}

Found check_residuals(const Mesh& mesh)
{
    for (std::size_t i = 0; i < mesh.residuals.size(); ++i) {
        if (!is_finite(mesh.residuals[i])) return not_finite("residual", i);
        if (!is_rest(mesh.residuals[i], mesh.positions[i]))
            return inconsistent("the residual of vertex " + text(i) + " is more than rounding leaves");
    }
    return std::nullopt;
}

Found check_vertices(const Mesh& mesh)
{
    if (!is_finite(mesh.origin)) return Fault{"", "non_finite", "the origin of the mesh is not finite"};
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (!is_finite(mesh.positions[i])) return not_finite("position", i);
    if (Found f = check_residuals(mesh)) return f;
    for (std::size_t i = 0; i < mesh.normals.size(); ++i)
        if (!is_finite(mesh.normals[i])) return not_finite("normal", i);
    for (std::size_t i = 0; i < mesh.uvs.size(); ++i)
        if (!std::isfinite(mesh.uvs[i].x) || !std::isfinite(mesh.uvs[i].y))
            return not_finite("texture coordinate", i);
    return std::nullopt;
}

Found check_triangles(const Mesh& mesh)
{
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (const std::uint32_t vertex : mesh.triangles[i])
            if (vertex >= mesh.positions.size())
                return Fault{"",
                             "index_out_of_range",
                             "triangle " + text(i) + " names vertex " + text(vertex) + ", but the mesh has " +
                                 text(mesh.positions.size()) + " vertices (counted from 0)"};
    // Material 0 stands for the default where the file has no materials.
    const std::size_t materials = mesh.materials.empty() ? 1 : mesh.materials.size();
    for (std::size_t i = 0; i < mesh.triangle_materials.size(); ++i)
        if (mesh.triangle_materials[i] >= materials)
            return Fault{"",
                         "index_out_of_range",
                         "triangle " + text(i) + " names material " + text(mesh.triangle_materials[i]) +
                             ", but the mesh has " + text(materials) + " (counted from 0)"};
    return std::nullopt;
}

Found check_pictures(const Mesh& mesh)
{
    for (const MeshMaterial& m : mesh.materials)
        for (const auto* const map :
             {&m.color_map, &m.specular_map, &m.alpha_map, &m.physical_map, &m.emission_map, &m.normal_map})
            if (*map && ((*map)->image >= mesh.images.size() || (*map)->channel > 3))
                return Fault{"",
                             "index_out_of_range",
                             "material \"" + m.name + "\" names picture " + text((*map)->image) +
                                 ", but the mesh has " + text(mesh.images.size()) + " (counted from 0)"};
    for (const MeshImage& named : mesh.images)
        if (const auto bad = validate_image(named.image))
            return Fault{"", "inconsistent", "picture \"" + named.name + "\": " + *bad};
    return std::nullopt;
}

Found check_materials_and_parts(const Mesh& mesh)
{
    for (std::size_t i = 0; i < mesh.materials.size(); ++i) {
        const MeshMaterial& m = mesh.materials[i];
        for (const float value : {m.diffuse.r,
                                  m.diffuse.g,
                                  m.diffuse.b,
                                  m.specular.r,
                                  m.specular.g,
                                  m.specular.b,
                                  m.shininess,
                                  m.metallic,
                                  m.roughness,
                                  m.absorption.r,
                                  m.absorption.g,
                                  m.absorption.b,
                                  m.ior,
                                  m.opacity,
                                  m.cutoff,
                                  m.emission.r,
                                  m.emission.g,
                                  m.emission.b})
            if (!std::isfinite(value))
                return Fault{"",
                             "non_finite",
                             "material " + text(i) + " (\"" + m.name + "\") has a value that is not finite"};
        if (std::min({m.absorption.r, m.absorption.g, m.absorption.b}) < 0)
            return Fault{"",
                         "out_of_range",
                         "material " + text(i) + " (\"" + m.name + "\") absorbs less than nothing"};
        if (m.ior < 1 || m.ior > kGreatestMeshIor)
            return Fault{"",
                         "out_of_range",
                         "material " + text(i) + " (\"" + m.name +
                             "\") has an index of refraction below 1 or above 10"};
    }
    if (Found f = check_pictures(mesh)) return f;
    for (const MeshPart& part : mesh.parts)
        if (part.triangle_count == 0 || part.first_triangle >= mesh.triangles.size() ||
            part.triangle_count > mesh.triangles.size() - part.first_triangle)
            return Fault{"",
                         "index_out_of_range",
                         "part \"" + part.name + "\" names " + text(part.triangle_count) +
                             " triangles from " + text(part.first_triangle) + ", but the mesh has " +
                             text(mesh.triangles.size())};
    return std::nullopt;
}

} // namespace

std::optional<Fault> validate_mesh(const Mesh& mesh)
{
    if (Found f = check_counts(mesh)) return f;
    if (Found f = check_vertices(mesh)) return f;
    if (Found f = check_triangles(mesh)) return f;
    return check_materials_and_parts(mesh);
}

} // namespace renderer
