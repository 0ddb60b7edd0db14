// Log: one JSON object a line on standard error, with the request id where there is one.
//
// Threads  any. Cost: formatting on the caller's thread, one write.
#pragma once

#include <cstdint>
#include <initializer_list>
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
    LogLevel level_;
};

} // namespace server
