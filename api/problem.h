// Problem details (RFC 9457): how every error is told, with all faults of a request at once.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace api {

// One fault of the request.
struct Problem {
    std::string pointer; // JSON Pointer into the request body; empty: the whole
    std::string code;    // "out_of_range", "unknown_member", "missing_asset", "unsupported", ...
    std::string detail;  // what is wrong and how to mend it
    friend bool operator==(const Problem&, const Problem&) = default;
};

// One answer. `type` is /problems/<code>, `title` comes from the table of codes in problem.cpp.
struct ProblemDetails {
    int status = 500;
    std::string code; // "invalid_scene", "queue_full", "still_running", ...
    std::string detail;
    bool retryable = false;
    std::string request_id;
    std::vector<Problem> errors;
    friend bool operator==(const ProblemDetails&, const ProblemDetails&) = default;
};

// application/problem+json text.
std::string write_problem(const ProblemDetails& problem);
// Reads back what write_problem wrote (the store keeps job errors as text; the CLI shows them).
// Nothing if it is not one.
bool read_problem(const std::string& text, ProblemDetails& out);

// Whether the table of codes has it.
bool has_title(std::string_view code);

// From faults to the answer: status, code and a summary ("2 faults; first: ...").
ProblemDetails problem_from_faults(int status, std::string code, std::vector<Problem> errors);

} // namespace api
