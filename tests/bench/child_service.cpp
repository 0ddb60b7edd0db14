#include "tests/bench/child_service.h"

#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <spawn.h>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace bench {

namespace {

std::filesystem::path make_folder()
{
    std::string pattern = (std::filesystem::temp_directory_path() / "heliograph-bench-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot make a folder like " + pattern);
    return pattern;
}

// The first http://host:port of what the service prints when it is ready.
std::string read_url(int fd)
{
    std::string text;
    char buffer[512];
    while (text.find('\n') == std::string::npos) {
        const ssize_t got = read(fd, buffer, sizeof buffer);
        if (got <= 0) break;
        text.append(buffer, static_cast<std::size_t>(got));
    }
    const std::size_t start = text.find("http://");
    if (start == std::string::npos) throw std::runtime_error("heliographd did not come up: " + text);
    return text.substr(start, text.find_first_of(" \n)", start) - start);
}

double status_mib(pid_t pid, const std::string& field)
{
    std::ifstream status("/proc/" + std::to_string(pid) + "/status");
    for (std::string word; status >> word;) {
        double kib = 0;
        if (word == field + ":" && status >> kib) return kib / 1024;
    }
    return 0;
}

} // namespace

ChildService::ChildService(const std::vector<std::string>& extra_options) : folder_(make_folder())
{
    const std::string program =
        (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "heliographd").string();
    std::vector<std::string> words{program,
                                   "--port",
                                   "0",
                                   "--health-port",
                                   "0",
                                   "--log-level",
                                   "error",
                                   "--data",
                                   (folder_ / "data").string()};
    words.insert(words.end(), extra_options.begin(), extra_options.end());
    std::vector<char*> argv;
    for (std::string& word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);

    int out[2];
    if (pipe2(out, O_CLOEXEC) != 0) throw std::runtime_error("pipe2 failed");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
    const int failed = posix_spawn(&pid_, program.c_str(), &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(out[1]);
    if (failed != 0) throw std::runtime_error("cannot start " + program);
    url_ = read_url(out[0]);
    close(out[0]);
}

ChildService::~ChildService()
{
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
    std::error_code ignored; // a leftover in /tmp is no reason to lose the figures
    std::filesystem::remove_all(folder_, ignored);
}

double ChildService::resident_mib() const
{
    return status_mib(pid_, "VmRSS");
}
double ChildService::peak_mib() const
{
    return status_mib(pid_, "VmHWM");
}

} // namespace bench
