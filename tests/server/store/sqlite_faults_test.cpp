// The embedded store on a disk that fails: every call that can fail is failed once, and a small disk is
// really full.
#include "server/store/blob_store.h"
#include "server/store/sqlite_store.h"
#include "tests/server/store/store_fixture.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <new>
#include <set>
#include <sqlite3.h>
#include <sys/mount.h>

namespace {

using server::open_sqlite_store;
using server::StoredState;
using server::StoreError;
using server::SubmitStatus;
using tests::a_request;
using tests::a_result;
using tests::kTtl;
using tests::TempFolder;

// A layer over SQLite's file system, the default while it lives, that counts syncs and fails one call by
// number.
class FaultyDisk {
public:
    FaultyDisk()
    {
        vfs_ = *real_;
        vfs_.zName = "faulty";
        vfs_.pAppData = this;
        vfs_.szOsFile = static_cast<int>(sizeof(File)) + real_->szOsFile;
        vfs_.xOpen = [](sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags, int* out) {
            return static_cast<FaultyDisk*>(vfs->pAppData)->open(name, file, flags, out);
        };
        sqlite3_vfs_register(&vfs_, 1);
    }
    ~FaultyDisk()
    {
        sqlite3_vfs_unregister(&vfs_);
        sqlite3_vfs_register(real_, 1);
    }
    FaultyDisk(const FaultyDisk&) = delete;
    FaultyDisk& operator=(const FaultyDisk&) = delete;

    // The call of this number from now on (0: the next write, sync or truncation) and `times` in all answer
    // `code`.
    void fail_at(int call, int code, int times = 1)
    {
        code_ = code;
        first_failing_ = calls_ + call;
        end_failing_ = first_failing_ + times;
    }
    bool failed() const { return failed_; }
    int syncs() const { return syncs_; }

private:
    struct File {
        sqlite3_file base;
        FaultyDisk* disk;
        sqlite3_file* real() { return reinterpret_cast<sqlite3_file*>(this + 1); }
    };
    static File* file_of(sqlite3_file* file) { return reinterpret_cast<File*>(file); }
    static sqlite3_file* real_of(sqlite3_file* file) { return file_of(file)->real(); }

    int open(const char* name, sqlite3_file* file, int flags, int* out)
    {
        File* layered = new (file) File{{nullptr}, this};
        const int code = real_->xOpen(real_, name, layered->real(), flags, out);
        if (layered->real()->pMethods != nullptr) layered->base.pMethods = methods();
        return code;
    }

    int fate()
    {
        const int call = calls_++;
        if (call < first_failing_ || call >= end_failing_) return SQLITE_OK;
        failed_ = true;
        return code_;
    }

    static const sqlite3_io_methods* methods();

