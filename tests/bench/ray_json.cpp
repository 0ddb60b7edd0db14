// The JSON of `heliograph-bench rays`. README.md describes it: members are added, not changed; else `format`
// counts up.
#include "tests/bench/machine.h"
#include "tests/bench/ray_report.h"

#include <nlohmann/json.hpp>

namespace bench {

namespace {

using nlohmann::json;

json to_json(const HitDifferences& d)
{
    return {{"rays", d.total()},
            {"only_ours", d.only_ours},
            {"only_theirs", d.only_theirs},
            {"other_triangle", d.other_triangle},
            {"because",
             {{"same_t", d.same_t},
              {"at_edge", d.at_edge},
              {"at_end", d.at_end},
              {"unexplained", d.unexplained},
              {"ours_wrong", d.ours_wrong}}}};
}

json to_json(const EngineReport& engine)
{
    json builds = json::array(), rays = json::array();
    for (const BuildFigures& build : engine.builds)
        builds.push_back({{"threads", build.threads},
                          {"cpu_ms", to_json(build.cpu_ms)},
                          {"wall_ms", to_json(build.wall_ms)}});
    for (const SetFigures& set : engine.sets)
        for (const RayFigures& f : set.figures) {
            json row{{"set", set.set},
                     {"threads", f.threads},
                     {"rays", f.rays},
                     {"hits", f.hits},
                     {"million_per_s", {{"cpu", to_json(f.cpu)}, {"wall", to_json(f.wall)}}},
                     {"million_per_cpu_s_by_repeat", f.cpu_repeats}};
            if (!engine.ours && set.differences) row["differs_from_first_engine"] = to_json(*set.differences);
            rays.push_back(std::move(row));
        }
    return {{"name", engine.name},
            {"tree", engine.tree},
            {"ours", engine.ours},
            {"high_quality", engine.high_quality},
            {"builds", std::move(builds)},
            {"bytes_per_triangle", engine.bytes_per_triangle},
            {"vertex_bytes_per_triangle", engine.vertex_bytes_per_triangle},
            {"rays", std::move(rays)}};
}

} // namespace

json to_json(const std::vector<RayReport>& reports)
{
    json cases = json::array();
    for (const RayReport& report : reports) {
        json engines = json::array();
        for (const EngineReport& engine : report.engines)
            engines.push_back(to_json(engine));
        cases.push_back({{"mesh", report.mesh},
                         {"view", report.view},
                         {"triangles", report.triangles},
                         {"diagonal", report.diagonal},
                         {"native_size", report.native},
                         {"repeats", report.repeats},
                         {"every", report.every},
                         {"engines", std::move(engines)}});
    }
    return {{"format", "heliograph-bench rays 1"}, {"machine", machine_json()}, {"cases", std::move(cases)}};
}

} // namespace bench
