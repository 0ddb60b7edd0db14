// OpenConnections: the sockets that are served or wait for it, so that all can be cut off at once.
//
// Threads  any.
#pragma once

#include <cstddef>
#include <mutex>
#include <set>

namespace server {

class OpenConnections {
public:
    void add(int fd);
    void close(int fd); // shuts it down, closes it and forgets it
    std::size_t cut();  // from now on every read and write on them fails; how many there were

private:
    std::mutex mutex_;
    std::set<int> open_; // under mutex: a number is another's as soon as it is closed
};

} // namespace server
