#include "server/store/store_rules.h"

#include <array>
#include <charconv>
#include <utility>

namespace server {

namespace {

constexpr char kCursorMark = 'c';

} // namespace

std::string cursor_after(std::uint64_t sequence)
{
    std::array<char, 24> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), sequence, 16).ptr;
    return kCursorMark + std::string(digits.data(), end);
}

std::optional<std::uint64_t> sequence_of_cursor(std::string_view cursor)
{
    if (cursor.empty() || cursor.front() != kCursorMark) return std::nullopt;
    std::uint64_t sequence = 0;
    const char* end = cursor.data() + cursor.size();
    const auto [stop, error] = std::from_chars(cursor.data() + 1, end, sequence, 16);
    // Sequence numbers are positive and SQLite's integers are signed.
    if (error != std::errc{} || stop != end || sequence == 0 || sequence > INT64_MAX) return std::nullopt;
    return sequence;
}

JobRecord job_of(const SubmitRequest& request, std::optional<JobResult> of_twin)
{
    JobRecord job;
    job.id = request.id.empty() ? make_job_id() : request.id;
    job.tenant = request.tenant;
    job.spec = request.spec;
    job.created_ms = request.now_ms;
    if (of_twin) {
        job.state = StoredState::succeeded;
        job.finished_ms = request.now_ms;
        job.reused = true;
        job.result = std::move(of_twin);
    }
    return job;
}

StoredState state_when_given_back(bool cancel_requested)
{
    return cancel_requested ? StoredState::canceled : StoredState::queued;
}

StoredState state_when_failed(bool retry, bool cancel_requested, std::uint32_t attempts)
{
    if (!retry) return StoredState::failed;
    if (cancel_requested) return StoredState::canceled;
    return attempts < kMaxAttempts ? StoredState::queued : StoredState::failed;
}

bool is_final(StoredState state)
{
    switch (state) {
    case StoredState::queued:
    case StoredState::leased:
        return false;
    case StoredState::succeeded:
    case StoredState::failed:
    case StoredState::canceled:
    case StoredState::expired:
        return true;
    }
    return true;
}

} // namespace server
