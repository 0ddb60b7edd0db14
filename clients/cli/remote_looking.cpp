#include "api/client_words.h"
#include "clients/cli/remote_commands.h"
#include "clients/cli/remote_job.h"
#include "clients/cli/service_errors.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>

namespace clients {
namespace {

std::string time_text(std::int64_t unix_ms)
{
    const auto seconds = static_cast<std::time_t>(unix_ms / 1000);
    std::tm parts{};
    std::array<char, 32> text{};
    if (::gmtime_r(&seconds, &parts) == nullptr) return "?";
    const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S UTC", &parts);
    return {text.data(), length};
}

std::string state_text(const api::JobView& job)
{
    std::string text = api::name_of(job.state);
    if (!api::is_final(job.state)) {
        text += ", " + std::to_string(static_cast<int>(std::clamp(job.progress, 0.0, 1.0) * 100)) + " %";
        if (job.queue_position) text += ", " + std::to_string(*job.queue_position) + " before it";
    }
    return text;
}

std::string labels_text(const api::JobView& job)
{
    std::string text;
    for (const auto& [name, value] : job.labels) {
        if (!text.empty()) text += ' ';
        text += name;
        text += '=';
        text += value;
    }
    return text;
}

void print_status(const api::JobView& job)
{
    std::printf("job       %s\nstate     %s\n", job.id.c_str(), state_text(job).c_str());
    std::printf("created   %s\n", time_text(job.created_ms).c_str());
    if (job.started_ms) std::printf("started   %s\n", time_text(*job.started_ms).c_str());
    if (job.finished_ms) std::printf("finished  %s\n", time_text(*job.finished_ms).c_str());
    std::printf("samples   %u\npriority  %d\n", job.samples_done, job.priority);
    if (job.reused) std::printf("reused    yes\n");
    if (!job.labels.empty()) std::printf("labels    %s\n", labels_text(job).c_str());
    if (!job.render_key.empty()) std::printf("render    %s\n", job.render_key.c_str());
    if (job.error) {
        const HttpAnswer words{
            .status = job.error->status, .headers = {}, .body = api::write_problem(*job.error)};
        std::printf("error     %s\n", describe(words).c_str());
    }
}

// NAME=VALUE as --label of submit has it, NAME:VALUE as the query has it.
std::string label_query(std::string label)
{
    const std::size_t equals = label.find('=');
    if (label.empty()) return label;
    if (equals == 0 || equals == std::string::npos)
        throw UserError(ExitCode::usage, "--label " + label + ": write NAME=VALUE");
    label[equals] = ':';
    return label;
}

std::string list_path(const ListOptions& options, const std::string& cursor, std::uint32_t left)
{
    std::string path = "/v1/jobs";
    const auto add = [&path](const char* name, const std::string& value) {
        if (value.empty()) return;
        path += path.find('?') == std::string::npos ? '?' : '&';
        path += name;
        path += '=' + percent_encoded(value);
    };
    add("state", options.state);
    add("label", label_query(options.label));
    add("limit", left > 0 ? std::to_string(std::min(left, 100u)) : "");
    add("cursor", cursor);
    return path;
}

HttpClient client_for(const ServiceOptions& service, std::stop_token stop)
{
    return {parse_service_url(service.url), service.patience_s, std::move(stop)};
}

} // namespace

ExitCode status_command(const ServiceOptions& service, const StatusOptions& options, std::stop_token stop)
{
    HttpClient client = client_for(service, std::move(stop));
    std::string text;
    const api::JobView job = get_job(client, options.id, &text);
    if (options.json)
        std::printf("%s\n", text.c_str());
    else
        print_status(job);
    return ExitCode::ok;
}

ExitCode list_command(const ServiceOptions& service, const ListOptions& options, std::stop_token stop)
{
    HttpClient client = client_for(service, std::move(stop));
    std::string cursor;
    std::uint32_t left = options.limit;
    do {
        const HttpAnswer answer = client.send({.path = list_path(options, cursor, left)});
        if (answer.status != 200) throw error_from("list", answer);
        const auto page = api::read_job_list(answer.body);
        if (!page)
            throw UserError(ExitCode::unreachable,
                            "list: the answer is no list of jobs; is this a Heliograph service?");
        if (options.json) std::printf("%s\n", answer.body.c_str());
        for (const api::JobView& job : page->jobs) {
            if (!options.json)
                std::printf("%s  %s  %-18s %s\n",
                            job.id.c_str(),
                            time_text(job.created_ms).c_str(),
                            state_text(job).c_str(),
                            labels_text(job).c_str());
            if (left > 0 && --left == 0) return ExitCode::ok;
        }
        cursor = page->next_cursor;
    } while (!cursor.empty());
    return ExitCode::ok;
}

ExitCode cancel_command(const ServiceOptions& service, const std::string& id, std::stop_token stop)
{
    HttpClient client = client_for(service, std::move(stop));
    const HttpAnswer answer = client.send({.method = "POST", .path = path_of_job(id) + "/cancel"});
    if (answer.status != 200 && answer.status != 202) throw error_from(id, answer);
    return ExitCode::ok;
}

ExitCode rm_command(const ServiceOptions& service, const std::string& id, std::stop_token stop)
{
    HttpClient client = client_for(service, std::move(stop));
    const HttpAnswer answer = client.send({.method = "DELETE", .path = path_of_job(id)});
    if (answer.status != 204) throw error_from(id, answer);
    return ExitCode::ok;
}

ExitCode health_command(const ServiceOptions& service, std::stop_token stop)
{
    try {
        HttpClient client(parse_service_url(service.url), 0, std::move(stop)); // a probe asks once
        const HttpAnswer answer = client.send({.path = "/readyz"});
        if (answer.status == 200) {
            if (!service.quiet) std::printf("ready\n");
            return ExitCode::ok;
        }
        std::fprintf(stderr, "heliograph: not ready: %s\n", describe(answer).c_str());
    } catch (const UserError& error) {
        if (error.code() == ExitCode::usage || error.code() == ExitCode::interrupted) throw;
        std::fprintf(stderr, "heliograph: %s\n", error.what());
    }
    return ExitCode::failed;
}

} // namespace clients
