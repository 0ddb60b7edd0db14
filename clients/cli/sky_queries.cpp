#include "clients/cli/sky_queries.h"

#include "api/read_atmosphere.h"
#include "clients/cli/files.h"
#include "clients/cli/user_error.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>

namespace clients {

namespace {

using renderer::AtmosphereDescription;
using renderer::AtmospherePreset;

std::optional<AtmospherePreset> preset_of(const CsvTable& table, std::size_t row)
{
    const std::string& letter = table.text(row, "atm");
    if (letter.empty()) return std::nullopt;
    if (letter == "R") return AtmospherePreset::reference_r;
    if (letter == "S") return AtmospherePreset::reference_s;
    if (letter == "B") return AtmospherePreset::reference_b;
    table.fail(row, "atm: \"" + letter + "\" is none of R, S, B; an empty cell takes the file's atmosphere");
}

AtmosphereDescription
read(const std::string& file, const std::string& text, std::optional<AtmospherePreset> preset)
{
    auto result = api::read_atmosphere(text, preset);
    const auto* problem = std::get_if<api::ProblemDetails>(&result);
    if (!problem) return std::get<AtmosphereDescription>(std::move(result));
    std::string message = file + ": " + problem->detail;
    for (const api::Problem& fault : problem->errors)
        message += "\n  " + fault.pointer + ": " + fault.detail;
    throw UserError(ExitCode::faults, message);
}

bool by_laws_alone(const AtmosphereDescription& atmosphere)
{
    const auto one_for_all = [](const std::vector<double>& list) { return list.size() <= 1; };
    return one_for_all(atmosphere.planet.ground_albedo) && one_for_all(atmosphere.rayleigh.scattering) &&
           one_for_all(atmosphere.mie.scattering) && one_for_all(atmosphere.mie.extinction) &&
           one_for_all(atmosphere.ozone.absorption);
}

// The atmosphere's wavelengths become those that its rows ask for, where it has laws for them.
void settle_wavelengths(const CsvTable& table, SkyQueries::Part& part)
{
    std::vector<double>& known = part.atmosphere.wavelengths_nm;
    if (by_laws_alone(part.atmosphere)) known.clear();
    const bool may_add = known.empty();
    for (const std::size_t row : part.rows) {
        const double nm = table.number(row, "lambda_nm");
        auto found = std::find(known.begin(), known.end(), nm);
        if (found == known.end()) {
            if (!may_add)
                table.fail(row,
                           "lambda_nm: " + table.text(row, "lambda_nm") +
                               " is none of the atmosphere's wavelengths_nm, whose coefficients are given "
                               "one by one");
            if (!(nm >= 100 && nm <= 10'000)) table.fail(row, "lambda_nm: not in [100, 10000]");
            if (known.size() == renderer::kMostWavelengths)
                table.fail(row,
                           "lambda_nm: more than " + std::to_string(renderer::kMostWavelengths) +
                               " different ones");
            found = known.insert(known.end(), nm);
        }
        part.wavelength.push_back(static_cast<std::size_t>(found - known.begin()));
    }
}

} // namespace

AtmosphereDescription read_atmosphere_file(const std::string& file)
{
    return read(file, read_file(file), {});
}

SkyQueries read_sky_queries(const CsvTable& table, const std::string& atmosphere_file)
{
    const std::string text = read_file(atmosphere_file);
    read(atmosphere_file, text, {}); // its faults first, whatever the rows say
    if (table.rows() > 0) static_cast<void>(table.column("lambda_nm"));
    std::map<std::optional<AtmospherePreset>, std::size_t> known;
    SkyQueries queries;
    for (std::size_t row = 0; row < table.rows(); ++row) {
        const auto preset = preset_of(table, row);
        const auto [found, is_new] = known.emplace(preset, queries.parts.size());
        if (is_new) queries.parts.push_back({read(atmosphere_file, text, preset), {}, {}});
        queries.parts[found->second].rows.push_back(row);
    }
    for (SkyQueries::Part& part : queries.parts)
        settle_wavelengths(table, part);
    return queries;
}

double altitude_of(const CsvTable& table,
                   std::size_t row,
                   const AtmosphereDescription& atmosphere,
                   std::size_t& below_ground)
{
    if (!table.has("altitude_m")) return atmosphere.altitude_m;
    const double altitude = table.number(row, "altitude_m");
    if (altitude > 1e15) table.fail(row, "altitude_m: beyond 1e15");
    if (altitude >= 0) return altitude;
    ++below_ground;
    return 0;
}

} // namespace clients
