#include "server/store/sqlite_jobs.h"
#include "server/store/store_rules.h"

namespace server {

std::int64_t insert_job(SqliteConnection& db, const JobRecord& job)
{
    db.prepare("INSERT INTO jobs(id, tenant, state, priority, reused, created_ms, finished_ms, render_key, "
               "no_cache) "
               "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)")
        .bind(job.id,
              job.tenant,
              static_cast<std::int64_t>(job.state),
              std::int64_t{job.spec.priority},
              std::int64_t{job.reused},
              job.created_ms,
              job.finished_ms,
              job.spec.render_key,
              std::int64_t{job.spec.no_cache})
        .run();
    const std::int64_t sequence = db.last_row();
    db.prepare("INSERT INTO requests(job, request_json) VALUES (?1, ?2)")
        .bind(sequence, job.spec.request_json)
        .run();
    for (const auto& [name, value] : job.spec.labels)
        db.prepare("INSERT INTO labels(job, name, value) VALUES (?1, ?2, ?3)")
            .bind(sequence, name, value)
            .run();
    std::int64_t place = 0;
    for (const std::string& digest : job.spec.asset_digests)
        db.prepare("INSERT INTO job_assets(job, place, digest) VALUES (?1, ?2, ?3)")
            .bind(sequence, place++, digest)
            .run();
    return sequence;
}

void insert_key(SqliteConnection& db, const SubmitRequest& request, std::int64_t sequence)
{
    db.prepare("INSERT INTO idempotency_keys(tenant, key, body_digest, job, created_ms) VALUES (?1, ?2, ?3, "
               "?4, ?5)")
        .bind(request.tenant, request.idempotency_key, request.body_digest, sequence, request.now_ms)
        .run();
}

void insert_result(SqliteConnection& db, std::int64_t sequence, const JobResult& result)
{
    db.prepare("INSERT INTO results(job, image_digest, samples, reusable, report_json, scene_json) "
               "VALUES (?1, ?2, ?3, ?4, ?5, ?6)")
        .bind(sequence,
              result.image_digest,
              std::int64_t{result.samples},
              std::int64_t{result.reusable},
              result.report_json,
              result.scene_json)
        .run();
}

void set_state(SqliteConnection& db, std::int64_t sequence, StoredState state, std::int64_t now_ms)
{
    std::optional<std::int64_t> finished_ms;
    if (is_final(state)) finished_ms = now_ms;
    db.prepare("UPDATE jobs SET state = ?2, finished_ms = ?3, started_ms = iif(?2 = 0, NULL, started_ms) "
               "WHERE seq = ?1")
        .bind(sequence, static_cast<std::int64_t>(state), finished_ms)
        .run();
}

void set_error(SqliteConnection& db, std::int64_t sequence, const std::string& error_json)
{
    db.prepare("UPDATE jobs SET error_json = ?2 WHERE seq = ?1").bind(sequence, error_json).run();
}

void set_reused(SqliteConnection& db, std::int64_t sequence)
{
    db.prepare("UPDATE jobs SET reused = 1 WHERE seq = ?1").bind(sequence).run();
}

void request_cancel(SqliteConnection& db, std::int64_t sequence)
{
    db.prepare("UPDATE jobs SET cancel_requested = 1 WHERE seq = ?1").bind(sequence).run();
}

void uncount_attempt(SqliteConnection& db, std::int64_t sequence)
{
    db.prepare("UPDATE jobs SET attempts = attempts - 1 WHERE seq = ?1").bind(sequence).run();
}

std::optional<Lease> lease_next(SqliteConnection& db, std::int64_t now_ms)
{
    SqliteStatement row = db.prepare(
        "UPDATE jobs SET state = 1, epoch = epoch + 1, attempts = attempts + 1, started_ms = ?1 WHERE seq = "
        "(SELECT seq FROM jobs WHERE state = 0 ORDER BY priority DESC, seq LIMIT 1) RETURNING id, epoch");
    row.bind(now_ms);
    if (!row.step()) return std::nullopt;
    Lease lease{.job = row.text(0), .epoch = static_cast<std::uint64_t>(row.integer(1))};
    row.run();
    return lease;
}

void reset_job(SqliteConnection& db, std::int64_t sequence)
{
    db.prepare("DELETE FROM results WHERE job = ?1").bind(sequence).run();
    db.prepare("UPDATE jobs SET state = 0, attempts = 0, reused = 0, started_ms = NULL, finished_ms = NULL "
               "WHERE seq = ?1")
        .bind(sequence)
        .run();
}

void delete_job(SqliteConnection& db, std::int64_t sequence)
{
    db.prepare("DELETE FROM jobs WHERE seq = ?1").bind(sequence).run();
}

std::size_t expire_jobs(SqliteConnection& db, std::int64_t before_ms)
{
    db.prepare("DELETE FROM jobs WHERE finished_ms < ?1").bind(before_ms - kExpiredKept_ms).run();
    const std::int64_t forgotten = db.changes();
    db.prepare("DELETE FROM results WHERE job IN (SELECT seq FROM jobs WHERE finished_ms < ?1)")
        .bind(before_ms)
        .run();
    db.prepare("UPDATE jobs SET state = 5 WHERE finished_ms < ?1 AND state IN (2, 3, 4)")
        .bind(before_ms)
        .run();
    return static_cast<std::size_t>(forgotten + db.changes());
}

void delete_keys(SqliteConnection& db, std::int64_t before_ms)
{
    db.prepare("DELETE FROM idempotency_keys WHERE created_ms < ?1").bind(before_ms).run();
}

} // namespace server
