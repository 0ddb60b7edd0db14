// ConnectionStream: one connection: its request as it comes, its answer as it goes, and the moment at which it
// is dropped when neither moves on.
//
// Nothing here blocks but read(), for the rest of a large body. Everything else does what can be done at once,
// so that a connection waits without a thread (ParkedConnections) until deadline().
// httplib  reads exactly the body that the head announced, chunks taken apart and put together anew. `100
//          Continue` is sent when, and only when, a handler begins to read. An answer that comes before the
//          whole body says `Connection: close`.
// Threads  one at a time.
#pragma once

#include "server/http/guard/answer_outbox.h"
#include "server/http/guard/body_places.h"
#include "server/http/guard/open_connections.h"
#include "server/http/guard/request_intake.h"

#include <httplib.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace server {

struct StreamLimits {
    std::chrono::milliseconds head{5000};       // to send a head, from its first byte
    std::chrono::milliseconds keep_alive{5000}; // silence before a head
    std::chrono::milliseconds idle_body{30000}; // silence within a body
    std::chrono::milliseconds whole_body{std::chrono::hours(1)};
    std::chrono::milliseconds idle_write{10000}; // silence of a reader of an answer
    std::chrono::milliseconds grace{10000};      // from then on min_rate counts, both ways
    std::uint64_t min_rate = 16 << 10;           // bytes a second on average
    std::chrono::milliseconds farewell{1000};    // to read a refusal while the body still comes
};

class ConnectionStream final : public httplib::Stream {
public:
    using Clock = std::chrono::steady_clock;

    ConnectionStream(OpenConnections::Entry entry, const StreamLimits& limits);

    // What it waits for. farewell: its last answer has gone, what still comes is dropped, so that the client
    // sees the answer instead of a reset.
    enum class Phase : std::uint8_t { request, answer, farewell };
    Phase phase() const { return phase_; }
    Clock::time_point deadline() const; // of what it waits for
    const RequestIntake& intake() const { return intake_; }
    const std::string& request_id() { return intake_.request_id(); }
    std::size_t requests() const { return requests_; } // begun on this connection, the one that comes too
    std::size_t held_bytes() const { return intake_.held_bytes() + outbox_.held_bytes(); }

    enum class Come : std::uint8_t { nothing, some, end };
    Come receive();      // what is there, into the request; in a farewell into nothing
    void begin_answer(); // the request is read, and the answer written, from now on
    void give_body(httplib::ContentProvider provider, std::size_t length); // after the head of the answer
    AnswerOutbox::Sent send_answer(std::size_t most);
    void close_after_answer() { closes_ = true; }
    bool closes_after_answer() const { return closes_; }
    void next_request();
    bool needs_farewell() const; // closed at once, the client could lose the answer
    void begin_farewell();

    void hold_until_body_is_read(BodyPlaces::Place place) { place_ = std::move(place); }
    bool body_complete() const { return !read_failed_ && intake_.body_complete(); }
    bool peer_is_there() const;            // false when the client has hung up
    int status() const { return status_; } // of the answer written, 0 before
    std::uint64_t bytes_sent() const { return outbox_.bytes_sent(); }
    Clock::time_point begun() const { return begun_; } // the answer
    int descriptor() const { return entry_.descriptor(); }
    const std::string& address() const { return entry_.peer().ip; }
    const std::string& client() const { return entry_.client(); }

    bool is_readable() const override { return !read_failed_; }
    bool is_writable() const override { return true; }
    ssize_t read(char* to, size_t size) override;
    ssize_t write(const char* from, size_t size) override;
    void get_remote_ip_and_port(std::string& ip, int& port) const override;
    void get_local_ip_and_port(std::string& ip, int& port) const override;
    socket_t socket() const override { return entry_.descriptor(); }

private:
    bool wait_for_body() const;
    bool send_continue();
    Clock::time_point body_deadline() const;
    Clock::time_point slowest(Clock::time_point since, std::uint64_t bytes) const;

    OpenConnections::Entry entry_;
    const StreamLimits& limits_;
    Phase phase_ = Phase::request;
    RequestIntake intake_;
    AnswerOutbox outbox_;
    std::size_t requests_ = 1, dropped_ = 0;
    bool closes_ = false, continue_due_ = false, read_failed_ = false;
    std::optional<BodyPlaces::Place> place_; // while the body is on its way
    Clock::time_point head_since_, body_since_, begun_, write_since_;
    Clock::time_point moved_; // bytes came or went, or the phase began
    int status_ = 0;
};

} // namespace server
