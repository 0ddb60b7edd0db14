// The words of `heliograph sky ...` on the command line.
#pragma once

#include "clients/cli/sky_commands.h"

#include <functional>

namespace CLI { // NOLINT(readability-identifier-naming): as the library has it
class App;
}

namespace clients {

struct SkyOptions {
    SkyTableOptions table;
    SkyPanoramaOptions panorama;
};

// Adds `sky` and its commands to `app`; `chosen` is called with the action of the one that was named. `options` must
// outlive the parse and the action.
void add_sky_commands(CLI::App& app,
                      SkyOptions& options,
                      const std::function<void(std::function<ExitCode(const std::stop_token&)>)>& chosen);

} // namespace clients
