// WorkerPool: the threads that connections are served on: made when they are first needed, bounded, with a
// bounded queue before them.
//
// Threads  enqueue() and shutdown() from the accepting thread alone, the rest from any.
// Cost     a thread that waits holds its stack's few touched pages.
#pragma once

#include <httplib.h>

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace server {

class WorkerPool final : public httplib::TaskQueue {
public:
    // At most `threads` at work and `queue` connections waiting; what comes beyond runs on the accepting
    // thread itself, which by that knows to refuse it.
    WorkerPool(std::size_t threads, std::size_t queue) : max_threads_(threads), max_queue_(queue) {}
    ~WorkerPool() override;

    void enqueue(std::function<void()> task) override;
    void shutdown() override; // when the queue is empty and every task has returned
    bool backlog() const;     // true: connections wait for a thread

private:
    void work();
    bool add_thread();

    const std::size_t max_threads_, max_queue_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> queue_;
    std::vector<std::thread> threads_;
    std::size_t idle_ = 0;
    bool stopping_ = false;
};

} // namespace server
