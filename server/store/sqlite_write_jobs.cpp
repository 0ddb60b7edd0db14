#include "server/store/blob_store.h"
#include "server/store/sqlite_jobs.h"
#include "server/store/sqlite_states.h"
#include "server/store/store_rules.h"

namespace server {

namespace {

// The number of the text, which is new or another job's too. The triggers count who has it.
std::int64_t keep_text(SqliteConnection& db, const std::string& text)
{
    const std::string digest = digest_of(std::string_view(text));
    {
        SqliteStatement known = db.prepare("SELECT id FROM texts WHERE digest = ?1");
        known.bind(digest);
        if (known.step()) return known.integer(0);
    }
    db.prepare("INSERT INTO texts(digest) VALUES (?1)").bind(digest).run();
    const std::int64_t id = db.last_row();
    db.prepare("INSERT INTO text_bodies(text, body) VALUES (?1, ?2)").bind(id, text).run();
    return id;
}

} // namespace

std::int64_t insert_job(SqliteConnection& db, const JobRecord& job)
{
    db.prepare("INSERT INTO jobs(id, tenant, state, priority, reused, created_ms, finished_ms, render_key, "
               "no_cache, layers) "
               "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10)")
        .bind(job.id,
              job.tenant,
              static_cast<std::int64_t>(job.state),
              std::int64_t{job.spec.priority},
              std::int64_t{job.reused},
              job.created_ms,
              job.finished_ms,
              job.spec.render_key,
              std::int64_t{job.spec.no_cache},
              std::int64_t{job.spec.layers})
        .run();
    const std::int64_t sequence = db.last_row();
    db.prepare("INSERT INTO requests(job, request) VALUES (?1, ?2)")
        .bind(sequence, keep_text(db, job.spec.request_json))
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
    const std::int64_t report = keep_text(db, result.report_json), scene = keep_text(db, result.scene_json);
    db.prepare("INSERT INTO results(job, image_digest, samples, reusable, report, scene) "
               "VALUES (?1, ?2, ?3, ?4, ?5, ?6)")
        .bind(sequence,
              result.image_digest,
              std::int64_t{result.samples},
              std::int64_t{result.reusable},
              report,
              scene)
        .run();
}

void copy_result(SqliteConnection& db, std::int64_t from, std::int64_t to)
{
    db.prepare("INSERT INTO results(job, image_digest, samples, reusable, report, scene) "
               "SELECT ?2, image_digest, samples, reusable, report, scene FROM results WHERE job = ?1")
        .bind(from, to)
        .run();
}

void set_state(SqliteConnection& db, std::int64_t sequence, StoredState state, std::int64_t now_ms)
{
    std::optional<std::int64_t> finished_ms;
    if (is_final(state)) finished_ms = now_ms;
    db.prepare("UPDATE jobs SET state = ?2, finished_ms = ?3, started_ms = iif(?2 = " + kQueued +
               ", NULL, started_ms) WHERE seq = ?1")
        .bind(sequence, static_cast<std::int64_t>(state), finished_ms)
        .run();
}

void set_failure(SqliteConnection& db, std::int64_t sequence, const JobFailure& why)
{
    db.prepare("UPDATE jobs SET failure_json = ?2 WHERE seq = ?1").bind(sequence, why.summary_json).run();
    db.prepare("INSERT INTO failures(job, whole) VALUES (?1, ?2)")
        .bind(sequence, keep_text(db, why.whole_json))
        .run();
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
    SqliteStatement row = db.prepare("UPDATE jobs SET state = " + kLeased +
                                     ", epoch = epoch + 1, attempts = attempts + 1, started_ms = ?1 WHERE "
                                     "seq = (SELECT seq FROM jobs WHERE state = " +
                                     kQueued + " ORDER BY priority DESC, seq LIMIT 1) RETURNING id, epoch");
    row.bind(now_ms);
    if (!row.step()) return std::nullopt;
    Lease lease{.job = row.text(0), .epoch = static_cast<std::uint64_t>(row.integer(1))};
    row.run();
    return lease;
}

void reset_job(SqliteConnection& db, std::int64_t sequence)
{
    db.prepare("DELETE FROM results WHERE job = ?1").bind(sequence).run();
    db.prepare("UPDATE jobs SET state = " + kQueued +
               ", attempts = 0, reused = 0, started_ms = NULL, finished_ms = NULL WHERE seq = ?1")
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
    db.prepare("UPDATE jobs SET state = " + kExpired + " WHERE finished_ms < ?1 AND state IN (" + kEnded +
               ")")
        .bind(before_ms)
        .run();
    return static_cast<std::size_t>(forgotten + db.changes());
}

bool expire_picture(SqliteConnection& db, const std::string& image_digest, std::int64_t newest)
{
    {
        SqliteStatement later =
            db.prepare("SELECT 1 FROM results WHERE image_digest = ?1 AND job > ?2 LIMIT 1");
        later.bind(image_digest, newest);
        if (later.step()) return false;
    }
    db.prepare("UPDATE jobs SET state = " + kExpired +
               " WHERE seq IN (SELECT job FROM results WHERE image_digest = ?1)")
        .bind(image_digest)
        .run();
    db.prepare("DELETE FROM results WHERE image_digest = ?1").bind(image_digest).run();
    return true;
}

std::size_t forget_ended(SqliteConnection& db, std::size_t most)
{
    db.prepare("DELETE FROM jobs WHERE seq IN (SELECT seq FROM jobs WHERE state IN (" + kWithoutResult +
               ") ORDER BY finished_ms LIMIT ?1)")
        .bind(static_cast<std::int64_t>(most))
        .run();
    return static_cast<std::size_t>(db.changes());
}

void delete_keys(SqliteConnection& db, std::int64_t before_ms)
{
    db.prepare("DELETE FROM idempotency_keys WHERE created_ms < ?1").bind(before_ms).run();
}

} // namespace server
