// heliograph-bench memory: what trees hold and what building them takes at most, as predicted and as the system
// counts it; of one large mesh, or of many instances of a small one.
#include "renderer/accel/prepared_mesh.h"
#include "renderer/plan/budget.h"
#include "tests/bench/bench_instances.h"
#include "tests/bench/commands.h"
#include "tests/bench/stopwatch.h"
#include "tests/bench/terrain.h"

#include <cstdio>
#include <fstream>
#include <malloc.h>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace bench {

namespace {

using namespace renderer;

// Of this process, in bytes.
std::uint64_t status_bytes(const std::string& name)
{
    std::ifstream file("/proc/self/status");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with(name + ":")) return 1024 * std::stoull(line.substr(name.size() + 1));
    throw std::runtime_error("/proc/self/status says nothing of " + name);
}

// What is resident more than at the start: now, and at most since then.
class Growth {
public:
    Growth()
    {
        malloc_trim(0);
        before_ = status_bytes("VmRSS");
        std::ofstream("/proc/self/clear_refs") << "5"; // the peak starts anew
    }
    std::uint64_t most() const { return status_bytes("VmHWM") - before_; }
    std::uint64_t kept() const
    {
        malloc_trim(0);
        return status_bytes("VmRSS") - before_;
    }

private:
    std::uint64_t before_;
};

void print(const char* what, std::uint64_t predicted, std::uint64_t measured, std::uint64_t things)
{
    const auto a = static_cast<double>(predicted), b = static_cast<double>(measured);
    std::printf("%-24s predicted %8.1f MB, measured %8.1f MB, %6.1f bytes each, predicted/measured %.3f\n",
                what,
                a / 1e6,
                b / 1e6,
                b / static_cast<double>(things),
                a / b);
}

void measure_mesh(const std::shared_ptr<const PreparedMesh>& mesh, const Growth& growth)
{
    const std::uint64_t triangles = mesh_of(*mesh).triangles.size();
    print("tree, while it is built",
          tree_bytes(triangles) + tree_building_bytes(triangles),
          growth.most(),
          triangles);
    print("tree", tree_bytes(triangles), growth.kept(), triangles);
}

} // namespace

void run_memory(const MemoryOptions& options)
{
    ThreadPool pool(options.threads);
    Mesh made = terrain_mesh(options.triangles);
    const Growth of_mesh;
    const auto mesh = prepare_mesh(std::move(made), MeshTree::wide_sah, pool);
    if (options.instances == 0) return measure_mesh(mesh, of_mesh);
    const Growth growth;
    std::vector<Instance> instances = instances_of(*mesh, options.instances);
    const Stopwatch watch(CLOCK_PROCESS_CPUTIME_ID);
    const InstanceTree tree(std::move(instances), BvhSplit::sah, pool);
    const double build_s = watch.spent().cpu_s;
    std::printf("%u instances of %llu triangles: %.1f million\n",
                options.instances,
                static_cast<unsigned long long>(options.triangles),
                static_cast<double>(options.instances) * static_cast<double>(options.triangles) / 1e6);
    const std::uint64_t predicted = options.instances * kInstanceBytes;
    print("instances, being built",
          predicted + options.instances * kInstanceBuildingBytes,
          growth.most(),
          options.instances);
    print("instances", predicted, growth.kept(), options.instances);
    std::printf("upper level built in %.1f ms of processor time; %.3f million rays a second of it\n",
                1e3 * build_s,
                million_rays_a_second(tree));
}

} // namespace bench
