#include "renderer/parallel/thread_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <sched.h>
#include <stdexcept>
#include <thread>
#include <vector>

using renderer::ThreadPool;

TEST(ThreadPool, RunsEveryItemExactlyOnceOnAnyNumberOfThreads)
{
    for (unsigned threads = 1; threads <= 8; ++threads) {
        ThreadPool pool(threads);
        ASSERT_EQ(pool.size(), threads);
        std::vector<std::atomic<int>> seen(10000);
        pool.run(seen.size(), [&](std::size_t item, unsigned) { seen[item].fetch_add(1); });
        for (const std::atomic<int>& count : seen)
            ASSERT_EQ(count.load(), 1);
    }
}

TEST(ThreadPool, NumbersWorkersBelowTheLimitAndUsesNoMore)
{
    ThreadPool pool(8);
    std::atomic<unsigned> largest{0}, inside{0}, most_inside{0};
    const auto raise = [](std::atomic<unsigned>& to, unsigned value) {
        for (unsigned old = to.load(); old < value && !to.compare_exchange_weak(old, value);) {
        }
    };
    pool.run(
        20000,
        [&](std::size_t, unsigned worker) {
            raise(most_inside, inside.fetch_add(1) + 1);
            raise(largest, worker);
            inside.fetch_sub(1);
        },
        {},
        3);
    EXPECT_LT(largest.load(), 3u);
    EXPECT_LE(most_inside.load(), 3u);
}

TEST(ThreadPool, StartsNoItemAfterAStop)
{
    ThreadPool pool(4);
    std::stop_source stop;
    std::atomic<int> ran{0}, late{0};
    pool.run(
        1'000'000,
        [&](std::size_t, unsigned) {
            if (stop.stop_requested()) late.fetch_add(1);
            if (ran.fetch_add(1) == 10) stop.request_stop();
        },
        stop.get_token());
    EXPECT_GE(ran.load(), 11);
    EXPECT_LE(late.load(), 3) << "each other thread may have been about to start one";
    ran = 0;
    pool.run(
        100, [&](std::size_t, unsigned) { ran.fetch_add(1); }, stop.get_token());
    EXPECT_EQ(ran.load(), 0);
}

TEST(ThreadPool, ThrowsTheBodysExceptionAndWorksOn)
{
    ThreadPool pool(4);
    EXPECT_THROW(pool.run(1000,
                          [](std::size_t item, unsigned) {
                              if (item == 500) throw std::runtime_error("item");
                          }),
                 std::runtime_error);
    std::atomic<int> ran{0};
    pool.run(1000, [&](std::size_t, unsigned) { ran.fetch_add(1); });
    EXPECT_EQ(ran.load(), 1000);
}

TEST(ThreadPool, QueuesCallersBehindOneAnother)
{
    ThreadPool pool(4);
    std::atomic<int> ran{0};
    {
        std::vector<std::jthread> callers;
        for (int c = 0; c < 8; ++c)
            callers.emplace_back([&] {
                for (int loop = 0; loop < 50; ++loop)
                    pool.run(20, [&](std::size_t, unsigned) { ran.fetch_add(1); });
            });
    }
    EXPECT_EQ(ran.load(), 8 * 50 * 20);
}

TEST(ThreadPool, RunsNothingForNoItems)
{
    ThreadPool pool(2);
    pool.run(0, [](std::size_t, unsigned) { FAIL(); });
}

namespace {

// How many of a loop's threads, all of the pool's, may not run on every processor of `usable`.
unsigned bound_threads(ThreadPool& pool, const cpu_set_t& usable)
{
    std::atomic<unsigned> inside{0}, bound{0};
    pool.run(pool.size(), [&](std::size_t, unsigned) {
        inside.fetch_add(1);
        while (inside.load() < pool.size())
            std::this_thread::yield();
        cpu_set_t mine;
        if (sched_getaffinity(0, sizeof mine, &mine) != 0 || !CPU_EQUAL(&mine, &usable)) bound.fetch_add(1);
    });
    return bound.load();
}

} // namespace

TEST(ThreadPool, WakesThreadsThatHaveFallenAsleepAndLeavesThemEveryProcessor)
{
    cpu_set_t usable;
    ASSERT_EQ(sched_getaffinity(0, sizeof usable, &usable), 0);
    ThreadPool pool(4);
    for (int loop = 0; loop < 20; ++loop) {
        ASSERT_EQ(bound_threads(pool, usable), 0u) << loop;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

// Loops that begin about when the threads fall asleep.
TEST(ThreadPool, LeavesThreadsEveryProcessorWhereverInFallingAsleepALoopFindsThem)
{
    using std::chrono::steady_clock;
    cpu_set_t usable;
    ASSERT_EQ(sched_getaffinity(0, sizeof usable, &usable), 0);
    ThreadPool pool(3);
    for (int loop = 0; loop < 300; ++loop) {
        ASSERT_EQ(bound_threads(pool, usable), 0u) << loop;
        const auto next = steady_clock::now() + std::chrono::microseconds(480 + loop % 60);
        while (steady_clock::now() < next)
            std::this_thread::yield();
    }
}

TEST(ThreadPool, RunsEveryItemOfItsPartsExactlyOnce)
{
    for (unsigned threads = 1; threads <= 8; ++threads) {
        ThreadPool pool(threads);
        for (const std::size_t items : {0u, 1u, 3u, 7u, 1000u}) {
            std::vector<std::atomic<int>> seen(items);
            pool.run_near(items, [&](std::size_t item, unsigned worker) {
                EXPECT_LT(worker, threads);
                seen[item].fetch_add(1);
            });
            for (const std::atomic<int>& count : seen)
                ASSERT_EQ(count.load(), 1);
        }
    }
}

TEST(ThreadPool, GivesEachWorkerTheSamePartInEveryLoop)
{
    ThreadPool pool(2);
    for (int loop = 0; loop < 10; ++loop) {
        std::atomic<unsigned> begun{0};
        std::size_t first[2] = {};
        pool.run_near(100, [&](std::size_t item, unsigned worker) {
            if (first[worker] != 0) return;
            first[worker] = item + 1;
            begun.fetch_add(1);
            while (begun.load() < 2)
                std::this_thread::yield();
        });
        EXPECT_EQ(first[0], 1u);
        EXPECT_EQ(first[1], 51u);
    }
}

TEST(ThreadPool, StopsLoopsOverPartsAsItStopsOthers)
{
    ThreadPool pool(4);
    std::stop_source stop;
    std::atomic<int> ran{0};
    pool.run_near(
        1'000'000,
        [&](std::size_t, unsigned) {
            if (ran.fetch_add(1) == 10) stop.request_stop();
        },
        stop.get_token());
    EXPECT_GE(ran.load(), 11);
    EXPECT_LT(ran.load(), 1'000'000);
    EXPECT_THROW(pool.run_near(1000,
                               [](std::size_t item, unsigned) {
                                   if (item == 500) throw std::runtime_error("item");
                               }),
                 std::runtime_error);
    ran = 0;
    pool.run_near(1000, [&](std::size_t, unsigned) { ran.fetch_add(1); });
    EXPECT_EQ(ran.load(), 1000);
}
