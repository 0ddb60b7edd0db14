// Commands that need no service: render, check, plan, compare.
//
// Each prints what it has to say and returns the exit code; UserError for what the user can mend.
#pragma once

#include "clients/cli/exit_code.h"
#include "renderer/description/settings.h"

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace clients {

struct RenderOptions {
    std::string scene;  // file, mesh or "-"
    std::string output; // its extension tells the format; "-": PNG
    std::string report; // file for the report; empty: none
    // What stands here goes before what the scene says.
    std::optional<std::uint32_t> width_px, height_px, samples, threads, tile_px;
    std::optional<std::uint64_t> seed;
    std::optional<double> time_s;
    std::optional<renderer::BvhSplit> split;
    std::optional<std::uint32_t> bits; // a channel, of a PNG
    std::vector<std::string> layers;   // NAME=FILE, see layer_files.h; beside those that the scene asks for
    bool quiet = false;
};
ExitCode render_command(const RenderOptions& options, const std::stop_token& stop);

struct CheckOptions {
    std::string scene;
    bool expand = false;
};
ExitCode check_command(const CheckOptions& options);

// Prints the plan as JSON: what is used, what is left out, what it will take.
struct PlanOptions {
    std::string scene;
};
ExitCode plan_command(const PlanOptions& options);

struct CompareOptions {
    std::string picture, reference;
    bool json = false;
};
ExitCode compare_command(const CompareOptions& options);

} // namespace clients
