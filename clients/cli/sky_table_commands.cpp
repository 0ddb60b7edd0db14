// Rows in, rows out. What rows of several wavelengths share, a line of sight or a place under a sun, is asked once.
#include "clients/cli/csv_table.h"
#include "clients/cli/files.h"
#include "clients/cli/sky_commands.h"
#include "clients/cli/sky_queries.h"
#include "clients/cli/user_error.h"
#include "renderer/math/transcendental.h"
#include "renderer/sky/sky.h"

#include <array>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>

namespace clients {

namespace {

using renderer::Sky;
using renderer::SkyGeometry;
using renderer::Spectrum;

// What a row asks apart from the wavelength: altitude, sun, view, azimuth, tangent; unused ones are 0.
using Question = std::array<double, 6>;
// Answers, one a column that is written.
using Answer = std::vector<Spectrum>;

struct Task {
    std::vector<std::string> columns; // that are written
    std::function<Question(const CsvTable&, std::size_t row, double altitude)> read;
    std::function<Answer(const Sky&, const Question&)> solve;
    bool needs_scattered = true;
};

double angle(const CsvTable& table, std::size_t row, const char* column, double low, double high)
{
    const double value = table.number(row, column);
    if (!(value >= low && value <= high)) {
        char range[80];
        std::snprintf(range, sizeof range, ": not in [%g, %g]", low, high);
        table.fail(row, column + std::string(range));
    }
    return value;
}

ExitCode run(const SkyTableOptions& options, const Task& task, const std::stop_token& stop)
{
    if (options.out != "-") check_writable(options.out);
    CsvTable table(options.in, read_file(options.in));
    SkyQueries queries = read_sky_queries(table, options.atmosphere);
    std::size_t below_ground = 0;
    renderer::ThreadPool pool(options.threads);
    std::vector<std::pair<const SkyQueries::Part*, std::map<Question, std::vector<std::size_t>>>> work;
    for (SkyQueries::Part& part : queries.parts) { // every row is read before anything is worked out
        auto& questions = work.emplace_back(&part, std::map<Question, std::vector<std::size_t>>{}).second;
        for (std::size_t i = 0; i < part.rows.size(); ++i)
            questions[task.read(table,
                                part.rows[i],
                                altitude_of(table, part.rows[i], part.atmosphere, below_ground))]
                .push_back(i);
        if (!task.needs_scattered) part.atmosphere.scattering = renderer::SkyScattering::single;
    }
    for (const auto& [part, questions] : work) {
        const Sky sky(part->atmosphere, pool, stop);
        std::vector<const Question*> each;
        for (const auto& entry : questions)
            each.push_back(&entry.first);
        std::vector<Answer> answers(each.size());
        pool.run(
            each.size(), [&](std::size_t i, unsigned) { answers[i] = task.solve(sky, *each[i]); }, stop);
        if (stop.stop_requested()) return ExitCode::interrupted;
        for (std::size_t q = 0; q < each.size(); ++q)
            for (const std::size_t i : questions.at(*each[q]))
                for (std::size_t c = 0; c < task.columns.size(); ++c)
                    table.set(part->rows[i], task.columns[c], answers[q][c][part->wavelength[i]]);
    }
    write_file(options.out, table.write());
    if (below_ground > 0)
        std::fprintf(stderr, "note: %zu rows lie below the ground: taken as on it\n", below_ground);
    return ExitCode::ok;
}

Spectrum sum(Spectrum a, const Spectrum& b)
{
    for (std::size_t w = 0; w < a.size(); ++w)
        a[w] += b[w];
    return a;
}

// Where a line of sight is told by its tangent: [4] is 1 and [5] the tangent's altitude.
Question probe_of(const CsvTable& table, std::size_t row, double altitude)
{
    const double sun = angle(table, row, "sun_zenith_deg", 0, 180),
                 azimuth = angle(table, row, "az_deg", -1e6, 1e6);
    const bool by_tangent = !table.text(row, "tangent_height_m").empty();
    if (by_tangent && !table.text(row, "view_zenith_deg").empty())
        table.fail(row, "view_zenith_deg and tangent_height_m: give one of them");
    if (!by_tangent) return {altitude, sun, angle(table, row, "view_zenith_deg", 0, 180), azimuth, 0, 0};
    const double tangent = table.number(row, "tangent_height_m");
    if (tangent > altitude) table.fail(row, "tangent_height_m: above the eye");
    return {altitude, sun, 0, azimuth, 1, tangent};
}

Answer solve_probe(const Sky& sky, const Question& q)
{
    const double radius = sky.air().radius_m;
    renderer::SkyRadiance found;
    if (q[4] == 0) {
        found = sky.radiance(SkyGeometry::from_angles_deg(q[0], q[1], q[2], q[3]));
    } else {
        const SkyGeometry geometry = SkyGeometry::towards_tangent_deg(radius, q[0], q[5], q[1], q[3]);
        found = sky.radiance(q[5] < 0 ? renderer::PlanetRay(radius, q[0], -1)
                                      : renderer::PlanetRay::through(radius, q[0], q[5], true),
                             geometry);
    }
    const Spectrum total = sum(found.single, found.multiple);
    return {total, found.single, total};
}

Answer solve_transmittance(const Sky& sky, const Question& q)
{
    const double mu = renderer::sin_cos_deg(q[1]).second;
    const Spectrum transmittance = sky.transmittance(q[0], mu);
    Spectrum depth{};
    for (std::size_t w = 0; w < sky.air().wavelengths; ++w)
        depth[w] = transmittance[w] == 1 ? 0 : -renderer::log(transmittance[w]);
    return {depth, transmittance};
}

Answer solve_irradiance(const Sky& sky, const Question& q)
{
    const renderer::SkyIrradiance found = sky.irradiance(q[0], renderer::sin_cos_deg(q[1]).second);
    return {found.sun, found.single, found.multiple, sum(found.single, found.multiple)};
}

} // namespace

ExitCode sky_probe_command(const SkyTableOptions& options, const std::stop_token& stop)
{
    return run(options, {{"L_over_E0", "single", "total"}, probe_of, solve_probe}, stop);
}

ExitCode sky_transmittance_command(const SkyTableOptions& options, const std::stop_token& stop)
{
    const auto read = [](const CsvTable& table, std::size_t row, double altitude) -> Question {
        return {altitude, angle(table, row, "zenith_deg", 0, 180)};
    };
    return run(options, {{"optical_depth", "transmittance"}, read, solve_transmittance, false}, stop);
}

ExitCode sky_irradiance_command(const SkyTableOptions& options, const std::stop_token& stop)
{
    const auto read = [](const CsvTable& table, std::size_t row, double altitude) -> Question {
        return {altitude, angle(table, row, "sun_zenith_deg", 0, 180)};
    };
    return run(options, {{"Esun", "E1", "Ems", "Esky_total"}, read, solve_irradiance}, stop);
}

} // namespace clients
