// What only a store on disk can show: it outlives its process, refuses what is damaged.
#include "server/store/sqlite_connection.h"
#include "server/store/sqlite_store.h"
#include "tests/server/store/store_fixture.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <future>
#include <set>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace {

using server::open_sqlite_store;
using server::SqliteConnection;
using server::StoredState;
using server::StoreError;
using server::SubmitStatus;
using tests::a_request;
using tests::a_result;
using tests::kTtl;
using tests::TempFolder;

std::string refusal_of(const std::filesystem::path& file)
{
    try {
        open_sqlite_store(file);
        return "(opened)";
    } catch (const StoreError& error) {
        return error.what();
    }
}

TEST(SqliteStore, KeepsEverythingOverARestartAndQueuesWhatWasRunning)
{
    const TempFolder folder;
    const auto file = folder.path() / "jobs.sqlite";
    auto keyed = a_request("keyed", 99);
    keyed.idempotency_key = "key-1";
    std::string done, running, canceling, queued;
    server::Lease lost;
    {
        const auto store = open_sqlite_store(file);
        done = store->submit(keyed).job.id;
        store->complete(store->claim("worker", 1, kTtl).at(0), a_result("keyed"), 5);
        running = store->submit(a_request("running", 90)).job.id;
        canceling = store->submit(a_request("canceling", 80)).job.id;
        queued = store->submit(a_request("queued", 70)).job.id;
        lost = store->claim("worker", 2, kTtl).at(0);
        store->cancel("alice", canceling, 6);
    }
    const auto store = open_sqlite_store(file);
    EXPECT_EQ(store->get("alice", done)->result, a_result("keyed"));
    EXPECT_EQ(store->get("alice", done)->spec.request_json, keyed.spec.request_json);
    EXPECT_EQ(store->get("alice", done)->spec.labels, keyed.spec.labels);
    EXPECT_EQ(store->submit(keyed).status, SubmitStatus::replayed);
    EXPECT_EQ(store->get("alice", running)->state, StoredState::queued);
    EXPECT_EQ(store->get("alice", running)->attempts, 1U) << "an attempt that a restart ended counts";
    EXPECT_EQ(store->get("alice", canceling)->state, StoredState::canceled);
    EXPECT_TRUE(store->get("alice", canceling)->finished_ms);
    EXPECT_FALSE(store->complete(lost, a_result("zombie"), 7)) << "every lease is void";

    const auto leases = store->claim("worker", 9, kTtl);
    ASSERT_EQ(leases.size(), 2U);
    EXPECT_EQ(leases[0].job, running);
    EXPECT_GT(leases[0].epoch, lost.epoch);
    EXPECT_EQ(leases[1].job, queued);
}

// In a child: submits from four threads, writes an id to `out` once it is acknowledged, works a little, never
// ends.
[[noreturn]] void submit_for_ever(const std::filesystem::path& file, int out)
{
    const auto store = open_sqlite_store(file);
    const auto submit = [&] {
        for (;;) {
            const std::string id = store->submit(a_request("job")).job.id + '\n';
            if (::write(out, id.data(), id.size()) < 0) _exit(1);
        }
    };
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back(submit);
    for (;;)
        for (const auto& lease : store->claim("worker", 1, kTtl))
            store->release({lease});
}

// Kills a child that submits after `count` acknowledgements; all that it gave.
std::set<std::string> acknowledged_before_kill(const std::filesystem::path& file, int count)
{
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("pipe");
    const pid_t child = fork();
    if (child == 0) submit_for_ever(file, ends[1]);
    close(ends[1]);
    std::set<std::string> ids;
    FILE* lines = fdopen(ends[0], "r");
    char line[64];
    while (fgets(line, sizeof line, lines) != nullptr) {
        const std::string text = line;
        if (text.size() == 33) ids.insert(text.substr(0, 32));
        if (static_cast<int>(ids.size()) == count) kill(child, SIGKILL);
    }
    fclose(lines);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
    return ids;
}

