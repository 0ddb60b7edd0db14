#include "clients/cli/service_errors.h"

#include "api/problem.h"

namespace clients {
namespace {

std::string printable(std::string text)
{
    for (char& c : text) {
        const auto byte =
            static_cast<unsigned char>(c); // `char` has a sign on some processors and none on others
        if ((byte < ' ' && c != '\n') || byte == 127) c = '?';
    }
    return text;
}

} // namespace

ExitCode exit_code_of_status(int status)
{
    switch (status) {
    case 400:
    case 413:
    case 415:
    case 422:
        return ExitCode::faults;
    case 404:
    case 410:
        return ExitCode::not_found;
    case 429:
    case 503:
        return ExitCode::unreachable;
    case 504:
        return ExitCode::timed_out;
    case 406:
        return ExitCode::usage;
    default:
        return ExitCode::failed;
    }
}

std::string describe(const HttpAnswer& answer)
{
    api::ProblemDetails problem;
    if (!api::read_problem(answer.body, problem))
        return printable("HTTP " + std::to_string(answer.status) + ' ' + answer.body.substr(0, 200));
    std::string text = problem.detail + " (" + problem.code + ')';
    for (const api::Problem& fault : problem.errors)
        text += "\n  " + (fault.pointer.empty() ? "(the whole)" : fault.pointer) + ": " + fault.detail +
                " (" + fault.code + ')';
    if (answer.status >= 500 && !problem.request_id.empty()) text += "\n  request " + problem.request_id;
    return printable(std::move(text));
}

UserError error_from(const std::string& what, const HttpAnswer& answer)
{
    return {exit_code_of_status(answer.status), what + ": " + describe(answer)};
}

} // namespace clients
