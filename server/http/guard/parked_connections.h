// ParkedConnections: the connections that wait for their clients: for a head, a small body, or for an answer to
// be read. They sit in one epoll set that one thread looks after, and hold no other.
//
// Bounds   connections of one client, connections in all, bytes that they hold in all. Where one is passed,
//          the connection of that client (of the client that has most) which has waited longest makes room, so
//          that newcomers get in and a crowd from a few addresses displaces itself. If all of a client's are
//          at work, the newcomer goes.
// Errors   where there is no memory for one, it closes.
// Threads  park() and drain() from any; the callbacks come from its own thread, one at a time, and must not
//          block. They may park.
#pragma once

#include "server/http/guard/worker_pool.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace server {

struct ParkingLimits {
    std::size_t connections = 4096;
    std::size_t per_client = 1024;
    std::size_t held_bytes = 24 << 20;
};

class ParkedConnections {
public:
    enum class Why : std::uint8_t { late, displaced };
    struct Callbacks {
        std::function<void(Connection)> go_on; // the request has come, or the answer can go on
        std::function<void(Connection, Why)> give_up;
    };

    // Throws std::system_error.
    ParkedConnections(const OpenConnections& open, const ParkingLimits& limits, Callbacks callbacks);
    ~ParkedConnections();
    ParkedConnections(const ParkedConnections&) = delete;
    ParkedConnections& operator=(const ParkedConnections&) = delete;

    void park(Connection connection);
    // From now on, who has sent nothing of a request is closed instead of waited for.
    void drain();
    void stop(); // closes what is parked, and what is parked later at once
    std::size_t count() const { return count_; }

private:
    using Clock = ConnectionStream::Clock;
    struct Place {
        Connection connection;
        std::multimap<Clock::time_point, int>::iterator due;
        std::list<int>::iterator age;
        std::size_t bytes = 0; // as counted in held_bytes_
    };

    void run();
    void admit(Connection connection);
    void step(int fd);
    bool keeps_waiting(ConnectionStream& connection); // false: it is to go on, or has gone
    Connection take_out(int fd);
    void settle(Place& place);
    void expire();
    bool make_room_for(const Connection& connection);
    void bound_bytes();
    int oldest_of(const std::string& client) const;
    std::string greediest() const;
    int wait_ms() const;
    void wake() const;

    const OpenConnections& open_;
    const ParkingLimits limits_;
    const Callbacks callbacks_;
    int epoll_ = -1, bell_ = -1;
    std::mutex mutex_;
    std::vector<Connection> arrivals_; // under mutex
    std::atomic<bool> draining_ = false, stopping_ = false;
    std::atomic<std::size_t> count_ = 0;
    // Of its thread alone.
    std::map<int, Place> parked_;
    std::multimap<Clock::time_point, int> due_;
    std::list<int> by_age_; // the one that has waited longest first
    std::size_t held_bytes_ = 0;
    bool drained_ = false; // those that were parked when draining began have been looked at
    std::thread thread_;
};

} // namespace server