TEST(SqliteStore, LosesNothingAcknowledgedWhenItsProcessIsKilled)
{
    const TempFolder folder;
    const auto file = folder.path() / "jobs.sqlite";
    std::set<std::string> acknowledged;
    for (int round = 0; round < 20; ++round) {
        acknowledged.merge(acknowledged_before_kill(file, 1 + 7 * round));
        const auto store = open_sqlite_store(file);
        EXPECT_EQ(store->depth().leased, 0U);
        for (const std::string& id : acknowledged) {
            const auto job = store->get("alice", id);
            ASSERT_TRUE(job) << "lost " << id << " in round " << round;
            EXPECT_EQ(job->spec.labels.size(), 2U) << "half a job";
            EXPECT_EQ(job->spec.asset_digests.size(), 2U) << "half a job";
        }
    }
    EXPECT_GE(acknowledged.size(), 20U + 7U * 190U);
}

TEST(SqliteStore, RefusesADamagedFileByName)
{
    const TempFolder folder;
    const auto file = folder.path() / "jobs.sqlite";
    {
        const auto store = open_sqlite_store(file);
        for (int i = 0; i < 200; ++i)
            store->submit(a_request("job " + std::to_string(i)));
    }
    const auto size = std::filesystem::file_size(file);
    ASSERT_GT(size, 10U * 4096U);
    {
        std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
        for (std::size_t page = 1; page < size / 4096; ++page) {
            bytes.seekp(static_cast<std::streamoff>(page * 4096));
            bytes.write("\x0D\xFF\xFF\xFF\xFF\xFF\xFF\xFF", 8);
        }
    }
    EXPECT_NE(refusal_of(file).find(file.string()), std::string::npos) << refusal_of(file);
    EXPECT_NE(refusal_of(file).find("restore a backup"), std::string::npos) << refusal_of(file);

    std::filesystem::resize_file(file, size / 2);
    EXPECT_NE(refusal_of(file).find(file.string()), std::string::npos) << refusal_of(file);
    std::ofstream(file, std::ios::trunc) << "this is a text and not a database, whatever its name may say";
    EXPECT_NE(refusal_of(file).find("not a database"), std::string::npos) << refusal_of(file);
    EXPECT_NE(refusal_of(folder.path() / "none" / "jobs.sqlite").find("none/jobs.sqlite"), std::string::npos);
}

