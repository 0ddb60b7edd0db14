#include "server/store/sqlite_schema.h"

#include "server/store/file_io.h"
#include "server/store/sqlite_states.h"
#include "server/store/store.h"

#include <string>
#include <vector>

namespace server {

namespace {

// Jobs that can be forgotten without losing a result.
std::string ended_index()
{
    return "CREATE INDEX jobs_without_result ON jobs(finished_ms) WHERE state IN (" + kWithoutResult + ");\n";
}

constexpr std::int64_t kSchemaVersion = 4;
constexpr std::int64_t kApplicationId = 0x48656C69; // "Heli"

// `seq` is the order of submission (never a clock) and never used twice. `state` is StoredState's number.
std::string jobs_schema()
{
    return R"sql(
CREATE TABLE jobs(
    seq INTEGER PRIMARY KEY AUTOINCREMENT,
    id TEXT NOT NULL UNIQUE,
    tenant TEXT NOT NULL,
    state INTEGER NOT NULL,
    priority INTEGER NOT NULL,
    epoch INTEGER NOT NULL DEFAULT 0,
    attempts INTEGER NOT NULL DEFAULT 0,
    cancel_requested INTEGER NOT NULL DEFAULT 0,
    reused INTEGER NOT NULL DEFAULT 0,
    created_ms INTEGER NOT NULL,
    started_ms INTEGER,
    finished_ms INTEGER, -- if and only if the state is final
    render_key TEXT NOT NULL,
    failure_json TEXT NOT NULL DEFAULT '', -- the summary
    no_cache INTEGER NOT NULL DEFAULT 0,
    layers INTEGER NOT NULL DEFAULT 0
) STRICT;
CREATE INDEX jobs_of_tenant ON jobs(tenant, seq);
CREATE INDEX jobs_in_state ON jobs(tenant, state, seq);
CREATE INDEX jobs_ended ON jobs(finished_ms) WHERE finished_ms IS NOT NULL;
CREATE INDEX jobs_waiting ON jobs(priority DESC, seq) WHERE state = )sql" +
           kQueued + ";\nCREATE INDEX jobs_open ON jobs(state) WHERE state IN (" + kOpen +
           ");\nCREATE INDEX jobs_reusable ON jobs(tenant, render_key, seq) WHERE state = " + kSucceeded +
           ";\n" + ended_index();
}

// Long texts are apart, so that a change of state rewrites a short row, and by content: many jobs may have the
// same. How many do is counted by the triggers, and a text that none has goes; as foreign keys these columns
// would be searched for each text that goes.
constexpr const char* kTextsSchema = R"sql(
CREATE TABLE texts(
    id INTEGER PRIMARY KEY,
    digest TEXT NOT NULL UNIQUE,
    uses INTEGER NOT NULL DEFAULT 0
) STRICT;
CREATE TABLE text_bodies(
    text INTEGER PRIMARY KEY REFERENCES texts(id) ON DELETE CASCADE,
    body TEXT NOT NULL
) STRICT;

CREATE TABLE requests(
    job INTEGER PRIMARY KEY REFERENCES jobs(seq) ON DELETE CASCADE,
    request INTEGER NOT NULL
) STRICT;
CREATE TABLE failures(
    job INTEGER PRIMARY KEY REFERENCES jobs(seq) ON DELETE CASCADE,
    whole INTEGER NOT NULL
) STRICT;
CREATE TABLE results(
    job INTEGER PRIMARY KEY REFERENCES jobs(seq) ON DELETE CASCADE,
    image_digest TEXT NOT NULL,
    samples INTEGER NOT NULL,
    reusable INTEGER NOT NULL,
    report INTEGER NOT NULL,
    scene INTEGER NOT NULL
) STRICT;
CREATE INDEX results_by_picture ON results(image_digest, job);
)sql";

