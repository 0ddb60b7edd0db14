#include "server/jobs/deadline.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>

namespace {

using server::Deadline;

TEST(Deadline, ExpiresOnce)
{
    std::promise<void> expired;
    const Deadline deadline(0.001, [&] { expired.set_value(); }); // a second time would throw
    EXPECT_EQ(expired.get_future().wait_for(std::chrono::seconds(60)), std::future_status::ready);
}

TEST(Deadline, DoesNothingOnceItIsGone)
{
    bool expired = false;
    {
        const Deadline far(1e6, [&] { expired = true; }); // and its end waits for no time to pass
        const Deadline none(std::nullopt, [&] { expired = true; });
    }
    EXPECT_FALSE(expired);
}

} // namespace
