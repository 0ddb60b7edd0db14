#include "server/http/guard/answer_outbox.h"

#include <algorithm>
#include <cerrno>
#include <sys/socket.h>
#include <utility>

namespace server {

namespace {
constexpr std::size_t kPiece = 1 << 20;
}

void AnswerOutbox::follow_with(httplib::ContentProvider provider, std::size_t length)
{
    provider_ = std::move(provider);
    body_at_ = 0;
    body_size_ = length;
}

AnswerOutbox::Sent AnswerOutbox::send_bytes(int fd, std::string_view bytes, std::size_t& count)
{
    ssize_t gone = 0;
    do
        gone = ::send(fd, bytes.data(), std::min(bytes.size(), kPiece), MSG_NOSIGNAL | MSG_DONTWAIT);
    while (gone < 0 && errno == EINTR);
    count = static_cast<std::size_t>(std::max<ssize_t>(gone, 0));
    sent_ += count;
    if (gone >= 0) return Sent::more;
    return errno == EAGAIN || errno == EWOULDBLOCK ? Sent::blocked : Sent::failed;
}

AnswerOutbox::Sent AnswerOutbox::send_body(int fd)
{
    Sent sent = Sent::failed; // unless the provider gives something
    httplib::DataSink sink;
    sink.is_writable = [] { return true; };
    sink.write = [&](const char* data, std::size_t size) {
        std::size_t count = 0;
        sent = send_bytes(fd, {data, std::min(size, body_size_ - body_at_)}, count);
        body_at_ += count;
        return sent == Sent::more && count == size;
    };
    const std::size_t before = body_at_;
    // What it returns says no more than the sink did: it is asked again from where the client has come to.
    provider_(body_at_, body_size_ - body_at_, sink);
    return sent == Sent::more && body_at_ == before ? Sent::failed : sent;
}

void AnswerOutbox::let_source_go()
{
    httplib::DataSink nowhere;
    nowhere.is_writable = [] { return false; };
    nowhere.write = [](const char*, std::size_t) { return false; };
    provider_(body_at_, 0, nowhere);
}

AnswerOutbox::Sent AnswerOutbox::send(int fd, std::size_t most)
{
    const std::uint64_t end = sent_ + most;
    while (waiting_at_ < waiting_.size()) {
        std::size_t count = 0;
        const Sent sent = send_bytes(fd, std::string_view(waiting_).substr(waiting_at_), count);
        waiting_at_ += count;
        if (sent != Sent::more) return sent;
    }
    std::string().swap(waiting_); // an assignment would keep the memory
    waiting_at_ = 0;
    while (body_at_ < body_size_) {
        if (sent_ >= end) return Sent::more;
        const Sent sent = send_body(fd);
        if (sent == Sent::blocked) let_source_go();
        if (sent != Sent::more) return sent;
    }
    provider_ = nullptr; // and what it holds
    return Sent::done;
}

} // namespace server
