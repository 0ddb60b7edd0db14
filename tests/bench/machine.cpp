#include "tests/bench/machine.h"

#include "renderer/accel/mesh_kernels.h"
#include "renderer/parallel/thread_pool.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <string>

namespace bench {

namespace {

std::string processor_name()
{
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name") && line.find(": ") != std::string::npos)
            return line.substr(line.find(": ") + 2);
    return "unknown";
}

} // namespace

nlohmann::json machine_json()
{
    return {{"processor", processor_name()},
            {"cores", renderer::usable_cores()},
            {"ray_kernel", renderer::mesh_kernels().name}};
}

nlohmann::json to_json(const Spread& spread)
{
    return {{"median", spread.median},
            {"min", spread.least},
            {"max", spread.greatest},
            {"lower_quartile", spread.lower_quartile},
            {"upper_quartile", spread.upper_quartile}};
}

} // namespace bench
