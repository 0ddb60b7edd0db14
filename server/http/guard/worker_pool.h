// WorkerPool: the threads that connections are served on: made when they are first needed, bounded, with a
// bounded queue before them.
//
// Threads  enqueue(), finish_by() and shutdown() from one at a time, the rest from any.
// Cost     a thread that waits holds its stack's few touched pages.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace server {

class WorkerPool {
public:
    // At most `threads` at work and `queue` connections waiting.
    WorkerPool(std::size_t threads, std::size_t queue) : max_threads_(threads), max_queue_(queue) {}
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    bool enqueue(std::function<void()> task); // false: there is no room for it
    bool backlog() const;                     // true: connections wait for a thread
    // Waits until nothing is queued or at work; false if that is not so by `deadline`.
    bool finish_by(std::chrono::steady_clock::time_point deadline);
    void shutdown(); // when the queue is empty and every task has returned

private:
    void work();
    bool add_thread();

    const std::size_t max_threads_, max_queue_;
    mutable std::mutex mutex_;
    std::condition_variable changed_, finished_;
    std::deque<std::function<void()>> queue_;
    std::vector<std::thread> threads_;
    std::size_t idle_ = 0, busy_ = 0;
    bool stopping_ = false;
};

} // namespace server
