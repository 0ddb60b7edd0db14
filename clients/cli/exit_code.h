// ExitCode: what the program's exit status means; clients/README.md and --help print this table.
#pragma once

#include <array>

namespace clients {

enum class ExitCode : int {
    ok = 0,
    failed = 1,       // the render or job failed, was cancelled, or the service is not ready (health)
    usage = 2,        // unknown option, or a file that cannot be read, written or compared
    faults = 3,       // the scene, or a mesh that it names, has faults; all are printed
    unreachable = 4,  // no service answers at the URL, or it stayed busy until --patience ended
    not_found = 5,    // the service knows no such job, or no longer has its picture
    timed_out = 6,    // --timeout ended, or the picture is not ready yet; the job goes on
    interrupted = 130 // Ctrl-C or SIGTERM
};

struct ExitCodeLine {
    ExitCode code;
    const char* meaning;
};

inline constexpr std::array<ExitCodeLine, 8> kExitCodes{{
    {ExitCode::ok, "done"},
    {ExitCode::failed, "the render or job failed or was cancelled; health: the service is not ready"},
    {ExitCode::usage, "unknown option, or a file that cannot be read, written or compared"},
    {ExitCode::faults, "the scene or one of its meshes has faults; all are printed"},
    {ExitCode::unreachable, "no service answers at the URL, or it stayed busy for as long as --patience"},
    {ExitCode::not_found, "no such job, or its picture is no longer kept"},
    {ExitCode::timed_out, "--timeout ended, or the picture is not ready yet; the job goes on"},
    {ExitCode::interrupted, "interrupted"},
}};

} // namespace clients