    sqlite3_vfs* real_ = sqlite3_vfs_find(nullptr);
    sqlite3_vfs vfs_{};
    std::atomic<int> calls_{0}, syncs_{0}, first_failing_{-1}, end_failing_{-1}, code_{SQLITE_OK};
    std::atomic<bool> failed_{false};
};

const sqlite3_io_methods* FaultyDisk::methods()
{
    static const sqlite3_io_methods table = [] {
        sqlite3_io_methods m{};
        m.iVersion = 2; // shared memory, but no mapped pages
        m.xClose = [](sqlite3_file* f) { return real_of(f)->pMethods->xClose(real_of(f)); };
        m.xRead = [](sqlite3_file* f, void* to, int n, sqlite3_int64 at) {
            return real_of(f)->pMethods->xRead(real_of(f), to, n, at);
        };
        m.xWrite = [](sqlite3_file* f, const void* from, int n, sqlite3_int64 at) {
            const int fate = file_of(f)->disk->fate();
            return fate != SQLITE_OK ? fate : real_of(f)->pMethods->xWrite(real_of(f), from, n, at);
        };
        m.xTruncate = [](sqlite3_file* f, sqlite3_int64 size) {
            const int fate = file_of(f)->disk->fate();
            return fate != SQLITE_OK ? fate : real_of(f)->pMethods->xTruncate(real_of(f), size);
        };
        m.xSync = [](sqlite3_file* f, int flags) {
            ++file_of(f)->disk->syncs_;
            const int fate = file_of(f)->disk->fate();
            return fate != SQLITE_OK ? fate : real_of(f)->pMethods->xSync(real_of(f), flags);
        };
        m.xFileSize = [](sqlite3_file* f, sqlite3_int64* n) {
            return real_of(f)->pMethods->xFileSize(real_of(f), n);
        };
        m.xLock = [](sqlite3_file* f, int lock) { return real_of(f)->pMethods->xLock(real_of(f), lock); };
        m.xUnlock = [](sqlite3_file* f, int lock) { return real_of(f)->pMethods->xUnlock(real_of(f), lock); };
        m.xCheckReservedLock = [](sqlite3_file* f, int* out) {
            return real_of(f)->pMethods->xCheckReservedLock(real_of(f), out);
        };
        m.xFileControl = [](sqlite3_file* f, int op, void* arg) {
            return real_of(f)->pMethods->xFileControl(real_of(f), op, arg);
        };
        m.xSectorSize = [](sqlite3_file* f) { return real_of(f)->pMethods->xSectorSize(real_of(f)); };
        m.xDeviceCharacteristics = [](sqlite3_file* f) {
            return real_of(f)->pMethods->xDeviceCharacteristics(real_of(f));
        };
        m.xShmMap = [](sqlite3_file* f, int page, int size, int extend, void volatile** out) {
            return real_of(f)->pMethods->xShmMap(real_of(f), page, size, extend, out);
        };
        m.xShmLock = [](sqlite3_file* f, int offset, int n, int flags) {
            return real_of(f)->pMethods->xShmLock(real_of(f), offset, n, flags);
        };
        m.xShmBarrier = [](sqlite3_file* f) { real_of(f)->pMethods->xShmBarrier(real_of(f)); };
        m.xShmUnmap = [](sqlite3_file* f, int remove) {
            return real_of(f)->pMethods->xShmUnmap(real_of(f), remove);
        };
        return m;
    }();
    return &table;
}

// Submits until `count` are acknowledged; the ids. What throws must be a StoreError of the right kind.
std::set<std::string> submit_through(server::Store& store, int count, bool full)
{
    std::set<std::string> acknowledged;
    for (int attempt = 0; static_cast<int>(acknowledged.size()) < count; ++attempt) {
        if (attempt > count + 20) throw std::runtime_error("the store does not recover");
        try {
            acknowledged.insert(store.submit(a_request("job")).job.id);
        } catch (const StoreError& error) {
            EXPECT_EQ(error.storage_full, full) << error.what();
        }
    }
    return acknowledged;
}

class FailingCall : public testing::TestWithParam<int> {};

std::string fault_name(const testing::TestParamInfo<int>& tested)
{
    if (tested.param == SQLITE_FULL) return "DiskFull";
    return tested.param == SQLITE_IOERR_FSYNC ? "SyncFails" : "WriteFails";
}

INSTANTIATE_TEST_SUITE_P(Every,
                         FailingCall,
                         testing::Values(SQLITE_FULL, SQLITE_IOERR_FSYNC, SQLITE_IOERR_WRITE),
                         fault_name);

TEST_P(FailingCall, LosesNothingAcknowledgedAndIsReported)
{
    for (int call = 0; call < 36; ++call) {
        const TempFolder folder;
        const auto file = folder.path() / "jobs.sqlite";
        FaultyDisk disk;
        std::set<std::string> acknowledged;
        {
            const auto store = open_sqlite_store(file);
            acknowledged = submit_through(*store, 1, false);
            disk.fail_at(call, GetParam(), 3);
            acknowledged.merge(submit_through(*store, 12, GetParam() == SQLITE_FULL));
            EXPECT_TRUE(disk.failed());
            for (const std::string& id : acknowledged)
                EXPECT_TRUE(store->get("alice", id)) << "lost " << id << ", failing call " << call;
            EXPECT_EQ(store->depth().queued, acknowledged.size()) << "what was refused must not be there";
        }
        const auto store = open_sqlite_store(file);
        for (const std::string& id : acknowledged)
            EXPECT_TRUE(store->get("alice", id)) << "lost " << id << " at the restart, failing call " << call;
    }
}

TEST(SqliteStore, RefusesAllWhileTheDiskIsFullAndStillReads)
{
    const TempFolder folder;
    FaultyDisk disk;
    const auto store = open_sqlite_store(folder.path() / "jobs.sqlite");
    const auto id = store->submit(a_request("before")).job.id;
    EXPECT_FALSE(store->storage_full());
    disk.fail_at(0, SQLITE_FULL, 1'000'000);
    EXPECT_FALSE(store->storage_full()) << "nobody has tried yet";
    for (int i = 0; i < 5; ++i) {
        EXPECT_THROW(store->submit(a_request("refused")), StoreError);
        EXPECT_THROW(store->cancel("alice", id, 1), StoreError);
        EXPECT_THROW(store->claim("worker", 1, kTtl), StoreError);
        EXPECT_EQ(store->get("alice", id)->state, StoredState::queued);
        EXPECT_EQ(store->list({.tenant = "alice"}).jobs.size(), 1U);
        EXPECT_TRUE(store->storage_full());
    }
    disk.fail_at(0, SQLITE_OK, 0);
    EXPECT_EQ(store->claim("worker", 1, kTtl).at(0).job, id) << "a claim that failed leases nothing";
    EXPECT_EQ(store->get("alice", id)->attempts, 1U);
    EXPECT_EQ(store->submit(a_request("after")).status, SubmitStatus::accepted);
    EXPECT_FALSE(store->storage_full());

    disk.fail_at(0, SQLITE_FULL, 1'000'000);
    EXPECT_THROW(store->submit(a_request("refused")), StoreError);
    disk.fail_at(0, SQLITE_OK, 0);
    EXPECT_FALSE(store->storage_full()) << "it finds out by itself";
}

TEST(SqliteStore, SyncsWhatClientsAreToldAndWritesWhatWorkersSay)
{
    const TempFolder folder;
    FaultyDisk disk;
    const auto store = open_sqlite_store(folder.path() / "jobs.sqlite");
    const auto first = store->submit(a_request("first")).job.id; // the first commit also makes the log
    const auto syncs_of = [&](const auto& action) {
        const int before = disk.syncs();
        action();
        return disk.syncs() - before;
    };
    EXPECT_EQ(syncs_of([&] { store->submit(a_request("second")); }), 1) << "one fdatasync a submission";
    server::Lease lease;
    EXPECT_EQ(syncs_of([&] { lease = store->claim("worker", 1, kTtl).at(0); }), 0);
    EXPECT_EQ(syncs_of([&] { store->complete(lease, a_result("first"), 1); }), 0);
    EXPECT_EQ(store->get("alice", first)->state, StoredState::succeeded) << "and everyone reads it";
    EXPECT_EQ(syncs_of([&] { store->remove("alice", first); }), 1);
    EXPECT_EQ(syncs_of([&] { lease = store->claim("worker", 1, kTtl).at(0); }), 0);
    EXPECT_EQ(syncs_of([&] { store->cancel("alice", lease.job, 1); }), 1);
    EXPECT_EQ(syncs_of([&] { store->confirm_cancel(lease, 1); }), 0);
}

// A file system of a few megabytes, mounted where that is allowed.
class SmallDisk {
public:
    SmallDisk() { mounted_ = mount("tmpfs", folder_.path().c_str(), "tmpfs", 0, "size=3m") == 0; }
    ~SmallDisk()
    {
        if (mounted_) umount2(folder_.path().c_str(), MNT_DETACH);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;

    bool mounted() const { return mounted_; }
    const std::filesystem::path& path() const { return folder_.path(); }
    void grow() const
    {
        ASSERT_EQ(mount("tmpfs", path().c_str(), "tmpfs", MS_REMOUNT, "size=64m"), 0) << strerror(errno);
    }

private:
    TempFolder folder_;
    bool mounted_ = false;
};

TEST(FullDisk, RefusesWithStorageFullAndGoesOnWhenThereIsRoom)
{
    const SmallDisk disk;
    if (!disk.mounted()) GTEST_SKIP() << "mounting a small tmpfs is not allowed here: " << strerror(errno);
    server::BlobStore blobs(disk.path());
    const auto file = disk.path() / "jobs.sqlite";
    std::set<std::string> acknowledged;
    {
        const auto store = open_sqlite_store(file);
        auto request = a_request("large");
        request.spec.request_json = std::string(20'000, 'x');
        int refused = 0;
        while (refused < 10) {
            try {
                acknowledged.insert(store->submit(request).job.id);
            } catch (const StoreError& error) {
                EXPECT_TRUE(error.storage_full) << error.what();
                ++refused;
            }
        }
        EXPECT_GT(acknowledged.size(), 10U);
        const std::vector<std::byte> blob(4 << 20);
        try {
            blobs.put(server::BlobStore::Kind::asset, blob);
            ADD_FAILURE() << "4 MiB on a full disk of 3";
        } catch (const StoreError& error) {
            EXPECT_TRUE(error.storage_full) << error.what();
        }
        EXPECT_EQ(blobs.total_bytes(server::BlobStore::Kind::asset), 0U);
        EXPECT_TRUE(store->get("alice", *acknowledged.begin()));
        EXPECT_TRUE(store->storage_full());
        disk.grow();
        EXPECT_FALSE(store->storage_full());
        EXPECT_TRUE(
            blobs.has(server::BlobStore::Kind::asset, blobs.put(server::BlobStore::Kind::asset, blob)));
        acknowledged.insert(store->submit(request).job.id);
        EXPECT_EQ(store->depth().queued, acknowledged.size());
    }
    const auto store = open_sqlite_store(file);
    for (const std::string& id : acknowledged)
        EXPECT_TRUE(store->get("alice", id)) << "lost " << id;
}

} // namespace
