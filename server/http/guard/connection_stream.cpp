#include "server/http/guard/connection_stream.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <poll.h>

namespace server {

namespace {

using std::chrono::milliseconds;

// How often an idle or refused connection looks whether it should give its thread back.
constexpr milliseconds kGlance{100};
constexpr std::size_t kReceiveBytes = 16 << 10;
constexpr std::size_t kSmallBody = 64 << 10;
constexpr milliseconds kLinger{1000};
constexpr std::size_t kLingerBytes = 4 << 20;

void address_of(const sockaddr_storage& address, std::string& ip, int& port)
{
    char text[INET6_ADDRSTRLEN] = "";
    if (address.ss_family == AF_INET) {
        sockaddr_in v4{};
        std::memcpy(&v4, &address, sizeof v4);
        inet_ntop(AF_INET, &v4.sin_addr, text, sizeof text);
        port = ntohs(v4.sin_port);
    } else if (address.ss_family == AF_INET6) {
        sockaddr_in6 v6{};
        std::memcpy(&v6, &address, sizeof v6);
        inet_ntop(AF_INET6, &v6.sin6_addr, text, sizeof text);
        port = ntohs(v6.sin6_port);
    }
    ip = text;
}

sockaddr* as_sockaddr(sockaddr_storage& address)
{
    return reinterpret_cast<sockaddr*>(&address);
}

} // namespace

bool ConnectionStream::wait_for(short events, milliseconds timeout) const
{
    const auto end = Clock::now() + timeout;
    for (;;) {
        pollfd wanted{fd_, events, 0};
        const auto left = std::chrono::ceil<milliseconds>(end - Clock::now());
        const int ready =
            poll(&wanted, 1, static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 1 << 30)));
        if (ready > 0) return true;
        if (ready == 0 || errno != EINTR) return false;
    }
}

