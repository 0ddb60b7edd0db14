// Listener: a TCP socket that listens, and the connections that come to it one by one, whatever is short.
//
// Threads  accept() from one, stop() from any.
// Errors   the constructor throws std::system_error that names host and port. accept() goes on after every
//          error that passes: that of a single connection at once, a shortage (descriptors, memory) after a
//          pause and one line in the log.
#pragma once

#include "server/log/log.h"

#include <atomic>
#include <cstdint>
#include <string>

namespace server {

// What an error of accept(2) concerns: the connection that came, what the system has left, or the socket.
enum class AcceptError : std::uint8_t { of_one, shortage, broken };
AcceptError kind_of_accept_error(int error);

class Listener {
public:
    Listener(const std::string& host, int port, const Log& log); // port 0: any free one
    ~Listener();
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    // The next connection, which the caller closes; -1 after stop(), and when the socket broke.
    int accept();
    void stop();                           // refuses what comes from now on, and ends accept()
    int broken() const { return broken_; } // why accept() ended without stop(); 0: it did not
    int descriptor() const { return fd_; }
    int port() const { return port_; }

private:
    void bind_first_of(const std::string& host, int port);
    void wait_out_shortage(int error);

    const Log& log_;
    int fd_ = -1;
    int port_ = 0;
    bool short_ = false; // said already
    std::atomic<int> broken_ = 0;
    std::atomic<bool> stopped_ = false;
};

} // namespace server
