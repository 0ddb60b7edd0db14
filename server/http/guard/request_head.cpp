#include "server/http/guard/request_head.h"

#include "server/store/store.h"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace server {

namespace {

bool is_token_char(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

bool is_token(std::string_view text)
{
    return !text.empty() && std::all_of(text.begin(), text.end(), is_token_char);
}

bool same(std::string_view a, std::string_view b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
        return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
    });
}

std::string_view trimmed(std::string_view text)
{
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t'))
        text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t'))
        text.remove_suffix(1);
    return text;
}

HeadFault malformed(std::string detail)
{
    return {400, "bad_request", std::move(detail)};
}

// http://host/path, as a proxy would send it, becomes /path.
std::string_view origin_form(std::string_view target)
{
    if (target.size() < 7 || !same(target.substr(0, 7), "http://")) return target;
    const std::size_t slash = target.find('/', 7);
    return slash == std::string_view::npos ? std::string_view("/") : target.substr(slash);
}

std::optional<HeadFault> read_request_line(std::string_view line, RequestHead& head)
{
    const std::size_t first = line.find(' ');
    const std::size_t last = line.rfind(' ');
    if (first == std::string_view::npos || first == last)
        return malformed("the request line is not \"METHOD /path HTTP/1.1\"");
    const std::string_view method = line.substr(0, first), version = line.substr(last + 1);
    const std::string_view target = origin_form(line.substr(first + 1, last - first - 1));
    if (!is_token(method) || method.size() > 16) return malformed("the method is not a token");
    head.method = method;
    if (version == "HTTP/1.0")
        head.close = true;
    else if (version != "HTTP/1.1")
        return HeadFault{505, "http_version", "the service speaks HTTP/1.1 and HTTP/1.0"};
    const auto is_wrong = [](char c) { return c <= ' ' || c >= 0x7f || c == '#'; };
    if (target.empty() || target.front() != '/' || std::any_of(target.begin(), target.end(), is_wrong))
        return malformed(
            "the target must be a path that starts with / and holds no blank, control or non-ASCII byte "
            "(percent-encode those)");
    if (target.size() > kMaxTargetBytes || target.substr(0, target.find('?')).size() > kMaxPathBytes)
        return HeadFault{414,
                         "target_too_long",
                         "the path may have " + std::to_string(kMaxPathBytes) + " bytes, path and query " +
                             std::to_string(kMaxTargetBytes)};
    head.target = target;
    return std::nullopt;
}

std::optional<HeadFault> read_field(std::string_view line, RequestHead& head)
{
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || !is_token(line.substr(0, colon)))
        return malformed("a header line is not \"Name: value\"");
    const std::string_view name = line.substr(0, colon), value = trimmed(line.substr(colon + 1));
    if (std::any_of(value.begin(), value.end(), [](char c) {
            return (static_cast<unsigned char>(c) < ' ' && c != '\t') || c == 0x7f;
        }))
        return malformed("a header value holds a control character");
    head.fields.emplace_back(name, value);
    return std::nullopt;
}

// The values of all fields of that name.
std::vector<std::string_view> values_of(const RequestHead& head, std::string_view name)
{
    std::vector<std::string_view> values;
    for (const auto& [field, value] : head.fields)
        if (same(field, name)) values.push_back(value);
    return values;
}

bool names_token(const std::vector<std::string_view>& lists, std::string_view token)
{
    for (std::string_view list : lists) {
        while (!list.empty()) {
            const std::size_t comma = std::min(list.find(','), list.size());
            if (same(trimmed(list.substr(0, comma)), token)) return true;
            list.remove_prefix(std::min(comma + 1, list.size()));
        }
    }
    return false;
}

std::optional<HeadFault> read_framing(RequestHead& head, bool http_1_0)
{
    const auto lengths = values_of(head, "Content-Length"), encodings = values_of(head, "Transfer-Encoding");
    if (!lengths.empty() && !encodings.empty())
        return malformed("Content-Length and Transfer-Encoding in one request");
    if (lengths.size() > 1) return malformed("Content-Length more than once");
    if (!lengths.empty()) {
        std::uint64_t length = 0;
        const char* const end = lengths[0].data() + lengths[0].size();
        const auto [stop, error] = std::from_chars(lengths[0].data(), end, length);
        if (lengths[0].empty() || error != std::errc() || stop != end || length >> 62)
            return malformed("Content-Length is not a number of bytes");
        head.content_length = length;
    }
    if (!encodings.empty()) {
        if (encodings.size() > 1 || !same(encodings[0], "chunked") || http_1_0)
            return malformed("of transfer encodings only \"chunked\" is known, in HTTP/1.1");
        head.chunked = true;
    }
    if (head.has_body() && head.method != "POST" && head.method != "PUT" && head.method != "PATCH")
        return malformed("a " + head.method + " request takes no body");
    return std::nullopt;
}

std::optional<HeadFault> check_fields(RequestHead& head, bool http_1_0)
{
    if (values_of(head, "Host").size() > 1 || (!http_1_0 && values_of(head, "Host").empty()))
        return malformed("there must be one Host header");
    if (auto fault = read_framing(head, http_1_0)) return fault;
    for (const std::string_view encoding : values_of(head, "Content-Encoding"))
        if (!same(encoding, "identity"))
            return HeadFault{
                415, "unsupported_encoding", "bodies are taken as they are: send without Content-Encoding"};
    for (const std::string_view expectation : values_of(head, "Expect")) {
        if (!same(expectation, "100-continue"))
            return HeadFault{417, "expectation_failed", "of expectations only 100-continue is known"};
        head.expects_continue = !http_1_0 && head.has_body();
    }
    if (names_token(values_of(head, "Connection"), "close")) head.close = true;
    return std::nullopt;
}

} // namespace

bool is_request_id(std::string_view text)
{
    return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
    });
}

std::optional<HeadFault> read_head(std::string_view block, RequestHead& head)
{
    head = {};
    head.request_id = make_job_id();
    std::optional<HeadFault> fault;
    bool http_1_0 = false;
    for (std::size_t line_number = 0;; ++line_number) {
        const std::size_t end = block.find("\r\n");
        const std::string_view line = block.substr(0, end);
        if (end == std::string_view::npos ||
            line.find_first_of(std::string_view("\r\n\0", 3)) != std::string_view::npos)
            return malformed("header lines end in CR LF and hold neither alone");
        if (line_number > 0 && line.empty()) break;
        if (line_number == 0) {
            fault = read_request_line(line, head);
            http_1_0 = line.ends_with("HTTP/1.0");
        } else if (auto wrong = read_field(line, head); wrong && !fault) {
            fault = wrong;
        }
        if (line_number > kMaxHeadLines)
            return HeadFault{
                431, "headers_too_large", "more than " + std::to_string(kMaxHeadLines) + " header lines"};
        block.remove_prefix(end + 2);
    }
    // After the loop, so that a refusal of the first line carries the id too.
    if (const auto ids = values_of(head, "X-Request-Id"); ids.size() == 1 && is_request_id(ids[0]))
        head.request_id = ids[0];
    return fault ? fault : check_fields(head, http_1_0);
}

std::string RequestHead::rewritten() const
{
    std::string block = method + " " + target + " HTTP/1.1\r\nHost: guard\r\n";
    if (chunked)
        block += "Transfer-Encoding: chunked\r\n";
    else if (content_length)
        block += "Content-Length: " + std::to_string(*content_length) + "\r\n";
    if (close) block += "Connection: close\r\n";
    return block + "\r\n";
}

} // namespace server