bool ConnectionStream::receive(milliseconds timeout)
{
    if (!wait_for(POLLIN, timeout)) return false;
    if (buffer_at_ > 0) {
        buffer_.erase(0, buffer_at_);
        buffer_at_ = 0;
    }
    const std::size_t old = buffer_.size();
    buffer_.resize(old + kReceiveBytes);
    ssize_t count = 0;
    do
        count = recv(fd_, buffer_.data() + old, kReceiveBytes, MSG_DONTWAIT);
    while (count < 0 && errno == EINTR);
    buffer_.resize(old + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    return count > 0;
}

ConnectionStream::Await ConnectionStream::await_head(std::string& block, const std::function<bool()>& give_up)
{
    const auto idle_end = Clock::now() + limits_.keep_alive;
    auto head_end = Clock::time_point::max();
    for (;;) {
        // Servers should bear an empty line before a request line (RFC 9112, 2.2).
        while (std::string_view(buffer_).substr(buffer_at_, 2) == "\r\n")
            buffer_at_ += 2;
        const std::size_t size = buffer_.size() - buffer_at_;
        const std::size_t end = buffer_.find("\r\n\r\n", buffer_at_);
        if (end != std::string::npos && end + 4 - buffer_at_ <= kMaxHeadBytes) {
            block = buffer_.substr(buffer_at_, end + 4 - buffer_at_);
            buffer_at_ = end + 4;
            return Await::ready;
        }
        if (size > kMaxHeadBytes) return Await::too_large;
        const auto now = Clock::now();
        if (size > 0 && head_end == Clock::time_point::max()) head_end = now + limits_.head;
        if (now >= head_end) return Await::too_slow;
        // Closed over a request that has come, the socket would take the answer before it along.
        if (size == 0 && (now >= idle_end || give_up()) && !wait_for(POLLIN, milliseconds(0)))
            return Await::closed;
        const auto left = std::chrono::ceil<milliseconds>((size > 0 ? head_end : idle_end) - now);
        const auto slice = size > 0 ? left : std::min(left, kGlance);
        if (wait_for(POLLIN, slice) && !receive(milliseconds(0))) return Await::closed;
    }
}

void ConnectionStream::begin(const RequestHead& head)
{
    ready_ = head.rewritten();
    ready_at_ = 0;
    chunked_ = head.chunked;
    continue_due_ = head.expects_continue;
    body_left_ = head.content_length.value_or(0);
    body_received_ = 0;
    decoder_ = {};
    place_.reset();
    body_since_ = Clock::now();
    write_since_ = body_since_;
    status_ = 0;
    bytes_written_ = 0;
}

bool ConnectionStream::body_comes_within(milliseconds moment)
{
    if (chunked_ || continue_due_ || body_left_ > kSmallBody) return false;
    const auto end = Clock::now() + moment;
    while (buffer_.size() - buffer_at_ < body_left_) {
        const auto left = std::chrono::ceil<milliseconds>(end - Clock::now());
        if (left.count() <= 0 || !receive(left)) return false;
    }
    return true;
}

bool ConnectionStream::too_slow(Clock::time_point since, std::uint64_t bytes) const
{
    const auto late = std::chrono::duration<double>(Clock::now() - since - limits_.grace).count();
    return late > 0 && static_cast<double>(bytes) < late * static_cast<double>(limits_.min_rate);
}

// The next piece of the body into ready_. False at its end, and when it fails.
bool ConnectionStream::fill_body()
{
    ready_.clear();
    ready_at_ = 0;
    while (ready_.empty()) {
        if (read_failed_ || (chunked_ ? decoder_.finished() : body_left_ == 0)) return false;
        if (buffer_at_ == buffer_.size()) {
            if (continue_due_) read_failed_ = !send_all("HTTP/1.1 100 Continue\r\n\r\n");
            continue_due_ = false;
            read_failed_ =
                read_failed_ || too_slow(body_since_, body_received_) || !receive(limits_.idle_body);
            if (read_failed_) return false;
        }
        std::string_view raw = std::string_view(buffer_).substr(buffer_at_);
        const std::size_t before = raw.size();
        if (chunked_) {
            std::string data;
            read_failed_ = !decoder_.decode(raw, data);
            if (read_failed_) return false;
            char size[20];
            const char* const end = std::to_chars(size, size + sizeof size, data.size(), 16).ptr;
            if (!data.empty())
                ready_.append(std::string_view(size, static_cast<std::size_t>(end - size)))
                    .append("\r\n")
                    .append(data)
                    .append("\r\n");
            if (decoder_.finished()) ready_ += "0\r\n\r\n";
        } else {
            ready_ = raw.substr(0, static_cast<std::size_t>(std::min<std::uint64_t>(raw.size(), body_left_)));
            raw.remove_prefix(ready_.size());
            body_left_ -= ready_.size();
        }
        buffer_at_ += before - raw.size();
        body_received_ += before - raw.size();
    }
    if (body_complete()) place_.reset();
    return true;
}

bool ConnectionStream::is_readable() const
{
    return ready_at_ < ready_.size() || buffer_at_ < buffer_.size() || !read_failed_;
}

ssize_t ConnectionStream::read(char* to, size_t size)
{
    if (ready_at_ == ready_.size() && !fill_body()) return read_failed_ ? -1 : 0;
    const std::size_t count = std::min(size, ready_.size() - ready_at_);
    std::memcpy(to, ready_.data() + ready_at_, count);
    ready_at_ += count;
    return static_cast<ssize_t>(count);
}

bool ConnectionStream::send_all(std::string_view bytes)
{
    while (!bytes.empty() && !write_failed_) {
        const ssize_t count = send(
            fd_, bytes.data(), std::min<std::size_t>(bytes.size(), 1 << 20), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (count > 0) {
            bytes.remove_prefix(static_cast<std::size_t>(count));
            bytes_written_ += static_cast<std::uint64_t>(count);
        } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
            write_failed_ = !wait_for(POLLOUT, limits_.idle_write) || too_slow(write_since_, bytes_written_);
        } else if (errno != EINTR) {
            write_failed_ = true;
        }
    }
    return !write_failed_;
}

// The head of an answer with `Connection: close` in it.
std::string ConnectionStream::with_close(std::string_view head) const
{
    const std::size_t line = head.find("\r\n");
    std::string text(head);
    if (line != std::string_view::npos && head.find("\r\nConnection: close\r\n") == std::string_view::npos)
        text.insert(line + 2, "Connection: close\r\n");
    return text;
}

ssize_t ConnectionStream::write(const char* from, size_t size)
{
    const std::string_view bytes(from, size);
    if (status_ > 0) return send_all(bytes) ? static_cast<ssize_t>(size) : -1;
    // httplib writes the head of an answer in one piece: "HTTP/1.1 200 OK\r\n...".
    write_since_ = Clock::now();
    if (size >= 12) std::from_chars(from + 9, from + 12, status_);
    const bool sent = body_complete() ? send_all(bytes) : send_all(with_close(bytes));
    return sent ? static_cast<ssize_t>(size) : -1;
}

bool ConnectionStream::peer_is_there() const
{
    char byte = 0;
    const ssize_t count = recv(fd_, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
    return count > 0 || (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR));
}

void ConnectionStream::linger(const std::function<bool()>& give_up)
{
    ::shutdown(fd_, SHUT_WR);
    const auto end = Clock::now() + kLinger;
    std::size_t dropped = 0;
    while (dropped < kLingerBytes && Clock::now() < end && !give_up()) {
        buffer_.clear();
        buffer_at_ = 0;
        const auto left = std::chrono::ceil<milliseconds>(end - Clock::now());
        if (!wait_for(POLLIN, std::min(left, kGlance))) continue;
        if (!receive(milliseconds(0))) return;
        dropped += buffer_.size();
    }
}

void ConnectionStream::get_remote_ip_and_port(std::string& ip, int& port) const
{
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    if (getpeername(fd_, as_sockaddr(address), &size) == 0) address_of(address, ip, port);
}

void ConnectionStream::get_local_ip_and_port(std::string& ip, int& port) const
{
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    if (getsockname(fd_, as_sockaddr(address), &size) == 0) address_of(address, ip, port);
}

} // namespace server
