#include "server/import/lockdown.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdint>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace {

// Each body runs in a child of the test, which it leaves with 0 if all holds.
int locked_down(int (*body)())
{
    std::string why_not;
    if (!server::lock_down({512u << 20, 1u << 20, 5}, why_not)) return 99;
    return body();
}

rlim_t hard_limit(__rlimit_resource resource)
{
    rlimit limit{};
    return ::getrlimit(resource, &limit) == 0 ? limit.rlim_max : RLIM_INFINITY;
}

TEST(LockdownDeathTest, BoundsWhatTheImporterMayUse)
{
    const auto body = [] {
        const bool bounded = hard_limit(RLIMIT_CPU) == 6 && hard_limit(RLIMIT_FSIZE) == 1u << 20 &&
                             hard_limit(RLIMIT_CORE) == 0 && hard_limit(RLIMIT_NOFILE) <= 16;
        return bounded && ::prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0) == 1 ? 0 : 1;
    };
    EXPECT_EXIT(::_exit(locked_down(body)), testing::ExitedWithCode(0), "");
}

TEST(LockdownDeathTest, BoundsTheAddressSpaceAndForbidsTracing)
{
#ifdef HELIOGRAPH_SANITIZED
    GTEST_SKIP() << "sanitizers need the whole address space";
#else
    const auto body = [] {
        void* big = ::mmap(nullptr, 1u << 30, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        return big == MAP_FAILED && errno == ENOMEM && ::prctl(PR_GET_DUMPABLE) == 0 ? 0 : 1;
    };
    EXPECT_EXIT(::_exit(locked_down(body)), testing::ExitedWithCode(0), "");
#endif
}

} // namespace
