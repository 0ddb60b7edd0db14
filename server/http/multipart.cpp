#include "server/http/multipart.h"

#include <algorithm>
#include <cctype>
#include <optional>

namespace server {

namespace {

constexpr std::size_t kMaxPartHeadBytes = 16 << 10;

bool starts_with_no_case(std::string_view text, std::string_view start)
{
    return text.size() >= start.size() &&
           std::equal(start.begin(), start.end(), text.begin(), [](char a, char b) {
               return std::tolower(static_cast<unsigned char>(a)) ==
                      std::tolower(static_cast<unsigned char>(b));
           });
}

// The value of a parameter, quoted or not, in `form-data; name="x"; filename="y"`.
std::optional<std::string> parameter(std::string_view text, std::string_view name)
{
    std::size_t at = text.find(';');
    while (at != std::string_view::npos && at < text.size()) {
        at = text.find_first_not_of("; \t", at);
        if (at == std::string_view::npos) break;
        const std::size_t equals = text.find_first_of("=;", at);
        if (equals == std::string_view::npos || text[equals] == ';') {
            at = equals;
            continue;
        }
        const std::string_view key = text.substr(at, equals - at);
        std::string value;
        std::size_t end = equals + 1;
        if (end < text.size() && text[end] == '"') {
            for (++end; end < text.size() && text[end] != '"'; ++end) {
                if (text[end] == '\\' && end + 1 < text.size() &&
                    (text[end + 1] == '"' || text[end + 1] == '\\'))
                    ++end;
                value += text[end];
            }
            if (end >= text.size()) return std::nullopt;
            ++end;
        } else {
            end = std::min(text.find_first_of("; \t", end), text.size());
            value = text.substr(equals + 1, end - equals - 1);
        }
        if (key.size() == name.size() && starts_with_no_case(key, name)) return value;
        at = end;
    }
    return std::nullopt;
}

// Browsers and curl write just these three bytes percent-encoded into a part's name.
std::string without_form_escapes(std::string text)
{
    static constexpr std::pair<std::string_view, char> escapes[] = {
        {"%22", '"'}, {"%0D", '\r'}, {"%0A", '\n'}};
    for (const auto& [escape, byte] : escapes)
        for (std::size_t at = 0; (at = text.find(escape, at)) != std::string::npos; ++at)
            text.replace(at, 3, 1, byte);
    return text;
}

// The name of the part whose head this is.
std::optional<std::string> part_name(std::string_view head)
{
    while (!head.empty()) {
        const std::size_t end = std::min(head.find("\r\n"), head.size());
        const std::string_view line = head.substr(0, end);
        if (starts_with_no_case(line, "Content-Disposition:")) {
            auto name = parameter(line, "name");
            if (name) return without_form_escapes(*std::move(name));
        }
        head.remove_prefix(std::min(end + 2, head.size()));
    }
    return std::nullopt;
}

} // namespace

MultipartReader::MultipartReader(const std::string& boundary, PartTaker& taker)
    : taker_(taker), delimiter_("\r\n--" + boundary),
      buffer_("\r\n") // so that the first boundary looks like the others
{
}

bool MultipartReader::fail(std::string what)
{
    fault_ = std::move(what);
    return false;
}

bool MultipartReader::feed(std::string_view bytes)
{
    if (!fault_.empty()) return false;
    buffer_ += bytes;
    for (bool more = true; more;) {
        switch (state_) {
        case State::preamble:
        case State::content:
            if (!read_until_boundary(more)) return false;
            break;
        case State::boundary_end:
            if (!read_boundary_end(more)) return false;
            break;
        case State::head:
            if (!read_head(more)) return false;
            break;
        case State::epilogue:
            buffer_.clear();
            more = false;
        }
    }
    return true;
}

bool MultipartReader::read_until_boundary(bool& more)
{
    const std::size_t found = buffer_.find(delimiter_);
    // What may be the beginning of a boundary stays for the next time.
    const std::size_t sure =
        found != std::string::npos ? found : buffer_.size() - std::min(buffer_.size(), delimiter_.size() - 1);
    if (state_ == State::content && sure > 0 && !taker_.take(std::string_view(buffer_).substr(0, sure)))
        return false;
    buffer_.erase(0, sure);
    more = found != std::string::npos;
    if (!more) return true;
    buffer_.erase(0, delimiter_.size());
    const bool ends = state_ == State::content;
    state_ = State::boundary_end;
    return !ends || taker_.end_part();
}

bool MultipartReader::read_boundary_end(bool& more)
{
    const std::size_t text = buffer_.find_first_not_of(" \t");
    more = text != std::string::npos && buffer_.size() >= text + 2;
    if (!more)
        return buffer_.size() <= kMaxPartHeadBytes || fail("a boundary is followed by blanks without end");
    if (buffer_.compare(text, 2, "--") == 0)
        state_ = State::epilogue;
    else if (buffer_.compare(text, 2, "\r\n") == 0)
        state_ = State::head;
    else
        return fail("a boundary is followed by something else than a line end or --");
    // Of a line end the head keeps its own: a head without lines is then an empty line too.
    buffer_.erase(0, state_ == State::head ? text : text + 2);
    return true;
}

bool MultipartReader::read_head(bool& more)
{
    const std::size_t end = buffer_.find("\r\n\r\n");
    more = end != std::string::npos;
    if ((more ? end : buffer_.size()) > kMaxPartHeadBytes)
        return fail("the head of a part is longer than " + std::to_string(kMaxPartHeadBytes) + " bytes");
    if (!more) return true;
    const auto name = part_name(std::string_view(buffer_).substr(0, end));
    if (!name) return fail("a part has no name: each needs Content-Disposition: form-data; name=\"...\"");
    buffer_.erase(0, end + 4);
    if (!taker_.begin_part(*name)) return false;
    state_ = State::content;
    return true;
}

std::string multipart_boundary(const std::string& content_type)
{
    const std::string boundary = parameter(content_type, "boundary").value_or("");
    const bool good =
        !boundary.empty() && boundary.size() <= 70 && boundary.back() != ' ' &&
        std::all_of(boundary.begin(), boundary.end(), [](unsigned char c) {
            return std::isalnum(c) != 0 ||
                   std::string_view("'()+_,-./:=? ").find(static_cast<char>(c)) != std::string_view::npos;
        });
    return good ? boundary : std::string();
}

} // namespace server
