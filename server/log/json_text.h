// JSON text of single values, for log lines: what `api` does for documents, without a document.
//
// Errors  none: bytes that are not UTF-8 become U+FFFD, numbers that are not finite null.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace server {

// Appends `text` as a JSON string with its quotes.
void append_json(std::string& out, std::string_view text);
void append_json(std::string& out, std::int64_t number);
void append_json(std::string& out, double number); // the shortest that reads back the same
void append_json(std::string& out, bool truth);

// "2026-01-31T12:00:00.000Z" of Unix time.
std::string rfc3339_of(std::int64_t unix_ms);

} // namespace server
