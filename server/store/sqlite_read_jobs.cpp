#include "server/store/sqlite_jobs.h"

#include <algorithm>

namespace server {

namespace {

const std::string kShortColumns =
    "j.seq, j.id, j.tenant, j.state, j.priority, j.epoch, j.attempts, j.cancel_requested, j.reused, "
    "j.created_ms, "
    "j.started_ms, j.finished_ms, j.render_key, j.error_json, r.image_digest, r.samples, r.reusable, "
    "j.no_cache";
const std::string kFromJobs = " FROM jobs j LEFT JOIN results r ON r.job = j.seq";
const std::string kWholeJob = "SELECT " + kShortColumns + ", r.report_json, r.scene_json, q.request_json" +
                              kFromJobs + " JOIN requests q ON q.job = j.seq";

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
    record.error_json = row.text(13);
    record.spec.no_cache = row.integer(17) != 0;
    if (row.is_null(14)) return job;
    record.result.emplace();
    record.result->image_digest = row.text(14);
    record.result->samples = static_cast<std::uint32_t>(row.integer(15));
    record.result->reusable = row.integer(16) != 0;
    return job;
}

void add_long_texts(JobRecord& record, const SqliteStatement& row)
{
    if (record.result) {
        record.result->report_json = row.text(18);
        record.result->scene_json = row.text(19);
    }
    record.spec.request_json = row.text(20);
}

void add_labels_and_assets(SqliteConnection& db, JobRow& job)
{
    SqliteStatement label = db.prepare("SELECT name, value FROM labels WHERE job = ?1");
    label.bind(job.sequence);
    while (label.step())
        job.record.spec.labels.emplace(label.text(0), label.text(1));
    SqliteStatement asset = db.prepare("SELECT digest FROM job_assets WHERE job = ?1 ORDER BY place");
    asset.bind(job.sequence);
    while (asset.step())
        job.record.spec.asset_digests.push_back(asset.text(0));
}

std::string json_array_of(const std::vector<JobId>& ids) // of hex digits: nothing to escape
{
    std::string text;
    for (const JobId& id : ids)
        text += (text.empty() ? "\"" : ",\"") + id + '"';
    return '[' + text + ']';
}

std::optional<JobRow> whole_job(SqliteConnection& db, SqliteStatement& row)
{
    if (!row.step()) return std::nullopt;
    JobRow job = short_row(row);
    add_long_texts(job.record, row);
    add_labels_and_assets(db, job);
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

std::optional<JobRow> read_job(SqliteConnection& db, const Tenant& tenant, const JobId& id)
{
    SqliteStatement row = db.prepare(kWholeJob + " WHERE j.id = ?1 AND j.tenant = ?2");
    row.bind(id, tenant);
    return whole_job(db, row);
}

std::optional<JobRow> read_job(SqliteConnection& db, std::int64_t sequence)
{
    SqliteStatement row = db.prepare(kWholeJob + " WHERE j.seq = ?1");
    row.bind(sequence);
    return whole_job(db, row);
}

std::vector<JobRow> read_jobs_before(SqliteConnection& db, std::int64_t sequence, const ListQuery& query)
{
    std::string sql = "SELECT " + kShortColumns + kFromJobs + " WHERE j.tenant = ?1 AND j.seq < ?2";
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
        add_labels_and_assets(db, job);
    return jobs;
}

std::optional<JobHead> read_head(SqliteConnection& db, const JobId& id)
{
    SqliteStatement row = db.prepare("SELECT seq, state, cancel_requested, attempts FROM jobs WHERE id = ?1");
    row.bind(id);
    return head(row);
}

std::optional<JobHead> read_head(SqliteConnection& db, const Tenant& tenant, const JobId& id)
{
    SqliteStatement row =
        db.prepare("SELECT seq, state, cancel_requested, attempts FROM jobs WHERE id = ?1 AND tenant = ?2");
    row.bind(id, tenant);
    return head(row);
}

std::optional<JobHead> read_leased_head(SqliteConnection& db, const Lease& lease)
{
    SqliteStatement row = db.prepare(
        "SELECT seq, state, cancel_requested, attempts FROM jobs WHERE id = ?1 AND epoch = ?2 AND state = 1");
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

std::optional<JobResult>
read_reusable(SqliteConnection& db, const Tenant& tenant, const std::string& render_key)
{
    if (render_key.empty()) return std::nullopt;
    SqliteStatement row = db.prepare("SELECT r.image_digest, r.report_json, r.scene_json, r.samples FROM "
                                     "jobs j JOIN results r ON r.job = j.seq "
                                     "WHERE j.tenant = ?1 AND j.render_key = ?2 AND j.state = 2 AND "
                                     "r.reusable = 1 ORDER BY j.seq DESC LIMIT 1");
    row.bind(tenant, render_key);
    if (!row.step()) return std::nullopt;
    return JobResult{.image_digest = row.text(0),
                     .report_json = row.text(1),
                     .scene_json = row.text(2),
                     .samples = static_cast<std::uint32_t>(row.integer(3))};
}

QueueDepth read_depth(SqliteConnection& db)
{
    QueueDepth depth;
    depth.queued = static_cast<std::uint64_t>(db.integer("SELECT count(*) FROM jobs WHERE state = 0"));
    depth.leased = static_cast<std::uint64_t>(db.integer("SELECT count(*) FROM jobs WHERE state = 1"));
    return depth;
}

bool any_waiting(SqliteConnection& db)
{
    return db.integer("SELECT EXISTS (SELECT 1 FROM jobs WHERE state = 0)") != 0;
}

std::optional<std::uint32_t> read_queue_position(SqliteConnection& db, const JobId& id)
{
    SqliteStatement row = db.prepare(
        "SELECT (SELECT count(*) FROM jobs WHERE state = 0 AND priority > own.priority) + "
        "(SELECT count(*) FROM jobs WHERE state = 0 AND priority = own.priority AND seq < own.seq) "
        "FROM jobs own WHERE own.id = ?1 AND own.state = 0");
    row.bind(id);
    if (!row.step()) return std::nullopt;
    return static_cast<std::uint32_t>(row.integer(0));
}

std::vector<std::string> read_referenced_digests(SqliteConnection& db)
{
    SqliteStatement row =
        db.prepare("SELECT a.digest FROM jobs j JOIN job_assets a ON a.job = j.seq WHERE j.state IN (0, 1) "
                   "UNION SELECT image_digest FROM results");
    std::vector<std::string> digests;
    while (row.step())
        digests.push_back(row.text(0));
    return digests;
}

} // namespace server
