#include "server/http/guard/worker_pool.h"

#include <system_error>
#include <utility>

namespace server {

WorkerPool::~WorkerPool()
{
    shutdown();
}

bool WorkerPool::add_thread()
{
    if (threads_.size() >= max_threads_) return false;
    try {
        threads_.emplace_back([this] { run(); });
        return true;
    } catch (const std::system_error&) {
        return false; // no more threads to be had: serve with those that are
    }
}

bool WorkerPool::enqueue(Connection& connection, What what)
{
    const std::lock_guard lock(mutex_);
    const bool room = queue_.size() < max_queue_ || what == What::goes_on;
    const bool taken = !stopping_ && (idle_ > queue_.size() || add_thread() || (room && !threads_.empty()));
    if (!taken) return false;
    queue_.push_back(std::move(connection));
    changed_.notify_one();
    return true;
}

void WorkerPool::run()
{
    std::unique_lock lock(mutex_);
    for (;;) {
        ++idle_;
        changed_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
        --idle_;
        if (stopping_) return;
        Connection connection = std::move(queue_.front());
        queue_.pop_front();
        lock.unlock();
        work_(std::move(connection));
        lock.lock();
    }
}

std::size_t WorkerPool::threads() const
{
    const std::lock_guard lock(mutex_);
    return threads_.size();
}

std::size_t WorkerPool::queued() const
{
    const std::lock_guard lock(mutex_);
    return queue_.size();
}

void WorkerPool::shutdown()
{
    std::deque<Connection> dropped;
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        dropped.swap(queue_);
        changed_.notify_all();
    }
    for (std::thread& thread : threads_)
        thread.join();
    threads_.clear();
}

} // namespace server
