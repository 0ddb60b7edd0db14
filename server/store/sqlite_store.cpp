#include "server/store/sqlite_store.h"

#include "server/store/group_commit.h"
#include "server/store/lease_table.h"
#include "server/store/sqlite_jobs.h"
#include "server/store/sqlite_readers.h"
#include "server/store/sqlite_schema.h"
#include "server/store/store_rules.h"
#include "server/store/work_bell.h"

#include <utility>

namespace server {

namespace {

class Embedded final : public SqliteStore {
public:
    Embedded(const std::filesystem::path& file, StoreClock clock)
        : file_(file), clock_(std::move(clock)), writer_(open_sqlite_writer(file, clock_.wall_ms())),
          readers_(file)
    {
    }

    CommitCounts commit_counts() const override { return writer_.counts(); }
    Submitted submit(const SubmitRequest& request) override;
    std::optional<JobRecord> get(const Tenant& tenant, const JobId& id) override;
    std::optional<JobRecord> find(const Tenant& tenant, const JobId& id) override;
    ListPage list(const ListQuery& query) override;
    QueueDepth depth() override { return readers_.read(read_depth); }
    bool storage_full() override;
    std::optional<std::uint32_t> queue_position(const JobId& id) override;
    std::vector<Lease>
    claim(const std::string& worker, std::size_t max, std::chrono::milliseconds ttl) override;
    std::size_t renew(const std::vector<Lease>& leases, std::chrono::milliseconds ttl) override;
    bool complete(const Lease& lease, const JobResult& result, std::int64_t now_ms, bool reused) override;
    bool complete_queued(const JobId& id, const JobResult& result, std::int64_t now_ms) override;
    std::optional<std::string> find_picture(const Tenant& tenant, const std::string& render_key) override;
    std::optional<JobResult> find_result(const Tenant& tenant, const std::string& render_key) override;
    void release(const std::vector<Lease>& leases) override;
    bool fail(const Lease& lease, const JobFailure& why, bool retry, std::int64_t now_ms) override;
    bool confirm_cancel(const Lease& lease, std::int64_t now_ms) override;
    std::optional<JobRecord> cancel(const Tenant& tenant, const JobId& id, std::int64_t now_ms) override;
    bool render_again(const Tenant& tenant, const JobId& id, const std::string& image_digest) override;
    bool remove(const Tenant& tenant, const JobId& id) override;
    std::size_t sweep(std::int64_t before_ms) override;
    std::uint64_t newest() override { return static_cast<std::uint64_t>(readers_.read(newest_sequence)); }
    std::vector<std::string> expire_results(const std::vector<std::string>& image_digests,
                                            std::uint64_t newest) override;
    std::size_t forget_ended(std::size_t most) override;
    std::uint64_t stored_bytes() override { return readers_.read(used_bytes); }
    std::vector<std::string> assets_in_use() override { return readers_.read(read_assets_in_use); }
    std::vector<std::string> pictures() override { return readers_.read(read_pictures); }
    bool shows(const std::string& image_digest) override;
    void wait_work(std::chrono::milliseconds timeout, std::stop_token stop) override;

private:
    template <typename Write>
    auto write(Durability durability, const Write& work) -> std::invoke_result_t<Write, SqliteConnection&>
    {
        std::invoke_result_t<Write, SqliteConnection&> answer{};
        writer_.run(durability, [&](SqliteConnection& db) { answer = work(db); });
        return answer;
    }
    // Ends or gives back a leased job by `change`, which says the state it goes to. False: fenced.
    template <typename Change>
    bool leave(const Lease& lease, std::int64_t now_ms, const Change& change);

