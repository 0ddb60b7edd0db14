#include "server/jobs/encoding_turns.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace {

using server::EncodingTurns;

TEST(EncodingTurns, AreNeverMoreThanThereAreAndNeverTwoOfOneKey)
{
    EncodingTurns turns(2);
    std::atomic<int> all = 0, of_a = 0, most = 0, most_of_a = 0;
    const auto raise = [](std::atomic<int>& most_seen, int now) {
        int seen = most_seen;
        while (now > seen && !most_seen.compare_exchange_weak(seen, now)) {
        }
    };
    const auto work = [&](const std::string& key) {
        for (int i = 0; i < 200; ++i) {
            const EncodingTurns::Turn turn(turns, key);
            raise(most, ++all);
            if (key == "a") raise(most_of_a, ++of_a);
            std::this_thread::yield();
            if (key == "a") --of_a;
            --all;
        }
    };
    {
        std::vector<std::jthread> threads;
        for (const char* key : {"a", "a", "a", "b", "c"})
            threads.emplace_back(work, std::string(key));
    }
    EXPECT_LE(most, 2);
    EXPECT_EQ(most_of_a, 1);
    EXPECT_EQ(all, 0);
}

TEST(EncodingTurns, EndWhereWorkThrows)
{
    EncodingTurns turns(1);
    EXPECT_THROW(
        {
            const EncodingTurns::Turn turn(turns, "a");
            throw 1;
        },
        int);
    const EncodingTurns::Turn again(turns, "a");
}

} // namespace
