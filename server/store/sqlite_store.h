// SqliteStore: the embedded store: SQLite in WAL mode, synchronous=FULL, one writer that folds waiting
// commits into one transaction (group commit, no timer). Leases live in memory: every lease is void at start,
// so what was running is queued again, its attempts kept (and canceled where that was asked).
//
// Durability  a transaction in which somebody waits for durability is synced; one of workers' words alone is
//             written and synced with the next one, so the death of the process loses nothing, a power cut at
//             most those.
// Errors      StoreError; a damaged database, or one of a newer version, is refused at open, with its path. A
//             commit that fails fails every request that was folded into it; the next ones are tried anew, so
//             the store works again when the disk does.
// Process     one process at a time may open a file (DataFolder sees to it): SQLite before 3.51.3 can damage
//             a database when two connections write or checkpoint at the same instant.
#pragma once

#include "server/store/store.h"

#include <cstdint>
#include <filesystem>
#include <memory>

namespace server {

struct CommitCounts {
    std::uint64_t requests = 0;     // that were acknowledged
    std::uint64_t transactions = 0; // that carried them
};

class SqliteStore : public Store {
public:
    virtual CommitCounts commit_counts() const = 0;
};

std::unique_ptr<SqliteStore> open_sqlite_store(const std::filesystem::path& file, StoreClock clock = {});

} // namespace server
