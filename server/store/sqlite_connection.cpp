#include "server/store/sqlite_connection.h"

#include "server/store/store.h"

#include <cassert>
#include <cerrno>
#include <sqlite3.h>

namespace server {

namespace {

[[noreturn]] void throw_error(sqlite3* db, int code, const std::string& action)
{
    const int primary = code & 0xFF;
    const int system = db != nullptr ? sqlite3_system_errno(db) : 0;
    // A delayed allocation fails in fsync, and the log's index in ftruncate: both come as an I/O error.
    const bool full =
        primary == SQLITE_FULL || (primary == SQLITE_IOERR && (system == ENOSPC || system == EDQUOT));
    std::string what = "job database: " + action + ": ";
    what += db != nullptr ? sqlite3_errmsg(db) : sqlite3_errstr(code);
    throw StoreError(what + " (SQLite " + std::to_string(code) + ')', full);
}

void require(sqlite3* db, int code, const std::string& action)
{
    if (code != SQLITE_OK) throw_error(db, code, action);
}

} // namespace

SqliteStatement::~SqliteStatement()
{
    sqlite3_reset(compiled_);
    sqlite3_clear_bindings(compiled_);
}

void SqliteStatement::bind_at(int index, std::int64_t value)
{
    require(db_, sqlite3_bind_int64(compiled_, index, value), "bind");
}

void SqliteStatement::bind_at(int index, std::string_view value)
{
    const char* text = value.data() != nullptr ? value.data() : ""; // a null pointer would be NULL
    require(db_,
            sqlite3_bind_text64(compiled_, index, text, value.size(), SQLITE_TRANSIENT, SQLITE_UTF8),
            "bind");
}

void SqliteStatement::bind_at(int index, std::optional<std::int64_t> value)
{
    if (value)
        bind_at(index, *value);
    else
        require(db_, sqlite3_bind_null(compiled_, index), "bind");
}

bool SqliteStatement::step()
{
    const int code = sqlite3_step(compiled_);
    if (code == SQLITE_ROW) return true;
    if (code != SQLITE_DONE) throw_error(db_, code, sqlite3_sql(compiled_));
    return false;
}

void SqliteStatement::run()
{
    while (step()) {
    }
}

std::int64_t SqliteStatement::integer(int column) const
{
    return sqlite3_column_int64(compiled_, column);
}

std::string SqliteStatement::text(int column) const
{
    const unsigned char* text = sqlite3_column_text(compiled_, column);
    if (text == nullptr) return {};
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(compiled_, column));
    return {reinterpret_cast<const char*>(text), size};
}

bool SqliteStatement::is_null(int column) const
{
    return sqlite3_column_type(compiled_, column) == SQLITE_NULL;
}

std::optional<std::int64_t> SqliteStatement::optional_integer(int column) const
{
    if (is_null(column)) return std::nullopt;
    return integer(column);
}

SqliteConnection::SqliteConnection(const std::filesystem::path& file, Open open)
{
    const int flags =
        SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX | (open == Open::create ? SQLITE_OPEN_CREATE : 0);
    const int code = sqlite3_open_v2(file.c_str(), &db_, flags, nullptr);
    if (code != SQLITE_OK) {
        const std::string words = db_ != nullptr ? sqlite3_errmsg(db_) : sqlite3_errstr(code);
        const bool full = db_ != nullptr && sqlite3_system_errno(db_) == ENOSPC;
        sqlite3_close(db_);
        throw StoreError("cannot open " + file.string() + ": " + words, full);
    }
    sqlite3_extended_result_codes(db_, 1);
    // In the place of SQLite's own hook, which would checkpoint inside the commit.
    const auto note_commit = [](void* connection, sqlite3*, const char*, int count) {
        auto& self = *static_cast<SqliteConnection*>(connection);
        self.log_pages_ = count;
        ++self.commits_;
        return SQLITE_OK;
    };
    sqlite3_wal_hook(db_, note_commit, this);
}

SqliteConnection::~SqliteConnection()
{
    for (const auto& [sql, compiled] : compiled_)
        sqlite3_finalize(compiled);
    sqlite3_close(db_);
}

SqliteStatement SqliteConnection::prepare(const std::string& sql)
{
    sqlite3_stmt*& compiled = compiled_[sql];
    if (compiled == nullptr) {
        const int code =
            sqlite3_prepare_v3(db_, sql.c_str(), -1, SQLITE_PREPARE_PERSISTENT, &compiled, nullptr);
        require(db_, code, sql);
    }
    assert(sqlite3_stmt_busy(compiled) == 0);
    return {db_, compiled};
}

void SqliteConnection::execute(const char* sql)
{
    require(db_, sqlite3_exec(db_, sql, nullptr, nullptr, nullptr), sql);
}

std::int64_t SqliteConnection::integer(const std::string& sql)
{
    SqliteStatement statement = prepare(sql);
    return statement.step() ? statement.integer(0) : 0;
}

std::int64_t SqliteConnection::changes() const
{
    return sqlite3_changes64(db_);
}

std::int64_t SqliteConnection::last_row() const
{
    return sqlite3_last_insert_rowid(db_);
}

bool SqliteConnection::in_transaction() const
{
    return sqlite3_get_autocommit(db_) == 0;
}

void SqliteConnection::checkpoint(Checkpoint mode)
{
    const int how = mode == Checkpoint::passive ? SQLITE_CHECKPOINT_PASSIVE : SQLITE_CHECKPOINT_TRUNCATE;
    int pages = 0;
    int moved = 0;
    require(db_, sqlite3_wal_checkpoint_v2(db_, nullptr, how, &pages, &moved), "checkpoint");
    log_pages_ = pages - moved;
}

} // namespace server
