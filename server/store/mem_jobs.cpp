#include "server/store/mem_jobs.h"

#include "server/store/store_rules.h"

#include <algorithm>
#include <iterator>

namespace server {

namespace {

bool matches(const JobRecord& record, const ListQuery& query)
{
    if (record.tenant != query.tenant) return false;
    const bool named = std::find(query.also.begin(), query.also.end(), record.id) != query.also.end();
    if (query.state && record.state != *query.state && !named) return false;
    if (!query.label) return true;
    const auto label = record.spec.labels.find(query.label->first);
    return label != record.spec.labels.end() && label->second == query.label->second;
}

} // namespace

JobRecord without_long_texts(JobRecord job)
{
    job.spec.request_json.clear();
    job.spec.asset_digests.clear();
    if (job.result) job.result->report_json.clear();
    if (job.result) job.result->scene_json.clear();
    return job;
}

MemJobs::Job& MemJobs::add(JobRecord record)
{
    if (sequence_of_.count(record.id) != 0) throw StoreError("the job id " + record.id + " is taken", false);
    const std::uint64_t sequence = ++last_sequence_;
    sequence_of_.emplace(record.id, sequence);
    return by_sequence.emplace(sequence, Job{sequence, std::move(record)}).first->second;
}

MemJobs::Job* MemJobs::find(const JobId& id)
{
    const auto found = sequence_of_.find(id);
    return found == sequence_of_.end() ? nullptr : &by_sequence.at(found->second);
}

MemJobs::Job* MemJobs::find(const Tenant& tenant, const JobId& id)
{
    Job* job = find(id);
    return job != nullptr && job->record.tenant == tenant ? job : nullptr;
}

MemJobs::Job* MemJobs::find_leased(const Lease& lease)
{
    Job* job = find(lease.job);
    const bool owned =
        job != nullptr && job->record.state == StoredState::leased && job->record.epoch == lease.epoch;
    return owned ? job : nullptr;
}

const MemJobs::Job* MemJobs::find_reusable(const Tenant& tenant, const std::string& render_key) const
{
    if (render_key.empty()) return nullptr;
    for (auto at = by_sequence.rbegin(); at != by_sequence.rend(); ++at) {
        const JobRecord& record = at->second.record;
        if (record.tenant == tenant && record.state == StoredState::succeeded &&
            record.spec.render_key == render_key && record.result->reusable)
            return &at->second;
    }
    return nullptr;
}

void MemJobs::enter(Job& job, StoredState state)
{
    const WaitingKey key{-job.record.spec.priority, job.sequence};
    waiting_.erase(key);
    job.record.state = state;
    if (state != StoredState::queued) return;
    waiting_.insert(key);
    job.record.started_ms.reset();
    bell_.ring();
}

void MemJobs::finish(Job& job, StoredState state, std::int64_t now_ms)
{
    enter(job, state);
    job.record.finished_ms = now_ms;
}

MemJobs::Job* MemJobs::next_waiting()
{
    return waiting_.empty() ? nullptr : &by_sequence.at(waiting_.begin()->second);
}

std::uint32_t MemJobs::position(const Job& waiting) const
{
    const auto place = waiting_.find({-waiting.record.spec.priority, waiting.sequence});
    return static_cast<std::uint32_t>(std::distance(waiting_.begin(), place));
}

void MemJobs::forget(std::uint64_t sequence)
{
    sequence_of_.erase(by_sequence.at(sequence).record.id);
    by_sequence.erase(sequence);
    for (auto key = keys.begin(); key != keys.end();)
        key = key->second.sequence == sequence ? keys.erase(key) : std::next(key);
}

QueueDepth MemJobs::depth() const
{
    QueueDepth depth{.queued = waiting_.size(), .leased = 0};
    for (const auto& [sequence, job] : by_sequence)
        if (job.record.state == StoredState::leased) ++depth.leased;
    return depth;
}

ListPage MemJobs::list(const ListQuery& query) const
{
    ListPage page;
    std::optional<std::uint64_t> before = UINT64_MAX;
    if (!query.cursor.empty()) before = sequence_of_cursor(query.cursor);
    page.bad_cursor = !before;
    if (!before || query.limit == 0) return page;
    std::uint64_t last = 0;
    for (auto at = std::make_reverse_iterator(by_sequence.lower_bound(*before)); at != by_sequence.rend();
         ++at) {
        if (!matches(at->second.record, query)) continue;
        if (page.jobs.size() == query.limit) {
            page.next_cursor = cursor_after(last);
            break;
        }
        page.jobs.push_back(without_long_texts(at->second.record));
        page.jobs.back().failure.whole_json.clear();
        last = at->first;
    }
    return page;
}

std::vector<std::string> MemJobs::assets_in_use() const
{
    std::set<std::string> digests;
    for (const auto& [sequence, job] : by_sequence)
        if (!is_final(job.record.state))
            digests.insert(job.record.spec.asset_digests.begin(), job.record.spec.asset_digests.end());
    return {digests.begin(), digests.end()};
}

std::vector<std::string> MemJobs::pictures() const
{
    std::set<std::string> digests;
    for (const auto& [sequence, job] : by_sequence)
        if (job.record.result) digests.insert(job.record.result->image_digest);
    return {digests.begin(), digests.end()};
}

std::uint64_t MemJobs::bytes() const
{
    std::uint64_t bytes = 0;
    for (const auto& [sequence, job] : by_sequence) {
        const JobRecord& record = job.record;
        bytes += sizeof job + record.spec.request_json.size() + record.failure.whole_json.size();
        if (record.result) bytes += record.result->report_json.size() + record.result->scene_json.size();
    }
    return bytes;
}

bool MemJobs::expire_picture(const std::string& image_digest, std::uint64_t newest)
{
    std::vector<JobRecord*> showing;
    for (auto& [sequence, job] : by_sequence) {
        if (!job.record.result || job.record.result->image_digest != image_digest) continue;
        if (sequence > newest) return false;
        showing.push_back(&job.record);
    }
    for (JobRecord* record : showing) {
        record->state = StoredState::expired;
        record->result.reset();
    }
    return true;
}

std::size_t MemJobs::forget_ended(std::size_t most)
{
    std::vector<std::pair<std::int64_t, std::uint64_t>> ended;
    for (const auto& [sequence, job] : by_sequence)
        if (is_final(job.record.state) && !job.record.result)
            ended.emplace_back(*job.record.finished_ms, sequence);
    std::sort(ended.begin(), ended.end());
    ended.resize(std::min(ended.size(), most));
    for (const auto& [finished_ms, sequence] : ended)
        forget(sequence);
    return ended.size();
}

std::size_t MemJobs::expire(std::int64_t before_ms)
{
    std::size_t expired = 0;
    std::vector<std::uint64_t> old;
    for (auto& [sequence, job] : by_sequence) {
        JobRecord& record = job.record;
        if (!is_final(record.state) || *record.finished_ms >= before_ms) continue;
        if (*record.finished_ms < before_ms - kExpiredKept_ms) {
            old.push_back(sequence);
        } else if (record.state != StoredState::expired) {
            record.state = StoredState::expired;
            record.result.reset();
            ++expired;
        }
    }
    for (const std::uint64_t sequence : old)
        forget(sequence);
    return expired + old.size();
}

void MemJobs::forget_keys(std::int64_t before_ms)
{
    for (auto key = keys.begin(); key != keys.end();)
        key = key->second.created_ms < before_ms ? keys.erase(key) : std::next(key);
}

} // namespace server
