// Every kernel that this processor can run: no ray slips through where triangles meet, at home and far away.
#include "renderer/accel/mesh_kernels.h"
#include "tests/renderer/accel/mesh_rays.h"

#include <string>

namespace {

using namespace renderer;
using namespace renderer::mesh_rays;

constexpr unsigned kRun = MeshKernels::kMostRays;
constexpr std::uint64_t kAllOfThem = ~std::uint64_t{0} >> (64 - kRun);

class WatertightMeshKernel : public testing::TestWithParam<MeshKernels> {};

INSTANTIATE_TEST_SUITE_P(All,
                         WatertightMeshKernel,
                         testing::ValuesIn(all_mesh_kernels().begin(), all_mesh_kernels().end()),
                         [](const auto& suite) { return std::string(suite.param.name); });

// From inside a closed mesh, in beams at its corners and edges.
void expect_closed(const MeshKernels& kernels, const Mesh& mesh, Vec3d inside, double room, int beams)
{
    Random random(34);
    const MeshBvh bvh = build(mesh);
    MeshHit hits[kRun];
    for (int i = 0; i < beams / kThinning; ++i) {
        const Triangle& t = mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
        const Vec3d origin = inside + random.direction() * (room * random.uniform());
        std::vector<Ray> rays(kRun);
        for (Ray& ray : rays) {
            const Vec3d a = to_double(mesh.positions[t[random.below(3)]]),
                        b = to_double(mesh.positions[t[random.below(3)]]);
            const double w = random.uniform();
            ray = {origin, a * w + b * (1 - w) - origin};
        }
        ASSERT_EQ(bvh.closest_hits(rays, hits, kernels), ~std::uint64_t{0}) << i;
        ASSERT_EQ(bvh.any_hits(rays, kernels), ~std::uint64_t{0}) << i;
    }
}

TEST_P(WatertightMeshKernel, LetsNoRayOutOfAClosedMesh)
{
    Random random(35);
    expect_closed(GetParam(), closed_sphere(random, {0, 0, 0}, 1, 6, 16, 16), {0, 0, 0}, 0.2, 5000);
    const Vec3d far{148376, 1234, -223423}; // a float there is 1/64 wide
    expect_closed(GetParam(), closed_sphere(random, far, 2, 2, 200, 200), far, 1, 2500);
}

// Where the meshes of the next tests stand, all their coordinates whole numbers: at home, and where a float is 1/64
// wide.
constexpr Vec3d kStands[]{{0, 0, 0}, {148376, 1234, -223423}};

Mesh moved(Mesh mesh, Vec3d by)
{
    for (auto& p : mesh.positions)
        p = to_float(to_double(p) + by);
    return mesh;
}

TEST_P(WatertightMeshKernel, FindsEachCellOfAPlaneFromAMillionAway)
{
    Random random(37);
    for (const Vec3d stand : kStands) {
        const Mesh mesh = moved(grid(100, 100), stand);
        const MeshBvh bvh = build(mesh);
        MeshHit hits[kRun];
        for (std::uint32_t first = 0; first + kRun <= mesh.triangles.size(); first += kRun) {
            std::vector<Ray> rays;
            Vec3d away = random.direction();
            away.y = std::abs(away.y) + 0.05;
            for (std::uint32_t i = first; i < first + kRun; ++i) {
                const Triangle& v = mesh.triangles[i];
                const Vec3d centroid =
                    (mesh.position(v[0]) + mesh.position(v[1]) + mesh.position(v[2])) / 3.0;
                const Vec3d origin = centroid + away * 1e6;
                rays.push_back({origin, centroid - origin});
            }
            ASSERT_EQ(bvh.closest_hits(rays, hits, GetParam()), kAllOfThem);
            for (std::uint32_t i = 0; i < kRun; ++i) {
                ASSERT_EQ(hits[i].primitive, first + i);
                ASSERT_EQ(bvh.closest_hit(rays[i], GetParam())->primitive, first + i);
            }
        }
    }
}

TEST_P(WatertightMeshKernel, HasNoGapsAlongALattice)
{
    Random random(38);
    for (const Vec3d stand : kStands) {
        Mesh mesh = grid(40, 40);
        for (auto& p : mesh.positions)
            p.y = static_cast<float>(random.below(4));
        const MeshBvh bvh = build(moved(mesh, stand));
        for (int i = -38; i <= 38; ++i)
            for (int j = -38; j + 16 <= 39; j += 16) {
                std::vector<Ray> rays;
                for (int k = 0; k < 16; ++k)
                    rays.push_back(
                        {stand + Vec3d{i * 0.5, 100, (j + k) * 0.5}, {0, -1, k % 2 == 0 ? 0.0 : -0.0}});
                ASSERT_EQ(bvh.any_hits(rays, GetParam()), 0xffffu) << i << ' ' << j;
                for (const Ray& ray : rays)
                    ASSERT_TRUE(bvh.any_hit(ray, GetParam())) << i << ' ' << j;
            }
    }
}

// A diagonal that Moller-Trumbore in float was seen to let a ray slip through.
TEST_P(WatertightMeshKernel, HoldsAtTheDiagonalOfAQuad)
{
    Mesh quad;
    quad.positions = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
    quad.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (const Vec3d stand : kStands) {
        const Ray ray{stand + Vec3d{0, 0, 10}, {.30458447, .30458447, -.9024725}};
        const auto hit = build(moved(quad, stand)).closest_hit(ray, GetParam());
        ASSERT_TRUE(hit);
        EXPECT_LT(length(ray.at(hit->t) - stand - Vec3d{3.375, 3.375, 0}), 1e-7);
        const std::vector<Ray> run(kRun, ray);
        EXPECT_EQ(build(moved(quad, stand)).any_hits(run, GetParam()), kAllOfThem);
    }
}

TEST_P(WatertightMeshKernel, HoldsWhereSixMeet)
{
    Random random(39);
    for (const Vec3d stand : kStands)
        for (int i = 0; i < 300 / kThinning; ++i) {
            Mesh fan;
            fan.positions.push_back({});
            for (int k = 0; k < 6; ++k) {
                fan.positions.push_back(
                    to_float({8 * std::cos(k * kPi / 3), 8 * std::sin(k * kPi / 3), random.uniform(-2, 2)}));
                fan.triangles.push_back(
                    {0, static_cast<std::uint32_t>(1 + k), static_cast<std::uint32_t>(1 + (k + 1) % 6)});
            }
            fan = moved(fan, stand);
            const MeshBvh bvh = build(fan);
            const Vec3d hub = fan.position(0);
            std::vector<Ray> rays;
            for (unsigned k = 0; k < kRun; ++k) {
                const Vec3d origin = hub + Vec3d{random.uniform(-8, 8), random.uniform(-8, 8), 32};
                rays.push_back({origin, hub - origin});
            }
            ASSERT_EQ(bvh.any_hits(rays, GetParam()), kAllOfThem);
            for (Ray& ray : rays) {
                int crossings = 0;
                while (const auto hit = bvh.closest_hit(ray, GetParam())) {
                    ASSERT_LT(++crossings, 7);
                    ray.t_min = hit->t; // what lies within rounding of it is the same crossing
                }
                ASSERT_EQ(crossings, 1);
            }
        }
}

} // namespace
