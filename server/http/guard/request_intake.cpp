#include "server/http/guard/request_intake.h"

#include "server/store/store.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace server {

namespace {

constexpr std::string_view kHeadEnd = "\r\n\r\n";

bool is_known_method(std::string_view method)
{
    static constexpr std::array<std::string_view, 7> known{
        "GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"};
    return std::find(known.begin(), known.end(), method) != known.end();
}

} // namespace

RequestIntake::Stage RequestIntake::append(std::string_view bytes)
{
    if (buffer_at_ == buffer_.size()) {
        buffer_.clear();
        seen_ = buffer_at_ = 0;
    }
    buffer_ += bytes;
    if (stage_ == Stage::body || reading_) body_received_ += bytes.size();
    if (!reading_) look();
    return stage_;
}

void RequestIntake::look()
{
    if (stage_ == Stage::nothing && has_more()) stage_ = Stage::head;
    if (stage_ == Stage::head) look_for_head();
    if (stage_ == Stage::body) look_at_body();
}

void RequestIntake::fail(HeadFault fault)
{
    fault_ = std::move(fault);
    stage_ = Stage::faulty;
}

void RequestIntake::look_for_head()
{
    const std::size_t from = std::max(buffer_at_, seen_ - std::min(seen_, kHeadEnd.size() - 1));
    const std::size_t end = buffer_.find(kHeadEnd, from);
    seen_ = buffer_.size();
    const std::size_t size =
        end == std::string::npos ? seen_ - buffer_at_ : end + kHeadEnd.size() - buffer_at_;
    if (size > kMaxHeadBytes)
        return fail(
            {431, "headers_too_large", "the header may have " + std::to_string(kMaxHeadBytes) + " bytes"});
    if (end == std::string::npos) return;
    if (auto fault = read_head(std::string_view(buffer_).substr(buffer_at_, size), head_))
        return fail(*std::move(fault));
    if (!is_known_method(head_.method))
        return fail({405, "method_not_allowed", std::string("methods: ") + kKnownMethods});
    head_bytes_ = size;
    buffer_at_ += size;
    seen_ = buffer_at_;
    chunked_ = head_.chunked;
    body_left_ = head_.content_length.value_or(0);
    body_received_ = buffer_.size() - buffer_at_;
    stage_ = Stage::body;
}

void RequestIntake::look_at_body()
{
    const std::size_t come = buffer_.size() - buffer_at_;
    bool whole = false;
    if (chunked_) {
        std::string_view fresh = std::string_view(buffer_).substr(seen_);
        std::string data;
        whole = !probe_.decode(fresh, data) || probe_.finished();
        seen_ = buffer_.size() - fresh.size();
    } else {
        whole = come >= body_left_;
    }
    if (whole)
        stage_ = Stage::ready;
    else if (come >= kSmallBody || head_.expects_continue)
        stage_ = Stage::large;
}

void RequestIntake::begin_reading()
{
    ready_ = head_.rewritten();
    ready_at_ = 0;
    reading_ = true;
}

std::string_view RequestIntake::readable()
{
    while (ready_at_ == ready_.size() && !broken_ && !body_complete() && has_more())
        take_piece();
    return std::string_view(ready_).substr(ready_at_);
}

// Moves what has come of the body to ready_: chunks are taken apart and put together anew.
void RequestIntake::take_piece()
{
    ready_.clear();
    ready_at_ = 0;
    std::string_view raw = std::string_view(buffer_).substr(buffer_at_);
    const std::size_t before = raw.size();
    if (chunked_) {
        std::string data;
        broken_ = !decoder_.decode(raw, data);
        if (broken_) return;
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
}

const std::string& RequestIntake::request_id()
{
    if (head_.request_id.empty()) head_.request_id = make_job_id();
    return head_.request_id;
}

void RequestIntake::next_request()
{
    std::string ahead = buffer_.substr(buffer_at_);
    *this = {};
    if (!ahead.empty()) append(ahead);
}

} // namespace server
