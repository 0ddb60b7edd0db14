// run_program: one of our programs as a user runs it, to its end.
#pragma once

#include <string>
#include <vector>

namespace tests {

struct ProgramRun {
    int exit_code = -1; // 128 + the signal's number if one ended it, as a shell has it
    std::string out, err;
};

// `words[0]` is the program's path; `environment` ("NAME=value") is added to ours. Throws std::system_error
// if it cannot be started.
ProgramRun run_program(const std::vector<std::string>& words,
                       const std::string& input = {},
                       const std::vector<std::string>& environment = {});

} // namespace tests
