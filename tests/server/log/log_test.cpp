#include "server/log/json_text.h"
#include "server/log/log.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <regex>
#include <set>
#include <sstream>
#include <thread>
#include <vector>

namespace {

using nlohmann::ordered_json;
using server::Log;
using server::LogLevel;
using namespace std::string_view_literals;

std::vector<ordered_json> lines_of(const std::string& text)
{
    std::vector<ordered_json> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(ordered_json::parse(line));
    return lines;
}

TEST(Log, WritesAJsonObjectALine)
{
    testing::internal::CaptureStderr();
    Log().write(LogLevel::warning,
                "job_failed",
                {{"job", "abc"sv}, {"attempts", std::int64_t{-3}}, {"seconds", 0.1}, {"retry", true}});
    const std::string text = testing::internal::GetCapturedStderr();
    const std::vector<ordered_json> lines = lines_of(text);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_TRUE(std::regex_match(lines[0].at("time").get<std::string>(),
                                 std::regex(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z)")));
    ordered_json without_time = lines[0];
    without_time.erase("time");
    EXPECT_EQ(
        without_time.dump(),
        R"({"level":"warning","event":"job_failed","job":"abc","attempts":-3,"seconds":0.1,"retry":true})");
}

TEST(Log, DropsWhatIsBelowItsLevel)
{
    testing::internal::CaptureStderr();
    const Log log(LogLevel::warning);
    log.write(LogLevel::debug, "a");
    log.write(LogLevel::info, "b");
    log.write(LogLevel::warning, "c");
    log.write(LogLevel::error, "d");
    const auto lines = lines_of(testing::internal::GetCapturedStderr());
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0].at("event"), "c");
    EXPECT_EQ(lines[1].at("level"), "error");
}

TEST(Log, KeepsALineOneLineWhateverIsInIt)
{
    const std::string hostile =
        "a\nb\r\t\"quoted\" \\ \x01\x1F\x7F {} %v {0} " + std::string(1, '\0') + "end";
    testing::internal::CaptureStderr();
    Log().write(LogLevel::info, hostile, {{hostile, std::string_view(hostile)}});
    const auto lines = lines_of(testing::internal::GetCapturedStderr());
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0].at("event"), hostile);
    EXPECT_EQ(lines[0].at(hostile), hostile);
}

TEST(Log, WritesWholeLinesFromManyThreads)
{
    constexpr int kThreads = 8;
    constexpr int kLines = 200;
    testing::internal::CaptureStderr();
    const Log log;
    std::vector<std::thread> threads;
    for (int t = 0; t < kThreads; ++t)
        threads.emplace_back([copy = log, t] {
            for (int i = 0; i < kLines; ++i)
                copy.write(LogLevel::info,
                           "line",
                           {{"n", std::int64_t{t * kLines + i}}, {"pad", "................"sv}});
        });
    for (std::thread& thread : threads)
        thread.join();
    std::set<int> seen;
    for (const auto& line : lines_of(testing::internal::GetCapturedStderr()))
        seen.insert(line.at("n").get<int>());
    EXPECT_EQ(seen.size(), std::size_t{kThreads * kLines});
}

std::string json_of(std::string_view text)
{
    std::string out;
    server::append_json(out, text);
    return out;
}

TEST(JsonText, KeepsGoodUtf8AndReplacesTheRest)
{
    const std::string good = "\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x90\xB0 \xED\x9F\xBF \xF4\x8F\xBF\xBF";
    EXPECT_EQ(json_of(good), '"' + good + '"');
    for (const char* bad : {"\x80",
                            "\xC0\xAF",
                            "\xC1\xBF",
                            "\xE0\x80\x80",
                            "\xED\xA0\x80",
                            "\xF4\x90\x80\x80",
                            "\xF5\x80\x80\x80",
                            "\xFF",
                            "\xC3",
                            "\xE2\x82",
                            "\xF0\x9F\x90"}) {
        const ordered_json parsed = ordered_json::parse(json_of("<" + std::string(bad) + ">"));
        const std::string text = parsed.get<std::string>();
        EXPECT_EQ(text.substr(0, 4), "<\xEF\xBF\xBD") << text;
        EXPECT_EQ(text.back(), '>');
    }
}

TEST(JsonText, WritesNumbersThatReadBackTheSame)
{
    for (const double number : {0.0, -0.0, 0.1, 1e300, 5e-324, 1.0 / 3}) {
        std::string out;
        server::append_json(out, number);
        EXPECT_EQ(ordered_json::parse(out).get<double>(), number) << out;
    }
    std::string out;
    server::append_json(out, std::numeric_limits<double>::quiet_NaN());
    server::append_json(out, std::numeric_limits<double>::infinity());
    EXPECT_EQ(out, "nullnull");
}

TEST(JsonText, WritesTimeAsRfc3339)
{
    EXPECT_EQ(server::rfc3339_of(0), "1970-01-01T00:00:00.000Z");
    EXPECT_EQ(server::rfc3339_of(1'700'000'000'007), "2023-11-14T22:13:20.007Z");
    EXPECT_EQ(server::rfc3339_of(-1), "1969-12-31T23:59:59.999Z");
}

} // namespace
