#include "renderer/accel/prepared_mesh.h"

#include "renderer/accel/mesh_bvh.h"

#include <optional>
#include <utility>

namespace renderer {

class PreparedMesh {
public:
    PreparedMesh(std::shared_ptr<const Mesh> mesh, MeshBvh bvh, bool owns_mesh)
        : mesh_(std::move(mesh)), bvh_(std::move(bvh)), owns_mesh_(owns_mesh)
    {
    }

    const std::shared_ptr<const Mesh>& mesh() const { return mesh_; }
    const MeshBvh& bvh() const { return bvh_; }
    std::uint64_t size_bytes() const
    {
        return sizeof *this + bvh_.size_bytes() + (owns_mesh_ ? sizeof(Mesh) + mesh_->size_bytes() : 0);
    }

private:
    std::shared_ptr<const Mesh> mesh_;
    MeshBvh bvh_;
    bool owns_mesh_; // a part shares the arrays of the whole, which counts them
};

namespace {

std::shared_ptr<const PreparedMesh> prepare_run(std::shared_ptr<const Mesh> mesh,
                                                TriangleRun run,
                                                bool owns_mesh,
                                                BvhSplit split,
                                                ThreadPool& pool,
                                                std::stop_token stop)
{
    std::optional<MeshBvh> bvh = MeshBvh::build(*mesh, run, split, pool, std::move(stop));
    if (!bvh) return nullptr;
    return std::make_shared<const PreparedMesh>(std::move(mesh), std::move(*bvh), owns_mesh);
}

} // namespace

std::shared_ptr<const PreparedMesh>
prepare_mesh(Mesh mesh, BvhSplit split, ThreadPool& pool, std::stop_token stop)
{
    const TriangleRun all{0, static_cast<std::uint32_t>(mesh.triangles.size())};
    return prepare_run(
        std::make_shared<const Mesh>(std::move(mesh)), all, true, split, pool, std::move(stop));
}

std::shared_ptr<const PreparedMesh> prepare_part(const std::shared_ptr<const PreparedMesh>& whole,
                                                 const MeshPart& part,
                                                 BvhSplit split,
                                                 ThreadPool& pool,
                                                 std::stop_token stop)
{
    return prepare_run(
        whole->mesh(), {part.first_triangle, part.triangle_count}, false, split, pool, std::move(stop));
}

const Mesh& mesh_of(const PreparedMesh& prepared)
{
    return *prepared.mesh();
}
const MeshBvh& bvh_of(const PreparedMesh& prepared)
{
    return prepared.bvh();
}
std::uint64_t size_bytes(const PreparedMesh& prepared)
{
    return prepared.size_bytes();
}
std::uint64_t bvh_bytes(const PreparedMesh& prepared)
{
    return prepared.bvh().size_bytes();
}
std::uint64_t degenerate_triangles(const PreparedMesh& prepared)
{
    return prepared.bvh().degenerate_triangles();
}

} // namespace renderer
