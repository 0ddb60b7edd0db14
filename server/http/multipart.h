// MultipartReader: multipart/form-data (RFC 7578) as it streams by: part heads are bounded, contents never
// held.
//
// httplib's own reader keeps a part's head however long it is, and knows no limit on parts.
// Errors   a fault is a value: feed() is false, and fault() says what and how to mend it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace server {

// Who takes the parts. A false stops the reading; the reason is the taker's own.
class PartTaker {
public:
    virtual ~PartTaker() = default;
    virtual bool begin_part(const std::string& name) = 0;
    virtual bool take(std::string_view bytes) = 0;
    virtual bool end_part() = 0;
};

class MultipartReader {
public:
    MultipartReader(const std::string& boundary, PartTaker& taker);

    bool feed(std::string_view bytes);
    bool finished() const { return state_ == State::epilogue; } // the closing boundary was seen
    const std::string& fault() const { return fault_; }         // empty: the taker stopped it

private:
    enum class State : std::uint8_t { preamble, boundary_end, head, content, epilogue };
    bool fail(std::string what);
    bool read_until_boundary(bool& more);
    bool read_boundary_end(bool& more);
    bool read_head(bool& more);

    PartTaker& taker_;
    std::string delimiter_; // CR LF -- boundary
    std::string buffer_;
    std::string fault_;
    State state_ = State::preamble;
};

// The boundary of a Content-Type; empty if it has none that the standard allows.
std::string multipart_boundary(const std::string& content_type);

} // namespace server