// As the programs of before version 3 left it.
void make_old(const std::filesystem::path& file, int version)
{
    std::filesystem::remove(file);
    SqliteConnection db(file, SqliteConnection::Open::create);
    db.execute((std::string(R"sql(
CREATE TABLE jobs(seq INTEGER PRIMARY KEY AUTOINCREMENT, id TEXT NOT NULL UNIQUE, tenant TEXT NOT NULL,
    state INTEGER NOT NULL, priority INTEGER NOT NULL, epoch INTEGER NOT NULL DEFAULT 0,
    attempts INTEGER NOT NULL DEFAULT 0, cancel_requested INTEGER NOT NULL DEFAULT 0,
    reused INTEGER NOT NULL DEFAULT 0, created_ms INTEGER NOT NULL, started_ms INTEGER, finished_ms INTEGER,
    render_key TEXT NOT NULL, error_json TEXT NOT NULL DEFAULT '')sql") +
                (version == 2 ? ", no_cache INTEGER NOT NULL DEFAULT 0" : "") + R"sql() STRICT;
CREATE INDEX jobs_waiting ON jobs(priority DESC, seq) WHERE state = 0;
CREATE INDEX jobs_open ON jobs(state) WHERE state IN (0, 1);
CREATE INDEX jobs_reusable ON jobs(tenant, render_key, seq) WHERE state = 2;
CREATE INDEX jobs_of_tenant ON jobs(tenant, seq);
CREATE INDEX jobs_in_state ON jobs(tenant, state, seq);
CREATE INDEX jobs_ended ON jobs(finished_ms) WHERE finished_ms IS NOT NULL;
CREATE TABLE requests(job INTEGER PRIMARY KEY REFERENCES jobs(seq) ON DELETE CASCADE,
    request_json TEXT NOT NULL) STRICT;
CREATE TABLE results(job INTEGER PRIMARY KEY REFERENCES jobs(seq) ON DELETE CASCADE,
    image_digest TEXT NOT NULL, samples INTEGER NOT NULL, reusable INTEGER NOT NULL,
    report_json TEXT NOT NULL, scene_json TEXT NOT NULL) STRICT;
CREATE TABLE labels(job INTEGER NOT NULL REFERENCES jobs(seq) ON DELETE CASCADE, name TEXT NOT NULL,
    value TEXT NOT NULL, PRIMARY KEY (job, name)) STRICT, WITHOUT ROWID;
CREATE INDEX labels_by_value ON labels(name, value, job);
CREATE TABLE job_assets(job INTEGER NOT NULL REFERENCES jobs(seq) ON DELETE CASCADE, place INTEGER NOT NULL,
    digest TEXT NOT NULL, PRIMARY KEY (job, place)) STRICT, WITHOUT ROWID;
CREATE TABLE idempotency_keys(tenant TEXT NOT NULL, key TEXT NOT NULL, body_digest TEXT NOT NULL,
    job INTEGER NOT NULL REFERENCES jobs(seq) ON DELETE CASCADE, created_ms INTEGER NOT NULL,
    PRIMARY KEY (tenant, key)) STRICT, WITHOUT ROWID;
CREATE INDEX idempotency_keys_of_job ON idempotency_keys(job);
CREATE INDEX idempotency_keys_by_age ON idempotency_keys(created_ms);
INSERT INTO jobs(id, tenant, state, priority, created_ms, finished_ms, render_key, error_json) VALUES
    ('waits', 'alice', 0, 50, 1, NULL, 'key 1', ''), ('done', 'alice', 2, 50, 1, 2, 'key 2', ''),
    ('broken', 'alice', 3, 50, 1, 3, 'key 3', '{"code":"broken_mesh"}');
INSERT INTO requests VALUES (1, 'request 1'), (2, 'request 2'), (3, 'request 3');
INSERT INTO results VALUES (2, 'sha256:picture', 64, 1, 'report', 'scene');
PRAGMA application_id=1214606441;
PRAGMA user_version=)sql" +
                std::to_string(version))
                   .c_str());
}

TEST(SqliteStore, TakesUpADatabaseOfBeforeLayers)
{
    const TempFolder folder;
    const auto file = folder.path() / "jobs.sqlite";
    open_sqlite_store(file)->submit(a_request("was here"));
    {
        SqliteConnection db(file, SqliteConnection::Open::existing);
        db.execute("ALTER TABLE jobs DROP COLUMN layers; PRAGMA user_version=3");
    }
    const auto store = open_sqlite_store(file);
    const auto jobs = store->list({.tenant = "alice"}).jobs;
    ASSERT_EQ(jobs.size(), 1U);
    EXPECT_EQ(jobs[0].spec.layers, 0U);
    auto request = a_request("new");
    request.spec.layers = 3;
    EXPECT_EQ(store->find("alice", store->submit(request).job.id)->spec.layers, 3U);
}

TEST(SqliteStore, TakesUpADatabaseOfAnEarlierVersion)
{
    for (const int version : {1, 2}) {
        const TempFolder folder;
        const auto file = folder.path() / "jobs.sqlite";
        make_old(file, version);
        for (int start = 0; start < 2; ++start) {
            const auto store = open_sqlite_store(file);
            EXPECT_EQ(store->get("alice", "waits")->spec.request_json, "request 1");
            EXPECT_FALSE(store->get("alice", "waits")->spec.no_cache);
            const auto done = store->get("alice", "done");
            EXPECT_EQ(done->spec.request_json, "request 2");
            EXPECT_EQ(done->result->image_digest, "sha256:picture");
            EXPECT_EQ(done->result->report_json, "report");
            EXPECT_EQ(done->result->scene_json, "scene");
            EXPECT_EQ(store->find("alice", "broken")->failure.whole_json, "{\"code\":\"broken_mesh\"}");
            auto request = a_request("new");
            request.spec.no_cache = true;
            EXPECT_TRUE(store->get("alice", store->submit(request).job.id)->spec.no_cache);
        }
        const auto store = open_sqlite_store(file);
        for (const char* id : {"done", "broken"})
            EXPECT_TRUE(store->remove("alice", id));
        SqliteConnection db(file, SqliteConnection::Open::existing);
        EXPECT_EQ(db.integer("SELECT count(*) FROM texts"), 2)
            << "of the one that waits, and of the new ones";
        EXPECT_EQ(db.integer("SELECT count(*) FROM text_bodies"), 2);
    }
}

