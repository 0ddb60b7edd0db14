#include "tests/support/run_program.h"

#include "tests/support/temp_folder.h"

#include <cerrno>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace tests {
namespace {

std::vector<char*> pointers_to(std::vector<std::string>& words)
{
    std::vector<char*> out;
    for (std::string& word : words)
        out.push_back(word.data());
    out.push_back(nullptr);
    return out;
}

int wait_for(pid_t child)
{
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "waitpid");
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

} // namespace

ProgramRun run_program(const std::vector<std::string>& words,
                       const std::string& input,
                       const std::vector<std::string>& environment)
{
    // Files rather than pipes: nothing can fill up and wait for the other.
    const TempFolder folder;
    const std::string in = folder.write("in", input), out = folder.file("out"), err = folder.file("err");
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, in.c_str(), O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT, 0600);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT, 0600);
    std::vector<std::string> arguments = words, variables = environment;
    for (char** variable = environ; *variable != nullptr; ++variable)
        variables.emplace_back(*variable);
    pid_t child = 0;
    const int error = ::posix_spawn(&child,
                                    words.at(0).c_str(),
                                    &actions,
                                    nullptr,
                                    pointers_to(arguments).data(),
                                    pointers_to(variables).data());
    ::posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::system_error(error, std::generic_category(), words[0]);
    const int code = wait_for(child);
    return {code, bytes_of(out), bytes_of(err)};
}

} // namespace tests
