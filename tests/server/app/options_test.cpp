// The options table: flags, environment, defaults, and what is refused.
#include "api/words/limit_words.h"
#include "server/app/options.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace {

using server::EarlyExit;
using server::ServiceOptions;

std::variant<ServiceOptions, EarlyExit> read(std::vector<const char*> words)
{
    words.insert(words.begin(), "heliographd");
    return server::read_options(static_cast<int>(words.size()), words.data());
}

ServiceOptions accepted(const std::vector<const char*>& words)
{
    const auto answer = read(words);
    if (const auto* leave = std::get_if<EarlyExit>(&answer)) {
        ADD_FAILURE() << leave->text;
        return {};
    }
    return std::get<ServiceOptions>(answer);
}

std::string refused(const std::vector<const char*>& words)
{
    const auto answer = read(words);
    const auto* leave = std::get_if<EarlyExit>(&answer);
    EXPECT_NE(leave, nullptr);
    if (leave == nullptr) return {};
    EXPECT_EQ(leave->code, 2);
    return leave->text;
}

class Variable {
public:
    Variable(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
    ~Variable() { unsetenv(name_); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

private:
    const char* name_;
};

TEST(Options, HaveSafeDefaults)
{
    const ServiceOptions options = accepted({});
    EXPECT_EQ(options.host, "127.0.0.1");
    EXPECT_EQ(options.port, 8080);
    EXPECT_EQ(options.health_port, 8081);
    EXPECT_EQ(options.threads, 0U);
    EXPECT_FALSE(options.insecure);
    EXPECT_EQ(options.log_level, server::LogLevel::info);
    EXPECT_EQ(options.limits.queue_jobs, renderer::Limits{}.queue_jobs);
}

TEST(Options, PutTheHealthPortBesideThePort)
{
    EXPECT_EQ(accepted({"--port", "9000"}).health_port, 9001);
    EXPECT_EQ(accepted({"--port", "0"}).health_port, 0);
    EXPECT_EQ(accepted({"--port", "9000", "--health-port", "0"}).health_port, 0);
    EXPECT_NE(refused({"--port", "9000", "--health-port", "9000"}).find("9000"), std::string::npos);
    EXPECT_NE(refused({"--port", "65535"}).find("--health-port"), std::string::npos);
}

TEST(Options, TakeEveryLimitAsAFlagAndAVariable)
{
    for (const renderer::LimitEntry& limit : renderer::limit_table()) {
        const std::string flag = api::flag_of(limit.name), variable = api::environment_of(limit.name);
        EXPECT_EQ(accepted({flag.c_str(), "17"}).limits.*limit.value, 17U) << flag;
        const Variable set(variable.c_str(), "18");
        EXPECT_EQ(accepted({}).limits.*limit.value, 18U) << variable;
        EXPECT_EQ(accepted({flag.c_str(), "19"}).limits.*limit.value, 19U) << "the flag wins";
    }
}

TEST(Options, RefuseLimitsThatNothingCouldKeep)
{
    for (const renderer::LimitEntry& limit : renderer::limit_table()) {
        const std::string flag = api::flag_of(limit.name);
        const std::string most = std::to_string(limit.most), more = std::to_string(limit.most + 1);
        EXPECT_EQ(accepted({flag.c_str(), most.c_str()}).limits.*limit.value, limit.most) << flag;
        const std::string text = refused({flag.c_str(), more.c_str()});
        EXPECT_NE(text.find(flag), std::string::npos) << text;
        EXPECT_NE(text.find(most), std::string::npos) << text;
        EXPECT_NE(refused({flag.c_str(), "18446744073709551615"}), "") << flag;
        EXPECT_LE(renderer::Limits{}.*limit.value, limit.most) << flag;
    }
}

TEST(Options, AreReadFromTheEnvironment)
{
    const Variable port("HELIOGRAPH_PORT", "0"), host("HELIOGRAPH_HOST", "0.0.0.0"),
        insecure("HELIOGRAPH_INSECURE", "1"), data("HELIOGRAPH_DATA", "/somewhere"),
        level("HELIOGRAPH_LOG_LEVEL", "debug"), program("HELIOGRAPH_IMPORT_PROGRAM", "/bin/importer");
    const ServiceOptions options = accepted({});
    EXPECT_EQ(options.port, 0);
    EXPECT_EQ(options.host, "0.0.0.0");
    EXPECT_TRUE(options.insecure);
    EXPECT_EQ(options.data, "/somewhere");
    EXPECT_EQ(options.log_level, server::LogLevel::debug);
    EXPECT_EQ(options.import_program, "/bin/importer");
}

TEST(Options, DoNotLetStrangersInUnlessTold)
{
    for (const char* host : {"0.0.0.0", "::", "192.168.1.7", "example.org", "127.evil.org"}) {
        EXPECT_NE(refused({"--host", host}).find("--insecure"), std::string::npos) << host;
        EXPECT_EQ(accepted({"--host", host, "--insecure"}).host, host);
    }
    for (const char* host : {"127.0.0.1", "127.8.9.10", "localhost", "::1"})
        EXPECT_EQ(accepted({"--host", host}).host, host);
    const Variable off("HELIOGRAPH_INSECURE", "0");
    EXPECT_NE(refused({"--host", "0.0.0.0"}).find("--insecure"), std::string::npos);
}

TEST(Options, SayWhichValueIsWrongAndWhatIsAllowed)
{
    for (const char* wrong : {"abc", "-5", "65536", "80x", "", "1e3", "0x50", "99999999999999999999999"}) {
        const std::string text = refused({"--port", wrong});
        EXPECT_NE(text.find("--port"), std::string::npos) << wrong;
        EXPECT_NE(text.find("65535"), std::string::npos) << wrong << ": " << text;
    }
    EXPECT_NE(refused({"--log-level", "loud"}).find("warning"), std::string::npos);
    EXPECT_NE(refused({"--bogus"}).find("--bogus"), std::string::npos);
    EXPECT_NE(refused({"serve"}).find("serve"), std::string::npos);
    const Variable wrong("HELIOGRAPH_LIMIT_SAMPLES", "many");
    EXPECT_NE(refused({}).find("HELIOGRAPH_LIMIT_SAMPLES"), std::string::npos);
}

TEST(Options, HelpTellsEveryFlagItsVariableAndItsDefault)
{
    const auto answer = read({"--help"});
    const auto& help = std::get<EarlyExit>(answer);
    EXPECT_EQ(help.code, 0);
    for (const char* text : {"--host",
                             "HELIOGRAPH_HOST",
                             "127.0.0.1",
                             "--port",
                             "8080",
                             "--insecure",
                             "HELIOGRAPH_DATA",
                             "HELIOGRAPH_LIMIT_QUEUE_JOBS",
                             "--limit-queue-jobs",
                             "Exit codes"})
        EXPECT_NE(help.text.find(text), std::string::npos) << text;
    EXPECT_EQ(help.text.find("/metrics"), std::string::npos) << "no such route is served";
}

} // namespace
