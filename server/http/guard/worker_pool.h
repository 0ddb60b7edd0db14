// WorkerPool: the threads that connections are served on: made when they are first needed, bounded, with a
// bounded queue before them.
//
// Threads  any, but shutdown() from one.
// Cost     a thread that waits holds its stack's few touched pages.
#pragma once

#include "server/http/guard/connection_stream.h"

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace server {

using Connection = std::unique_ptr<ConnectionStream>;

class WorkerPool {
public:
    // At most `threads` at work and `queue` connections waiting. `work` must not throw.
    WorkerPool(std::size_t threads, std::size_t queue, std::function<void(Connection)> work)
        : max_threads_(threads), max_queue_(queue), work_(std::move(work))
    {
    }
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    // What is there may wait in the queue; what goes `on` already may do so beyond its bound. False: there is
    // no room for it, and the caller keeps it.
    enum class What : std::uint8_t { fresh, goes_on };
    bool enqueue(Connection& connection, What what = What::fresh);
    std::size_t threads() const; // made so far
    std::size_t queued() const;
    void shutdown(); // what is queued is dropped, what is at work is waited for

private:
    void run();
    bool add_thread();

    const std::size_t max_threads_, max_queue_;
    const std::function<void(Connection)> work_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Connection> queue_;
    std::vector<std::thread> threads_;
    std::size_t idle_ = 0;
    bool stopping_ = false;
};

} // namespace server
