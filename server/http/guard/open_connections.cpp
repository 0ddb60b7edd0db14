#include "server/http/guard/open_connections.h"

#include <algorithm>
#include <sys/socket.h>
#include <unistd.h>

namespace server {

OpenConnections::Entry::Entry(OpenConnections& all, int fd, SocketAddress peer)
    : all_(&all), fd_(fd), peer_(std::move(peer)), client_(client_of(peer_.ip))
{
    all_->open(fd_, client_);
}

OpenConnections::Entry OpenConnections::add(int fd)
{
    try {
        return {*this, fd, peer_of(fd)};
    } catch (...) {
        ::close(fd);
        throw;
    }
}

void OpenConnections::open(int fd, const std::string& client)
{
    const std::lock_guard lock(mutex_);
    std::size_t& of_client = by_client_[client];
    open_.insert(fd);
    ++of_client;
}

void OpenConnections::close(int fd, const std::string& client)
{
    const std::lock_guard lock(mutex_);
    open_.erase(fd);
    const auto found = by_client_.find(client);
    if (--found->second == 0) by_client_.erase(found);
    ::shutdown(fd, SHUT_RDWR);
    ::close(fd);
    if (open_.empty()) none_.notify_all();
}

std::size_t OpenConnections::count() const
{
    const std::lock_guard lock(mutex_);
    return open_.size();
}

std::size_t OpenConnections::count_of(const std::string& client) const
{
    const std::lock_guard lock(mutex_);
    const auto found = by_client_.find(client);
    return found == by_client_.end() ? 0 : found->second;
}

std::string OpenConnections::most_numerous() const
{
    const std::lock_guard lock(mutex_);
    const auto most = std::max_element(by_client_.begin(),
                                       by_client_.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == by_client_.end() ? std::string() : most->first;
}

bool OpenConnections::wait_for_none(std::chrono::steady_clock::time_point deadline)
{
    std::unique_lock lock(mutex_);
    return none_.wait_until(lock, deadline, [this] { return open_.empty(); });
}

std::size_t OpenConnections::cut()
{
    const std::lock_guard lock(mutex_);
    for (const int fd : open_)
        ::shutdown(fd, SHUT_RDWR);
    return open_.size();
}

} // namespace server
