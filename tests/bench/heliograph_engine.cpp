#include "renderer/accel/mesh_bvh.h"
#include "renderer/parallel/thread_pool.h"
#include "tests/bench/ray_engine.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <vector>

namespace bench {

using namespace renderer;

namespace {

class HeliographEngine : public RayEngine {
public:
    HeliographEngine(const Mesh& mesh, BvhSplit split, const MeshKernels& kernels)
        : mesh_(mesh), split_(split), kernels_(kernels)
    {
    }

    std::string name() const override
    {
        return std::string("Heliograph, ") + kernels_.name + (split_ == BvhSplit::sah ? "" : ", midpoint");
    }
    void build() override
    {
        bvh_.reset();
        ThreadPool one(1);
        bvh_ = MeshBvh::build(mesh_, {0, static_cast<std::uint32_t>(mesh_.triangles.size())}, split_, one);
    }
    std::uint64_t bytes() const override { return bvh_->size_bytes(); }
    std::uint64_t vertex_bytes() const override
    {
        return mesh_.positions.size() * sizeof(Vec3f) + mesh_.triangles.size() * sizeof(Triangle);
    }
    std::uint64_t trace(const RaySet& set, std::span<const FloatRay> rays) const override
    {
        std::uint64_t hits = 0;
        Ray run[MeshKernels::kMostRays];
        MeshHit found[MeshKernels::kMostRays];
        for (std::size_t first = 0; first < rays.size(); first += MeshKernels::kMostRays) {
            const std::size_t count = std::min<std::size_t>(MeshKernels::kMostRays, rays.size() - first);
            for (std::size_t i = 0; i < count; ++i) {
                const FloatRay& r = rays[first + i];
                run[i] = {to_double(r.origin), to_double(r.direction), r.t_min, r.t_max};
            }
            const std::span<const Ray> some(run, count);
            hits += static_cast<std::uint64_t>(std::popcount(
                set.occlusion ? bvh_->any_hits(some, kernels_) : bvh_->closest_hits(some, found, kernels_)));
        }
        return hits;
    }

private:
    const Mesh& mesh_;
    BvhSplit split_;
    MeshKernels kernels_;
    std::optional<MeshBvh> bvh_;
};

} // namespace

std::vector<std::unique_ptr<RayEngine>>
make_heliograph_engines(const Mesh& mesh, BvhSplit split, bool every_kernel)
{
    std::vector<std::unique_ptr<RayEngine>> engines;
    for (const MeshKernels& kernels : all_mesh_kernels().first(every_kernel ? all_mesh_kernels().size() : 1))
        engines.push_back(std::make_unique<HeliographEngine>(mesh, split, kernels));
    return engines;
}

} // namespace bench
