// What a service's refusal means to the user of the command: words and exit code.
#pragma once

#include "clients/cli/http_client.h"
#include "clients/cli/user_error.h"

#include <string>

namespace clients {

ExitCode exit_code_of_status(int status);

// The problem's detail and its faults, one a line; or the status and the first words of whatever came
// instead. Control characters are replaced: a terminal obeys them.
std::string describe(const HttpAnswer& answer);

// "what: description", with the code that the status stands for.
UserError error_from(const std::string& what, const HttpAnswer& answer);

} // namespace clients
