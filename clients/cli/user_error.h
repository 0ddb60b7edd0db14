// UserError: a command cannot go on; the message is for the user, the code for the shell. Thrown by the rooms
// of the CLI, caught once, in run_command_line().
#pragma once

#include "clients/cli/exit_code.h"

#include <stdexcept>
#include <string>

namespace clients {

class UserError : public std::runtime_error {
public:
    UserError(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

} // namespace clients
