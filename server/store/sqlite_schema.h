// The job database's shape, and how a writer opens it: checked, migrated, every lease void.
//
// Errors  StoreError that names the file and says what to do: damaged, of a newer version, not ours.
#pragma once

#include "server/store/sqlite_connection.h"

#include <cstdint>
#include <filesystem>
#include <memory>

namespace server {

std::unique_ptr<SqliteConnection> open_sqlite_writer(const std::filesystem::path& file, std::int64_t now_ms);
// A write that changes nothing: does the disk take one?
void touch_database(SqliteConnection& db);
// Cannot write, never checkpoints.
std::unique_ptr<SqliteConnection> open_sqlite_reader(const std::filesystem::path& file);

} // namespace server
