#include "server/http/guard/worker_pool.h"

#include <system_error>

namespace server {

WorkerPool::~WorkerPool()
{
    shutdown();
}

bool WorkerPool::add_thread()
{
    if (threads_.size() >= max_threads_) return false;
    try {
        threads_.emplace_back([this] { work(); });
        return true;
    } catch (const std::system_error&) {
        return false; // no more threads to be had: serve with those that are
    }
}

bool WorkerPool::enqueue(std::function<void()> task)
{
    const std::lock_guard lock(mutex_);
    const bool taken =
        idle_ > queue_.size() || add_thread() || (queue_.size() < max_queue_ && !threads_.empty());
    if (!taken) return false;
    queue_.push_back(std::move(task));
    changed_.notify_one();
    return true;
}

void WorkerPool::work()
{
    std::unique_lock lock(mutex_);
    for (;;) {
        ++idle_;
        changed_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
        --idle_;
        if (queue_.empty()) return;
        const std::function<void()> task = std::move(queue_.front());
        queue_.pop_front();
        ++busy_;
        lock.unlock();
        task();
        lock.lock();
        --busy_;
        if (busy_ == 0 && queue_.empty()) finished_.notify_all();
    }
}

bool WorkerPool::finish_by(std::chrono::steady_clock::time_point deadline)
{
    std::unique_lock lock(mutex_);
    return finished_.wait_until(lock, deadline, [this] { return busy_ == 0 && queue_.empty(); });
}

bool WorkerPool::backlog() const
{
    const std::lock_guard lock(mutex_);
    return queue_.size() > idle_;
}

void WorkerPool::shutdown()
{
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        changed_.notify_all();
    }
    for (std::thread& thread : threads_)
        thread.join();
    threads_.clear();
}

} // namespace server
