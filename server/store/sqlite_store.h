// SqliteStore: the embedded store: SQLite in WAL mode, synchronous=FULL, one writer that folds waiting
// commits into one transaction (group commit, no timer). Leases live in memory: every lease is void at start,
// so what was running is queued again.
//
// Errors  StoreError; a damaged database is refused at open, with its path.
#pragma once

#include "server/store/store.h"

#include <filesystem>
#include <memory>

namespace server {

std::unique_ptr<Store> open_sqlite_store(const std::filesystem::path& file);

} // namespace server
