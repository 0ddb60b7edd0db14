#include "clients/cli/sky_options.h"

#include "renderer/description/picture_formats.h"

#include <CLI/CLI.hpp>

namespace clients {

namespace {

constexpr const char* kAtmosphere =
    R"(JSON: an environment {"type": "atmosphere", ...}; "mode" exact or fast, "scattering" single or multiple)";

struct TableWords {
    const char* name;
    const char* help;
    const char* columns;
    ExitCode (*run)(const SkyTableOptions&, const std::stop_token&);
};

constexpr TableWords kTables[] = {
    {"probe",
     "radiance of the sky, row by row",
     "in: lambda_nm, altitude_m, sun_zenith_deg, az_deg, and view_zenith_deg or tangent_height_m (below 0: "
     "straight "
     "down)\nout: L_over_E0 (the total), single, total, in 1/sr over the sun's irradiance above the air",
     sky_probe_command},
    {"transmittance",
     "of the air from a point to its top, row by row",
     "in: lambda_nm, altitude_m, zenith_deg\nout: optical_depth, transmittance; behind the ground: inf, 0",
     sky_transmittance_command},
    {"irradiance",
     "of a horizontal surface, row by row",
     "in: lambda_nm, altitude_m, sun_zenith_deg\nout: Esun, E1 (sky, first order), Ems (sky, all others), "
     "Esky_total, "
     "over the sun's irradiance above the air",
     sky_irradiance_command},
};

} // namespace

void add_sky_commands(CLI::App& app,
                      SkyOptions& options,
                      const std::function<void(std::function<ExitCode(const std::stop_token&)>)>& chosen)
{
    CLI::App* sky = app.add_subcommand("sky", "ask an atmosphere");
    sky->require_subcommand(1);
    for (const TableWords& words : kTables) {
        CLI::App* command = sky->add_subcommand(words.name, words.help);
        command->footer(
            std::string(words.columns) +
            "\nColumn atm, where there is one: R, S or B, the reference preset of that letter instead of the "
            "file's.\nWithout a column altitude_m: the atmosphere's altitude_m. Other columns pass through.");
        command->add_option("--atmosphere", options.table.atmosphere, kAtmosphere)->required();
        command->add_option("--in", options.table.in, "CSV of questions; - for standard input")->required();
        command->add_option("--out", options.table.out, "CSV of answers; - for standard output")->required();
        command->add_option("--threads", options.table.threads, "0: one for every core")
            ->envname("HELIOGRAPH_THREADS")
            ->capture_default_str();
        command->parse_complete_callback([&options, chosen, run = words.run] {
            chosen([&options, run](const std::stop_token& stop) { return run(options.table, stop); });
        });
    }
    CLI::App* panorama = sky->add_subcommand("panorama", "the whole sky as an equirectangular picture");
    panorama->footer(
        "The centre column looks along -z, +x to its right, the top row is +y; seen from the atmosphere's "
        "altitude_m.\nW/(m^2 sr); the sun's disk is left out.");
    SkyPanoramaOptions& picture = options.panorama;
    panorama->add_option("--atmosphere", picture.atmosphere, kAtmosphere)->required();
    panorama
        ->add_option("-o,--output",
                     picture.output,
                     "picture; its extension tells the format: " + renderer::picture_extensions())
        ->required();
    panorama->add_option("--width", picture.width, "pixels")->capture_default_str();
    panorama->add_option("--height", picture.height, "pixels")->capture_default_str();
    panorama
        ->add_option(
            "--exposure-ev", picture.exposure_ev, "of a PNG or JPEG: light is multiplied by 2 to this power")
        ->capture_default_str();
    panorama->add_option("--threads", picture.threads, "0: one for every core")
        ->envname("HELIOGRAPH_THREADS")
        ->capture_default_str();
    panorama->parse_complete_callback([&options, chosen] {
        chosen(
            [&options](const std::stop_token& stop) { return sky_panorama_command(options.panorama, stop); });
    });
}

} // namespace clients
