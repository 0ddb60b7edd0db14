// OrderedMerge: takes results in whatever order threads finish them and passes them on in the order of their
// numbers.
//
// Sums of floating numbers depend on their order; with this they have one, on any number of threads.
//
// Threads  put() from any thread; `merge` is called by one thread at a time, under the lock.
// Memory   at most `window` results wait. A thread that runs further ahead sleeps until the oldest one has
//          come; numbers are claimed in order, so whoever holds the oldest is at work and never sleeps here.
// Errors   abort() wakes and releases everybody; nothing is merged after it.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <map>
#include <mutex>
#include <utility>

namespace renderer {

template <typename Result, typename Merge>
class OrderedMerge {
public:
    OrderedMerge(std::size_t first, std::size_t window, Merge merge)
        : next_(first), window_(window), merge_(std::move(merge))
    {
    }

    void put(std::size_t number, Result result)
    {
        std::unique_lock lock(mutex_);
        has_room_.wait(lock, [&] { return aborted_ || number < next_ + window_; });
        if (aborted_) return;
        waiting_.emplace(number, std::move(result));
        const std::size_t before = next_;
        for (auto oldest = waiting_.begin(); oldest != waiting_.end() && oldest->first == next_;
             oldest = waiting_.begin()) {
            merge_(oldest->first, oldest->second);
            waiting_.erase(oldest);
            ++next_;
        }
        if (next_ != before) has_room_.notify_all();
    }

    void abort()
    {
        {
            const std::lock_guard lock(mutex_);
            aborted_ = true;
        }
        has_room_.notify_all();
    }

private:
    std::mutex mutex_;
    std::condition_variable has_room_;
    std::map<std::size_t, Result> waiting_;
    std::size_t next_, window_;
    Merge merge_;
    bool aborted_ = false;
};

} // namespace renderer