TEST(SqliteStore, KeepsATextOnceAndAsLongAsOneJobHasIt)
{
    const TempFolder folder;
    const auto file = folder.path() / "jobs.sqlite";
    const auto store = open_sqlite_store(file);
    auto request = a_request("shared");
    request.spec.request_json = std::string(1 << 20, 'x');
    server::JobResult result = a_result("shared");
    result.report_json = std::string(1 << 20, 'r');
    result.scene_json = std::string(1 << 20, 's');
    std::vector<std::string> ids{store->submit(request).job.id};
    EXPECT_TRUE(store->complete(store->claim("w", 1, tests::kTtl).at(0), result, 1));
    const std::uint64_t one = store->stored_bytes();
    EXPECT_GT(one, 3U << 20);
    for (int i = 0; i < 20; ++i)
        ids.push_back(store->submit(request).job.id);
    EXPECT_LT(store->stored_bytes(), one + (1 << 20)) << "twenty more have the same texts";
    for (std::size_t i = 0; i + 1 < ids.size(); ++i)
        EXPECT_TRUE(store->remove("alice", ids[i]));
    EXPECT_EQ(store->get("alice", ids.back())->result, result);
    EXPECT_EQ(store->get("alice", ids.back())->spec.request_json, request.spec.request_json);
    EXPECT_TRUE(store->remove("alice", ids.back()));
    EXPECT_LT(store->stored_bytes(), 1U << 20) << "with the last one they go";
    SqliteConnection db(file, SqliteConnection::Open::existing);
    EXPECT_EQ(db.integer("SELECT count(*) FROM texts"), 0);
    EXPECT_EQ(db.integer("SELECT count(*) FROM text_bodies"), 0);
}

TEST(SqliteStore, RefusesANewerVersionAndAnotherProgramsDatabase)
{
    const TempFolder folder;
    const auto file = folder.path() / "jobs.sqlite";
    open_sqlite_store(file);
    SqliteConnection(file, SqliteConnection::Open::existing).execute("PRAGMA user_version=1000");
    EXPECT_NE(refusal_of(file).find("newer program"), std::string::npos) << refusal_of(file);

    const auto other = folder.path() / "other.sqlite";
    SqliteConnection(other, SqliteConnection::Open::create).execute("CREATE TABLE mine(a)");
    EXPECT_NE(refusal_of(other).find("another program"), std::string::npos) << refusal_of(other);
    EXPECT_EQ(SqliteConnection(other, SqliteConnection::Open::existing).integer("SELECT count(*) FROM mine"),
              0);
}

TEST(SqliteStore, CommitsFewerTimesThanItAcknowledges)
{
    const TempFolder folder;
    const auto store = open_sqlite_store(folder.path() / "jobs.sqlite");
    std::vector<std::thread> threads;
    for (int t = 0; t < 16; ++t)
        threads.emplace_back([&] {
            for (int i = 0; i < 25; ++i)
                store->submit(a_request("job"));
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(store->commit_counts().requests, 400U);
    EXPECT_LT(store->commit_counts().transactions, 400U);
    EXPECT_EQ(store->depth().queued, 400U);
}

TEST(SqliteStore, EmptiesItsLogAsItGrowsAndAtTheEnd)
{
    const TempFolder folder;
    const auto file = folder.path() / "jobs.sqlite";
    {
        const auto store = open_sqlite_store(file);
        auto request = a_request("large");
        request.spec.request_json = std::string(1 << 20, 'x');
        for (int i = 0; i < 30; ++i)
            store->submit(request);
        EXPECT_LT(std::filesystem::file_size(folder.path() / "jobs.sqlite-wal"), 16U << 20);
    }
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "jobs.sqlite-wal"));
    EXPECT_EQ(open_sqlite_store(file)->depth().queued, 30U);
}

} // namespace
