#include "renderer/accel/joined_mesh.h"

#include "renderer/geometry/triangle.h"

#include <utility>
#include <variant>

namespace renderer {

namespace {

Instance whole(const PreparedMesh& mesh)
{
    const MeshBvh* const bvh = bvh_of(mesh);
    return Instance::place(bvh != nullptr
                               ? InstanceGeometry{MeshGeometry{&mesh_of(mesh), bvh}}
                               : InstanceGeometry{BaselineGeometry{&mesh_of(mesh), baseline_of(mesh)}},
                           Affine3{})
        .value();
}

// The residuals too; whether there are any.
bool add_corner(Mesh& mesh, std::vector<Vec3f>& residuals, Vec3d place)
{
    const Vec3f rounded = to_float(place), rest = to_float(place - to_double(rounded));
    mesh.positions.push_back(rounded);
    residuals.push_back(rest);
    return rest.x != 0 || rest.y != 0 || rest.z != 0;
}

} // namespace

JoinedMesh::JoinedMesh(std::shared_ptr<const PreparedMesh> mesh,
                       std::vector<Origin> triangles,
                       std::span<const Member> members)
    : mesh_(std::move(mesh)), triangles_(std::move(triangles)), members_(members.begin(), members.end()),
      instance_(whole(*mesh_))
{
}

std::optional<JoinedMesh> JoinedMesh::join(std::span<const Instance> instances,
                                           std::span<const Member> members,
                                           MeshTree tree,
                                           ThreadPool& pool,
                                           const std::stop_token& stop)
{
    Mesh joined;
    std::vector<Vec3f> residuals;
    std::vector<Origin> triangles;
    bool more_than_floats = false;
    for (const Member& member : members) {
        const Instance& instance = instances[member.instance];
        const Mesh& mesh = *mesh_behind(instance.geometry());
        const Affine3 &there = instance.world_from_object(), &back = instance.object_from_world();
        for (std::uint32_t i = member.run.first; i < member.run.first + member.run.count; ++i) {
            const Triangle& v = mesh.triangles[i];
            const Vec3d a = mesh.position(v[0]), b = mesh.position(v[1]), c = mesh.position(v[2]);
            if (is_degenerate(a, b, c)) continue;
            const auto first = static_cast<std::uint32_t>(joined.positions.size());
            for (const Vec3d corner : {a, b, c})
                more_than_floats |= add_corner(joined, residuals, there.point(corner));
            joined.triangles.push_back({first, first + 1, first + 2});
            triangles.push_back(
                {member.instance, i, normalize(back.transposed_vector(normalize(cross(b - a, c - a))))});
        }
    }
    if (more_than_floats) joined.residuals = residuals;
    std::shared_ptr<const PreparedMesh> prepared = prepare_mesh(std::move(joined), tree, pool, stop);
    if (!prepared) return std::nullopt;
    return JoinedMesh(std::move(prepared), std::move(triangles), members);
}

SceneHit JoinedMesh::resolve(const Instance::Candidate& found, std::span<const Instance> instances) const
{
    const Origin& origin = triangles_[found.primitive];
    const Mesh &joined = mesh_of(*mesh_), &own = *mesh_behind(instances[origin.instance].geometry());
    const Vec3d& weights = found.barycentrics;
    const Triangle &v = joined.triangles[found.primitive], &own_v = own.triangles[origin.primitive];
    SceneHit hit;
    hit.t = found.t;
    hit.instance = origin.instance;
    hit.primitive = origin.primitive;
    hit.barycentrics = weights;
    hit.object_position = own.position(own_v[0]) * weights.x + own.position(own_v[1]) * weights.y +
                          own.position(own_v[2]) * weights.z;
    hit.point = weighted_point(joined.position(v[0]), joined.position(v[1]), joined.position(v[2]), weights);
    hit.point.normal = origin.normal;
    return hit;
}

} // namespace renderer
