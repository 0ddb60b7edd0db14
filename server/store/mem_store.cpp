#include "server/store/mem_store.h"

#include "server/store/lease_table.h"
#include "server/store/mem_jobs.h"
#include "server/store/store_rules.h"
#include "server/store/work_bell.h"

#include <algorithm>
#include <mutex>
#include <set>

namespace server {

namespace {

JobRecord without_long_texts(JobRecord job)
{
    job.spec.request_json.clear();
    if (job.result) job.result->report_json.clear();
    if (job.result) job.result->scene_json.clear();
    return job;
}

class MemStore final : public Store {
public:
    explicit MemStore(StoreClock clock) : clock_(std::move(clock)) {}

    Submitted submit(const SubmitRequest& request) override;
    std::optional<JobRecord> get(const Tenant& tenant, const JobId& id) override;
    ListPage list(const ListQuery& query) override;
    QueueDepth depth() override;
    std::optional<std::uint32_t> queue_position(const JobId& id) override;
    std::vector<Lease>
    claim(const std::string& worker, std::size_t max, std::chrono::milliseconds ttl) override;
    std::size_t renew(const std::vector<Lease>& leases, std::chrono::milliseconds ttl) override;
    bool complete(const Lease& lease, const JobResult& result, std::int64_t now_ms, bool reused) override;
    bool complete_queued(const JobId& id, const JobResult& result, std::int64_t now_ms) override;
    std::optional<JobResult> find_result(const Tenant& tenant, const std::string& render_key) override;
    void release(const std::vector<Lease>& leases) override;
    bool fail(const Lease& lease, const std::string& error_json, bool retry, std::int64_t now_ms) override;
    bool confirm_cancel(const Lease& lease, std::int64_t now_ms) override;
    std::optional<JobRecord> cancel(const Tenant& tenant, const JobId& id, std::int64_t now_ms) override;
    bool render_again(const Tenant& tenant, const JobId& id, const std::string& image_digest) override;
    bool remove(const Tenant& tenant, const JobId& id) override;
    std::size_t sweep(std::int64_t before_ms) override;
    std::vector<std::string> referenced_digests() override;
    void wait_work(std::chrono::milliseconds timeout, std::stop_token stop) override;

private:
    using Job = MemJobs::Job;
    void give_back(Job& job);
    bool matches(const Job& job, const ListQuery& query) const;

