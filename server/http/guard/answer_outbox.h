// AnswerOutbox: an answer on its way: bytes that httplib wrote, then a body that is asked for piece by piece;
// it goes out as far as the client reads, and the rest waits here without a thread.
//
// Memory   what httplib wrote and the client has not yet taken; of a body with a source nothing.
// Threads  one.
// Errors   what the source of a body throws.
#pragma once

#include <httplib.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace server {

class AnswerOutbox {
public:
    void put(std::string_view bytes) { waiting_ += bytes; }
    // `length` bytes that the provider gives, asked for the offset that was reached each time, after what was
    // put. Asked for no bytes, the provider may let go of what it can have again: the client makes us wait.
    void follow_with(httplib::ContentProvider provider, std::size_t length);

    // done: all has gone. blocked: the client must read first. more: `most` bytes have gone. failed: it cannot
    // be reached, or the body broke off.
    enum class Sent : std::uint8_t { done, blocked, more, failed };
    Sent send(int fd, std::size_t most);

    std::uint64_t bytes_sent() const { return sent_; }
    std::size_t held_bytes() const { return waiting_.size(); }
    void clear() { *this = {}; }

private:
    Sent send_bytes(int fd, std::string_view bytes, std::size_t& count);
    Sent send_body(int fd);
    void let_source_go();

    std::string waiting_;
    std::size_t waiting_at_ = 0;
    httplib::ContentProvider provider_;
    std::size_t body_at_ = 0, body_size_ = 0;
    std::uint64_t sent_ = 0;
};

} // namespace server