    std::filesystem::path file_;
    StoreClock clock_;
    LeaseTable leases_;
    WorkBell bell_;
    GroupCommit writer_;
    SqliteReaders readers_; // closes before the writer, which empties the log as the last one
};

// Decides in the writer's thread, so that no other request comes between looking and writing.
Submitted submit_in(SqliteConnection& db, const SubmitRequest& request)
{
    const bool keyed = !request.idempotency_key.empty();
    if (const auto key = keyed ? read_key(db, request.tenant, request.idempotency_key) : std::nullopt) {
        if (key->body_digest != request.body_digest) return {SubmitStatus::key_reused, {}};
        return {SubmitStatus::replayed, read_short_job(db, key->sequence)->record};
    }
    std::optional<std::int64_t> twin;
    if (request.allow_reuse) twin = find_reusable(db, request.tenant, request.spec.render_key);
    if (!twin && request.queue_limit != 0 && read_depth(db).queued >= request.queue_limit)
        return {SubmitStatus::queue_full, {}};

    JobRecord job = job_of(request, twin ? std::optional(read_short_result(db, *twin)) : std::nullopt);
    const std::int64_t sequence = insert_job(db, job);
    if (twin) copy_result(db, *twin, sequence);
    if (keyed) insert_key(db, request, sequence);
    return {SubmitStatus::accepted, std::move(job)};
}

Submitted Embedded::submit(const SubmitRequest& request)
{
    Submitted submitted =
        write(Durability::synced, [&](SqliteConnection& db) { return submit_in(db, request); });
    if (submitted.status == SubmitStatus::accepted && submitted.job.state == StoredState::queued)
        bell_.ring();
    return submitted;
}

std::optional<JobRecord> Embedded::get(const Tenant& tenant, const JobId& id)
{
    std::optional<JobRow> job = readers_.read([&](SqliteConnection& db) { return read_job(db, tenant, id); });
    if (!job) return std::nullopt;
    return std::move(job->record);
}

std::optional<JobRecord> Embedded::find(const Tenant& tenant, const JobId& id)
{
    std::optional<JobRow> job =
        readers_.read([&](SqliteConnection& db) { return read_short_job(db, tenant, id); });
    if (!job) return std::nullopt;
    return std::move(job->record);
}

ListPage Embedded::list(const ListQuery& query)
{
    ListPage page;
    std::optional<std::uint64_t> before = INT64_MAX;
    if (!query.cursor.empty()) before = sequence_of_cursor(query.cursor);
    page.bad_cursor = !before;
    if (!before || query.limit == 0) return page;
    std::vector<JobRow> jobs = readers_.read([&](SqliteConnection& db) {
        return read_jobs_before(db, static_cast<std::int64_t>(*before), query);
    });
    const bool more = jobs.size() > query.limit;
    if (more) jobs.resize(query.limit);
    for (JobRow& job : jobs)
        page.jobs.push_back(std::move(job.record));
    if (more) page.next_cursor = cursor_after(static_cast<std::uint64_t>(jobs.back().sequence));
    return page;
}

bool Embedded::storage_full()
{
    if (!writer_.storage_full()) return false;
    // A page may find room where a job's rows do not.
    constexpr std::uintmax_t kRoom = 1 << 20;
    std::error_code unknown;
    const auto space = std::filesystem::space(file_, unknown);
    if (!unknown && space.available < kRoom) return true;
    try {
        writer_.run(Durability::synced, touch_database);
    } catch (const StoreError& error) {
        return error.storage_full;
    }
    return writer_.storage_full();
}

std::optional<std::uint32_t> Embedded::queue_position(const JobId& id)
{
    return readers_.read([&](SqliteConnection& db) { return read_queue_position(db, id); });
}

std::vector<Lease> Embedded::claim(const std::string&, std::size_t max, std::chrono::milliseconds ttl)
{
    const std::vector<Lease> lapsed = leases_.lapsed(clock_.steady());
    std::vector<Lease> leases = write(Durability::written, [&](SqliteConnection& db) {
        for (const Lease& lease : lapsed)
            if (const auto job = read_leased_head(db, lease))
                set_state(db, job->sequence, state_when_given_back(job->cancel_requested), clock_.wall_ms());
        std::vector<Lease> taken;
        while (taken.size() < max) {
            const std::optional<Lease> lease = lease_next(db, clock_.wall_ms());
            if (!lease) break;
            taken.push_back(*lease);
        }
        return taken;
    });
    leases_.forget(lapsed);
    leases_.grant(leases, clock_.steady() + ttl);
    if (!lapsed.empty()) bell_.ring(); // more may have come back than were taken
    return leases;
}

std::size_t Embedded::renew(const std::vector<Lease>& leases, std::chrono::milliseconds ttl)
{
    return leases_.renew(leases, clock_.steady() + ttl);
}

template <typename Change>
bool Embedded::leave(const Lease& lease, std::int64_t now_ms, const Change& change)
{
    const auto state = write(Durability::written, [&](SqliteConnection& db) -> std::optional<StoredState> {
        const std::optional<JobHead> job = read_leased_head(db, lease);
        if (!job) return std::nullopt;
        const StoredState next = change(db, *job);
        set_state(db, job->sequence, next, now_ms);
        return next;
    });
    leases_.forget({lease});
    if (state == StoredState::queued) bell_.ring();
    return state.has_value();
}

bool Embedded::complete(const Lease& lease, const JobResult& result, std::int64_t now_ms, bool reused)
{
    bool kept = false;
    const bool owned = leave(lease, now_ms, [&](SqliteConnection& db, const JobHead& job) {
        kept = !job.cancel_requested;
        if (kept) insert_result(db, job.sequence, result);
        if (kept && reused) set_reused(db, job.sequence);
        return kept ? StoredState::succeeded : StoredState::canceled;
    });
    return owned && kept;
}

bool Embedded::complete_queued(const JobId& id, const JobResult& result, std::int64_t now_ms)
{
    return write(Durability::written, [&](SqliteConnection& db) {
        const std::optional<JobHead> job = read_head(db, id);
        if (!job || job->state != StoredState::queued) return false;
        insert_result(db, job->sequence, result);
        set_reused(db, job->sequence);
        set_state(db, job->sequence, StoredState::succeeded, now_ms);
        return true;
    });
}

std::optional<JobResult> Embedded::find_result(const Tenant& tenant, const std::string& render_key)
{
    return readers_.read([&](SqliteConnection& db) -> std::optional<JobResult> {
        const std::optional<std::int64_t> job = find_reusable(db, tenant, render_key);
        if (!job) return std::nullopt;
        return read_result(db, *job);
    });
}

std::optional<std::string> Embedded::find_picture(const Tenant& tenant, const std::string& render_key)
{
    return readers_.read([&](SqliteConnection& db) -> std::optional<std::string> {
        const std::optional<std::int64_t> job = find_reusable(db, tenant, render_key);
        if (!job) return std::nullopt;
        return read_short_result(db, *job).image_digest;
    });
}

void Embedded::release(const std::vector<Lease>& leases)
{
    for (const Lease& lease : leases)
        leave(lease, clock_.wall_ms(), [&](SqliteConnection& db, const JobHead& job) {
            uncount_attempt(db, job.sequence);
            return state_when_given_back(job.cancel_requested);
        });
}

bool Embedded::fail(const Lease& lease, const JobFailure& why, bool retry, std::int64_t now_ms)
{
    return leave(lease, now_ms, [&](SqliteConnection& db, const JobHead& job) {
        const StoredState state = state_when_failed(retry, job.cancel_requested, job.attempts);
        if (state == StoredState::failed) set_failure(db, job.sequence, why);
        return state;
    });
}

bool Embedded::confirm_cancel(const Lease& lease, std::int64_t now_ms)
{
    return leave(lease, now_ms, [](SqliteConnection&, const JobHead&) { return StoredState::canceled; });
}

std::optional<JobRecord> Embedded::cancel(const Tenant& tenant, const JobId& id, std::int64_t now_ms)
{
    return write(Durability::synced, [&](SqliteConnection& db) -> std::optional<JobRecord> {
        const std::optional<JobHead> job = read_head(db, tenant, id);
        if (!job) return std::nullopt;
        if (!is_final(job->state)) request_cancel(db, job->sequence);
        if (job->state == StoredState::queued) set_state(db, job->sequence, StoredState::canceled, now_ms);
        return std::move(read_short_job(db, job->sequence)->record);
    });
}

bool Embedded::render_again(const Tenant& tenant, const JobId& id, const std::string& image_digest)
{
    const bool waits = write(Durability::written, [&](SqliteConnection& db) {
        const std::optional<JobRow> job = read_short_job(db, tenant, id);
        if (!job || job->record.state != StoredState::succeeded ||
            job->record.result->image_digest != image_digest)
            return false;
        reset_job(db, job->sequence);
        return true;
    });
    if (waits) bell_.ring();
    return waits;
}

bool Embedded::remove(const Tenant& tenant, const JobId& id)
{
    return write(Durability::synced, [&](SqliteConnection& db) {
        const std::optional<JobHead> job = read_head(db, tenant, id);
        if (!job || !is_final(job->state)) return false;
        delete_job(db, job->sequence);
        return true;
    });
}

std::size_t Embedded::sweep(std::int64_t before_ms)
{
    return write(Durability::synced, [&](SqliteConnection& db) {
        delete_keys(db, clock_.wall_ms() - kIdempotencyKept_ms);
        return expire_jobs(db, before_ms);
    });
}

std::vector<std::string> Embedded::expire_results(const std::vector<std::string>& image_digests,
                                                  std::uint64_t newest)
{
    return write(Durability::synced, [&](SqliteConnection& db) {
        std::vector<std::string> expired;
        for (const std::string& digest : image_digests)
            if (expire_picture(db, digest, static_cast<std::int64_t>(newest))) expired.push_back(digest);
        return expired;
    });
}

std::size_t Embedded::forget_ended(std::size_t most)
{
    return write(Durability::synced, [&](SqliteConnection& db) { return server::forget_ended(db, most); });
}

bool Embedded::shows(const std::string& image_digest)
{
    return readers_.read([&](SqliteConnection& db) { return shows_picture(db, image_digest); });
}

void Embedded::wait_work(std::chrono::milliseconds timeout, std::stop_token stop)
{
    const std::uint64_t mark = bell_.mark();
    if (readers_.read(any_waiting)) return;
    bell_.wait(mark, leases_.until_lapse(clock_.steady(), timeout), std::move(stop));
}

} // namespace

std::unique_ptr<SqliteStore> open_sqlite_store(const std::filesystem::path& file, StoreClock clock)
{
    return std::make_unique<Embedded>(file, std::move(clock));
}

} // namespace server
