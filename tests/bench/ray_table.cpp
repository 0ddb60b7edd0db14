#include "tests/bench/ray_report.h"

#include <algorithm>
#include <cinttypes>
#include <functional>
#include <optional>

namespace bench {

namespace {

constexpr int kNameWidth = 44, kColumnWidth = 24;

void print_cell(std::FILE* out, const std::string& text)
{
    std::fprintf(out, "%*s", kColumnWidth, text.c_str());
}

template <typename... Values>
std::string format(const char* pattern, Values... values)
{
    char text[96];
    std::snprintf(text, sizeof text, pattern, values...);
    return text;
}

// Half of the measurements lie within so much of the middle.
double spread_percent(const Spread& s)
{
    return 50 * (s.upper_quartile - s.lower_quartile) / s.median;
}

std::string short_name(const std::string& set)
{
    return set == "diffuse in pixel order" ? "diffuse in order" : set;
}

// "Embree high quality, packets of 16": "high, packets of 16".
std::string mode_of(const std::string& engine)
{
    std::string mode = engine.substr(engine.find(' ') + 1);
    if (const std::size_t at = mode.find(" quality"); at != std::string::npos) mode.erase(at, 8);
    return mode;
}

// Null where builds were not timed.
const BuildFigures* build_of(const EngineReport& engine, unsigned threads)
{
    const auto found = std::find_if(engine.builds.begin(), engine.builds.end(), [&](const BuildFigures& b) {
        return b.threads == threads;
    });
    return found == engine.builds.end() ? nullptr : &*found;
}

// Repeat by repeat, since what disturbs the machine disturbs a whole turn.
Spread ratio(const RayFigures& ours, const RayFigures& theirs)
{
    std::vector<double> ratios;
    for (std::size_t i = 0; i < ours.cpu_repeats.size(); ++i)
        ratios.push_back(ours.cpu_repeats[i] / theirs.cpu_repeats[i]);
    return spread_of(std::move(ratios));
}

// How the first engine stands to the best of those that `counts`.
void print_ratio_to_best(std::FILE* out,
                         const RayReport& report,
                         std::size_t thread_index,
                         const char* title,
                         const std::function<bool(const EngineReport&)>& counts)
{
    const EngineReport& ours = report.engines.front();
    const auto rate = [&](const EngineReport& e, std::size_t set) {
        return e.sets[set].figures[thread_index].cpu.median;
    };
    std::vector<const EngineReport*> best(ours.sets.size(), nullptr);
    for (const EngineReport& engine : report.engines)
        if (counts(engine))
            for (std::size_t set = 0; set < best.size(); ++set)
                if (best[set] == nullptr || rate(engine, set) > rate(*best[set], set)) best[set] = &engine;
    if (best.empty() || best.front() == nullptr) return;
    std::fprintf(out, "%-*s", kNameWidth, title);
    for (std::size_t set = 0; set < best.size(); ++set) {
        const Spread r =
            ratio(ours.sets[set].figures[thread_index], best[set]->sets[set].figures[thread_index]);
        print_cell(out, format("%.2f (%.2f to %.2f)", r.median, r.least, r.greatest));
    }
    std::fprintf(out, "\n%-*s", kNameWidth, "");
    for (const EngineReport* engine : best)
        print_cell(out, mode_of(engine->name));
    std::fprintf(out, "\n");
}

void print_rates(std::FILE* out, const RayReport& report, std::size_t thread_index)
{
    const EngineReport& first = report.engines.front();
    const unsigned threads = first.sets.front().figures[thread_index].threads;
    std::fprintf(out,
                 "%-*s",
                 kNameWidth,
                 format("Mrays/s of cpu time, %u thread%s", threads, threads == 1 ? "" : "s").c_str());
    for (const SetFigures& set : first.sets)
        print_cell(out, short_name(set.set));
    std::fprintf(out, "%16s %9s %7s %7s\n", "build cpu ms", "wall ms", "B/tri", "+vert");
    for (const EngineReport& engine : report.engines) {
        std::fprintf(out, "%-*s", kNameWidth, engine.name.c_str());
        for (const SetFigures& set : engine.sets) {
            const RayFigures& f = set.figures[thread_index];
            print_cell(out, format("%.2f +-%.0f%%", f.cpu.median, spread_percent(f.cpu)));
        }
        std::string cpu = "-", wall = "-";
        if (const BuildFigures* build = build_of(engine, threads)) {
            cpu = format("%.1f +-%.0f%%", build->cpu_ms.median, spread_percent(build->cpu_ms));
            wall = format("%.1f", build->wall_ms.median);
        }
        std::fprintf(out,
                     "%16s %9s %7.1f %7.1f\n",
                     cpu.c_str(),
                     wall.c_str(),
                     engine.bytes_per_triangle,
                     engine.vertex_bytes_per_triangle);
    }
    if (!first.ours) {
        std::fprintf(out, "\n");
        return;
    }
    const auto peer = [](const EngineReport& e) { return !e.ours; };
    print_ratio_to_best(out, report, thread_index, "ours / the peer's best mode", peer);
    print_ratio_to_best(out, report, thread_index, "ours / best of default quality", [&](const auto& e) {
        return peer(e) && !e.high_quality;
    });
    for (const EngineReport& engine : report.engines) {
        if (engine.ours || &engine == &report.engines.front()) continue;
        std::fprintf(out, "%-*s", kNameWidth, ("ours / " + engine.name).c_str());
        for (std::size_t set = 0; set < engine.sets.size(); ++set) {
            const Spread r =
                ratio(first.sets[set].figures[thread_index], engine.sets[set].figures[thread_index]);
            print_cell(out, format("%.2f", r.median));
        }
        const BuildFigures *build = build_of(first, threads), *theirs = build_of(engine, threads);
        std::string cpu = "-", wall = "-";
        if (build != nullptr && theirs != nullptr) {
            cpu = format("%.2f", build->cpu_ms.median / theirs->cpu_ms.median);
            wall = format("%.2f", build->wall_ms.median / theirs->wall_ms.median);
        }
        std::fprintf(out,
                     "%16s %9s %7.2f\n",
                     cpu.c_str(),
                     wall.c_str(),
                     first.bytes_per_triangle / engine.bytes_per_triangle);
    }
    std::fprintf(out, "\n");
}

void print_hits(std::FILE* out, const RayReport& report)
{
    const bool compared = report.engines.front().ours;
    std::fprintf(out, "%-*s", kNameWidth, compared ? "hits; rays answered otherwise" : "hits");
    for (const SetFigures& set : report.engines.front().sets)
        print_cell(out, format("of %" PRIu64, set.figures.front().rays));
    std::fprintf(out, "\n");
    HitDifferences sum;
    for (const EngineReport& engine : report.engines) {
        std::fprintf(out, "%-*s", kNameWidth, engine.name.c_str());
        for (const SetFigures& set : engine.sets) {
            if (!compared) {
                print_cell(out, format("%" PRIu64, set.figures.front().hits));
                continue;
            }
            const HitDifferences d = set.differences.value_or(HitDifferences{});
            print_cell(out, format("%" PRIu64 "; %" PRIu64, set.figures.front().hits, d.total()));
            sum.only_ours += d.only_ours;
            sum.only_theirs += d.only_theirs;
            sum.other_triangle += d.other_triangle;
            sum.same_t += d.same_t;
            sum.at_edge += d.at_edge;
            sum.at_end += d.at_end;
            sum.unexplained += d.unexplained;
            sum.ours_wrong += d.ours_wrong;
        }
        std::fprintf(out, "\n");
    }
    if (!compared) {
        std::fprintf(out, "\n");
        return;
    }
    std::fprintf(out,
                 "%" PRIu64 " answers differ: %" PRIu64 " hits only ours, %" PRIu64 " only theirs, %" PRIu64
                 " of another triangle. Why: %" PRIu64 " at the same t, %" PRIu64 " at an edge, %" PRIu64
                 " at an end of the ray, %" PRIu64 " unexplained, %" PRIu64 " a fault of ours.\n\n",
                 sum.total(),
                 sum.only_ours,
                 sum.only_theirs,
                 sum.other_triangle,
                 sum.same_t,
                 sum.at_edge,
                 sum.at_end,
                 sum.unexplained,
                 sum.ours_wrong);
}

} // namespace

void print_table(const RayReport& report, std::FILE* out)
{
    std::fprintf(out,
                 "%s, %s view: %" PRIu64 " triangles, diagonal %.4g%s; medians of %d, +- half the quartiles' "
                 "distance; ratios repeat by repeat\n",
                 report.mesh.c_str(),
                 report.view.c_str(),
                 report.triangles,
                 report.diagonal,
                 report.native ? " (its own)" : "",
                 report.repeats);
    if (report.every > 1) std::fprintf(out, "of %zu runs of rays one was traced\n", report.every);
    for (std::size_t i = 0; i < report.engines.front().sets.front().figures.size(); ++i)
        print_rates(out, report, i);
    print_hits(out, report);
}

} // namespace bench
