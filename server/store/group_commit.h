// GroupCommit: the one writer of a database: a thread that folds every request that came while it was
// committing into its next transaction.
//
// Durability  run() returns after its transaction was committed. `synced`: it outlasts a power cut; else it
//             outlasts the process, and is synced with the next one that is.
// Errors      what a request throws undoes that request alone and reaches its caller; a transaction that
//             fails throws StoreError to every caller in it.
// Threads     any. Cost: one fdatasync a transaction with a synced request in it, none without.
#pragma once

#include "server/store/sqlite_connection.h"
#include "server/store/sqlite_store.h"

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace server {

enum class Durability : std::uint8_t { written, synced };

class GroupCommit {
public:
    using Work = std::function<void(SqliteConnection&)>;

    explicit GroupCommit(std::unique_ptr<SqliteConnection> db);
    ~GroupCommit(); // commits what waits
    GroupCommit(const GroupCommit&) = delete;
    GroupCommit& operator=(const GroupCommit&) = delete;

    void run(Durability durability, const Work& work);
    CommitCounts counts() const;
    bool storage_full() const;   // a write found the disk full, and none has worked since
    std::size_t waiting() const; // requests that the next transaction will carry

private:
    struct Request {
        const Work& work;
        Durability durability;
        std::exception_ptr error{};
        bool done = false;
    };
    using Batch = std::vector<Request*>; // of callers who wait

    void write_batches(const std::stop_token& stop);
    void commit(const Batch& batch);
    void apply(const Batch& batch);
    void apply_one(Request& request);
    void choose_sync(const Batch& batch);
    void move_log();

    std::unique_ptr<SqliteConnection> db_; // the thread's alone
    Durability durability_ = Durability::synced;
    bool log_doubtful_ = false;

    mutable std::mutex mutex_; // of waiting_, done, counts_, storage_full_
    std::condition_variable_any came_;
    std::condition_variable done_;
    Batch waiting_;
    CommitCounts counts_;
    bool storage_full_ = false;
    std::jthread thread_; // last: stops first
};

} // namespace server
