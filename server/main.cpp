// heliographd: the service. Options, signals, and the one line to standard error when it cannot start.
#include "server/app/app.h"
#include "server/app/options.h"
#include "server/app/stop_signals.h"

#include <exception>
#include <iostream>

int main(int argc, char** argv)
{
    try {
        const auto read = server::read_options(argc, argv);
        if (const auto* leave = std::get_if<server::EarlyExit>(&read)) {
            (leave->code == 0 ? std::cout : std::cerr) << leave->text;
            return leave->code;
        }
        const server::StopSignals signals; // before the first thread
        return server::run_service(std::get<server::ServiceOptions>(read), signals, std::cout);
    } catch (const std::exception& error) {
        std::cerr << "heliographd: " << error.what() << '\n';
        return 1;
    }
}
