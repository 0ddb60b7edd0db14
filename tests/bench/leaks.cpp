// heliograph-bench leaks: rays at the edges and corners of closed meshes, near the origin and far from it, through
// every kernel of this processor, one by one and in runs: how many slip through. Ours may not lose one.
#include "renderer/accel/mesh_bvh.h"
#include "renderer/geometry/mesh_frame.h"
#include "renderer/geometry/rounding.h"
#include "renderer/parallel/thread_pool.h"
#include "tests/bench/bench_mesh.h"
#include "tests/bench/closed_mesh.h"
#include "tests/bench/commands.h"
#include "tests/bench/ray_engine.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>

namespace bench {

namespace {

using namespace renderer;
using random_scenes::Random;

// Where a model stands and how it is kept there.
struct Stand {
    const char* name;
    Vec3d at;
    bool as_floats; // the file's own, where they are; else in a frame of the mesh's own
};
constexpr Stand kStands[]{{"near", {0, 0, 0}, false},
                          {"far, in floats", {148376, 1234, -223423}, true},
                          {"far, own frame", {148376, 1234, -223423}, false},
                          {"1e6, own frame", {1e6, -1e6, 1e6}, false},
                          {"1e9, own frame", {-1e9, 1e9, 1e9}, false}};

Mesh place(const Model& model, const Stand& stand)
{
    Mesh mesh;
    mesh.triangles = model.triangles;
    std::vector<Vec3d> places;
    for (const Vec3d& p : model.places)
        places.push_back(p + stand.at);
    if (stand.as_floats)
        for (const Vec3d& p : places)
            mesh.positions.push_back(to_float(p));
    else
        set_positions(mesh, places);
    return mesh;
}

struct Count {
    std::uint64_t rays = 0, leaks = 0;
};

struct Tally {
    std::vector<Count> alone, in_runs; // one a kernel
    std::vector<Count> peers;
};

// Sixteen rays through one kernel: any hit and the closest, one by one and together.
void trace_block(const MeshBvh& bvh,
                 const std::array<AimedRay, 16>& aimed,
                 const MeshKernels& kernels,
                 Count& alone,
                 Count& in_runs)
{
    Ray rays[16];
    MeshHit hits[16];
    for (std::size_t i = 0; i < 16; ++i) {
        rays[i] = aimed[i].ray;
        alone.leaks += bvh.closest_hit(rays[i], kernels) ? 0u : 1u;
        alone.leaks += bvh.any_hit(rays[i], kernels) ? 0u : 1u;
    }
    in_runs.leaks += 16u - static_cast<unsigned>(std::popcount(bvh.closest_hits(rays, hits, kernels)));
    in_runs.leaks += 16u - static_cast<unsigned>(std::popcount(bvh.any_hits(rays, kernels)));
    alone.rays += 32;
    in_runs.rays += 32;
}

void trace_peers(const std::vector<std::unique_ptr<RayEngine>>& peers,
                 const std::array<AimedRay, 16>& aimed,
                 std::vector<Count>& counts)
{
    const RaySet set{"edges", false, false, {}};
    FloatRay rays[16];
    for (std::size_t i = 0; i < 16; ++i) {
        const Vec3f origin = to_float(aimed[i].ray.origin);
        rays[i] = {
            origin, 0, to_float(aimed[i].target - to_double(origin)), static_cast<float>(aimed[i].ray.t_max)};
    }
    for (std::size_t e = 0; e < peers.size(); ++e) {
        counts[e].rays += 16;
        counts[e].leaks += 16 - peers[e]->trace(set, rays);
    }
}

void add(std::vector<Count>& to, const std::vector<Count>& from)
{
    for (std::size_t i = 0; i < to.size(); ++i) {
        to[i].rays += from[i].rays;
        to[i].leaks += from[i].leaks;
    }
}

Tally empty_tally(std::size_t peers)
{
    const std::size_t kernels = all_mesh_kernels().size();
    return {std::vector<Count>(kernels), std::vector<Count>(kernels), std::vector<Count>(peers)};
}

// So many blocks of sixteen rays, half of them beams.
Tally trace_mesh(const ClosedMesh& closed,
                 const MeshBvh& bvh,
                 const std::vector<std::unique_ptr<RayEngine>>& peers,
                 std::uint64_t blocks,
                 std::uint64_t seed,
                 ThreadPool& pool)
{
    constexpr std::uint64_t kChunk = 256;
    Tally all = empty_tally(peers.size());
    std::mutex adding;
    pool.run((blocks + kChunk - 1) / kChunk, [&](std::size_t chunk, unsigned) {
        Random random(seed + chunk * 0x9e3779b97f4a7c15u);
        Tally mine = empty_tally(peers.size());
        std::array<AimedRay, 16> rays;
        for (std::uint64_t i = chunk * kChunk; i < std::min(blocks, (chunk + 1) * kChunk); ++i) {
            closed.aim(random, i % 2 == 0, rays);
            for (std::size_t k = 0; k < mine.alone.size(); ++k)
                trace_block(bvh, rays, all_mesh_kernels()[k], mine.alone[k], mine.in_runs[k]);
            trace_peers(peers, rays, mine.peers);
        }
        const std::lock_guard lock(adding);
        add(all.alone, mine.alone);
        add(all.in_runs, mine.in_runs);
        add(all.peers, mine.peers);
    });
    return all;
}

std::string in_words(const std::vector<Count>& counts)
{
    std::string text;
    for (const Count& count : counts)
        text += (text.empty() ? "" : " / ") + std::to_string(count.leaks);
    return text;
}

std::uint64_t sum_of(const std::vector<Count>& counts, std::uint64_t Count::*what)
{
    std::uint64_t sum = 0;
    for (const Count& count : counts)
        sum += count.*what;
    return sum;
}

std::vector<Model> models_for(const LeaksOptions& options)
{
    std::vector<Model> models{icosphere(4, 2),
                              torus_knot(192, 24),
                              wrinkled_sphere(1, 1, 6, 16, 16),
                              wrinkled_sphere(2, 1, 6, 64, 64),
                              wrinkled_sphere(3, 2, 2, 200, 200)};
    for (const std::string& path : options.meshes)
        models.push_back(model_of(read_mesh(path), path.substr(path.rfind('/') + 1)));
    return models;
}

// Ours in a row of the table; the peers' apart, by engine and stand.
class Table {
public:
    Table()
    {
        std::printf("rays that slip through, by kernel:");
        for (const MeshKernels& kernels : all_mesh_kernels())
            std::printf(" %s", kernels.name);
        std::printf("\n%-16s %-15s %9s %11s  %-15s %s\n",
                    "mesh",
                    "stands",
                    "triangles",
                    "rays",
                    "one by one",
                    "runs of 16");
    }
    void add(const Model& model,
             const Stand& stand,
             const Tally& tally,
             const std::vector<std::unique_ptr<RayEngine>>& peers)
    {
        const std::uint64_t rays = sum_of(tally.alone, &Count::rays) + sum_of(tally.in_runs, &Count::rays);
        traced_ += rays;
        leaks_ += sum_of(tally.alone, &Count::leaks) + sum_of(tally.in_runs, &Count::leaks);
        std::printf("%-16s %-15s %9zu %11llu  %-15s %s\n",
                    model.name.c_str(),
                    stand.name,
                    model.triangles.size(),
                    static_cast<unsigned long long>(rays),
                    in_words(tally.alone).c_str(),
                    in_words(tally.in_runs).c_str());
        std::fflush(stdout);
        for (std::size_t e = 0; e < peers.size(); ++e) {
            Count& count = peers_[peers[e]->name() + ", " + stand.name];
            count.rays += tally.peers[e].rays;
            count.leaks += tally.peers[e].leaks;
        }
    }
    // The number of leaks of ours.
    std::uint64_t finish() const
    {
        std::printf("%llu leaks in %llu rays\n",
                    static_cast<unsigned long long>(leaks_),
                    static_cast<unsigned long long>(traced_));
        for (const auto& [name, count] : peers_)
            std::printf("%s: %llu leaks in %llu rays\n",
                        name.c_str(),
                        static_cast<unsigned long long>(count.leaks),
                        static_cast<unsigned long long>(count.rays));
        return leaks_;
    }

private:
    std::uint64_t traced_ = 0, leaks_ = 0;
    std::map<std::string, Count> peers_;
};

} // namespace

void run_leaks(const LeaksOptions& options)
{
    ThreadPool pool(options.threads);
    const auto models = models_for(options);
    const auto cases = static_cast<double>(models.size() * std::size(kStands));
    const auto a_block = static_cast<double>(all_mesh_kernels().size() * 64);
    const auto blocks = static_cast<std::uint64_t>(std::ceil(options.rays / a_block / cases));
    Table table;
    std::uint64_t seed = 1;
    for (const Model& model : models)
        for (const Stand& stand : kStands) {
            const Mesh mesh = place(model, stand);
            const Bounds3f box = mesh.bounds();
            const float largest = std::max(max_abs(box.lower), max_abs(box.upper));
            const ClosedMesh closed(mesh, stand.as_floats ? 32 * 0x1p-23 * static_cast<double>(largest) : 0);
            const auto bvh = *MeshBvh::build(mesh,
                                             {0, static_cast<std::uint32_t>(mesh.triangles.size())},
                                             split_named(options.split),
                                             pool);
            std::vector<std::unique_ptr<RayEngine>> peers;
            // In a frame of the mesh's own a peer would be asked what it was asked near the origin.
            if (options.peer == "embree" && (stand.as_floats || stand.at == Vec3d{}))
                peers = make_embree_engines(mesh);
            for (const auto& peer : peers)
                peer->build();
            table.add(model, stand, trace_mesh(closed, bvh, peers, blocks, seed++ << 32, pool), peers);
        }
    if (table.finish() != 0) throw std::runtime_error("rays slipped through closed meshes");
}

} // namespace bench
