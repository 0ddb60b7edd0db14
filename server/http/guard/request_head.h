// RequestHead: a request's line and header fields, read strictly before httplib sees a byte of them.
//
// httplib 0.11.4 has no cap on header lines, takes Content-Length beside Transfer-Encoding, reads a body
// without length to the end of the connection, and percent-decodes header values. So the guard reads the
// block itself, refuses what is doubtful, and hands httplib a block of its own making: request line, Host and
// the framing of the body, nothing else.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace server {

inline constexpr std::size_t kMaxHeadBytes = 32 << 10;
inline constexpr std::size_t kMaxHeadLines = 100;
inline constexpr std::size_t kMaxPathBytes = 256;
inline constexpr std::size_t kMaxTargetBytes = 2048;

// Why a request is refused unread; the connection closes.
struct HeadFault {
    int status = 400;
    std::string code;   // "malformed_request", "headers_too_large", ...
    std::string detail; // for the client
};

struct RequestHead {
    std::string method;
    std::string target;                                      // origin form: path and query as sent
    std::vector<std::pair<std::string, std::string>> fields; // values as sent, without surrounding blanks
    std::optional<std::uint64_t> content_length;
    bool chunked = false;
    bool expects_continue = false;
    bool close = false;     // the client wants the connection closed afterwards
    std::string request_id; // the client's X-Request-Id where it is one, else made

    bool has_body() const { return chunked || content_length.value_or(0) > 0; }
    // The block that httplib is given.
    std::string rewritten() const;
};

// Reads `block` (everything up to and with the empty line). `head` is filled as far as reading came, so that
// a refusal can carry the client's request id.
std::optional<HeadFault> read_head(std::string_view block, RequestHead& head);

// A client's request id, if it is one: 1 to 64 of [A-Za-z0-9_-].
bool is_request_id(std::string_view text);

} // namespace server
