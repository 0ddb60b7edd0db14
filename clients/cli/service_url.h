// ServiceUrl: where a service is: http(s)://host[:port][/prefix].
//
// Errors  UserError(usage) that says what is wrong with the URL.
#pragma once

#include <string>
#include <string_view>

namespace clients {

struct ServiceUrl {
    std::string origin; // "http://127.0.0.1:8080"
    std::string prefix; // "" or "/render": before every path
};

// Without a scheme it is http. User names, queries and fragments are refused.
ServiceUrl parse_service_url(const std::string& url);

// Everything but letters, digits and -._~ as %XX (RFC 3986 section 2.3).
std::string percent_encoded(std::string_view text);

} // namespace clients
