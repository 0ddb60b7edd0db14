// ThreadPool: a fixed set of std::jthread that run one parallel loop at a time.
//
// Threads  run() may be called from any thread, but not from a body of the same pool; callers queue behind one
//          another. The caller works along, so a pool of n has n-1 threads of its own. The body is called concurrently.
// Numbers  bodies run in the default floating-point environment, also in a caller that has set another.
// Errors   an exception from the body stops the loop and is thrown again by run().
// Cost     one atomic increment an item: items should take microseconds, not nanoseconds. After a loop the threads
//          stay awake for half a millisecond, giving way to whoever wants their processor, then sleep; those that
//          sleep are woken, as many as there are items for, on other processors than the caller's where there are any.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <stop_token>

namespace renderer {

unsigned usable_cores(); // those this process may run on, 1 at least

class ThreadPool {
public:
    // `threads` 0: usable_cores().
    explicit ThreadPool(unsigned threads = 0);
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    unsigned size() const;

    // Calls body(item, worker) for every item in [0, items), in order of claim, worker in [0, workers used).
    // At most `max_workers` threads take part (0: all). Once `stop` is requested nobody claims another item.
    void run(std::size_t items,
             const std::function<void(std::size_t item, unsigned worker)>& body,
             std::stop_token stop = {},
             unsigned max_workers = 0);

    // As run() with all threads, but each begins with a part of the items that is its own, the same in every loop
    // of so many items, and then helps the others: for loops that follow each other over the same data, most of
    // which then is in the caches of the processor that needs it.
    void run_near(std::size_t items,
                  const std::function<void(std::size_t item, unsigned worker)>& body,
                  std::stop_token stop = {});

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace renderer
