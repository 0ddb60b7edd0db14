// SqliteReaders: connections that only read, lent to whoever reads, each read one snapshot.
//
// Threads  any; readers wait neither for each other nor for the writer.
// Errors   StoreError; a connection that failed is not lent again.
#pragma once

#include "server/store/sqlite_connection.h"
#include "server/store/sqlite_schema.h"

#include <filesystem>
#include <memory>
#include <mutex>
#include <type_traits>
#include <utility>
#include <vector>

namespace server {

class SqliteReaders {
public:
    explicit SqliteReaders(std::filesystem::path file) : file_(std::move(file)) {}

    template <typename Read>
    auto read(const Read& read) -> std::invoke_result_t<Read, SqliteConnection&>
    {
        std::unique_ptr<SqliteConnection> db = lend();
        db->execute("BEGIN");
        auto answer = read(*db);
        db->execute("COMMIT");
        take_back(std::move(db));
        return answer;
    }

private:
    static constexpr std::size_t kIdleKept = 8;

    std::unique_ptr<SqliteConnection> lend()
    {
        {
            const std::lock_guard lock(mutex_);
            if (!idle_.empty()) {
                std::unique_ptr<SqliteConnection> db = std::move(idle_.back());
                idle_.pop_back();
                return db;
            }
        }
        return open_sqlite_reader(file_);
    }

    void take_back(std::unique_ptr<SqliteConnection> db)
    {
        const std::lock_guard lock(mutex_);
        if (idle_.size() < kIdleKept) idle_.push_back(std::move(db));
    }

    std::filesystem::path file_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<SqliteConnection>> idle_;
};

} // namespace server
