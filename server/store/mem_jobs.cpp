#include "server/store/mem_jobs.h"

#include <iterator>

namespace server {

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

} // namespace server
