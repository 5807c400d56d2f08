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

/// A prepared statement, which ends with its scope.
class Statement {
public:
    Statement() = default;
    /// @param guard of a statement that has only so much time
    Statement(sqlite3* database, const std::string& path, const std::string& sql,
              std::shared_ptr<QueryGuard> guard = nullptr);

    Statement& bind(int position, double value); ///< NULL unless finite
    Statement& bind(int position, std::int64_t value);
    Statement& bind(int position, std::size_t value) { return bind(position, static_cast<std::int64_t>(value)); }
    /// The text must live until the statement has run.
    Statement& bind(int position, std::string_view text);
    /// The same of a text that need not.
    Statement& bind_copy(int position, std::string_view text);
    Statement& bind_null(int position);
    /// @return whether there is a row
    bool step();
    /// A number that may be infinite, which other numbers are not: they are then missing.
    Statement& bind_extended(int position, double value);
    /// Runs a statement without rows, for it to be run again.
    void run();
    /// Lets a statement whose rows have been read be run again.
    void reset();

    int columns() const { return sqlite3_column_count(statement_.get()); }
    bool is_null(int column) const { return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL; }
    int type(int column) const { return sqlite3_column_type(statement_.get(), column); }
    double number(int column) const { return sqlite3_column_double(statement_.get(), column); }
    std::int64_t integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
    std::string text(int column) const;
    std::string name(int column) const { return sqlite3_column_name(statement_.get(), column); }

private:
    struct Finish {
        void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
    };
    std::unique_ptr<sqlite3_stmt, Finish> statement_;
    std::string path_;
    std::shared_ptr<QueryGuard> guard_; // goes before the statement does, which keeps the connection alive
    QueryGuard::Clock::duration left_{};
};

/// A connection to one file.
class Database {
public:
    /// @throws InputError when it cannot be opened, or is no plain file
    Database(const std::string& path, bool writing);

    /// A statement of ours. From a connection that only reads, it has only so much time.
    Statement prepare(const std::string& sql) const;
    /// A statement of somebody else's: it reads, has only so much time, and nothing follows it.
    Statement prepare_query(const std::string& sql) const;
    /// From now on nothing but reading, for good.
    void only_read() { guard_->only_read(); }
    void set_patience(QueryGuard::Clock::duration patience) { guard_->set_patience(patience); }
    /// @throws InputError when the file that was opened is no longer there under its name
    void require_present() const;
    /// Several statements without results.
    void execute(const std::string& sql) const;
    /// The one whole number that a query gives.
    std::int64_t value(const std::string& sql) const;
    const std::string& path() const { return path_; }

private:
    struct Close {
        void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
    };
    std::string path_;
    std::uint64_t device_ = 0, file_ = 0; ///< which the path led to
    std::unique_ptr<sqlite3, Close> database_;
    std::shared_ptr<QueryGuard> guard_;
};

/// What SQLite says has gone wrong, as a message with a remedy. @throws InputError
[[noreturn]] void throw_database_error(int code, const std::string& message, const std::string& path);

/// A name as SQL writes it, between double quotes.
std::string quoted_name(std::string_view name);
/// A text as SQL writes it, between single quotes.
std::string text_literal(std::string_view text);
/// Texts as SQL lists them.
std::string text_literals(const std::vector<std::string>& texts);

} // namespace graze
