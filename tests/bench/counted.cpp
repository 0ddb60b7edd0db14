#include "tests/bench/counted.h"

#include <cassert>

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#define HELIOGRAPH_CALLGRIND
#endif

namespace bench {

#ifdef HELIOGRAPH_CALLGRIND

bool CountedWork::is_possible()
{
    return RUNNING_ON_VALGRIND != 0;
}

CountedWork::CountedWork()
{
    CALLGRIND_ZERO_STATS;
    CALLGRIND_START_INSTRUMENTATION;
}

CountedWork::~CountedWork()
{
    CALLGRIND_STOP_INSTRUMENTATION;
}

void CountedWork::dump(const std::string& label)
{
    assert(label.size() <= 400); // callgrind copies it to 512 characters without looking
    CALLGRIND_DUMP_STATS_AT(label.c_str());
}

#else

bool CountedWork::is_possible()
{
    return false;
}

CountedWork::CountedWork() = default;
CountedWork::~CountedWork() = default;
void CountedWork::dump(const std::string&) {}

#endif

} // namespace bench
