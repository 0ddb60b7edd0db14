#include "server/http/list_query.h"

#include "api/words/sentences.h"
#include "server/http/printable.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace server {

namespace {

constexpr std::uint32_t kMaxPage = 200;

std::optional<api::Problem> read_state(const std::string& text, ListWords& words)
{
    words.state = api::job_state_from_name(text);
    if (words.state) return std::nullopt;
    const std::vector<std::string> known = api::job_state_names();
    return api::Problem{"",
                        "invalid_parameter",
                        "state \"" + printable(text) + "\" is not known" + api::did_you_mean(text, known) +
                            " (known: " + api::listed(known) + ")"};
}

} // namespace

std::vector<std::string> list_query_keys()
{
    return {"state", "label", "limit", "cursor"};
}

std::variant<ListWords, std::vector<api::Problem>> read_list_query(const Exchange& exchange)
{
    ListWords query;
    std::vector<api::Problem> faults;
    if (const auto state = exchange.query("state"))
        if (auto fault = read_state(*state, query)) faults.push_back(*std::move(fault));
    if (const auto label = exchange.query("label")) {
        const std::size_t colon = label->find(':');
        if (colon == std::string::npos || colon == 0)
            faults.push_back({"", "invalid_parameter", "label is name:value"});
        else
            query.label = {label->substr(0, colon), label->substr(colon + 1)};
    }
    if (const auto limit = exchange.query("limit")) {
        const auto [stop, error] = std::from_chars(limit->data(), limit->data() + limit->size(), query.limit);
        if (error != std::errc() || stop != limit->data() + limit->size() || query.limit < 1 ||
            query.limit > kMaxPage)
            faults.push_back({"", "out_of_range", "limit is a number from 1 to " + std::to_string(kMaxPage)});
    }
    if (const auto cursor = exchange.query("cursor")) {
        query.cursor = *cursor;
        const bool good =
            !cursor->empty() && cursor->size() <= 256 &&
            std::all_of(cursor->begin(), cursor->end(), [](char c) { return c > ' ' && c <= '~'; });
        if (!good)
            faults.push_back({"", "invalid_parameter", "cursor is what next_cursor of the page before said"});
    }
    if (!faults.empty()) return faults;
    return query;
}

} // namespace server
