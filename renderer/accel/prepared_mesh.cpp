#include "renderer/accel/prepared_mesh.h"

#include "renderer/accel/baseline_mesh.h"
#include "renderer/accel/mesh_bvh.h"

#include <optional>
#include <utility>
#include <variant>

namespace renderer {

class PreparedMesh {
public:
    using Search = std::variant<MeshBvh, BaselineMesh>;

    PreparedMesh(std::shared_ptr<const Mesh> mesh, Search search, bool owns_mesh)
        : mesh_(std::move(mesh)), search_(std::move(search)), owns_mesh_(owns_mesh)
    {
    }

    const std::shared_ptr<const Mesh>& mesh() const { return mesh_; }
    const Search& search() const { return search_; }
    std::uint64_t size_bytes() const
    {
        return sizeof *this + bvh_bytes(*this) + (owns_mesh_ ? sizeof(Mesh) + mesh_->size_bytes() : 0);
    }

private:
    std::shared_ptr<const Mesh> mesh_;
    Search search_;
    bool owns_mesh_; // a part shares the arrays of the whole, which counts them
};

namespace {

std::shared_ptr<const PreparedMesh> prepare_run(std::shared_ptr<const Mesh> mesh,
                                                TriangleRun run,
                                                bool owns_mesh,
                                                MeshTree tree,
                                                ThreadPool& pool,
                                                const std::stop_token& stop)
{
    const auto prepared = [&](auto search) -> std::shared_ptr<const PreparedMesh> {
        if (!search) return nullptr;
        return std::make_shared<const PreparedMesh>(std::move(mesh), std::move(*search), owns_mesh);
    };
    switch (tree) {
    case MeshTree::wide_sah:
        return prepared(MeshBvh::build(*mesh, run, BvhSplit::sah, pool, stop));
    case MeshTree::wide_spatial:
        return prepared(MeshBvh::build(*mesh, run, BvhSplit::spatial, pool, stop));
    case MeshTree::wide_midpoint:
        return prepared(MeshBvh::build(*mesh, run, BvhSplit::midpoint, pool, stop));
    case MeshTree::binary_sah:
        return prepared(BaselineMesh::build(*mesh, run, BvhSplit::sah, pool, stop));
    case MeshTree::binary_midpoint:
        return prepared(BaselineMesh::build(*mesh, run, BvhSplit::midpoint, pool, stop));
    case MeshTree::none:
        return prepared(BaselineMesh::build(*mesh, run, std::nullopt, pool, stop));
    }
    return nullptr;
}

} // namespace

std::shared_ptr<const PreparedMesh>
prepare_mesh(Mesh mesh, MeshTree tree, ThreadPool& pool, const std::stop_token& stop)
{
    const TriangleRun all{0, static_cast<std::uint32_t>(mesh.triangles.size())};
    return prepare_run(std::make_shared<const Mesh>(std::move(mesh)), all, true, tree, pool, stop);
}

std::shared_ptr<const PreparedMesh> prepare_again(const std::shared_ptr<const PreparedMesh>& prepared,
                                                  MeshTree tree,
                                                  ThreadPool& pool,
                                                  const std::stop_token& stop)
{
    const TriangleRun all{0, static_cast<std::uint32_t>(mesh_of(*prepared).triangles.size())};
    return prepare_run(prepared->mesh(), all, true, tree, pool, stop);
}

std::shared_ptr<const PreparedMesh> prepare_part(const std::shared_ptr<const PreparedMesh>& whole,
                                                 const MeshPart& part,
                                                 MeshTree tree,
                                                 ThreadPool& pool,
                                                 const std::stop_token& stop)
{
    return prepare_run(whole->mesh(), {part.first_triangle, part.triangle_count}, false, tree, pool, stop);
}

const Mesh& mesh_of(const PreparedMesh& prepared)
{
    return *prepared.mesh();
}
const MeshBvh* bvh_of(const PreparedMesh& prepared)
{
    return std::get_if<MeshBvh>(&prepared.search());
}
const BaselineMesh* baseline_of(const PreparedMesh& prepared)
{
    return std::get_if<BaselineMesh>(&prepared.search());
}
std::uint64_t size_bytes(const PreparedMesh& prepared)
{
    return prepared.size_bytes();
}
std::uint64_t bvh_bytes(const PreparedMesh& prepared)
{
    return std::visit([](const auto& search) { return search.size_bytes(); }, prepared.search());
}
std::uint64_t degenerate_triangles(const PreparedMesh& prepared)
{
    return std::visit([](const auto& search) { return search.degenerate_triangles(); }, prepared.search());
}

TreeBytes tree_bytes(const PreparedMesh& prepared)
{
    const MeshBvh* const bvh = bvh_of(prepared);
    return bvh ? bvh->bytes() : TreeBytes();
}

std::shared_ptr<const PreparedMesh>
prepared_from(Mesh mesh, const TreeBytes& tree, const std::shared_ptr<const void>& keeper)
{
    std::optional<MeshBvh> bvh = MeshBvh::from_bytes(tree, keeper);
    if (!bvh) return nullptr;
    return std::make_shared<const PreparedMesh>(
        std::make_shared<const Mesh>(std::move(mesh)), std::move(*bvh), true);
}

} // namespace renderer