// Of a column that names a text.
std::string counting_triggers(const std::string& table, const std::string& column)
{
    const std::string name = table + '_' + column;
    return "CREATE TRIGGER " + name + "_comes AFTER INSERT ON " + table +
           " BEGIN UPDATE texts SET uses = uses + 1 WHERE id = NEW." + column + "; END;\n" +
           "CREATE TRIGGER " + name + "_goes AFTER DELETE ON " + table +
           " BEGIN UPDATE texts SET uses = uses - 1 WHERE id = OLD." + column + ";" +
           " DELETE FROM texts WHERE id = OLD." + column + " AND uses = 0; END;\n";
}

std::string texts_schema()
{
    return kTextsSchema + counting_triggers("requests", "request") + counting_triggers("failures", "whole") +
           counting_triggers("results", "report") + counting_triggers("results", "scene");
}

constexpr const char* kSmallTables = R"sql(
CREATE TABLE labels(
    job INTEGER NOT NULL REFERENCES jobs(seq) ON DELETE CASCADE,
    name TEXT NOT NULL,
    value TEXT NOT NULL,
    PRIMARY KEY (job, name)
) STRICT, WITHOUT ROWID;
CREATE INDEX labels_by_value ON labels(name, value, job);

CREATE TABLE job_assets(
    job INTEGER NOT NULL REFERENCES jobs(seq) ON DELETE CASCADE,
    place INTEGER NOT NULL,
    digest TEXT NOT NULL,
    PRIMARY KEY (job, place)
) STRICT, WITHOUT ROWID;

CREATE TABLE idempotency_keys(
    tenant TEXT NOT NULL,
    key TEXT NOT NULL,
    body_digest TEXT NOT NULL,
    job INTEGER NOT NULL REFERENCES jobs(seq) ON DELETE CASCADE,
    created_ms INTEGER NOT NULL,
    PRIMARY KEY (tenant, key)
) STRICT, WITHOUT ROWID;
CREATE INDEX idempotency_keys_of_job ON idempotency_keys(job);
CREATE INDEX idempotency_keys_by_age ON idempotency_keys(created_ms);
)sql";

// Texts of before get names that no digest is: each stays its job's own until it goes with it.
std::string step_to_texts()
{
    return R"sql(
ALTER TABLE requests RENAME TO old_requests;
ALTER TABLE results RENAME TO old_results;
)sql" + texts_schema() +
           R"sql(
INSERT INTO texts(digest) SELECT 'request ' || job FROM old_requests;
INSERT INTO text_bodies SELECT t.id, o.request_json FROM old_requests o JOIN texts t ON t.digest = 'request ' || o.job;
INSERT INTO requests SELECT o.job, t.id FROM old_requests o JOIN texts t ON t.digest = 'request ' || o.job;
INSERT INTO texts(digest) SELECT 'report ' || job FROM old_results;
INSERT INTO text_bodies SELECT t.id, o.report_json FROM old_results o JOIN texts t ON t.digest = 'report ' || o.job;
INSERT INTO texts(digest) SELECT 'scene ' || job FROM old_results;
INSERT INTO text_bodies SELECT t.id, o.scene_json FROM old_results o JOIN texts t ON t.digest = 'scene ' || o.job;
INSERT INTO results SELECT o.job, o.image_digest, o.samples, o.reusable, r.id, s.id FROM old_results o
    JOIN texts r ON r.digest = 'report ' || o.job JOIN texts s ON s.digest = 'scene ' || o.job;
DROP TABLE old_requests;
DROP TABLE old_results;
INSERT INTO texts(digest) SELECT 'failure ' || seq FROM jobs WHERE error_json <> '';
INSERT INTO text_bodies SELECT t.id, j.error_json FROM jobs j JOIN texts t ON t.digest = 'failure ' || j.seq;
INSERT INTO failures SELECT j.seq, t.id FROM jobs j JOIN texts t ON t.digest = 'failure ' || j.seq;
ALTER TABLE jobs RENAME COLUMN error_json TO failure_json;
)sql" + ended_index();
}

// What each version added to the one before: the first is from 1 to 2.
std::vector<std::string> steps()
{
    return {"ALTER TABLE jobs ADD COLUMN no_cache INTEGER NOT NULL DEFAULT 0",
            step_to_texts(),
            "ALTER TABLE jobs ADD COLUMN layers INTEGER NOT NULL DEFAULT 0"};
}

