// ConnectionStream: one connection as httplib reads and writes it, with a deadline on everything.
//
// Reading  the head block is collected here, whole and bounded; of the body httplib is given exactly what the
//          head announced, chunked bodies taken apart and put together anew. `100 Continue` is sent when, and
//          only when, a handler begins to read the body.
// Writing  never blocks longer than `idle_write`, nor below `min_rate` for longer than `grace`. An answer
//          that is sent before the request's body was read says `Connection: close`.
// Threads  one.
#pragma once

#include "server/http/guard/body_places.h"
#include "server/http/guard/chunk_decoder.h"
#include "server/http/guard/request_head.h"

#include <httplib.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace server {

struct StreamLimits {
    std::chrono::milliseconds head{5000};        // to send a head, from its first byte
    std::chrono::milliseconds keep_alive{5000};  // silence between two requests
    std::chrono::milliseconds idle_body{30000};  // silence within a body
    std::chrono::milliseconds idle_write{10000}; // silence of a reader of an answer
    std::chrono::milliseconds grace{10000};      // from then on min_rate counts, both ways
    std::uint64_t min_rate = 16 << 10;           // bytes a second on average
};

class ConnectionStream final : public httplib::Stream {
public:
    ConnectionStream(int fd, const StreamLimits& limits) : fd_(fd), limits_(limits) {}

    enum class Await : std::uint8_t { ready, closed, too_slow, too_large };
    // Collects the next head into `block`. `give_up` is asked while nothing of it has come yet.
    Await await_head(std::string& block, const std::function<bool()>& give_up);
    // What httplib reads from now on: the rewritten head and the body.
    void begin(const RequestHead& head);

    // Collects a small body whose end nobody has to wait for. False: it is large, chunked, asked for
    // 100 Continue, or is not there after `moment`.
    bool body_comes_within(std::chrono::milliseconds moment);
    void hold_until_body_is_read(BodyPlaces::Place place) { place_ = std::move(place); }
    bool body_complete() const
    {
        return !read_failed_ && body_left_ == 0 && (!chunked_ || decoder_.finished());
    }
    bool write_failed() const { return write_failed_; }
    bool peer_is_there() const;            // false when the client has hung up
    int status() const { return status_; } // of the answer written, 0 before
    std::uint64_t bytes_written() const { return bytes_written_; }
    // Reads and drops what still comes, shortly, so that the client sees the answer instead of a reset; not
    // longer than until `give_up`.
    void linger(const std::function<bool()>& give_up);

    bool is_readable() const override;
    bool is_writable() const override { return !write_failed_; }
    ssize_t read(char* to, size_t size) override;
    ssize_t write(const char* from, size_t size) override;
    void get_remote_ip_and_port(std::string& ip, int& port) const override;
    void get_local_ip_and_port(std::string& ip, int& port) const override;
    socket_t socket() const override { return fd_; }

private:
    using Clock = std::chrono::steady_clock;
    bool wait_for(short events, std::chrono::milliseconds timeout) const;
    bool receive(std::chrono::milliseconds timeout); // appends to buffer_
    bool too_slow(Clock::time_point since, std::uint64_t bytes) const;
    bool fill_body();
    bool send_all(std::string_view bytes);
    std::string with_close(std::string_view head) const;

    int fd_;
    StreamLimits limits_;
    std::string buffer_; // received, not yet used
    std::size_t buffer_at_ = 0;
    std::string ready_; // for httplib: head, then pieces of body
    std::size_t ready_at_ = 0;
    bool chunked_ = false, continue_due_ = false, read_failed_ = false, write_failed_ = false;
    std::uint64_t body_left_ = 0, body_received_ = 0;
    ChunkDecoder decoder_;
    std::optional<BodyPlaces::Place> place_; // while the body is on its way
    Clock::time_point body_since_, write_since_;
    int status_ = 0;
    std::uint64_t bytes_written_ = 0;
};

} // namespace server
