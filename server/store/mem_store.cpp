#include "server/store/mem_store.h"

#include "server/store/lease_table.h"
#include "server/store/mem_jobs.h"
#include "server/store/store_rules.h"
#include "server/store/work_bell.h"

#include <algorithm>
#include <mutex>
#include <utility>

namespace server {

namespace {

class MemStore final : public Store {
public:
    explicit MemStore(StoreClock clock) : clock_(std::move(clock)) {}

    Submitted submit(const SubmitRequest& request) override
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

        JobRecord record =
            job_of(request, twin == nullptr ? std::nullopt : std::optional(*twin->record.result));
        Job& kept = jobs_.add(std::move(record));
        if (!request.idempotency_key.empty())
            jobs_.keys[key_name] = {request.body_digest, kept.sequence, request.now_ms};
        jobs_.enter(kept, kept.record.state);
        return {SubmitStatus::accepted, kept.record};
    }

    std::optional<JobRecord> get(const Tenant& tenant, const JobId& id) override
    {
        const std::lock_guard lock(mutex_);
        const Job* job = jobs_.find(tenant, id);
        if (job == nullptr) return std::nullopt;
        return job->record;
    }

    std::optional<JobRecord> find(const Tenant& tenant, const JobId& id) override
    {
        std::optional<JobRecord> job = get(tenant, id);
        if (!job) return std::nullopt;
        return without_long_texts(*std::move(job));
    }

    ListPage list(const ListQuery& query) override
    {
        const std::lock_guard lock(mutex_);
        return jobs_.list(query);
    }

    QueueDepth depth() override
    {
        const std::lock_guard lock(mutex_);
        return jobs_.depth();
    }

    bool storage_full() override { return false; }

    std::optional<std::uint32_t> queue_position(const JobId& id) override
    {
        const std::lock_guard lock(mutex_);
        const Job* job = jobs_.find(id);
        if (job == nullptr || job->record.state != StoredState::queued) return std::nullopt;
        return jobs_.position(*job);
    }

    std::vector<Lease> claim(const std::string&, std::size_t max, std::chrono::milliseconds ttl) override
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

    std::size_t renew(const std::vector<Lease>& leases, std::chrono::milliseconds ttl) override
    {
        return leases_.renew(leases, clock_.steady() + ttl);
    }

    bool complete(const Lease& lease, const JobResult& result, std::int64_t now_ms, bool reused) override
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

    bool complete_queued(const JobId& id, const JobResult& result, std::int64_t now_ms) override
    {
        const std::lock_guard lock(mutex_);
        Job* job = jobs_.find(id);
        if (job == nullptr || job->record.state != StoredState::queued) return false;
        job->record.result = result;
        job->record.reused = true;
        jobs_.finish(*job, StoredState::succeeded, now_ms);
        return true;
    }

    std::optional<JobResult> find_result(const Tenant& tenant, const std::string& render_key) override
    {
        const std::lock_guard lock(mutex_);
        const Job* job = jobs_.find_reusable(tenant, render_key);
        if (job == nullptr) return std::nullopt;
        return job->record.result;
    }

    std::optional<std::string> find_picture(const Tenant& tenant, const std::string& render_key) override
    {
        const std::optional<JobResult> result = find_result(tenant, render_key);
        if (!result) return std::nullopt;
        return result->image_digest;
    }

    void release(const std::vector<Lease>& leases) override
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

    bool fail(const Lease& lease, const JobFailure& why, bool retry, std::int64_t now_ms) override
    {
        const std::lock_guard lock(mutex_);
        Job* job = jobs_.find_leased(lease);
        if (job == nullptr) return false;
        leases_.forget({lease});
        const StoredState state =
            state_when_failed(retry, job->record.cancel_requested, job->record.attempts);
        if (state == StoredState::failed) job->record.failure = why;
        if (is_final(state))
            jobs_.finish(*job, state, now_ms);
        else
            jobs_.enter(*job, state);
        return true;
    }

    bool confirm_cancel(const Lease& lease, std::int64_t now_ms) override
    {
        const std::lock_guard lock(mutex_);
        Job* job = jobs_.find_leased(lease);
        if (job == nullptr) return false;
        leases_.forget({lease});
        jobs_.finish(*job, StoredState::canceled, now_ms);
        return true;
    }

    std::optional<JobRecord> cancel(const Tenant& tenant, const JobId& id, std::int64_t now_ms) override
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

    bool render_again(const Tenant& tenant, const JobId& id, const std::string& image_digest) override
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

    bool remove(const Tenant& tenant, const JobId& id) override
    {
        const std::lock_guard lock(mutex_);
        const Job* job = jobs_.find(tenant, id);
        if (job == nullptr || !is_final(job->record.state)) return false;
        jobs_.forget(job->sequence);
        return true;
    }

    std::size_t sweep(std::int64_t before_ms) override
    {
        const std::lock_guard lock(mutex_);
        jobs_.forget_keys(clock_.wall_ms() - kIdempotencyKept_ms);
        return jobs_.expire(before_ms);
    }

    std::uint64_t newest() override
    {
        const std::lock_guard lock(mutex_);
        return jobs_.newest();
    }

    std::vector<std::string> expire_results(const std::vector<std::string>& image_digests,
                                            std::uint64_t newest) override
    {
        const std::lock_guard lock(mutex_);
        std::vector<std::string> expired;
        for (const std::string& digest : image_digests)
            if (jobs_.expire_picture(digest, newest)) expired.push_back(digest);
        return expired;
    }

    std::size_t forget_ended(std::size_t most) override
    {
        const std::lock_guard lock(mutex_);
        return jobs_.forget_ended(most);
    }

    std::uint64_t stored_bytes() override
    {
        const std::lock_guard lock(mutex_);
        return jobs_.bytes();
    }

    std::vector<std::string> assets_in_use() override
    {
        const std::lock_guard lock(mutex_);
        return jobs_.assets_in_use();
    }

    std::vector<std::string> pictures() override
    {
        const std::lock_guard lock(mutex_);
        return jobs_.pictures();
    }

    bool shows(const std::string& image_digest) override
    {
        const std::vector<std::string> shown = pictures();
        return std::find(shown.begin(), shown.end(), image_digest) != shown.end();
    }

    void wait_work(std::chrono::milliseconds timeout, std::stop_token stop) override
    {
        const std::uint64_t mark = bell_.mark();
        {
            const std::lock_guard lock(mutex_);
            if (jobs_.waiting() != 0) return;
        }
        bell_.wait(mark, leases_.until_lapse(clock_.steady(), timeout), std::move(stop));
    }

private:
    using Job = MemJobs::Job;

    void give_back(Job& job)
    {
        const StoredState state = state_when_given_back(job.record.cancel_requested);
        if (is_final(state))
            jobs_.finish(job, state, clock_.wall_ms());
        else
            jobs_.enter(job, state);
    }

    StoreClock clock_;
    LeaseTable leases_;
    WorkBell bell_;
    std::mutex mutex_; // of jobs_
    MemJobs jobs_{bell_};
};

} // namespace

std::unique_ptr<Store> make_mem_store(StoreClock clock)
{
    return std::make_unique<MemStore>(std::move(clock));
}

} // namespace server
