#include "server/http/guard/chunk_decoder.h"

#include <algorithm>
#include <charconv>

namespace server {

namespace {
constexpr std::size_t kMaxLineBytes = 256;
constexpr std::size_t kMaxTrailerBytes = 8 << 10;
} // namespace

bool ChunkDecoder::take_line(std::string_view& raw, bool& complete)
{
    const std::size_t newline = raw.find('\n');
    const std::size_t count = newline == std::string_view::npos ? raw.size() : newline + 1;
    line_.append(raw.substr(0, std::min(count, kMaxLineBytes + 1)));
    raw.remove_prefix(count);
    complete = newline != std::string_view::npos;
    if (line_.size() > kMaxLineBytes) return false;
    if (!complete) return true;
    if (!line_.ends_with("\r\n")) return false;
    line_.resize(line_.size() - 2);
    return true;
}

bool ChunkDecoder::read_size()
{
    const std::string_view digits = std::string_view(line_).substr(0, line_.find_first_of("; \t"));
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), left_, 16);
    const bool good = !digits.empty() && digits.front() != '-' && error == std::errc() &&
                      stop == digits.data() + digits.size();
    line_.clear();
    return good && left_ >> 62 == 0;
}

bool ChunkDecoder::decode(std::string_view& raw, std::string& out)
{
    while (!raw.empty() && state_ != State::finished) {
        bool complete = false;
        switch (state_) {
        case State::size:
            if (!take_line(raw, complete)) return false;
            if (!complete) return true;
            if (!read_size()) return false;
            state_ = left_ == 0 ? State::trailer : State::data;
            break;
        case State::data: {
            const std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(left_, raw.size()));
            out.append(raw.substr(0, count));
            raw.remove_prefix(count);
            left_ -= count;
            if (left_ == 0) state_ = State::data_end;
            break;
        }
        case State::data_end:
            if (!take_line(raw, complete)) return false;
            if (!complete) return true;
            if (!line_.empty()) return false;
            state_ = State::size;
            break;
        case State::trailer:
            if (!take_line(raw, complete)) return false;
            if (!complete) return true;
            trailer_bytes_ += line_.size();
            if (trailer_bytes_ > kMaxTrailerBytes) return false;
            if (line_.empty()) state_ = State::finished;
            line_.clear();
            break;
        case State::finished:
            break;
        }
    }
    return true;
}

} // namespace server
