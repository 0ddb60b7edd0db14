// OpenConnections: the sockets of a server, counted by client, so that none has too many and all can be cut
// off at once.
//
// Threads  any.
#pragma once

#include "server/http/guard/socket_address.h"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>

namespace server {

class OpenConnections {
public:
    // An open socket; its destructor closes it.
    class Entry {
    public:
        Entry(OpenConnections& all, int fd, SocketAddress peer);
        Entry(Entry&& other) noexcept
            : all_(std::exchange(other.all_, nullptr)), fd_(other.fd_), peer_(std::move(other.peer_)),
              client_(std::move(other.client_))
        {
        }
        Entry& operator=(Entry&&) = delete;
        Entry(const Entry&) = delete;
        Entry& operator=(const Entry&) = delete;
        ~Entry()
        {
            if (all_ != nullptr) all_->close(fd_, client_);
        }

        int descriptor() const { return fd_; }
        const SocketAddress& peer() const { return peer_; }
        const std::string& client() const { return client_; }

    private:
        OpenConnections* all_;
        int fd_;
        SocketAddress peer_;
        std::string client_;
    };

    Entry add(int fd); // throws std::bad_alloc, and has closed it then
    std::size_t count() const;
    std::size_t count_of(const std::string& client) const;
    std::string most_numerous() const; // the client that has most
    // Waits until none is left; false if that is not so by `deadline`.
    bool wait_for_none(std::chrono::steady_clock::time_point deadline);
    std::size_t cut(); // from now on every read and write on them fails; how many there were

private:
    void open(int fd, const std::string& client);
    void close(int fd, const std::string& client);

    mutable std::mutex mutex_;
    std::condition_variable none_;
    std::set<int> open_; // under mutex: a number is another's as soon as it is closed
    std::map<std::string, std::size_t> by_client_;
};

} // namespace server
