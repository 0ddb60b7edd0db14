#include "api/words/word_table.h"
#include "tests/bench/bar_chart.h"
#include "tests/bench/evaluation.h"
#include "tests/bench/machine.h"

#include <nlohmann/json.hpp>

#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace bench {

namespace {

using nlohmann::json;
using namespace renderer;

const char* name_of(Scheduler scheduler)
{
    switch (scheduler) {
    case Scheduler::pool:
        return "pool";
    case Scheduler::async_a_tile:
        return "std::async, one a tile";
    case Scheduler::async_a_pixel:
        return "std::async, one a pixel";
    }
    return "";
}

json acceleration_json(const AccelerationSettings& a)
{
    const auto word = [](auto value) {
        return api::name_of(api::words_for<decltype(value)>(), static_cast<int>(value));
    };
    json bvh{{"width", word(a.width)}, {"levels", word(a.levels)}};
    if (a.split) bvh["split"] = word(*a.split); // as in a scene: without it, as pays
    return {{"bvh", bvh}, {"bounds", a.bounds}, {"threads", a.threads}, {"tile", a.tile_px}};
}

double percent_less(double before, double after)
{
    return 100 * (1 - after / before);
}

json to_json(const Row& row)
{
    return {{"variant", row.variant},
            {"acceleration", acceleration_json(row.acceleration)},
            {"scheduler", name_of(row.scheduler)},
            {"threads", row.threads},
            {"wall_s", to_json(row.wall_s)},
            {"cpu_s", to_json(row.cpu_s)},
            {"prepare_cpu_s", to_json(row.prepare_cpu_s)},
            {"pictures_a_measurement", row.pictures},
            {"same_picture", row.same_picture}};
}

json to_json(const Comparison& c)
{
    json rows = json::array();
    for (const Row& row : c.rows)
        rows.push_back(to_json(row));
    return {{"subject", c.subject},
            {"triangles", c.triangles},
            {"objects", c.objects},
            {"width", c.width_px},
            {"height", c.height_px},
            {"samples", c.samples},
            {"relative_rmse", c.relative_rmse},
            {"rows", std::move(rows)}};
}

const Spread& shown(const Figure& figure, const Row& row)
{
    return figure.wall ? row.wall_s : row.cpu_s;
}

std::string reduction(double before, double after)
{
    char text[48];
    const double percent = percent_less(before, after);
    if (percent < 0)
        std::snprintf(text, sizeof text, "+%.0f %%", -percent);
    else
        std::snprintf(text, sizeof text, percent < 99 ? "-%.1f %%" : "-%.3f %%", percent);
    return text;
}

std::string describe(const Comparison& c)
{
    return c.subject + ": " + std::to_string(c.triangles) + " triangles in " + std::to_string(c.objects) +
           (c.objects == 1 ? " object, " : " objects, ") + std::to_string(c.width_px) + " x " +
           std::to_string(c.height_px) + " pixels, " + std::to_string(c.samples) +
           (c.samples == 1 ? " sample" : " samples");
}

BarChart chart_of(const Figure& figure, int repeats)
{
    BarChart chart;
    chart.title = figure.title;
    chart.subtitle =
        "Medians of " + std::to_string(repeats) + ", whiskers from least to greatest. " + figure.note;
    chart.axis = figure.wall ? "seconds on the wall, one picture" : "seconds of the processor, one picture";
    double least = 1e300, greatest = 0;
    for (const Comparison& c : figure.comparisons) {
        BarGroup& group = chart.groups.emplace_back();
        group.name = describe(c);
        for (const Row& row : c.rows) {
            const Spread& value = shown(figure, row);
            const bool first = &row == &c.rows.front();
            group.bars.push_back(
                {row.variant,
                 value,
                 first ? "" : reduction(shown(figure, c.rows.front()).median, value.median)});
            least = std::min(least, value.least);
            greatest = std::max(greatest, value.greatest);
        }
    }
    chart.logarithmic = greatest > 30 * least;
    return chart;
}

struct Headline {
    double wall = 0, cpu = 0, cpu_with_trees = 0; // per cent less than without anything
};

Headline headline_of(const EvaluationReport& report)
{
    const Comparison& c = report.figures.back().comparisons.front();
    const Row &first = c.rows.front(), &last = c.rows.back();
    return {percent_less(first.wall_s.median, last.wall_s.median),
            percent_less(first.cpu_s.median, last.cpu_s.median),
            percent_less(first.cpu_s.median + first.prepare_cpu_s.median,
                         last.cpu_s.median + last.prepare_cpu_s.median)};
}

} // namespace

json to_json(const EvaluationReport& report)
{
    json figures = json::array();
    for (const Figure& figure : report.figures) {
        json comparisons = json::array();
        for (const Comparison& c : figure.comparisons)
            comparisons.push_back(to_json(c));
        figures.push_back({{"name", figure.name},
                           {"title", figure.title},
                           {"note", figure.note},
                           {"comparisons", std::move(comparisons)}});
    }
    const Headline headline = headline_of(report);
    return {{"format", "heliograph-bench evaluation 1"},
            {"machine", machine_json()},
            {"repeats", report.repeats},
            {"figures", std::move(figures)},
            {"headline",
             {{"reduction_percent_wall", headline.wall},
              {"reduction_percent_cpu", headline.cpu},
              {"reduction_percent_cpu_with_trees_built", headline.cpu_with_trees}}}};
}

void print_table(const EvaluationReport& report)
{
    for (const Figure& figure : report.figures) {
        std::printf("%s (%s)\n", figure.title.c_str(), figure.name.c_str());
        for (const Comparison& c : figure.comparisons) {
            std::printf("  %s; relative RMSE %.4f\n", describe(c).c_str(), c.relative_rmse);
            std::printf("  %-44s %7s %12s %22s %12s %10s %9s %10s\n",
                        "",
                        "threads",
                        "cpu ms",
                        "quartiles",
                        "wall ms",
                        "trees ms",
                        "faster",
                        "picture");
            for (const Row& row : c.rows)
                std::printf("  %-44s %7u %12.3f %10.3f to %8.3f %12.3f %10.2f %8.1fx %10s\n",
                            row.variant.c_str(),
                            row.threads,
                            1e3 * row.cpu_s.median,
                            1e3 * row.cpu_s.lower_quartile,
                            1e3 * row.cpu_s.upper_quartile,
                            1e3 * row.wall_s.median,
                            1e3 * row.prepare_cpu_s.median,
                            c.rows.front().cpu_s.median / row.cpu_s.median,
                            row.same_picture ? "the same" : "DIFFERS");
        }
        std::printf("\n");
    }
    const Headline headline = headline_of(report);
    std::printf(
        "From nothing to everything: %.3f %% less time on the wall, %.3f %% less of the processor; %.3f %% "
        "with the trees built for one picture.\n",
        headline.wall,
        headline.cpu,
        headline.cpu_with_trees);
}

void write_charts(const EvaluationReport& report, const std::filesystem::path& folder)
{
    for (const Figure& figure : report.figures) {
        const std::filesystem::path path = folder / (figure.name + ".svg");
        std::ofstream file(path);
        if (!(file << to_svg(chart_of(figure, report.repeats))) || !file.flush())
            throw std::runtime_error("cannot write " + path.string());
    }
}

} // namespace bench
