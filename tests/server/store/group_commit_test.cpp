// Writers that wait at once share a transaction.
#include "server/store/group_commit.h"
#include "server/store/sqlite_connection.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace {

using server::SqliteConnection;
using tests::TempFolder;

// The writer is held while so many threads submit a request each: when it is let go, they are in one transaction.
void run_while_held(server::GroupCommit& writer, unsigned count, const std::function<void(int)>& submit)
{
    std::promise<void> entered, let_go;
    std::thread holder([&] {
        writer.run(server::Durability::synced, [&](SqliteConnection&) {
            entered.set_value();
            let_go.get_future().wait();
        });
    });
    entered.get_future().wait();
    std::vector<std::thread> threads;
    for (unsigned t = 0; t < count; ++t)
        threads.emplace_back(submit, static_cast<int>(t));
    while (writer.waiting() < count)
        std::this_thread::yield();
    let_go.set_value();
    holder.join();
    for (std::thread& thread : threads)
        thread.join();
}

TEST(GroupCommit, FoldsWhatWaitsIntoOneTransaction)
{
    const TempFolder folder;
    auto db = std::make_unique<SqliteConnection>(folder.path() / "db", SqliteConnection::Open::create);
    db->execute("PRAGMA journal_mode=WAL; CREATE TABLE t(n INTEGER)");
    server::GroupCommit writer(std::move(db));
    const auto insert = [](SqliteConnection& c) { c.execute("INSERT INTO t VALUES(1)"); };

    run_while_held(writer, 16, [&](int) { writer.run(server::Durability::synced, insert); });
    EXPECT_EQ(writer.counts().requests, 17U);
    EXPECT_EQ(writer.counts().transactions, 2U);
}

TEST(GroupCommit, UndoesAFailedRequestAndKeepsItsNeighbours)
{
    const TempFolder folder;
    const auto file = folder.path() / "db";
    auto db = std::make_unique<SqliteConnection>(file, SqliteConnection::Open::create);
    db->execute("PRAGMA journal_mode=WAL; CREATE TABLE t(n INTEGER UNIQUE)");
    server::GroupCommit writer(std::move(db));

    std::atomic<int> refused{0};
    run_while_held(writer, 6, [&](int t) {
        try {
            writer.run(server::Durability::synced, [&](SqliteConnection& c) {
                c.prepare("INSERT INTO t VALUES(?1)").bind(std::int64_t{t}).run();
                if (t == 1) throw std::runtime_error("for its own reason");
                if (t == 2) c.execute("INSERT INTO t VALUES(2)"); // not unique
            });
        } catch (const std::exception&) {
            ++refused;
        }
    });
    EXPECT_EQ(refused, 2);
    EXPECT_EQ(writer.counts().transactions, 2U);
    SqliteConnection reader(file, SqliteConnection::Open::existing);
    EXPECT_EQ(reader.integer("SELECT count(*) FROM t"), 4);
    EXPECT_EQ(reader.integer("SELECT count(*) FROM t WHERE n IN (1, 2)"), 0);
}

} // namespace
