#include "server/http/guard/connection_stream.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <poll.h>
#include <sys/socket.h>

namespace server {

namespace {

using std::chrono::milliseconds;

constexpr std::size_t kReceiveBytes = 16 << 10;
constexpr std::size_t kMostDropped = 4 << 20; // of a body that nobody reads

// The head of an answer with `Connection: close` in it.
std::string with_close(std::string_view head)
{
    const std::size_t line = head.find("\r\n");
    std::string text(head);
    if (line != std::string_view::npos && head.find("\r\nConnection: close\r\n") == std::string_view::npos)
        text.insert(line + 2, "Connection: close\r\n");
    return text;
}

} // namespace

ConnectionStream::ConnectionStream(OpenConnections::Entry entry, const StreamLimits& limits)
    : entry_(std::move(entry)), limits_(limits), moved_(Clock::now())
{
}

// Until when so many bytes are min_rate on average.
ConnectionStream::Clock::time_point ConnectionStream::slowest(Clock::time_point since,
                                                              std::uint64_t bytes) const
{
    const std::uint64_t rate = std::max<std::uint64_t>(limits_.min_rate, 1);
    return since + limits_.grace + std::chrono::seconds(bytes / rate) +
           milliseconds(bytes % rate * 1000 / rate);
}

ConnectionStream::Clock::time_point ConnectionStream::body_deadline() const
{
    return std::min({moved_ + limits_.idle_body,
                     body_since_ + limits_.whole_body,
                     slowest(body_since_, intake_.body_received())});
}

ConnectionStream::Clock::time_point ConnectionStream::deadline() const
{
    switch (phase_) {
    case Phase::request:
        if (intake_.stage() == RequestIntake::Stage::nothing) return moved_ + limits_.keep_alive;
        if (intake_.stage() == RequestIntake::Stage::head) return head_since_ + limits_.head;
        return body_deadline();
    case Phase::answer:
        return std::min(moved_ + limits_.idle_write, slowest(write_since_, outbox_.bytes_sent()));
    case Phase::farewell:
        return moved_ + limits_.farewell;
    }
    return moved_;
}

ConnectionStream::Come ConnectionStream::receive()
{
    char bytes[kReceiveBytes];
    ssize_t count = 0;
    do
        count = recv(descriptor(), bytes, sizeof bytes, MSG_DONTWAIT);
    while (count < 0 && errno == EINTR);
    if (count < 0) return errno == EAGAIN || errno == EWOULDBLOCK ? Come::nothing : Come::end;
    if (count == 0) return Come::end;
    if (phase_ == Phase::farewell) {
        dropped_ += static_cast<std::size_t>(count);
        return dropped_ < kMostDropped ? Come::some : Come::end;
    }
    moved_ = Clock::now();
    const auto before = intake_.stage();
    const auto after = intake_.append({bytes, static_cast<std::size_t>(count)});
    if (before == RequestIntake::Stage::nothing) head_since_ = moved_;
    if (before != after && before != RequestIntake::Stage::body) body_since_ = moved_;
    return Come::some;
}

void ConnectionStream::begin_answer()
{
    phase_ = Phase::answer;
    begun_ = write_since_ = moved_ = Clock::now();
    outbox_.clear();
    status_ = 0;
    read_failed_ = false;
    if (intake_.stage() == RequestIntake::Stage::faulty) return;
    continue_due_ = intake_.head().expects_continue;
    intake_.begin_reading();
}

void ConnectionStream::give_body(httplib::ContentProvider provider, std::size_t length)
{
    outbox_.follow_with(std::move(provider), length);
}

AnswerOutbox::Sent ConnectionStream::send_answer(std::size_t most)
{
    const std::uint64_t before = outbox_.bytes_sent();
    const AnswerOutbox::Sent sent = outbox_.send(descriptor(), most);
    if (outbox_.bytes_sent() != before) moved_ = Clock::now();
    return sent;
}

void ConnectionStream::next_request()
{
    intake_.next_request();
    phase_ = Phase::request;
    ++requests_;
    head_since_ = body_since_ = moved_ = Clock::now();
}

bool ConnectionStream::needs_farewell() const
{
    char byte = 0;
    return !body_complete() || intake_.has_more() ||
           recv(descriptor(), &byte, 1, MSG_PEEK | MSG_DONTWAIT) > 0;
}

void ConnectionStream::begin_farewell()
{
    ::shutdown(descriptor(), SHUT_WR);
    phase_ = Phase::farewell;
    moved_ = Clock::now();
}

bool ConnectionStream::wait_for_body() const
{
    for (;;) {
        pollfd wanted{descriptor(), POLLIN, 0};
        const auto left = std::chrono::ceil<milliseconds>(body_deadline() - Clock::now());
        if (left.count() <= 0) return false;
        const int ready = poll(&wanted, 1, static_cast<int>(std::min<std::int64_t>(left.count(), 1 << 30)));
        if (ready > 0) return true;
        if (ready == 0 || errno != EINTR) return false;
    }
}

bool ConnectionStream::send_continue()
{
    static constexpr std::string_view line = "HTTP/1.1 100 Continue\r\n\r\n";
    continue_due_ = false;
    return send(descriptor(), line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT) ==
           static_cast<ssize_t>(line.size());
}

ssize_t ConnectionStream::read(char* to, size_t size)
{
    std::string_view come = intake_.readable();
    while (come.empty() && !read_failed_ && !intake_.broken() && !intake_.body_complete()) {
        read_failed_ = (continue_due_ && !send_continue()) || !wait_for_body() || receive() == Come::end;
        come = intake_.readable();
    }
    if (intake_.body_complete()) place_.reset();
    read_failed_ = read_failed_ || intake_.broken();
    if (come.empty()) return read_failed_ ? -1 : 0;
    const std::size_t count = std::min(size, come.size());
    std::memcpy(to, come.data(), count);
    intake_.took(count);
    return static_cast<ssize_t>(count);
}

ssize_t ConnectionStream::write(const char* from, size_t size)
{
    const std::string_view bytes(from, size);
    if (status_ > 0) {
        outbox_.put(bytes);
        return static_cast<ssize_t>(size);
    }
    // httplib writes the head of an answer in one piece: "HTTP/1.1 200 OK\r\n...".
    write_since_ = moved_ = Clock::now();
    if (size >= 12) std::from_chars(from + 9, from + 12, status_);
    outbox_.put(body_complete() ? std::string(bytes) : with_close(bytes));
    place_.reset();
    return static_cast<ssize_t>(size);
}

bool ConnectionStream::peer_is_there() const
{
    char byte = 0;
    const ssize_t count = recv(descriptor(), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
    return count > 0 || (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR));
}

void ConnectionStream::get_remote_ip_and_port(std::string& ip, int& port) const
{
    ip = entry_.peer().ip;
    port = entry_.peer().port;
}

void ConnectionStream::get_local_ip_and_port(std::string& ip, int& port) const
{
    const SocketAddress own = own_of(descriptor());
    ip = own.ip;
    port = own.port;
}

} // namespace server
