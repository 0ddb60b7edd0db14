// The command line of `heliograph`: every option with its flag, environment variable, default and help, in
// one place.
#pragma once

namespace clients {

// Parses, runs the command and returns the exit status (exit_code.h). The only catch site of the program.
int run_command_line(int argc, char** argv);

} // namespace clients
