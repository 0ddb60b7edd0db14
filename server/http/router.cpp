#include "server/http/router.h"

#include "api/words/digest.h"
#include "api/words/sentences.h"
#include "server/http/printable.h"
#include "server/store/damaged_blob.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>

namespace server {

namespace {

using Captures = std::map<std::string, std::string>;

// {name} stands for one segment; the rest is literal.
std::optional<Captures> match(std::string_view pattern, std::string_view path)
{
    Captures captures;
    for (;;) {
        const std::size_t pattern_end = std::min(pattern.find('/', 1), pattern.size());
        const std::size_t path_end = std::min(path.find('/', 1), path.size());
        const std::string_view wanted = pattern.substr(0, pattern_end), got = path.substr(0, path_end);
        if (wanted.size() > 2 && wanted[1] == '{') {
            if (got.size() < 2) return std::nullopt;
            captures.emplace(wanted.substr(2, wanted.size() - 3), got.substr(1));
        } else if (wanted != got) {
            return std::nullopt;
        }
        pattern.remove_prefix(pattern_end);
        path.remove_prefix(path_end);
        if (pattern.empty() || path.empty()) break;
    }
    if (!pattern.empty() || !path.empty()) return std::nullopt;
    return captures;
}

std::vector<api::Problem> query_faults(const httplib::Request& request, const std::vector<std::string>& known)
{
    std::vector<api::Problem> faults;
    std::set<std::string> seen;
    for (const auto& [key, value] : request.params) {
        if (key.empty() && value.empty()) continue; // "?" alone, "&&"
        if (!seen.insert(key).second) {
            faults.push_back(
                {"", "duplicate_parameter", "query key \"" + printable(key) + "\" stands more than once"});
        } else if (std::find(known.begin(), known.end(), key) == known.end()) {
            std::string all;
            for (const std::string& name : known)
                all += (all.empty() ? "" : ", ") + name;
            faults.push_back({"",
                              "unknown_parameter",
                              "query key \"" + printable(key) + "\" is not known here" +
                                  api::did_you_mean(key, known) +
                                  (all.empty() ? " (there are none)" : " (known: " + all + ")")});
        }
    }
    return faults;
}

std::string allowed(const std::set<std::string>& methods)
{
    std::set<std::string> all = methods;
    if (all.contains("GET")) all.insert("HEAD");
    all.insert("OPTIONS");
    std::string text;
    for (const std::string& method : all)
        text += (text.empty() ? "" : ", ") + method;
    return text;
}

} // namespace

void Router::add(Route route)
{
    routes_.push_back(std::move(route));
}

void Router::route(Exchange& exchange) const
{
    const std::string method = exchange.request.method == "HEAD" ? "GET" : exchange.request.method;
    std::set<std::string> methods;
    for (const Route& route : routes_) {
        auto captures = match(route.pattern, exchange.request.path);
        if (!captures) continue;
        methods.insert(route.method);
        if (route.method != method) continue;
        if (auto faults = query_faults(exchange.request, route.query); !faults.empty())
            return reply_problem(exchange, api::problem_from_faults(422, "invalid_query", std::move(faults)));
        exchange.path = std::move(*captures);
        return route.handler(exchange);
    }
    if (methods.empty())
        return reply_problem(
            exchange, problem(404, "not_found", "there is nothing at this path: GET / tells what there is"));
    exchange.response.set_header("Allow", allowed(methods));
    if (method == "OPTIONS") {
        exchange.response.status = 204;
        return;
    }
    reply_problem(exchange, problem(405, "method_not_allowed", "this path knows " + allowed(methods)));
}

void Router::dispatch(Exchange& exchange) const
{
    const std::string id = exchange.request_id();
    const auto failed = [&](const char* what, api::ProblemDetails details) {
        log_.write(LogLevel::error,
                   "handler_failure",
                   {{"what", what},
                    {"method", exchange.request.method},
                    {"path", exchange.request.path},
                    {"request_id", id}});
        const std::string version = exchange.response.version;
        exchange.response = {}; // nothing of a half-made answer
        exchange.response.version = version;
        reply_problem(exchange, std::move(details), 30);
    };
    static constexpr const char* kPublic = "the service failed; tell its keeper the request id";
    try {
        route(exchange);
    } catch (const DamagedBlob& damage) {
        failed(damage.what(),
               damage.asset ? problem(500, "asset_damaged", api::damaged_asset_words(damage.digest))
                            : problem(500, "internal", kPublic));
    } catch (const StoreError& error) {
        failed(error.what(),
               error.storage_full
                   ? problem(503,
                             "storage_full",
                             "the disk of the service is full; what is stored can still be read")
                   : problem(500, "internal", kPublic));
    } catch (const std::exception& error) {
        failed(error.what(), problem(500, "internal", kPublic));
    }
}

} // namespace server
