#include "renderer/accel/baseline_mesh.h"
#include "tests/renderer/accel/mesh_rays.h"

#include <optional>
#include <string>

namespace {

using namespace renderer;
using namespace renderer::mesh_rays;

using Split = std::optional<BvhSplit>;

TriangleRun all_of(const Mesh& mesh)
{
    return {0, static_cast<std::uint32_t>(mesh.triangles.size())};
}

BaselineMesh baseline(const Mesh& mesh, Split split)
{
    ThreadPool one(1);
    return *BaselineMesh::build(mesh, all_of(mesh), split, one);
}

class BaselineMeshOfEachKind : public testing::TestWithParam<Split> {};

INSTANTIATE_TEST_SUITE_P(All,
                         BaselineMeshOfEachKind,
                         testing::Values(Split(), Split(BvhSplit::sah), Split(BvhSplit::midpoint)),
                         [](const auto& kind) {
                             if (!kind.param) return std::string("list");
                             return std::string(*kind.param == BvhSplit::sah ? "sah" : "midpoint");
                         });

TEST_P(BaselineMeshOfEachKind, FindsTheHitsOfTheWideTree)
{
    Random random(41);
    int hits = 0, rays = 0;
    for (const Mesh& mesh : ten_meshes()) {
        const MeshBvh wide = build(mesh);
        const BaselineMesh plain = baseline(mesh, GetParam());
        EXPECT_EQ(plain.bounds(), wide.bounds());
        EXPECT_EQ(plain.degenerate_triangles(), wide.degenerate_triangles());
        for (int i = 0; i < 2000 / kThinning; ++i) {
            const Ray ray = random_ray(random, mesh);
            const auto expected = wide.closest_hit(ray);
            ASSERT_TRUE(same(plain.closest_hit(ray), expected)) << "ray " << i;
            ASSERT_EQ(plain.any_hit(ray), expected.has_value()) << "ray " << i;
            hits += expected.has_value();
            ++rays;
        }
    }
    EXPECT_GT(hits, rays / 5);
}

TEST_P(BaselineMeshOfEachKind, FindsThemInMeshesOfEverySize)
{
    Random random(42);
    for (const int exponent : {-130, -60, -20, 20, 60, 100}) {
        Mesh mesh = ten_meshes().front();
        for (Vec3f& position : mesh.positions)
            position = position * std::ldexp(1.0f, exponent);
        const MeshBvh wide = build(mesh);
        const BaselineMesh plain = baseline(mesh, GetParam());
        for (int i = 0; i < 200 / kThinning; ++i) {
            const Ray ray = random_ray(random, mesh);
            ASSERT_TRUE(same(plain.closest_hit(ray), wide.closest_hit(ray))) << "2^" << exponent;
        }
    }
}

TEST_P(BaselineMeshOfEachKind, HasNoHitWhereThereIsNothing)
{
    Mesh flat;
    flat.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    flat.triangles = {{0, 1, 2}};
    const BaselineMesh nothing = baseline(flat, GetParam());
    EXPECT_TRUE(nothing.bounds().empty());
    EXPECT_EQ(nothing.degenerate_triangles(), 1u);
    EXPECT_FALSE(nothing.any_hit(Ray{{0.5, 0, 1}, {0, 0, -1}}));
    const BaselineMesh something = baseline(grid(4, 1), GetParam());
    EXPECT_FALSE(something.any_hit(Ray{{0, 0, 0}, {0, 0, 0}}));
}

TEST(BaselineMesh, HoldsATreeOnlyWhereOneIsAskedFor)
{
    const Mesh mesh = grid(20, 1);
    const std::uint64_t list = baseline(mesh, {}).size_bytes();
    EXPECT_LT(list, mesh.triangles.size() * sizeof(TriangleBlock)); // four of them a block
    // A binary tree has one inner node fewer than leaves, and leaves hold four triangles at most.
    const std::uint64_t nodes = mesh.triangles.size() / 4 * sizeof(BvhNode<float>);
    EXPECT_GT(baseline(mesh, BvhSplit::midpoint).size_bytes(), list + nodes);
}

TEST(BaselineMesh, StopsWhenAsked)
{
    std::stop_source stop;
    stop.request_stop();
    ThreadPool pool(1);
    const Mesh mesh = grid(50, 1);
    EXPECT_FALSE(BaselineMesh::build(mesh, all_of(mesh), BvhSplit::sah, pool, stop.get_token()));
}

} // namespace
