// Options of heliographd: one table of flags, environment variables, defaults and help.
//
// A flag --some-name is also the environment variable HELIOGRAPH_SOME_NAME; the flag wins. Every limit is an
// option: --limit-<name with dashes>.
// Errors  a wrong value is an answer with exit code 2 that names the option, the value and what is allowed.
#pragma once

#include "renderer/description/limits.h"
#include "server/log/log.h"

#include <filesystem>
#include <string>
#include <variant>

namespace server {

struct ServiceOptions {
    std::string host = "127.0.0.1";
    int port = 8080;        // 0: any free port
    int health_port = 8081; // 0: any free port; port + 1 unless given
    std::filesystem::path data = "heliograph-data";
    unsigned threads = 0; // of the renderer; 0: every core
    LogLevel log_level = LogLevel::info;
    bool insecure = false;                // strangers may send jobs
    std::filesystem::path import_program; // beside the running program unless given
    renderer::Limits limits;
};

// What to print instead of serving.
struct EarlyExit {
    int code = 0;
    std::string text; // for standard output if code is 0, else for standard error
};

// `argv` as main() got it.
std::variant<ServiceOptions, EarlyExit> read_options(int argc, const char* const* argv);

bool is_loopback(const std::string& host); // a name or address that only this machine reaches

} // namespace server
