// The sub-commands of heliograph-bench: each adds itself to the command line and runs when it is named.
#pragma once

namespace CLI {
class App;
}

namespace bench {

void add_evaluation(CLI::App& app);
void add_import(CLI::App& app);
void add_leaks(CLI::App& app);
void add_memory(CLI::App& app);
void add_pictures(CLI::App& app);
void add_rays(CLI::App& app);
void add_service(CLI::App& app);
void add_sky(CLI::App& app);
void add_terrain(CLI::App& app);
void add_tiles(CLI::App& app);

} // namespace bench
