#include "server/app/options.h"

#include "api/build_info.h"
#include "api/words/limit_words.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <functional>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

namespace server {

namespace {

constexpr int kWrongOptions = 2;
constexpr std::array<std::pair<const char*, LogLevel>, 4> kLogLevels{{{"debug", LogLevel::debug},
                                                                      {"info", LogLevel::info},
                                                                      {"warning", LogLevel::warning},
                                                                      {"error", LogLevel::error}}};

// Text as given -> why it is refused; empty: taken.
using Take = std::function<std::string(const std::string& text)>;

struct Row {
    std::string flag, environment;
    std::string value_name; // empty: a switch
    std::string standard;   // the default, as help shows it
    std::string help;
    Take take;
};

std::string environment_of_flag(const std::string& flag)
{
    std::string name = "HELIOGRAPH_" + flag.substr(2);
    std::transform(name.begin(), name.end(), name.begin(), [](char c) {
        if (c == '-') return '_';
        return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    });
    return name;
}

Take take_number(std::uint64_t most, std::function<void(std::uint64_t)> set)
{
    return [most, set = std::move(set)](const std::string& text) -> std::string {
        std::uint64_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size() || value > most)
            return "'" + text + "' is not a whole number from 0 to " + std::to_string(most);
        set(value);
        return {};
    };
}

Take take_text(std::function<void(const std::string&)> set)
{
    return [set = std::move(set)](const std::string& text) -> std::string {
        if (text.empty()) return "it is empty";
        set(text);
        return {};
    };
}

std::string take_log_level(const std::string& text, LogLevel& level)
{
    for (const auto& [name, value] : kLogLevels) {
        if (text != name) continue;
        level = value;
        return {};
    }
    return "'" + text + "' is none of debug, info, warning, error";
}

struct Draft {
    ServiceOptions options;
    std::optional<int> health_port;
};

Row row_of(std::string flag, std::string value_name, std::string standard, std::string help, Take take)
{
    std::string environment = environment_of_flag(flag);
    return {std::move(flag),
            std::move(environment),
            std::move(value_name),
            std::move(standard),
            std::move(help),
            std::move(take)};
}

std::string help_of(const renderer::LimitEntry& limit)
{
    const std::string unit = limit.unit;
    return std::string("limit: ") + limit.what + (unit.empty() ? "" : ", in " + unit);
}

// THE table: every option of the program is a row here.
std::vector<Row> option_rows(Draft& draft)
{
    ServiceOptions& o = draft.options;
    constexpr std::uint64_t kMostPort = 65535;
    std::vector<Row> rows{
        row_of("--host",
               "ADDRESS",
               o.host,
               "address to listen on; one that others reach needs --insecure",
               take_text([&o](const std::string& text) { o.host = text; })),
        row_of("--port",
               "N",
               std::to_string(o.port),
               "port to listen on; 0: any free one",
               take_number(kMostPort, [&o](std::uint64_t n) { o.port = static_cast<int>(n); })),
        row_of(
            "--health-port",
            "N",
            "port + 1",
            "port of /healthz and /readyz alone; 0: any free one",
            take_number(kMostPort, [&draft](std::uint64_t n) { draft.health_port = static_cast<int>(n); })),
        row_of("--data",
               "FOLDER",
               "./" + o.data.string(),
               "where jobs, assets and pictures are kept",
               take_text([&o](const std::string& text) { o.data = text; })),
        row_of("--threads",
               "N",
               "0",
               "threads that render; 0: one for every core",
               take_number(4096, [&o](std::uint64_t n) { o.threads = static_cast<unsigned>(n); })),
        row_of("--log-level",
               "LEVEL",
               "info",
               "debug, info, warning or error",
               [&o](const std::string& text) { return take_log_level(text, o.log_level); }),
        row_of("--insecure",
               "",
               "",
               "listen where others reach it, although anyone may then send jobs",
               [&o](const std::string&) {
                   o.insecure = true;
                   return std::string();
               }),
        row_of("--import-program",
               "FILE",
               "heliograph-import beside this program",
               "the program that reads meshes",
               take_text([&o](const std::string& text) { o.import_program = text; }))};
    for (const renderer::LimitEntry& limit : renderer::limit_table())
        rows.push_back(
            {api::flag_of(limit.name),
             api::environment_of(limit.name),
             "N",
             std::to_string(o.limits.*limit.value),
             help_of(limit),
             take_number(limit.most, [&o, member = limit.value](std::uint64_t n) { o.limits.*member = n; })});
    return rows;
}

void add_row(CLI::App& app, const Row& row)
{
    const auto take = [&row](const std::string& text) {
        const std::string refused = row.take(text);
        if (!refused.empty()) throw CLI::ValidationError(row.flag + " (" + row.environment + "): " + refused);
    };
    if (row.value_name.empty()) {
        app.add_flag_callback(
               row.flag, [take] { take("true"); }, row.help)
            ->envname(row.environment);
        return;
    }
    app.add_option_function<std::string>(row.flag, take, row.help)
        ->envname(row.environment)
        ->type_name(row.value_name)
        ->default_str(row.standard);
}

EarlyExit wrong(const std::string& what)
{
    return {kWrongOptions, "heliographd: " + what + "\nheliographd --help lists every option\n"};
}

std::string version_text()
{
    const api::BuildInfo& build = api::build_info();
    return "heliographd " + build.version + " (commit " + build.commit + ", " + build.compiler + ", " +
           build.build_type + ")\n";
}

// What no single option can tell.
std::string conflict_in(Draft& draft)
{
    ServiceOptions& o = draft.options;
    if (!is_loopback(o.host) && !o.insecure)
        return "--host " + o.host +
               " lets others reach the service, and it has no keys: anyone could send it jobs. " +
               "Bind to 127.0.0.1, or give --insecure (HELIOGRAPH_INSECURE=1) if the network is trusted";
    o.health_port = draft.health_port.value_or(o.port == 0 ? 0 : o.port + 1);
    if (o.health_port > 65535) return "--port 65535 leaves no health port after it: give --health-port";
    if (o.health_port == o.port && o.port != 0)
        return "--port and --health-port are both " + std::to_string(o.port);
    return {};
}

} // namespace

bool is_loopback(const std::string& host)
{
    if (host == "localhost" || host == "::1") return true;
    return host.rfind("127.", 0) == 0 && host.find_first_not_of("0123456789.") == std::string::npos;
}

std::variant<ServiceOptions, EarlyExit> read_options(int argc, const char* const* argv)
{
    Draft draft;
    const std::vector<Row> rows = option_rows(draft);
    CLI::App app("Renders scenes that come over HTTP.", "heliographd");
    app.set_version_flag("--version", version_text(), "version, commit and compiler");
    app.footer("Exit codes: 0 stopped as asked, 1 could not start or serve, 2 wrong options, 128 + signal "
               "stopped in "
               "haste by a second signal.");
    for (const Row& row : rows)
        add_row(app, row);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return EarlyExit{0, app.help()};
    } catch (const CLI::CallForVersion&) {
        return EarlyExit{0, version_text()};
    } catch (const CLI::ParseError& error) {
        return wrong(error.what());
    }
    const std::string conflict = conflict_in(draft);
    if (!conflict.empty()) return wrong(conflict);
    return std::move(draft.options);
}

} // namespace server
