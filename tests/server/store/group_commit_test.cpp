// Writers that wait at once share a transaction.
#include "server/store/group_commit.h"
#include "server/store/sqlite_connection.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

namespace {

using server::SqliteConnection;
using tests::TempFolder;

// The writer is held while sixteen threads submit: when it is let go, they are in one transaction.
TEST(GroupCommit, FoldsWhatWaitsIntoOneTransaction)
{
    const TempFolder folder;
    auto db = std::make_unique<SqliteConnection>(folder.path() / "db", SqliteConnection::Open::create);
    db->execute("PRAGMA journal_mode=WAL; CREATE TABLE t(n INTEGER)");
    server::GroupCommit writer(std::move(db));
    const auto insert = [](SqliteConnection& c) { c.execute("INSERT INTO t VALUES(1)"); };

    std::promise<void> entered, let_go;
    std::thread holder([&] {
        writer.run(server::Durability::synced, [&](SqliteConnection&) {
            entered.set_value();
            let_go.get_future().wait();
        });
    });
    entered.get_future().wait();
    std::vector<std::thread> threads;
    for (int t = 0; t < 16; ++t)
        threads.emplace_back([&] { writer.run(server::Durability::synced, insert); });
    while (writer.waiting() < 16)
        std::this_thread::yield();
    let_go.set_value();
    holder.join();
    for (std::thread& thread : threads)
        thread.join();
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

    std::promise<void> entered, let_go;
    std::thread holder([&] {
        writer.run(server::Durability::written, [&](SqliteConnection&) {
            entered.set_value();
            let_go.get_future().wait();
        });
    });
    entered.get_future().wait();
    std::atomic<int> refused{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 6; ++t)
        threads.emplace_back([&, t] {
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
    while (writer.waiting() < 6)
        std::this_thread::yield();
    let_go.set_value();
    holder.join();
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(refused, 2);
    EXPECT_EQ(writer.counts().transactions, 2U);
    SqliteConnection reader(file, SqliteConnection::Open::existing);
    EXPECT_EQ(reader.integer("SELECT count(*) FROM t"), 4);
    EXPECT_EQ(reader.integer("SELECT count(*) FROM t WHERE n IN (1, 2)"), 0);
}

} // namespace
