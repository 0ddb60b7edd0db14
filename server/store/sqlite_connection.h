// SqliteConnection and SqliteStatement: SQLite's C interface as values that close themselves.
//
// Threads  a connection and its statements belong to one thread at a time.
// Errors   StoreError with SQLite's words; a full disk told apart.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace server {

// A statement in use; its connection keeps it compiled for the next use. One use of the same SQL at a time.
class SqliteStatement {
public:
    SqliteStatement(sqlite3* db, sqlite3_stmt* compiled) : db_(db), compiled_(compiled) {}
    ~SqliteStatement();
    SqliteStatement(const SqliteStatement&) = delete;
    SqliteStatement& operator=(const SqliteStatement&) = delete;

    // Values of ?1, ?2, ...: integers, text (copied) and optional integers (nothing: NULL).
    template <typename... Values>
    SqliteStatement& bind(const Values&... values)
    {
        int index = 0;
        (bind_at(++index, values), ...);
        return *this;
    }
    void bind_at(int index, std::int64_t value);
    void bind_at(int index, std::string_view value);
    void bind_at(int index, std::optional<std::int64_t> value);

    bool step(); // true: a row
    void run();  // to the end
    std::int64_t integer(int column) const;
    std::string text(int column) const;
    bool is_null(int column) const;
    std::optional<std::int64_t> optional_integer(int column) const;

private:
    sqlite3* db_;
    sqlite3_stmt* compiled_;
};

class SqliteConnection {
public:
    enum class Open : std::uint8_t { existing, create };

    SqliteConnection(const std::filesystem::path& file, Open open);
    ~SqliteConnection();
    SqliteConnection(const SqliteConnection&) = delete;
    SqliteConnection& operator=(const SqliteConnection&) = delete;

    SqliteStatement prepare(const std::string& sql);
    void execute(const char* sql); // one or more statements, no values, rows ignored
    std::int64_t integer(const std::string& sql);
    std::int64_t changes() const; // rows of the last statement
    std::int64_t last_row() const;
    bool in_transaction() const;

    // Pages in the write-ahead log after the last commit of this connection.
    int log_pages() const { return log_pages_; }
    std::uint64_t commits() const
    {
        return commits_;
    } // of this connection, those that wrote nothing left out
    enum class Checkpoint : std::uint8_t { passive, truncate };
    void checkpoint(Checkpoint mode); // passive: as far as readers let it

private:
    sqlite3* db_ = nullptr;
    std::map<std::string, sqlite3_stmt*, std::less<>> compiled_;
    int log_pages_ = 0;
    std::uint64_t commits_ = 0;
};

} // namespace server
