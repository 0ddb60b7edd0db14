#include "server/store/group_commit.h"

#include "server/store/store.h"

#include <algorithm>
#include <utility>

namespace server {

namespace {

constexpr int kPagesToMove = 1000; // 4 MiB of log

bool is_storage_full(const std::exception_ptr& error)
{
    try {
        if (error) std::rethrow_exception(error);
    } catch (const StoreError& of_store) {
        return of_store.storage_full;
    } catch (...) {
        return false; // the request's own
    }
    return false;
}

} // namespace

GroupCommit::GroupCommit(std::unique_ptr<SqliteConnection> db)
    : db_(std::move(db)), thread_([this](const std::stop_token& stop) { write_batches(stop); })
{
}

GroupCommit::~GroupCommit() = default;

void GroupCommit::run(Durability durability, const Work& work)
{
    Request request{work, durability};
    std::unique_lock lock(mutex_);
    waiting_.push_back(&request);
    came_.notify_one();
    done_.wait(lock, [&] { return request.done; });
    if (request.error) std::rethrow_exception(request.error);
}

CommitCounts GroupCommit::counts() const
{
    const std::lock_guard lock(mutex_);
    return counts_;
}

bool GroupCommit::storage_full() const
{
    const std::lock_guard lock(mutex_);
    return storage_full_;
}

std::size_t GroupCommit::waiting() const
{
    const std::lock_guard lock(mutex_);
    return waiting_.size();
}

void GroupCommit::write_batches(const std::stop_token& stop)
{
    std::unique_lock lock(mutex_);
    for (;;) {
        came_.wait(lock, stop, [&] { return !waiting_.empty(); });
        if (waiting_.empty()) return;
        const Batch batch = std::exchange(waiting_, {});
        lock.unlock();
        const std::uint64_t commits = db_->commits();
        commit(batch);
        const bool wrote = db_->commits() != commits,
                   refused = std::any_of(
                       batch.begin(), batch.end(), [](Request*r) { return is_storage_full(r->error); });
        lock.lock();
        if (wrote || refused) storage_full_ = refused; // who only looked has not learned anything
        const auto failed =
            std::count_if(batch.begin(), batch.end(), [](Request* r) { return r->error != nullptr; });
        counts_.requests += batch.size() - static_cast<std::size_t>(failed);
        if (static_cast<std::size_t>(failed) < batch.size()) ++counts_.transactions;
        for (Request* request : batch)
            request->done = true;
        done_.notify_all();
        lock.unlock();
        move_log();
        lock.lock();
    }
}

// Nobody is told that it worked before COMMIT did.
void GroupCommit::commit(const Batch& batch)
{
    try {
        apply(batch);
    } catch (...) {
        const std::exception_ptr error = std::current_exception();
        log_doubtful_ = true;
        for (Request* request : batch)
            request->error = error;
        try {
            if (db_->in_transaction()) db_->execute("ROLLBACK");
        } catch (const StoreError&) {
            // SQLite rolled back already; if not, the next BEGIN fails and says so.
        }
    }
}

void GroupCommit::apply(const Batch& batch)
{
    if (log_doubtful_) {
        // After a failed fsync the kernel may have dropped pages of earlier, unsynced commits while later
        // ones would be synced behind the gap: nothing goes into this log again before all of it is in the
        // database.
        db_->checkpoint(SqliteConnection::Checkpoint::truncate);
        log_doubtful_ = false;
    }
    choose_sync(batch);
    db_->execute("BEGIN IMMEDIATE");
    for (Request* request : batch)
        apply_one(*request);
    db_->execute("COMMIT");
}

void GroupCommit::apply_one(Request& request)
{
    db_->execute("SAVEPOINT request");
    try {
        request.work(*db_);
    } catch (...) {
        request.error = std::current_exception();
        if (!db_->in_transaction()) throw; // a full disk or an I/O error took the whole transaction
        db_->execute("ROLLBACK TO request");
    }
    db_->execute("RELEASE request");
}

void GroupCommit::choose_sync(const Batch& batch)
{
    const bool synced = std::any_of(batch.begin(), batch.end(), [](const Request* request) {
        return request->durability == Durability::synced;
    });
    const Durability wanted = synced ? Durability::synced : Durability::written;
    if (wanted == durability_) return;
    db_->execute(synced ? "PRAGMA synchronous=FULL" : "PRAGMA synchronous=NORMAL");
    durability_ = wanted;
}

// Here and not in the commit, so that nobody waits for it unless more comes.
void GroupCommit::move_log()
{
    if (db_->log_pages() < kPagesToMove) return;
    try {
        db_->checkpoint(SqliteConnection::Checkpoint::passive);
    } catch (const StoreError&) {
        // What is in the log is safe there; the next round tries again, and a full disk shows in the commits.
    }
}

} // namespace server
