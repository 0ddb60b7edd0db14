#include "server/store/sqlite_jobs.h"
#include "server/store/sqlite_states.h"

#include <algorithm>

namespace server {

namespace {

const std::string kShortColumns =
    "j.seq, j.id, j.tenant, j.state, j.priority, j.epoch, j.attempts, j.cancel_requested, j.reused, "
    "j.created_ms, j.started_ms, j.finished_ms, j.render_key, j.failure_json, r.image_digest, r.samples, "
    "r.reusable, j.no_cache, j.layers";
const std::string kFromJobs = " FROM jobs j LEFT JOIN results r ON r.job = j.seq";
const std::string kShortJob = "SELECT " + kShortColumns + kFromJobs;
const std::string kHead = "SELECT seq, state, cancel_requested, attempts FROM jobs";

StoredState state_of(std::int64_t number)
{
    if (number < 0 || number > static_cast<std::int64_t>(StoredState::expired))
        throw StoreError("job database: a job has the unknown state " + std::to_string(number), false);
    return static_cast<StoredState>(number);
}

JobRow short_row(const SqliteStatement& row)
{
    JobRow job{.sequence = row.integer(0), .record = {}};
    JobRecord& record = job.record;
    record.id = row.text(1);
    record.tenant = row.text(2);
    record.state = state_of(row.integer(3));
    record.spec.priority = static_cast<int>(row.integer(4));
    record.epoch = static_cast<std::uint64_t>(row.integer(5));
    record.attempts = static_cast<std::uint32_t>(row.integer(6));
    record.cancel_requested = row.integer(7) != 0;
    record.reused = row.integer(8) != 0;
    record.created_ms = row.integer(9);
    record.started_ms = row.optional_integer(10);
    record.finished_ms = row.optional_integer(11);
    record.spec.render_key = row.text(12);
    record.failure.summary_json = row.text(13);
    record.spec.no_cache = row.integer(17) != 0;
    record.spec.layers = static_cast<std::uint32_t>(row.integer(18));
    if (row.is_null(14)) return job;
    record.result.emplace();
    record.result->image_digest = row.text(14);
    record.result->samples = static_cast<std::uint32_t>(row.integer(15));
    record.result->reusable = row.integer(16) != 0;
    return job;
}

// The text that `column` of the job's row in `table` names; empty where there is no such row.
std::string text_of(SqliteConnection& db, std::int64_t sequence, const char* table, const char* column)
{
    SqliteStatement row = db.prepare(std::string("SELECT b.body FROM ") + table +
                                     " o JOIN text_bodies b ON b.text = o." + column + " WHERE o.job = ?1");
    row.bind(sequence);
    return row.step() ? row.text(0) : std::string();
}

void add_result_texts(SqliteConnection& db, std::int64_t sequence, JobResult& result)
{
    result.report_json = text_of(db, sequence, "results", "report");
    result.scene_json = text_of(db, sequence, "results", "scene");
}

void add_labels(SqliteConnection& db, JobRow& job)
{
    SqliteStatement label = db.prepare("SELECT name, value FROM labels WHERE job = ?1");
    label.bind(job.sequence);
    while (label.step())
        job.record.spec.labels.emplace(label.text(0), label.text(1));
}

void add_assets(SqliteConnection& db, JobRow& job)
{
    SqliteStatement asset = db.prepare("SELECT digest FROM job_assets WHERE job = ?1 ORDER BY place");
    asset.bind(job.sequence);
    while (asset.step())
        job.record.spec.asset_digests.push_back(asset.text(0));
}

std::vector<std::string> texts_in(SqliteStatement& row)
{
    std::vector<std::string> texts;
    while (row.step())
        texts.push_back(row.text(0));
    return texts;
}

std::string json_array_of(const std::vector<JobId>& ids) // of hex digits: nothing to escape
{
    std::string text;
    for (const JobId& id : ids)
        text += (text.empty() ? "\"" : ",\"") + id + '"';
    return '[' + text + ']';
}

std::optional<JobRow> short_job(SqliteConnection& db, SqliteStatement& row)
{
    if (!row.step()) return std::nullopt;
    JobRow job = short_row(row);
    add_labels(db, job);
    if (job.record.state == StoredState::failed)
        job.record.failure.whole_json = text_of(db, job.sequence, "failures", "whole");
    return job;
}

std::optional<JobHead> head(SqliteStatement& row)
{
    if (!row.step()) return std::nullopt;
    return JobHead{.sequence = row.integer(0),
                   .state = state_of(row.integer(1)),
                   .cancel_requested = row.integer(2) != 0,
                   .attempts = static_cast<std::uint32_t>(row.integer(3))};
}

} // namespace

std::optional<JobRow> read_short_job(SqliteConnection& db, const Tenant& tenant, const JobId& id)
{
    SqliteStatement row = db.prepare(kShortJob + " WHERE j.id = ?1 AND j.tenant = ?2");
    row.bind(id, tenant);
    return short_job(db, row);
}

std::optional<JobRow> read_short_job(SqliteConnection& db, std::int64_t sequence)
{
    SqliteStatement row = db.prepare(kShortJob + " WHERE j.seq = ?1");
    row.bind(sequence);
    return short_job(db, row);
}

std::optional<JobRow> read_job(SqliteConnection& db, const Tenant& tenant, const JobId& id)
{
    std::optional<JobRow> job = read_short_job(db, tenant, id);
    if (!job) return std::nullopt;
    job->record.spec.request_json = text_of(db, job->sequence, "requests", "request");
    if (job->record.result) add_result_texts(db, job->sequence, *job->record.result);
    add_assets(db, *job);
    return job;
}

std::vector<JobRow> read_jobs_before(SqliteConnection& db, std::int64_t sequence, const ListQuery& query)
{
    std::string sql = kShortJob + " WHERE j.tenant = ?1 AND j.seq < ?2";
    const bool named = query.state && !query.also.empty();
    const std::string label =
        query.label ? " AND j.seq IN (SELECT job FROM labels WHERE name = ?4 AND value = ?5)" : "";
    if (named) // each by its index: with a plain OR all jobs of the state would be sorted
        sql += " AND j.seq IN (SELECT seq FROM jobs WHERE id IN (SELECT value FROM json_each(?7)) "
               "UNION SELECT seq FROM (SELECT j.seq FROM jobs j WHERE j.tenant = ?1 AND j.seq < ?2 AND "
               "j.state = ?3" +
               label + " ORDER BY j.seq DESC LIMIT ?6))";
    else if (query.state)
        sql += " AND j.state = ?3";
    sql += label;
    SqliteStatement row = db.prepare(sql + " ORDER BY j.seq DESC LIMIT ?6");
    row.bind_at(1, query.tenant);
    row.bind_at(2, sequence);
    if (query.state) row.bind_at(3, static_cast<std::int64_t>(*query.state));
    if (query.label) {
        row.bind_at(4, query.label->first);
        row.bind_at(5, query.label->second);
    }
    row.bind_at(6, std::int64_t{query.limit} + 1); // one more tells whether there are more
    if (named) row.bind_at(7, json_array_of(query.also));
    std::vector<JobRow> jobs;
    while (row.step())
        jobs.push_back(short_row(row));
    for (JobRow& job : jobs)
        add_labels(db, job);
    return jobs;
}

std::optional<JobHead> read_head(SqliteConnection& db, const JobId& id)
{
    SqliteStatement row = db.prepare(kHead + " WHERE id = ?1");
    row.bind(id);
    return head(row);
}

std::optional<JobHead> read_head(SqliteConnection& db, const Tenant& tenant, const JobId& id)
{
    SqliteStatement row = db.prepare(kHead + " WHERE id = ?1 AND tenant = ?2");
    row.bind(id, tenant);
    return head(row);
}

std::optional<JobHead> read_leased_head(SqliteConnection& db, const Lease& lease)
{
    SqliteStatement row = db.prepare(kHead + " WHERE id = ?1 AND epoch = ?2 AND state = " + kLeased);
    row.bind(lease.job, static_cast<std::int64_t>(lease.epoch));
    return head(row);
}

std::optional<KeyRow> read_key(SqliteConnection& db, const Tenant& tenant, const std::string& key)
{
    SqliteStatement row =
        db.prepare("SELECT body_digest, job FROM idempotency_keys WHERE tenant = ?1 AND key = ?2");
    row.bind(tenant, key);
    if (!row.step()) return std::nullopt;
    return KeyRow{row.text(0), row.integer(1)};
}

std::optional<std::int64_t>
find_reusable(SqliteConnection& db, const Tenant& tenant, const std::string& render_key)
{
    if (render_key.empty()) return std::nullopt;
    SqliteStatement row = db.prepare("SELECT j.seq FROM jobs j JOIN results r ON r.job = j.seq "
                                     "WHERE j.tenant = ?1 AND j.render_key = ?2 AND j.state = " +
                                     kSucceeded + " AND r.reusable = 1 ORDER BY j.seq DESC LIMIT 1");
    row.bind(tenant, render_key);
    if (!row.step()) return std::nullopt;
    return row.integer(0);
}

JobResult read_short_result(SqliteConnection& db, std::int64_t sequence)
{
    SqliteStatement row = db.prepare("SELECT image_digest, samples, reusable FROM results WHERE job = ?1");
    row.bind(sequence);
    row.step();
    JobResult result;
    result.image_digest = row.text(0);
    result.samples = static_cast<std::uint32_t>(row.integer(1));
    result.reusable = row.integer(2) != 0;
    return result;
}

JobResult read_result(SqliteConnection& db, std::int64_t sequence)
{
    JobResult result = read_short_result(db, sequence);
    add_result_texts(db, sequence, result);
    return result;
}

QueueDepth read_depth(SqliteConnection& db)
{
    QueueDepth depth;
    depth.queued =
        static_cast<std::uint64_t>(db.integer("SELECT count(*) FROM jobs WHERE state = " + kQueued));
    depth.leased =
        static_cast<std::uint64_t>(db.integer("SELECT count(*) FROM jobs WHERE state = " + kLeased));
    return depth;
}

bool any_waiting(SqliteConnection& db)
{
    return db.integer("SELECT EXISTS (SELECT 1 FROM jobs WHERE state = " + kQueued + ")") != 0;
}

std::optional<std::uint32_t> read_queue_position(SqliteConnection& db, const JobId& id)
{
    const std::string before = "(SELECT count(*) FROM jobs WHERE state = " + kQueued + " AND ";
    SqliteStatement row = db.prepare("SELECT " + before + "priority > own.priority) + " + before +
                                     "priority = own.priority AND seq < own.seq) "
                                     "FROM jobs own WHERE own.id = ?1 AND own.state = " +
                                     kQueued);
    row.bind(id);
    if (!row.step()) return std::nullopt;
    return static_cast<std::uint32_t>(row.integer(0));
}

std::vector<std::string> read_assets_in_use(SqliteConnection& db)
{
    SqliteStatement row = db.prepare(
        "SELECT DISTINCT a.digest FROM jobs j JOIN job_assets a ON a.job = j.seq WHERE j.state IN (" + kOpen +
        ")");
    return texts_in(row);
}

std::vector<std::string> read_pictures(SqliteConnection& db)
{
    SqliteStatement row = db.prepare("SELECT DISTINCT image_digest FROM results");
    return texts_in(row);
}

bool shows_picture(SqliteConnection& db, const std::string& image_digest)
{
    SqliteStatement row = db.prepare("SELECT 1 FROM results WHERE image_digest = ?1 LIMIT 1");
    row.bind(image_digest);
    return row.step();
}

std::int64_t newest_sequence(SqliteConnection& db)
{
    return db.integer("SELECT coalesce(max(seq), 0) FROM jobs");
}

std::uint64_t used_bytes(SqliteConnection& db)
{
    const std::int64_t pages = db.integer("PRAGMA page_count") - db.integer("PRAGMA freelist_count");
    return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(db.integer("PRAGMA page_size"));
}

} // namespace server
