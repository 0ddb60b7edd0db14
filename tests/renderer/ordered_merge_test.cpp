#include "renderer/ordered_merge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace {

struct Collect {
    std::vector<std::size_t>* order;
    void operator()(std::size_t number, int value) const
    {
        EXPECT_EQ(static_cast<std::size_t>(value), number * 3);
        order->push_back(number);
    }
};

} // namespace

TEST(OrderedMerge, PassesOnInOrderWhateverTheOrderOfArrival)
{
    std::vector<std::size_t> order;
    renderer::OrderedMerge<int, Collect> merge(0, 100, Collect{&order});
    for (const std::size_t number : {3u, 1u, 4u, 0u, 5u, 2u})
        merge.put(number, static_cast<int>(number * 3));
    EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5}));
}

TEST(OrderedMerge, KeepsOrderAmongManyThreadsWithASmallWindow)
{
    std::vector<std::size_t> order;
    renderer::OrderedMerge<int, Collect> merge(0, 2, Collect{&order});
    std::atomic<std::size_t> next = 0;
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 8; ++t)
            threads.emplace_back([&] {
                for (std::size_t n = next++; n < 5000; n = next++)
                    merge.put(n, static_cast<int>(n * 3));
            });
    }
    ASSERT_EQ(order.size(), 5000u);
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST(OrderedMerge, ReleasesWhoeverWaitsWhenItIsAborted)
{
    std::vector<std::size_t> order;
    renderer::OrderedMerge<int, Collect> merge(0, 1, Collect{&order});
    {
        std::jthread waiting([&] { merge.put(1, 3); }); // beyond the window: 0 never comes
        merge.abort();
    }
    merge.put(0, 0);
    EXPECT_TRUE(order.empty());
}
