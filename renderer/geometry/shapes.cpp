#include "renderer/geometry/shapes.h"

namespace renderer {

namespace {

// A unit square centred at `center`, spanned by u and v, facing u x v.
void add_face(Mesh& mesh, Vec3f center, Vec3f u, Vec3f v)
{
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec2f uv : {Vec2f{0, 0}, Vec2f{1, 0}, Vec2f{1, 1}, Vec2f{0, 1}}) {
        mesh.positions.push_back(center + u * (uv.x - 0.5f) + v * (uv.y - 0.5f));
        mesh.normals.push_back(cross(u, v));
        mesh.uvs.push_back(uv);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
}

} // namespace

Mesh unit_rectangle()
{
    Mesh mesh;
    add_face(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    return mesh;
}

Mesh unit_box()
{
    Mesh mesh;
    add_face(mesh, {0.5f, 0, 0}, {0, 0, -1}, {0, 1, 0});
    add_face(mesh, {-0.5f, 0, 0}, {0, 0, 1}, {0, 1, 0});
    add_face(mesh, {0, 0.5f, 0}, {1, 0, 0}, {0, 0, -1});
    add_face(mesh, {0, -0.5f, 0}, {1, 0, 0}, {0, 0, 1});
    add_face(mesh, {0, 0, 0.5f}, {1, 0, 0}, {0, 1, 0});
    add_face(mesh, {0, 0, -0.5f}, {-1, 0, 0}, {0, 1, 0});
    return mesh;
}

} // namespace renderer
