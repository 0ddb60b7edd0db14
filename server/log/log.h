// Log: one JSON object a line on standard error, with the request id where there is one.
//
// A line is {"time": RFC 3339 with milliseconds, UTC, "level", "event", the fields in their order}. Bytes
// that are not UTF-8 become U+FFFD, numbers that are not finite null: a line is always JSON.
//
// Threads  any; a line is written whole. Copies share one sink.
// Errors   none reach the caller: a line that cannot be written is lost.
// Cost     formatting on the caller's thread, one write.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

namespace server {

enum class LogLevel : std::uint8_t { debug, info, warning, error };

struct LogField {
    std::string_view name;
    std::variant<std::string_view, std::int64_t, double, bool> value;
};

class Log {
public:
    // Lines below `level` are dropped.
    explicit Log(LogLevel level = LogLevel::info);

    void write(LogLevel level, std::string_view event, std::initializer_list<LogField> fields = {}) const;

private:
    struct Sink;
    LogLevel level_;
    std::shared_ptr<Sink> sink_;
};

} // namespace server
