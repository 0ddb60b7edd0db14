// RequestIntake: one connection's requests as their bytes come: says when enough has come for a thread to be
// of use, and gives httplib exactly the body that the head announced.
//
// No thread is of use before a head is whole, nor before a small body is; of a large one kSmallBody bytes
// must have come, so that who drips a body holds no thread either. Who asks for 100 Continue waits for us.
// Memory   what was received and not yet taken, and the head: held_bytes().
// Threads  one.
#pragma once

#include "server/http/guard/chunk_decoder.h"
#include "server/http/guard/request_head.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace server {

inline constexpr std::size_t kSmallBody = 64 << 10;
inline constexpr const char* kKnownMethods = "GET, HEAD, POST, PUT, PATCH, DELETE, OPTIONS";

class RequestIntake {
public:
    // nothing, head and body: more must come. ready: the request is whole, or a handler can refuse it. large:
    // the rest of its body comes while it is served. faulty: fault() says why.
    enum class Stage : std::uint8_t { nothing, head, body, ready, large, faulty };
    Stage append(std::string_view bytes);
    Stage stage() const { return stage_; }
    const RequestHead& head() const { return head_; }
    const HeadFault& fault() const { return fault_; }
    const std::string& request_id(); // the head's, or one made for a head that never came whole

    // The request as httplib reads it, rewritten head first; append() adds to its body from now on.
    void begin_reading();
    // What can be read now without more bytes; empty: body_complete(), broken(), or more must come.
    std::string_view readable();
    void took(std::size_t bytes) { ready_at_ += bytes; }
    bool broken() const { return broken_; } // the chunks are none
    bool body_complete() const { return body_left_ == 0 && (!chunked_ || decoder_.finished()); }
    std::uint64_t body_received() const { return body_received_; }

    void next_request(); // forgets this one; what was sent ahead of its answer is looked at
    bool has_more() const { return buffer_at_ < buffer_.size(); }
    std::size_t held_bytes() const { return buffer_.size() + head_bytes_ + ready_.size(); }

private:
    void look();
    void look_for_head();
    void look_at_body();
    void take_piece();
    void fail(HeadFault fault);

    Stage stage_ = Stage::nothing;
    std::string buffer_; // received, from buffer_at_ on not yet used
    std::size_t buffer_at_ = 0;
    std::size_t seen_ = 0; // of the buffer, by the search for the head's end or the probe of chunks
    RequestHead head_;
    std::size_t head_bytes_ = 0;
    HeadFault fault_;

    ChunkDecoder probe_; // runs ahead over a chunked body, to tell when it is whole
    bool chunked_ = false, broken_ = false, reading_ = false;
    std::uint64_t body_left_ = 0, body_received_ = 0;
    ChunkDecoder decoder_;
    std::string ready_; // for httplib: head, then pieces of body
    std::size_t ready_at_ = 0;
};

} // namespace server
