#include "server/log/log.h"

#include "server/log/json_text.h"

#include <spdlog/logger.h>
#include <spdlog/sinks/stdout_sinks.h>

#include <chrono>

namespace server {

namespace {

// Standard error has no buffer, so spdlog's one fwrite of a line is one write.
spdlog::logger make_logger()
{
    spdlog::logger logger("heliograph", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    logger.set_pattern("%v");
    logger.set_level(spdlog::level::trace); // Log drops what is below its own level, before it is formatted
    return logger;
}

const char* name_of(LogLevel level)
{
    switch (level) {
    case LogLevel::debug:
        return "debug";
    case LogLevel::info:
        return "info";
    case LogLevel::warning:
        return "warning";
    case LogLevel::error:
        return "error";
    }
    return "unknown";
}

spdlog::level::level_enum spdlog_level(LogLevel level)
{
    switch (level) {
    case LogLevel::debug:
        return spdlog::level::debug;
    case LogLevel::info:
        return spdlog::level::info;
    case LogLevel::warning:
        return spdlog::level::warn;
    case LogLevel::error:
        return spdlog::level::err;
    }
    return spdlog::level::err;
}

std::int64_t unix_ms()
{
    namespace chrono = std::chrono;
    return chrono::duration_cast<chrono::milliseconds>(chrono::system_clock::now().time_since_epoch())
        .count();
}

} // namespace

struct Log::Sink {
    spdlog::logger logger = make_logger();
};

Log::Log(LogLevel level) : level_(level), sink_(std::make_shared<Sink>()) {}

void Log::write(LogLevel level, std::string_view event, std::initializer_list<LogField> fields) const
{
    if (level < level_) return;
    std::string line =
        "{\"time\":\"" + rfc3339_of(unix_ms()) + "\",\"level\":\"" + name_of(level) + "\",\"event\":";
    append_json(line, event);
    for (const LogField& field : fields) {
        line += ',';
        append_json(line, field.name);
        line += ':';
        std::visit([&](const auto& value) { append_json(line, value); }, field.value);
    }
    line += '}';
    sink_->logger.log(spdlog_level(level), spdlog::string_view_t(line.data(), line.size()));
}

} // namespace server
