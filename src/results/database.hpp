#pragma once

#include "results/query_guard.hpp"

#include <sqlite3.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Exclusive right of one process to write a file. Released by the destructor, or when the process ends.
class WriteLock {
public:
    /// @throws InputError if another process has the right, or the folder cannot be written
    explicit WriteLock(const std::string& path);
    ~WriteLock();
    WriteLock(const WriteLock&) = delete;
    WriteLock& operator=(const WriteLock&) = delete;

private:
    std::string path_;
    int file_ = -1;
};

/// A prepared statement, finalized by its destructor.
class Statement {
public:
    Statement() = default;
    /// @param guard limits the time that the statement may run; null: no limit
    Statement(sqlite3* database, const std::string& path, const std::string& sql,
              std::shared_ptr<QueryGuard> guard = nullptr);

    Statement& bind(int position, double value); ///< NULL unless finite
    Statement& bind(int position, std::int64_t value);
    Statement& bind(int position, std::size_t value) { return bind(position, static_cast<std::int64_t>(value)); }
    /// The text is not copied, and must live until the statement has run.
    Statement& bind(int position, std::string_view text);
    /// The text is copied.
    Statement& bind_copy(int position, std::string_view text);
    Statement& bind_null(int position);
    /// @return whether there is a row
    bool step();
    /// Binds a number that may be infinite; NULL only if it is NaN.
    Statement& bind_extended(int position, double value);
    /// Runs a statement that gives no rows, and resets it.
    void run();
    /// The same with values, which are bound from left to right.
    template <class First, class... Others>
    void run(const First& first, const Others&... others) {
        bind_all(first, others...);
        run();
    }
    template <class... Values>
    Statement& bind_all(const Values&... values) {
        int position = 0;
        (bind(++position, values), ...);
        return *this;
    }
    /// Resets a statement whose rows have been read, so that it can be run again.
    void reset();

    int columns() const { return sqlite3_column_count(statement_.get()); }
    bool is_null(int column) const { return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL; }
    int type(int column) const { return sqlite3_column_type(statement_.get(), column); }
    double number(int column) const { return sqlite3_column_double(statement_.get(), column); }
    std::int64_t integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
    std::string text(int column) const;
    std::string name(int column) const { return sqlite3_column_name(statement_.get(), column); }

private:
    void require_bound(int code) const;
    /// @throws InputError for a text that SQLite would leave out
    void require_room_for(std::string_view text) const;
    struct Finish {
        void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
    };
    std::unique_ptr<sqlite3_stmt, Finish> statement_;
    std::string path_;
    std::shared_ptr<QueryGuard> guard_; // destroyed before the statement, which keeps the connection open
    QueryGuard::Clock::duration left_{};
};

/// A connection to one file.
class Database {
public:
    /// @throws InputError if it cannot be opened, or is no regular file
    Database(const std::string& path, bool writing);

    /// Prepares a statement of this program. Its time is limited if the connection only reads.
    Statement prepare(const std::string& sql) const;
    /// Prepares a statement from an untrusted source: a single statement that only reads, in limited time.
    Statement prepare_query(const std::string& sql) const;
    /// Allows only reading from now on.
    void only_read() { guard_->only_read(); }
    void set_patience(QueryGuard::Clock::duration patience) { guard_->set_patience(patience); }
    /// @throws InputError if the opened file has been removed or replaced
    void require_present() const;
    /// Executes one or several statements without results.
    void execute(const std::string& sql) const;
    /// Writes all that is there to a new file. @throws InputError
    void copy_to(const std::string& path) const;
    /// The whole number that a query gives.
    std::int64_t value(const std::string& sql) const;
    const std::string& path() const { return path_; }

private:
    struct Close {
        void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
    };
    std::string path_;
    std::uint64_t device_ = 0, file_ = 0; ///< identify the opened file
    std::unique_ptr<sqlite3, Close> database_;
    std::shared_ptr<QueryGuard> guard_;
};

/// Throws the error that SQLite reports, with a remedy. @throws InputError
[[noreturn]] void throw_database_error(int code, const std::string& message, const std::string& path);

/// A name in SQL, in double quotes.
std::string quoted_name(std::string_view name);
/// A text in SQL, in single quotes.
std::string text_literal(std::string_view text);
/// Texts in SQL, separated by commas.
std::string text_literals(const std::vector<std::string>& texts);

} // namespace graze
