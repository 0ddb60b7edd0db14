// heliograph-bench: figures beside a peer or a baseline in the same run. Nothing here is a test.
#include "tests/bench/commands.h"

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

int main(int argc, char** argv)
{
    CLI::App app{"Measures Heliograph beside a peer or a baseline in the same run.", "heliograph-bench"};
    app.require_subcommand(1);
    bench::add_evaluation(app);
    bench::add_import(app);
    bench::add_leaks(app);
    bench::add_memory(app);
    bench::add_rays(app);
    bench::add_service(app);
    bench::add_sky(app);
    bench::add_terrain(app);
    bench::add_pictures(app);
    bench::add_tiles(app);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error);
    } catch (const std::exception& error) {
        std::cerr << "heliograph-bench: " << error.what() << "\n";
        return 1;
    }
    return 0;
}
