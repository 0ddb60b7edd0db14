#include "renderer/parallel/thread_pool.h"

#include "renderer/math/floating_point_mode.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <sched.h>
#include <thread>
#include <vector>

namespace renderer {

unsigned usable_cores()
{
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) == 0)
        return static_cast<unsigned>(std::max(1, CPU_COUNT(&set)));
    return std::max(1u, std::thread::hardware_concurrency());
}

// One loop at a time: threads sleep until `generation` moves, claim items from `next`, and report back in
// `busy`.
struct ThreadPool::State {
    struct Loop {
        std::size_t items = 0;
        const std::function<void(std::size_t, unsigned)>* body = nullptr;
        std::stop_token stop;
        unsigned max_workers = 0;
        std::atomic<std::size_t> next{0};
        std::exception_ptr error; // the first one; under `mutex`
    };

    std::mutex callers; // one run() at a time
    std::mutex mutex;
    std::condition_variable wake, done;
    std::uint64_t generation = 0;
    unsigned busy = 0;
    bool closing = false;
    Loop* loop = nullptr;
    std::vector<std::jthread> threads;

    void work_on(Loop& l, unsigned worker)
    {
        try {
            while (!l.stop.stop_requested()) {
                const std::size_t item = l.next.fetch_add(1, std::memory_order_relaxed);
                if (item >= l.items) return;
                (*l.body)(item, worker);
            }
        } catch (...) {
            l.next.store(l.items, std::memory_order_relaxed);
            const std::lock_guard lock(mutex);
            if (!l.error) l.error = std::current_exception();
        }
    }

    void thread_main(unsigned worker)
    {
        const DefaultFloatingPoint whatever_the_maker_had;
        std::uint64_t seen = 0;
        std::unique_lock lock(mutex);
        for (;;) {
            wake.wait(lock, [&] { return closing || generation != seen; });
            if (closing) return;
            seen = generation;
            Loop* const l = loop;
            if (l == nullptr || worker >= l->max_workers) continue;
            ++busy;
            lock.unlock();
            work_on(*l, worker);
            lock.lock();
            if (--busy == 0) done.notify_all();
        }
    }
};

ThreadPool::ThreadPool(unsigned threads) : state_(std::make_unique<State>())
{
    const unsigned count = threads != 0 ? threads : usable_cores();
    for (unsigned worker = 1; worker < count; ++worker)
        state_->threads.emplace_back([state = state_.get(), worker] { state->thread_main(worker); });
}

ThreadPool::~ThreadPool()
{
    {
        const std::lock_guard lock(state_->mutex);
        state_->closing = true;
    }
    state_->wake.notify_all();
    state_->threads.clear();
}

unsigned ThreadPool::size() const
{
    return static_cast<unsigned>(state_->threads.size()) + 1;
}

void ThreadPool::run(std::size_t items,
                     const std::function<void(std::size_t, unsigned)>& body,
                     std::stop_token stop,
                     unsigned max_workers)
{
    const DefaultFloatingPoint whatever_the_caller_has;
    const std::lock_guard one_caller(state_->callers);
    State::Loop loop;
    loop.items = items;
    loop.body = &body;
    loop.stop = std::move(stop);
    loop.max_workers = max_workers == 0 ? size() : std::min(max_workers, size());
    if (loop.max_workers > 1 && items > 1) {
        {
            const std::lock_guard lock(state_->mutex);
            state_->loop = &loop;
            ++state_->generation;
        }
        state_->wake.notify_all();
    }
    state_->work_on(loop, 0);
    std::unique_lock lock(state_->mutex);
    state_->loop = nullptr; // a thread that wakes late finds nothing to join
    state_->done.wait(lock, [&] { return state_->busy == 0; });
    if (loop.error) std::rethrow_exception(loop.error);
}

} // namespace renderer
