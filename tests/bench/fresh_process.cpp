#include "tests/bench/fresh_process.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <malloc.h>
#include <stdexcept>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace bench {

namespace {

[[noreturn]] void be_the_child(int out, const std::function<std::vector<double>()>& work)
{
    int status = 1;
    try {
        const std::vector<double> numbers = work();
        const std::size_t bytes = numbers.size() * sizeof(double);
        // Less than PIPE_BUF: written at once or not at all.
        status = write(out, numbers.data(), bytes) == static_cast<ssize_t>(bytes) ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "heliograph-bench: %s\n", error.what());
    }
    _exit(status); // neither destructors nor buffers of the parent are the child's to end
}

} // namespace

std::vector<double> in_fresh_process(const std::function<std::vector<double>()>& work)
{
    int ends[2];
    if (pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
    std::fflush(nullptr);
    malloc_trim(0); // what has been freed comes to the child as new memory, not as the parent's to be copied
    const pid_t child = fork();
    if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
    if (child == 0) {
        close(ends[0]);
        be_the_child(ends[1], work);
    }
    close(ends[1]);
    std::vector<double> numbers(512 / sizeof(double));
    ssize_t got = 0;
    do
        got = read(ends[0], numbers.data(), numbers.size() * sizeof(double));
    while (got < 0 && errno == EINTR);
    close(ends[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (got < 0 || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw std::runtime_error("a measurement in a process of its own failed");
    numbers.resize(static_cast<std::size_t>(got) / sizeof(double));
    return numbers;
}

} // namespace bench
