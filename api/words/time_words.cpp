#include "api/words/time_words.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>

namespace api {

std::string rfc3339(std::int64_t unix_ms)
{
    constexpr std::int64_t first = -62167219200000, last = 253402300799999; // of the years 0 and 9999
    const std::chrono::sys_time<std::chrono::milliseconds> time{
        std::chrono::milliseconds(std::clamp(unix_ms, first, last))};
    const auto day = std::chrono::floor<std::chrono::days>(time);
    const std::chrono::year_month_day date(day);
    const std::chrono::hh_mm_ss clock(time - day);
    std::array<char, 64> text{};
    std::snprintf(text.data(),
                  text.size(),
                  "%04d-%02u-%02uT%02d:%02d:%02d.%03dZ",
                  static_cast<int>(date.year()),
                  static_cast<unsigned>(date.month()),
                  static_cast<unsigned>(date.day()),
                  static_cast<int>(clock.hours().count()),
                  static_cast<int>(clock.minutes().count()),
                  static_cast<int>(clock.seconds().count()),
                  static_cast<int>(clock.subseconds().count()));
    return text.data();
}

} // namespace api
