#include "clients/cli/remote_job.h"

#include "api/client_words.h"
#include "clients/cli/digest.h"
#include "clients/cli/files.h"
#include "clients/cli/job_source.h"
#include "clients/cli/progress_bar.h"
#include "clients/cli/service_errors.h"
#include "clients/cli/upload.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>

namespace clients {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kWaitS = 20;        // of one Prefer: wait
constexpr double kLeastPollS = 0.25; // between two looks, however quick the answers are

std::string fresh_key()
{
    std::random_device random;
    std::string key;
    for (int i = 0; i < 4; ++i) {
        std::array<char, 9> word{};
        std::snprintf(word.data(), word.size(), "%08x", static_cast<unsigned>(random()));
        key += word.data();
    }
    return key;
}

std::map<std::string, std::string> parse_labels(const std::vector<std::string>& words)
{
    std::map<std::string, std::string> labels;
    for (const std::string& word : words) {
        const std::size_t equals = word.find('=');
        if (equals == 0 || equals == std::string::npos)
            throw UserError(ExitCode::usage, "--label " + word + ": write NAME=VALUE");
        labels[word.substr(0, equals)] = word.substr(equals + 1);
    }
    return labels;
}

api::JobView job_from(const HttpAnswer& answer, const std::string& what)
{
    if (answer.status != 200 && answer.status != 202) throw error_from(what, answer);
    auto job = api::read_job_view(answer.body);
    if (!job)
        throw UserError(ExitCode::unreachable,
                        what + ": the answer is no job object; is this a Heliograph service?");
    return *std::move(job);
}

std::string progress_note(const api::JobView& job)
{
    std::string note = api::name_of(job.state);
    if (job.queue_position) note += ", " + std::to_string(*job.queue_position) + " before it";
    if (job.samples_done > 0) note += ", " + std::to_string(job.samples_done) + " samples";
    return note;
}

double seconds_since(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// A look at the job; the service may hold it for whole seconds up to `wait_s`, or until `etag` is out of
// date.
HttpRequest look_at(const std::string& id, double wait_s, const std::string& etag)
{
    HttpRequest request{.path = path_of_job(id), .wait_s = std::clamp(std::floor(wait_s), 0.0, kWaitS)};
    if (request.wait_s >= 1)
        request.headers.emplace_back("Prefer", "wait=" + std::to_string(static_cast<int>(request.wait_s)));
    if (!etag.empty()) request.headers.emplace_back("If-None-Match", etag);
    return request;
}

} // namespace

std::string path_of_job(const std::string& id)
{
    // The service tells which ids exist; this only keeps a slash or a query from asking for something else.
    if (id.empty() || percent_encoded(id) != id || id == "." || id == "..")
        throw UserError(ExitCode::usage, "\"" + id + "\" can be no job's id");
    return "/v1/jobs/" + id;
}

api::JobView submit_job(HttpClient& client, const SubmitOptions& options, bool quiet)
{
    const auto labels = parse_labels(options.labels);
    const JobSource source = read_job_source(options.scene);
    const api::JobRequest request = read_request(source);
    auto found = find_job_files(request, source.folder);
    if (const auto* faults = std::get_if<std::vector<api::Problem>>(&found))
        refuse_faults(source.name, *faults);

    api::JobAdditions additions{
        .files = {}, .priority = options.priority, .labels = labels, .layers = options.layers};
    for (const JobFile& file : std::get<std::vector<JobFile>>(found)) {
        additions.files[file.name] = file.digest;
        if (upload(client, file) && !quiet) std::fprintf(stderr, "note: uploaded %s\n", file.path.c_str());
    }
    HttpRequest post{.method = "POST", .path = "/v1/jobs", .headers = {{"Content-Type", "application/json"}}};
    post.headers.emplace_back("Idempotency-Key",
                              options.idempotency_key.empty() ? fresh_key() : options.idempotency_key);
    if (options.force) post.headers.emplace_back("Cache-Control", "no-cache");
    post.body = api::add_to_job(source.json, additions);
    return job_from(client.send(post), source.name);
}

api::JobView get_job(HttpClient& client, const std::string& id, std::string* text)
{
    const HttpAnswer answer = client.send({.path = path_of_job(id)});
    api::JobView job = job_from(answer, id);
    if (text) *text = answer.body;
    return job;
}

api::JobView
wait_for_job(HttpClient& client, const std::string& id, std::optional<double> timeout_s, bool quiet)
{
    const Clock::time_point start = Clock::now();
    ProgressBar bar(!quiet);
    std::optional<api::JobView> job;
    for (std::string etag;;) {
        const Clock::time_point asked = Clock::now();
        const bool first_look = !job; // may be all that it takes; only the next one waits
        const double left_s = timeout_s ? *timeout_s - seconds_since(start) : kWaitS;
        // Where nobody watches, only the end is of interest; else every change is.
        const HttpRequest look = look_at(id, first_look ? 0 : left_s, bar.visible() ? etag : std::string());
        const HttpAnswer answer = client.send(look);
        if (answer.status != 304) {
            job = job_from(answer, id);
            etag = answer.header("etag");
            bar.show(job->progress, progress_note(*job));
        }
        if (job && api::is_final(job->state)) return *std::move(job);
        if (timeout_s && seconds_since(start) >= *timeout_s)
            throw UserError(ExitCode::timed_out, id + " is not finished after the --timeout; it goes on");
        if (first_look) continue;
        const double pause_s = std::max(0.0, kLeastPollS - seconds_since(asked));
        client.pause(timeout_s ? std::clamp(*timeout_s - seconds_since(start), 0.0, pause_s) : pause_s);
    }
}

ExitCode tell_end(const api::JobView& job)
{
    if (job.state == api::JobState::succeeded) return ExitCode::ok;
    if (job.error) {
        HttpAnswer words{.status = job.error->status, .headers = {}, .body = api::write_problem(*job.error)};
        std::fprintf(stderr,
                     "heliograph: %s %s: %s\n",
                     job.id.c_str(),
                     api::name_of(job.state),
                     describe(words).c_str());
    } else {
        std::fprintf(stderr, "heliograph: %s %s\n", job.id.c_str(), api::name_of(job.state));
    }
    return job.state == api::JobState::expired ? ExitCode::not_found : ExitCode::failed;
}

namespace {

std::string fetch(HttpClient& client,
                  const std::string& id,
                  const std::string& what,
                  const renderer::PictureEncoding& encoding)
{
    const std::string query = encoding.bits == 16 ? "?bits=16" : "";
    HttpAnswer answer =
        client.send({.path = path_of_job(id) + what + query,
                     .headers = {{"Accept", std::string(entry_of(encoding.format).media_type)}}});
    if (answer.status == 504)
        throw UserError(ExitCode::timed_out,
                        id + " has no picture yet: heliograph wait " + id + ", then fetch again");
    if (answer.status != 200) throw error_from(id, answer);
    const std::string told = answer.header("repr-digest"), found = repr_digest_of(answer.body);
    if (!told.empty() && told != found)
        throw UserError(ExitCode::unreachable,
                        id + ": the picture was damaged on its way: " + found + " instead of " + told);
    return std::move(answer.body);
}

} // namespace

std::string
fetch_picture(HttpClient& client, const std::string& id, const renderer::PictureEncoding& encoding)
{
    return fetch(client, id, "/image", encoding);
}

std::string fetch_layer(HttpClient& client, const std::string& id, const LayerFile& file)
{
    return fetch(client, id, "/layers/" + std::string(entry_of(file.layer).name), file.encoding);
}

} // namespace clients
