// Commands that ask an atmosphere: radiance, transmittance and irradiance by rows of a table, and its panorama.
//
// Each prints what it has to say and returns the exit code; UserError for what the user can mend.
#pragma once

#include "clients/cli/exit_code.h"

#include <cstdint>
#include <stop_token>
#include <string>

namespace clients {

struct SkyTableOptions {
    std::string atmosphere; // JSON, an `atmosphere` environment
    std::string in, out;    // CSV; "-": standard input, standard output
    unsigned threads = 0;
};
ExitCode sky_probe_command(const SkyTableOptions& options, const std::stop_token& stop);
ExitCode sky_transmittance_command(const SkyTableOptions& options, const std::stop_token& stop);
ExitCode sky_irradiance_command(const SkyTableOptions& options, const std::stop_token& stop);

struct SkyPanoramaOptions {
    std::string atmosphere; // JSON, an `atmosphere` environment
    std::string output;     // its extension tells the format
    std::uint32_t width = 512, height = 256;
    double exposure_ev = 0; // of a PNG or JPEG
    unsigned threads = 0;
};
ExitCode sky_panorama_command(const SkyPanoramaOptions& options, const std::stop_token& stop);

} // namespace clients
