#include "server/http/job_handlers.h"

#include "server/http/list_query.h"
#include "server/http/negotiation.h"
#include "server/http/printable.h"
#include "server/http/submit_words.h"
#include "server/http/wanted_encoding.h"

#include <algorithm>
#include <chrono>
#include <span>

namespace server {

namespace {

using std::chrono::milliseconds;

bool is_job_id(const std::string& text)
{
    return text.size() == 32 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

api::ProblemDetails no_such_job(const std::string& id)
{
    return problem(
        404, "not_found", "there is no job \"" + printable(id) + "\": GET /v1/jobs lists those there are");
}

std::string path_of(const std::string& id)
{
    return "/v1/jobs/" + id;
}

api::ProblemDetails unknown_layer(const std::string& name)
{
    return problem(404,
                   "not_found",
                   "there is no layer \"" + printable(name) + "\": layers are " +
                       names_of(renderer::kEveryLayer));
}

// queue;dur=3, render;dur=120: in milliseconds, as browsers show them.
std::string server_timing(const api::JobView& job)
{
    std::string text;
    const auto add = [&](const char* name, std::optional<std::int64_t> from, std::optional<std::int64_t> to) {
        if (from && to)
            text += std::string(text.empty() ? "" : ", ") + name +
                    ";dur=" + std::to_string(std::max<std::int64_t>(*to - *from, 0));
    };
    add("queue", job.created_ms, job.started_ms);
    add("render", job.started_ms, job.finished_ms);
    return text;
}

} // namespace

void JobHandlers::add_routes(Router& router)
{
    const auto route = [&](const char* method,
                           const char* pattern,
                           void (JobHandlers::*handle)(Exchange&),
                           std::vector<std::string> query = {}) {
        router.add({method, pattern, std::move(query), [this, handle](Exchange& exchange) {
                        const auto id = exchange.path.find("id");
                        if (id != exchange.path.end() && !is_job_id(id->second))
                            return reply_problem(exchange, no_such_job(id->second));
                        (this->*handle)(exchange);
                    }});
    };
    route("POST", "/v1/jobs", &JobHandlers::submit, {"dry_run"});
    router.add({"GET", "/v1/jobs", list_query_keys(), [this](Exchange& exchange) { list(exchange); }});
    route("GET", "/v1/jobs/{id}", &JobHandlers::get);
    route("DELETE", "/v1/jobs/{id}", &JobHandlers::remove);
    route("POST", "/v1/jobs/{id}/cancel", &JobHandlers::cancel);
    route("GET", "/v1/jobs/{id}/image", &JobHandlers::image, {"bits"});
    route("GET", "/v1/jobs/{id}/layers/{name}", &JobHandlers::layer, {"bits"});
    route("GET", "/v1/jobs/{id}/report", &JobHandlers::report);
    route("GET", "/v1/jobs/{id}/scene", &JobHandlers::scene);
}

bool JobHandlers::enter_wait(Exchange& exchange, std::optional<Waiters::Place>& place, std::uint64_t& seconds)
{
    const auto preferred = preferred_wait_s(exchange.header("Prefer"));
    seconds = std::min(preferred.value_or(0), limits_.wait_s);
    if (!preferred) return true;
    if (seconds > 0) place = waiters_.enter();
    if (seconds > 0 && !place) {
        reply_problem(exchange, too_many_waiters(limits_));
        return false;
    }
    exchange.response.set_header("Preference-Applied", "wait=" + std::to_string(seconds));
    return true;
}

std::optional<api::JobView> JobHandlers::wait(Exchange& exchange,
                                              const std::string& id,
                                              std::uint64_t seconds,
                                              const std::string& known_etag)
{
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
    for (;;) {
        const auto left = std::chrono::ceil<milliseconds>(end - std::chrono::steady_clock::now());
        auto view = jobs_.wait(id, std::clamp(left, milliseconds(0), kGlance), known_etag);
        if (!view || api::is_final(view->state) || (!known_etag.empty() && etag_of(*view) != known_etag) ||
            left <= kGlance || !exchange.still_wanted())
            return view;
    }
}

// Imports may take their time, and this thread with it: it counts as waiting.
void JobHandlers::plan(Exchange& exchange, const SubmitWords& words)
{
    const auto place = waiters_.enter();
    if (!place) return reply_problem(exchange, too_many_waiters(limits_));
    auto planned = jobs_.plan(words, {});
    if (auto* refusal = std::get_if<api::ProblemDetails>(&planned))
        return reply_problem(exchange, std::move(*refusal));
    reply_json(exchange, 200, std::get<std::string>(planned));
}

void JobHandlers::submit(Exchange& exchange)
{
    const Acceptance accept = read_accept(exchange.header("Accept"));
    if (accept.only_images && !accept.best()) return reply_problem(exchange, not_acceptable({}));
    auto read = read_submit_words(exchange, store_, blobs_, limits_);
    if (auto* refusal = std::get_if<api::ProblemDetails>(&read))
        return reply_problem(exchange, std::move(*refusal));
    if (const auto dry_run = exchange.query("dry_run"); dry_run && *dry_run != "false") {
        if (*dry_run != "true")
            return reply_problem(
                exchange,
                query_problem("out_of_range", "dry_run=" + printable(*dry_run) + ": true or false"));
        return plan(exchange, std::get<SubmitWords>(read));
    }
    std::optional<Waiters::Place> place;
    std::uint64_t seconds = 0;
    if (!enter_wait(exchange, place, seconds)) return;
    auto submitted = jobs_.submit(std::get<SubmitWords>(read));
    if (auto* refusal = std::get_if<api::ProblemDetails>(&submitted))
        return reply_problem(exchange, std::move(*refusal), jobs_.estimated_wait_s());
    auto& answer = std::get<SubmitAnswer>(submitted);
    if (place) {
        const auto view = wait(exchange, answer.job.id, seconds, {});
        if (!view) return reply_problem(exchange, no_such_job(answer.job.id)); // deleted meanwhile
        answer.job = *view;
    }
    answer_submitted(exchange, answer, place.has_value());
}

void JobHandlers::answer_submitted(Exchange& exchange, const SubmitAnswer& answer, bool waited)
{
    const api::JobView& job = answer.job;
    exchange.response.set_header("Location", path_of(job.id));
    if (answer.replayed) exchange.response.set_header("Idempotency-Replayed", "true");
    const bool failed_by_client = job.state == api::JobState::failed && job.error && job.error->status < 500;
    const Acceptance accept = read_accept(exchange.header("Accept"));
    const bool picture = accept.only_images;
    if (failed_by_client && (waited || picture)) return reply_problem(exchange, *job.error);
    // Whoever takes nothing but pictures gets one or an error, never JSON in a file that is called .png.
    if (picture) return reply_image(exchange, job.id, {accept.best().value(), 8});
    exchange.response.set_header("ETag", '"' + etag_of(job) + '"');
    const bool done = waited && api::is_final(job.state);
    if (!done) exchange.response.set_header("Retry-After", "1");
    reply_json(exchange, done ? 200 : 202, api::write_job_view(job));
}

void JobHandlers::list(Exchange& exchange)
{
    auto query = read_list_query(exchange);
    if (auto* faults = std::get_if<std::vector<api::Problem>>(&query))
        return reply_problem(exchange, api::problem_from_faults(422, "invalid_query", std::move(*faults)));
    auto page = jobs_.list(std::get<ListWords>(query));
    if (auto* refusal = std::get_if<api::ProblemDetails>(&page))
        return reply_problem(exchange, std::move(*refusal));
    reply_json(exchange, 200, std::get<std::string>(page));
}

void JobHandlers::get(Exchange& exchange)
{
    const std::string& id = exchange.path.at("id");
    auto view = jobs_.get(id);
    if (!view) return reply_problem(exchange, no_such_job(id));
    std::optional<Waiters::Place> place;
    std::uint64_t seconds = 0;
    if (!enter_wait(exchange, place, seconds)) return;
    // A change since what the client knows; where it says nothing, since now.
    const std::string now = etag_of(*view);
    const bool known =
        !exchange.has_header("If-None-Match") || names_etag(exchange.header("If-None-Match"), now);
    if (place && known && !api::is_final(view->state)) view = wait(exchange, id, seconds, now);
    if (!view) return reply_problem(exchange, no_such_job(id));
    exchange.response.set_header("Cache-Control", "no-cache");
    reply_json_with_etag(exchange, api::write_job_view(*view), etag_of(*view));
}

void JobHandlers::cancel(Exchange& exchange)
{
    const std::string& id = exchange.path.at("id");
    const auto view = jobs_.cancel(id);
    if (!view) return reply_problem(exchange, no_such_job(id));
    reply_json(exchange, 200, api::write_job_view(*view));
}

void JobHandlers::remove(Exchange& exchange)
{
    const std::string& id = exchange.path.at("id");
    if (auto problem = jobs_.remove(id)) return reply_problem(exchange, std::move(*problem));
    exchange.response.status = 204;
}

void JobHandlers::image(Exchange& exchange)
{
    const std::string& id = exchange.path.at("id");
    auto wanted = wanted_encoding(exchange, {});
    if (auto* refusal = std::get_if<api::ProblemDetails>(&wanted))
        return reply_problem(exchange, std::move(*refusal));
    const auto encoding = std::get<renderer::PictureEncoding>(wanted);
    std::optional<Waiters::Place> place;
    const bool is_there = encoding == renderer::PictureEncoding{}; // the PNG of 8 bits
    if (wait_for_picture(exchange, id, place, !is_there)) reply_image(exchange, id, encoding);
}

bool JobHandlers::wait_for_picture(Exchange& exchange,
                                   const std::string& id,
                                   std::optional<Waiters::Place>& place,
                                   bool to_encode)
{
    std::uint64_t seconds = 0;
    if (!enter_wait(exchange, place, seconds)) return false;
    if (place) wait(exchange, id, seconds, {});
    if (place || !to_encode || (place = waiters_.enter())) return true;
    reply_problem(exchange, too_many_waiters(limits_));
    return false;
}

void JobHandlers::reply_image(Exchange& exchange,
                              const std::string& id,
                              const renderer::PictureEncoding& encoding)
{
    auto found = jobs_.image(id, encoding);
    if (auto* refusal = std::get_if<api::ProblemDetails>(&found))
        return reply_problem(exchange, std::move(*refusal));
    reply_encoded(exchange, id, id, std::get<EncodedPicture>(found), encoding.format);
}

void JobHandlers::layer(Exchange& exchange)
{
    const std::string &id = exchange.path.at("id"), &name = exchange.path.at("name");
    const renderer::LayerEntry* const entry = renderer::find_layer(name);
    if (entry == nullptr) return reply_problem(exchange, unknown_layer(name));
    auto wanted = wanted_encoding(exchange, entry->layer);
    if (auto* refusal = std::get_if<api::ProblemDetails>(&wanted))
        return reply_problem(exchange, std::move(*refusal));
    const auto encoding = std::get<renderer::PictureEncoding>(wanted);
    std::optional<Waiters::Place> place;
    if (!wait_for_picture(exchange, id, place, true)) return;
    auto found = jobs_.layer(id, entry->layer, encoding);
    if (auto* refusal = std::get_if<api::ProblemDetails>(&found))
        return reply_problem(exchange, std::move(*refusal));
    reply_encoded(exchange, id, id + "-" + name, std::get<EncodedPicture>(found), encoding.format);
}

void JobHandlers::reply_encoded(Exchange& exchange,
                                const std::string& id,
                                const std::string& name,
                                const EncodedPicture& picture,
                                renderer::PictureFormat format)
{
    const auto view = jobs_.get(id);
    const renderer::PictureFormatEntry& entry = entry_of(format);
    httplib::Response& response = exchange.response;
    response.set_header("Cache-Control", "private, immutable");
    response.set_header("Content-Disposition",
                        std::string("inline; filename=\"") + name + std::string(entry.extension) + '"');
    response.set_header("Vary", "Accept");
    response.set_header("Link", std::string("<") + path_of(id) + "/report>; rel=\"describedby\"");
    const std::string timing = view ? server_timing(*view) : std::string();
    if (!timing.empty()) response.set_header("Server-Timing", timing);
    const auto from = [bytes = picture.bytes](std::uint64_t offset) {
        return std::span<const std::byte>(*bytes).subspan(static_cast<std::size_t>(offset));
    };
    reply_payload(exchange,
                  {.source = from,
                   .size = picture.bytes->size(),
                   .digest = picture.digest,
                   .content_type = std::string(entry.media_type)});
}

void JobHandlers::report(Exchange& exchange)
{
    auto text = jobs_.report(exchange.path.at("id"));
    if (auto* refusal = std::get_if<api::ProblemDetails>(&text))
        return reply_problem(exchange, std::move(*refusal));
    reply_json(exchange, 200, std::get<std::string>(text));
}

void JobHandlers::scene(Exchange& exchange)
{
    auto text = jobs_.scene(exchange.path.at("id"));
    if (auto* refusal = std::get_if<api::ProblemDetails>(&text))
        return reply_problem(exchange, std::move(*refusal));
    reply_json(exchange, 200, std::get<std::string>(text));
}

} // namespace server