    StoreClock clock_;
    LeaseTable leases_;
    WorkBell bell_;
    std::mutex mutex_; // of jobs_
    MemJobs jobs_{bell_};
};

void MemStore::give_back(Job& job)
{
    const StoredState state = state_when_given_back(job.record.cancel_requested);
    if (is_final(state))
        jobs_.finish(job, state, clock_.wall_ms());
    else
        jobs_.enter(job, state);
}

Submitted MemStore::submit(const SubmitRequest& request)
{
    const std::lock_guard lock(mutex_);
    const std::pair key_name{request.tenant, request.idempotency_key};
    if (const auto key = jobs_.keys.find(key_name);
        key != jobs_.keys.end() && !request.idempotency_key.empty()) {
        if (key->second.body_digest != request.body_digest) return {SubmitStatus::key_reused, {}};
        return {SubmitStatus::replayed, jobs_.by_sequence.at(key->second.sequence).record};
    }
    const MemJobs::Job* twin =
        request.allow_reuse ? jobs_.find_reusable(request.tenant, request.spec.render_key) : nullptr;
    if (twin == nullptr && request.queue_limit != 0 && jobs_.waiting() >= request.queue_limit)
        return {SubmitStatus::queue_full, {}};

    JobRecord record;
    record.id = request.id.empty() ? make_job_id() : request.id;
    record.tenant = request.tenant;
    record.spec = request.spec;
    record.created_ms = request.now_ms;
    if (twin != nullptr) {
        record.reused = true;
        record.result = twin->record.result;
    }
    Job& kept = jobs_.add(std::move(record));
    if (!request.idempotency_key.empty())
        jobs_.keys[key_name] = {request.body_digest, kept.sequence, request.now_ms};
    if (kept.record.reused)
        jobs_.finish(kept, StoredState::succeeded, request.now_ms);
    else
        jobs_.enter(kept, StoredState::queued);
    return {SubmitStatus::accepted, kept.record};
}

std::optional<JobRecord> MemStore::get(const Tenant& tenant, const JobId& id)
{
    const std::lock_guard lock(mutex_);
    const Job* job = jobs_.find(tenant, id);
    if (job == nullptr) return std::nullopt;
    return job->record;
}

bool MemStore::matches(const Job& job, const ListQuery& query) const
{
    const JobRecord& record = job.record;
    if (record.tenant != query.tenant) return false;
    const bool named = std::find(query.also.begin(), query.also.end(), record.id) != query.also.end();
    if (query.state && record.state != *query.state && !named) return false;
    if (!query.label) return true;
    const auto label = record.spec.labels.find(query.label->first);
    return label != record.spec.labels.end() && label->second == query.label->second;
}

ListPage MemStore::list(const ListQuery& query)
{
    ListPage page;
    std::optional<std::uint64_t> before = UINT64_MAX;
    if (!query.cursor.empty()) before = sequence_of_cursor(query.cursor);
    page.bad_cursor = !before;
    if (!before || query.limit == 0) return page;
    const std::lock_guard lock(mutex_);
    std::uint64_t last = 0;
    for (auto at = std::make_reverse_iterator(jobs_.by_sequence.lower_bound(*before));
         at != jobs_.by_sequence.rend();
         ++at) {
        if (!matches(at->second, query)) continue;
        if (page.jobs.size() == query.limit) {
            page.next_cursor = cursor_after(last);
            break;
        }
        page.jobs.push_back(without_long_texts(at->second.record));
        last = at->first;
    }
    return page;
}

QueueDepth MemStore::depth()
{
    const std::lock_guard lock(mutex_);
    QueueDepth depth{.queued = jobs_.waiting(), .leased = 0};
    for (const auto& [sequence, job] : jobs_.by_sequence)
        if (job.record.state == StoredState::leased) ++depth.leased;
    return depth;
}

std::optional<std::uint32_t> MemStore::queue_position(const JobId& id)
{
    const std::lock_guard lock(mutex_);
    const Job* job = jobs_.find(id);
    if (job == nullptr || job->record.state != StoredState::queued) return std::nullopt;
    return jobs_.position(*job);
}

std::vector<Lease> MemStore::claim(const std::string&, std::size_t max, std::chrono::milliseconds ttl)
{
    const std::lock_guard lock(mutex_);
    const std::vector<Lease> lapsed = leases_.lapsed(clock_.steady());
    for (const Lease& lease : lapsed)
        if (Job* job = jobs_.find_leased(lease)) give_back(*job);
    leases_.forget(lapsed);

    std::vector<Lease> leases;
    while (leases.size() < max && jobs_.waiting() != 0) {
        Job& job = *jobs_.next_waiting();
        jobs_.enter(job, StoredState::leased);
        ++job.record.epoch;
        ++job.record.attempts;
        job.record.started_ms = clock_.wall_ms();
        leases.push_back({.job = job.record.id, .epoch = job.record.epoch});
    }
    leases_.grant(leases, clock_.steady() + ttl);
    return leases;
}

std::size_t MemStore::renew(const std::vector<Lease>& leases, std::chrono::milliseconds ttl)
{
    return leases_.renew(leases, clock_.steady() + ttl);
}

bool MemStore::complete(const Lease& lease, const JobResult& result, std::int64_t now_ms, bool reused)
{
    const std::lock_guard lock(mutex_);
    Job* job = jobs_.find_leased(lease);
    if (job == nullptr) return false;
    leases_.forget({lease});
    if (job->record.cancel_requested) {
        jobs_.finish(*job, StoredState::canceled, now_ms);
        return false;
    }
    job->record.result = result;
    job->record.reused = reused;
    jobs_.finish(*job, StoredState::succeeded, now_ms);
    return true;
}

bool MemStore::complete_queued(const JobId& id, const JobResult& result, std::int64_t now_ms)
{
    const std::lock_guard lock(mutex_);
    Job* job = jobs_.find(id);
    if (job == nullptr || job->record.state != StoredState::queued) return false;
    job->record.result = result;
    job->record.reused = true;
    jobs_.finish(*job, StoredState::succeeded, now_ms);
    return true;
}

std::optional<JobResult> MemStore::find_result(const Tenant& tenant, const std::string& render_key)
{
    const std::lock_guard lock(mutex_);
    const Job* job = jobs_.find_reusable(tenant, render_key);
    if (job == nullptr) return std::nullopt;
    return job->record.result;
}

void MemStore::release(const std::vector<Lease>& leases)
{
    const std::lock_guard lock(mutex_);
    for (const Lease& lease : leases) {
        Job* job = jobs_.find_leased(lease);
        if (job == nullptr) continue;
        --job->record.attempts;
        give_back(*job);
    }
    leases_.forget(leases);
}

bool MemStore::fail(const Lease& lease, const std::string& error_json, bool retry, std::int64_t now_ms)
{
    const std::lock_guard lock(mutex_);
    Job* job = jobs_.find_leased(lease);
    if (job == nullptr) return false;
    leases_.forget({lease});
    const StoredState state = state_when_failed(retry, job->record.cancel_requested, job->record.attempts);
    if (state == StoredState::failed) job->record.error_json = error_json;
    if (is_final(state))
        jobs_.finish(*job, state, now_ms);
    else
        jobs_.enter(*job, state);
    return true;
}

bool MemStore::confirm_cancel(const Lease& lease, std::int64_t now_ms)
{
    const std::lock_guard lock(mutex_);
    Job* job = jobs_.find_leased(lease);
    if (job == nullptr) return false;
    leases_.forget({lease});
    jobs_.finish(*job, StoredState::canceled, now_ms);
    return true;
}

std::optional<JobRecord> MemStore::cancel(const Tenant& tenant, const JobId& id, std::int64_t now_ms)
{
    const std::lock_guard lock(mutex_);
    Job* job = jobs_.find(tenant, id);
    if (job == nullptr) return std::nullopt;
    if (job->record.state == StoredState::leased) job->record.cancel_requested = true;
    if (job->record.state == StoredState::queued) {
        job->record.cancel_requested = true;
        jobs_.finish(*job, StoredState::canceled, now_ms);
    }
    return job->record;
}

bool MemStore::render_again(const Tenant& tenant, const JobId& id, const std::string& image_digest)
{
    const std::lock_guard lock(mutex_);
    Job* job = jobs_.find(tenant, id);
    if (job == nullptr || job->record.state != StoredState::succeeded ||
        job->record.result->image_digest != image_digest)
        return false;
    job->record.result.reset();
    job->record.finished_ms.reset();
    job->record.attempts = 0;
    job->record.reused = false;
    jobs_.enter(*job, StoredState::queued);
    return true;
}

bool MemStore::remove(const Tenant& tenant, const JobId& id)
{
    const std::lock_guard lock(mutex_);
    const Job* job = jobs_.find(tenant, id);
    if (job == nullptr || !is_final(job->record.state)) return false;
    jobs_.forget(job->sequence);
    return true;
}

std::size_t MemStore::sweep(std::int64_t before_ms)
{
    const std::lock_guard lock(mutex_);
    std::size_t swept = 0;
    std::vector<std::uint64_t> old;
    for (auto& [sequence, job] : jobs_.by_sequence) {
        JobRecord& record = job.record;
        if (!is_final(record.state) || *record.finished_ms >= before_ms) continue;
        if (*record.finished_ms < before_ms - kExpiredKept_ms) {
            old.push_back(sequence);
        } else if (record.state != StoredState::expired) {
            record.state = StoredState::expired;
            record.result.reset();
            ++swept;
        }
    }
    for (const std::uint64_t sequence : old)
        jobs_.forget(sequence);
    const std::int64_t oldest_key = clock_.wall_ms() - kIdempotencyKept_ms;
    for (auto key = jobs_.keys.begin(); key != jobs_.keys.end();)
        key = key->second.created_ms < oldest_key ? jobs_.keys.erase(key) : std::next(key);
    return swept + old.size();
}

std::vector<std::string> MemStore::referenced_digests()
{
    const std::lock_guard lock(mutex_);
    std::set<std::string> digests;
    for (const auto& [sequence, job] : jobs_.by_sequence) {
        const JobRecord& record = job.record;
        if (!is_final(record.state))
            digests.insert(record.spec.asset_digests.begin(), record.spec.asset_digests.end());
        if (record.result) digests.insert(record.result->image_digest);
    }
    return {digests.begin(), digests.end()};
}

void MemStore::wait_work(std::chrono::milliseconds timeout, std::stop_token stop)
{
    const std::uint64_t mark = bell_.mark();
    {
        const std::lock_guard lock(mutex_);
        if (jobs_.waiting() != 0) return;
    }
    bell_.wait(mark, leases_.until_lapse(clock_.steady(), timeout), std::move(stop));
}

} // namespace

std::unique_ptr<Store> make_mem_store(StoreClock clock)
{
    return std::make_unique<MemStore>(std::move(clock));
}

} // namespace server
