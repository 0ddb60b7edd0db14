#include "server/store/sqlite_schema.h"

#include "server/store/file_io.h"
#include "server/store/store.h"

#include <array>

namespace server {

namespace {

constexpr std::int64_t kSchemaVersion = 2;
constexpr std::int64_t kApplicationId = 0x48656C69; // "Heli"

// `seq` is the order of submission (never a clock) and never used twice. `state` is StoredState's number. The
// long texts are apart, so that a change of state rewrites a short row.
constexpr const char* kSchema = R"sql(
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
    error_json TEXT NOT NULL DEFAULT '',
    no_cache INTEGER NOT NULL DEFAULT 0
) STRICT;
CREATE INDEX jobs_waiting ON jobs(priority DESC, seq) WHERE state = 0;
CREATE INDEX jobs_open ON jobs(state) WHERE state IN (0, 1);
CREATE INDEX jobs_reusable ON jobs(tenant, render_key, seq) WHERE state = 2;
CREATE INDEX jobs_of_tenant ON jobs(tenant, seq);
CREATE INDEX jobs_in_state ON jobs(tenant, state, seq);
CREATE INDEX jobs_ended ON jobs(finished_ms) WHERE finished_ms IS NOT NULL;

CREATE TABLE requests(
    job INTEGER PRIMARY KEY REFERENCES jobs(seq) ON DELETE CASCADE,
    request_json TEXT NOT NULL
) STRICT;

CREATE TABLE results(
    job INTEGER PRIMARY KEY REFERENCES jobs(seq) ON DELETE CASCADE,
    image_digest TEXT NOT NULL,
    samples INTEGER NOT NULL,
    reusable INTEGER NOT NULL,
    report_json TEXT NOT NULL,
    scene_json TEXT NOT NULL
) STRICT;

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

// What each version added to the one before: the first is from 1 to 2.
constexpr std::array<const char*, kSchemaVersion - 1> kSteps{
    "ALTER TABLE jobs ADD COLUMN no_cache INTEGER NOT NULL DEFAULT 0",
};

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
        db.execute(kSchema);
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
    for (auto step = static_cast<std::size_t>(version - 1); step < kSteps.size(); ++step)
        db.execute(kSteps[step]);
    set_version(db);
    db.execute("COMMIT");
}

void void_leases(SqliteConnection& db, std::int64_t now_ms)
{
    db.execute("BEGIN IMMEDIATE");
    db.prepare("UPDATE jobs SET state = 4, finished_ms = ?1 WHERE state = 1 AND cancel_requested = 1")
        .bind(now_ms)
        .run();
    db.execute("UPDATE jobs SET state = 0, started_ms = NULL WHERE state = 1");
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
