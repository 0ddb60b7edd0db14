// SkyQueries: the rows of a table, each a question to an atmosphere at one wavelength, put together so that what several
// wavelengths share is worked out once.
//
// Columns  lambda_nm always; atm: R, S or B puts that reference preset in the place of the file's, an empty cell leaves
//          it. A wavelength that the file does not name is taken by the preset's laws, unless the file gives
//          coefficients one by one.
// Errors   UserError(usage) with file and line; UserError(faults) for the atmosphere.
#pragma once

#include "clients/cli/csv_table.h"
#include "renderer/description/atmosphere.h"

#include <cstddef>
#include <string>
#include <vector>

namespace clients {

// The atmosphere that the file holds.
renderer::AtmosphereDescription read_atmosphere_file(const std::string& file);

struct SkyQueries {
    struct Part { // rows of one atmosphere
        renderer::AtmosphereDescription atmosphere;
        std::vector<std::size_t> rows;
        std::vector<std::size_t> wavelength; // of each of the rows: index into the atmosphere's
    };
    std::vector<Part> parts;
};

SkyQueries read_sky_queries(const CsvTable& table, const std::string& atmosphere_file);

// The row's altitude_m, or the atmosphere's own where there is no such column; below the ground: 0, and counted.
double altitude_of(const CsvTable& table,
                   std::size_t row,
                   const renderer::AtmosphereDescription& atmosphere,
                   std::size_t& below_ground);

} // namespace clients
