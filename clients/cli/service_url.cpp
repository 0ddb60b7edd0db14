#include "clients/cli/service_url.h"

#include "clients/cli/user_error.h"

#include <charconv>
#include <cstdint>

namespace clients {
namespace {

bool is_unreserved(char c)
{
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
           std::string_view("-._~").find(c) != std::string_view::npos;
}

// Host names, IPv4, and IPv6 within brackets, with a port or none.
bool is_authority(std::string_view text)
{
    const bool bracketed = text.starts_with('[');
    const std::size_t host_end = bracketed ? text.find(']') : text.find(':');
    if (bracketed && host_end == std::string_view::npos) return false;
    std::string_view host = text.substr(0, host_end);
    std::string_view rest = host_end == std::string_view::npos ? "" : text.substr(host_end);
    if (bracketed) {
        host.remove_prefix(1);
        rest.remove_prefix(1);
    }
    if (host.empty()) return false;
    for (const char c : host)
        if (!is_unreserved(c) && !(bracketed && c == ':')) return false;
    if (rest.empty()) return true;
    std::uint16_t port = 0;
    const auto [end, error] = std::from_chars(rest.data() + 1, rest.data() + rest.size(), port);
    return rest[0] == ':' && error == std::errc() && end == rest.data() + rest.size() && port > 0;
}

} // namespace

ServiceUrl parse_service_url(const std::string& url)
{
    const auto refuse = [&url](const char* why) {
        throw UserError(ExitCode::usage, "--url " + url + ": " + why + "; write http://HOST:PORT");
    };
    std::string_view rest = url;
    std::string scheme = "http";
    if (const std::size_t mark = rest.find("://"); mark != std::string_view::npos) {
        scheme = rest.substr(0, mark);
        rest.remove_prefix(mark + 3);
    }
    if (scheme != "http" && scheme != "https") refuse("only http and https are spoken");
    if (rest.find_first_of("?#@ ") != std::string_view::npos)
        refuse("no user, query, fragment or blank belongs here");
    const std::size_t slash = rest.find('/');
    const std::string_view authority = rest.substr(0, slash);
    if (!is_authority(authority)) refuse("host or port is not valid");
    std::string prefix(slash == std::string_view::npos ? "" : rest.substr(slash));
    while (prefix.ends_with('/'))
        prefix.pop_back();
    return {scheme + "://" + std::string(authority), prefix};
}

std::string percent_encoded(std::string_view text)
{
    static constexpr std::string_view kHex = "0123456789ABCDEF";
    std::string out;
    for (const char c : text) {
        if (is_unreserved(c)) {
            out += c;
            continue;
        }
        const auto byte = static_cast<unsigned char>(c);
        out += '%';
        out += kHex[byte >> 4];
        out += kHex[byte & 15];
    }
    return out;
}

} // namespace clients
