#include "api/words/word_table.h"
#include "renderer/accel/mesh_bvh.h"
#include "renderer/parallel/thread_pool.h"
#include "tests/bench/fresh_process.h"
#include "tests/bench/ray_engine.h"
#include "tests/bench/stopwatch.h"

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
        return std::string("Heliograph, ") + kernels_.name +
               (split_ == BvhSplit::sah ? "" : ", " + split_name());
    }
    std::string tree() const override { return "Heliograph, " + split_name(); }
    bool high_quality() const override { return false; }
    BuildCost time_build(unsigned threads) const override
    {
        const std::vector<double> spent = in_fresh_process([&] {
            ThreadPool pool(threads);
            const Stopwatch watch(CLOCK_PROCESS_CPUTIME_ID);
            const std::optional<MeshBvh> bvh = MeshBvh::build(mesh_, all_triangles(), split_, pool);
            const Spent s = watch.spent();
            return std::vector<double>{s.wall_s, s.cpu_s};
        });
        return {spent.at(0), spent.at(1)};
    }
    void build() override
    {
        ThreadPool every_core;
        bvh_ = MeshBvh::build(mesh_, all_triangles(), split_, every_core);
    }
    std::uint64_t bytes() const override { return bvh_->size_bytes(); }
    std::uint64_t vertex_bytes() const override
    {
        return mesh_.positions.size() * sizeof(Vec3f) + mesh_.triangles.size() * sizeof(Triangle);
    }
    std::uint64_t trace(const RaySet& set, std::span<const FloatRay> rays, FoundHit* found) const override
    {
        return set.coherent ? trace_in_runs(set, rays, found) : trace_apart(set, rays, found);
    }

private:
    static Ray widen(const FloatRay& r)
    {
        return {to_double(r.origin), to_double(r.direction), r.t_min, r.t_max};
    }

    std::uint64_t trace_apart(const RaySet& set, std::span<const FloatRay> rays, FoundHit* found) const
    {
        constexpr std::size_t kAtOnce = 64;
        std::uint64_t hits = 0;
        Ray run[kAtOnce];
        MeshHit met[kAtOnce];
        for (std::size_t first = 0; first < rays.size(); first += kAtOnce) {
            const std::size_t count = std::min(kAtOnce, rays.size() - first);
            for (std::size_t i = 0; i < count; ++i)
                run[i] = widen(rays[first + i]);
            if (set.occlusion)
                bvh_->any_hits_apart({run, count}, met, kernels_);
            else
                bvh_->closest_hits_apart({run, count}, met, kernels_);
            for (std::size_t i = 0; i < count; ++i) {
                if (met[i].primitive == TriangleBlock::kNone) continue;
                ++hits;
                if (found == nullptr) continue;
                found[first + i] = set.occlusion ? FoundHit{0, 0} : FoundHit{met[i].primitive, met[i].t};
            }
        }
        return hits;
    }

    std::uint64_t trace_in_runs(const RaySet& set, std::span<const FloatRay> rays, FoundHit* found) const
    {
        std::uint64_t hits = 0;
        Ray run[MeshKernels::kMostRays];
        MeshHit met[MeshKernels::kMostRays];
        for (std::size_t first = 0; first < rays.size(); first += MeshKernels::kMostRays) {
            const std::size_t count = std::min<std::size_t>(MeshKernels::kMostRays, rays.size() - first);
            for (std::size_t i = 0; i < count; ++i)
                run[i] = widen(rays[first + i]);
            const std::span<const Ray> some(run, count);
            const std::uint64_t hit =
                set.occlusion ? bvh_->any_hits(some, kernels_) : bvh_->closest_hits(some, met, kernels_);
            hits += static_cast<std::uint64_t>(std::popcount(hit));
            if (found == nullptr) continue;
            for (std::size_t i = 0; i < count; ++i) {
                if ((hit >> i & 1u) == 0) continue;
                found[first + i] = set.occlusion ? FoundHit{0, 0} : FoundHit{met[i].primitive, met[i].t};
            }
        }
        return hits;
    }

    std::string split_name() const
    {
        return std::string(api::name_of(api::words_for<BvhSplit>(), static_cast<int>(split_)));
    }
    TriangleRun all_triangles() const { return {0, static_cast<std::uint32_t>(mesh_.triangles.size())}; }

    const Mesh& mesh_;
    BvhSplit split_;
    MeshKernels kernels_;
    std::optional<MeshBvh> bvh_;
};

} // namespace

BvhSplit split_named(const std::string& name)
{
    return static_cast<BvhSplit>(api::find_word(api::words_for<BvhSplit>(), name)->value);
}

std::vector<std::unique_ptr<RayEngine>>
make_heliograph_engines(const Mesh& mesh, BvhSplit split, bool every_kernel)
{
    std::vector<std::unique_ptr<RayEngine>> engines;
    for (const MeshKernels& kernels : all_mesh_kernels().first(every_kernel ? all_mesh_kernels().size() : 1))
        engines.push_back(std::make_unique<HeliographEngine>(mesh, split, kernels));
    return engines;
}

} // namespace bench
