#include "server/import/lockdown.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace server {

namespace {

constexpr rlim_t kOpenFiles = 16; // standard streams, input, output, desk, and one companion file at a time

template <typename Resource>
bool bound(Resource resource, std::uint64_t soft, std::uint64_t hard)
{
    const auto clamped = [](std::uint64_t value) { return std::min<std::uint64_t>(value, RLIM_INFINITY); };
    const rlimit limit{clamped(soft), clamped(hard)};
    if (::setrlimit(resource, &limit) == 0) return true;
    // Raising above the hard limit that we came with is not allowed, and what we came with is tighter anyway.
    rlimit present{};
    return errno == EPERM && ::getrlimit(resource, &present) == 0 && present.rlim_max <= limit.rlim_max;
}

template <typename Resource>
bool bound(Resource resource, std::uint64_t value)
{
    return bound(resource, value, value);
}

bool bound_resources(const LockdownBounds& bounds)
{
    const std::uint64_t cpu_s = std::max<std::uint64_t>(bounds.cpu_s, 1);
    const std::uint64_t cpu_hard_s = cpu_s == UINT64_MAX ? cpu_s : cpu_s + 1;
#ifndef HELIOGRAPH_SANITIZED
    if (!bound(RLIMIT_AS, bounds.memory_bytes)) return false;
#endif
    return bound(RLIMIT_CPU, cpu_s, cpu_hard_s) && bound(RLIMIT_FSIZE, bounds.output_bytes) &&
           bound(RLIMIT_CORE, 0) && bound(RLIMIT_NOFILE, kOpenFiles) && bound(RLIMIT_NPROC, 0);
}

// Where /proc is not there, or does not let us, the kernel chooses by size, which fits an importer as well.
void be_first_to_go()
{
    const int fd = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
    if (fd < 0) return;
    const ssize_t written = ::write(fd, "1000", 4);
    static_cast<void>(written);
    ::close(fd);
}

} // namespace

bool lock_down(const LockdownBounds& bounds, std::string& why_not)
{
    const auto fail = [&](const char* what) {
        why_not = std::string(what) + ": " + std::strerror(errno);
        return false;
    };
    be_first_to_go();
    if (::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) return fail("PR_SET_PDEATHSIG");
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return fail("PR_SET_NO_NEW_PRIVS");
#ifndef HELIOGRAPH_SANITIZED
    if (::prctl(PR_SET_DUMPABLE, 0) != 0) return fail("PR_SET_DUMPABLE");
#endif
    if (!bound_resources(bounds)) return fail("setrlimit");
    return true;
}

} // namespace server