// No mmap_size: an I/O error in a mapped page would be a signal.
constexpr const char* kSettings =
    "PRAGMA busy_timeout=5000; PRAGMA foreign_keys=ON; PRAGMA mmap_size=0;"
    "PRAGMA temp_store=MEMORY; PRAGMA trusted_schema=OFF; PRAGMA cell_size_check=ON;";

void check_pages(SqliteConnection& db)
{
    SqliteStatement check = db.prepare("PRAGMA quick_check(1)");
    const std::string answer = check.step() ? check.text(0) : "no answer";
    if (answer != "ok") throw StoreError("quick_check: " + answer, false);
}

void set_version(SqliteConnection& db)
{
    db.execute(("PRAGMA user_version=" + std::to_string(kSchemaVersion)).c_str());
}

void migrate(SqliteConnection& db)
{
    const std::int64_t version = db.integer("PRAGMA user_version");
    const bool empty = db.integer("SELECT count(*) FROM sqlite_schema") == 0;
    if (version == 0 && empty) {
        db.execute("BEGIN IMMEDIATE");
        db.execute((jobs_schema() + texts_schema() + kSmallTables).c_str());
        db.execute(("PRAGMA application_id=" + std::to_string(kApplicationId)).c_str());
        set_version(db);
        db.execute("COMMIT");
        return;
    }
    if (db.integer("PRAGMA application_id") != kApplicationId)
        throw StoreError("it is another program's database", false);
    if (version > kSchemaVersion)
        throw StoreError("it has version " + std::to_string(version) + ", this program knows " +
                             std::to_string(kSchemaVersion) + ": start the newer program",
                         false);
    if (version < 1) throw StoreError("it has no version", false);
    if (version == kSchemaVersion) return;
    db.execute("BEGIN IMMEDIATE");
    const std::vector<std::string> all = steps();
    for (auto step = static_cast<std::size_t>(version - 1); step < all.size(); ++step)
        db.execute(all[step].c_str());
    set_version(db);
    db.execute("COMMIT");
}

void void_leases(SqliteConnection& db, std::int64_t now_ms)
{
    db.execute("BEGIN IMMEDIATE");
    db.prepare("UPDATE jobs SET state = " + kCanceled + ", finished_ms = ?1 WHERE state = " + kLeased +
               " AND cancel_requested = 1")
        .bind(now_ms)
        .run();
    db.execute(
        ("UPDATE jobs SET state = " + kQueued + ", started_ms = NULL WHERE state = " + kLeased).c_str());
    db.execute("COMMIT");
}

} // namespace

std::unique_ptr<SqliteConnection> open_sqlite_writer(const std::filesystem::path& file, std::int64_t now_ms)
{
    try {
        auto db = std::make_unique<SqliteConnection>(file, SqliteConnection::Open::create);
        db->execute(kSettings);
        check_pages(*db);
        db->execute("PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; PRAGMA journal_size_limit=67108864;");
        SqliteStatement mode = db->prepare("PRAGMA journal_mode");
        if (!mode.step() || mode.text(0) != "wal")
            throw StoreError("its file system does not allow a write-ahead log", false);
        mode.run();
        migrate(*db);
        void_leases(*db, now_ms);
        sync_folder(file.has_parent_path() ? file.parent_path() : ".");
        return db;
    } catch (const StoreError& error) {
        throw StoreError("the job database " + file.string() + " cannot be used: " + error.what() +
                             (error.storage_full ? "" : "; move it away, or restore a backup"),
                         error.storage_full);
    }
}

void touch_database(SqliteConnection& db)
{
    set_version(db);
}

std::unique_ptr<SqliteConnection> open_sqlite_reader(const std::filesystem::path& file)
{
    auto db = std::make_unique<SqliteConnection>(file, SqliteConnection::Open::existing);
    db->execute(kSettings);
    db->execute("PRAGMA query_only=1; PRAGMA wal_autocheckpoint=0;");
    return db;
}

} // namespace server
