// Jobs as rows: the SQL of the job database, a function a statement or two.
//
// Errors   StoreError. Threads: the connection's.
#pragma once

#include "server/store/sqlite_connection.h"
#include "server/store/store.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace server {

struct JobRow {
    std::int64_t sequence = 0;
    JobRecord record;
};

// What a transition needs to know of a job.
struct JobHead {
    std::int64_t sequence = 0;
    StoredState state = StoredState::queued;
    bool cancel_requested = false;
    std::uint32_t attempts = 0;
};

struct KeyRow {
    std::string body_digest;
    std::int64_t sequence = 0;
};

// Reading.
std::optional<JobRow> read_job(SqliteConnection& db, const Tenant& tenant, const JobId& id);
// Without the long texts but that of a failure.
std::optional<JobRow> read_short_job(SqliteConnection& db, const Tenant& tenant, const JobId& id);
std::optional<JobRow> read_short_job(SqliteConnection& db, std::int64_t sequence);
std::vector<JobRow> read_jobs_before(SqliteConnection& db, std::int64_t sequence, const ListQuery& query);
std::optional<JobHead> read_head(SqliteConnection& db, const JobId& id);
std::optional<JobHead> read_head(SqliteConnection& db, const Tenant& tenant, const JobId& id);
std::optional<JobHead> read_leased_head(SqliteConnection& db, const Lease& lease); // nothing: fenced
std::optional<KeyRow> read_key(SqliteConnection& db, const Tenant& tenant, const std::string& key);
// The newest succeeded job with this key whose result others may have; nothing if there is none.
std::optional<std::int64_t>
find_reusable(SqliteConnection& db, const Tenant& tenant, const std::string& render_key);
JobResult read_result(SqliteConnection& db, std::int64_t sequence);       // whole
JobResult read_short_result(SqliteConnection& db, std::int64_t sequence); // without its texts
QueueDepth read_depth(SqliteConnection& db);
bool any_waiting(SqliteConnection& db);
std::optional<std::uint32_t> read_queue_position(SqliteConnection& db, const JobId& id);
std::vector<std::string> read_assets_in_use(SqliteConnection& db);
std::vector<std::string> read_pictures(SqliteConnection& db);
bool shows_picture(SqliteConnection& db, const std::string& image_digest);
std::int64_t newest_sequence(SqliteConnection& db);
std::uint64_t used_bytes(SqliteConnection& db);

// Writing, inside a transaction.
std::int64_t insert_job(SqliteConnection& db, const JobRecord& job); // its sequence
void insert_key(SqliteConnection& db, const SubmitRequest& request, std::int64_t sequence);
void insert_result(SqliteConnection& db, std::int64_t sequence, const JobResult& result);
void copy_result(SqliteConnection& db, std::int64_t from, std::int64_t to);
// Queued: not started, not finished. Final: finished at `now_ms`.
void set_state(SqliteConnection& db, std::int64_t sequence, StoredState state, std::int64_t now_ms);
void set_failure(SqliteConnection& db, std::int64_t sequence, const JobFailure& why);
void set_reused(SqliteConnection& db, std::int64_t sequence);
void request_cancel(SqliteConnection& db, std::int64_t sequence);
void uncount_attempt(SqliteConnection& db, std::int64_t sequence);
std::optional<Lease> lease_next(SqliteConnection& db, std::int64_t now_ms); // nothing waits
void reset_job(SqliteConnection& db, std::int64_t sequence); // queued as if never tried, without a result
void delete_job(SqliteConnection& db, std::int64_t sequence);
std::size_t expire_jobs(SqliteConnection& db, std::int64_t before_ms); // and forgets
// False: a job submitted after `newest` has the picture.
bool expire_picture(SqliteConnection& db, const std::string& image_digest, std::int64_t newest);
std::size_t forget_ended(SqliteConnection& db, std::size_t most);
void delete_keys(SqliteConnection& db, std::int64_t before_ms);

} // namespace server
