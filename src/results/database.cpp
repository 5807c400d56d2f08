#include "results/database.hpp"

#include "graze/base/input_error.hpp"
#include "graze/results/query_interruption.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace graze {

namespace {

/// A path as a URI for SQLite, with special characters escaped.
std::string uri_of(const std::string& path, bool unchanging) {
    std::string uri = "file:";
    for (const char c : path)
        uri += c == '%' || c == '?' || c == '#' ? fmt::format("%{:02X}", static_cast<unsigned char>(c))
                                                : std::string(1, c);
    return uri + (unchanging ? "?immutable=1" : "");
}

/// Time that a query may take: 30 s, plus the time to read the file slowly.
QueryGuard::Clock::duration patience_with(const std::string& path) {
    constexpr double least = 30, bytes_of_a_second = 1e6;
    std::error_code error;
    const auto size = std::filesystem::file_size(path, error);
    const double seconds = least + (error ? 0 : static_cast<double>(size) / bytes_of_a_second);
    return std::chrono::duration_cast<QueryGuard::Clock::duration>(std::chrono::duration<double>(seconds));
}

/// Refuses pipes, for which SQLite would wait, and writing through links, which would change a file elsewhere.
void require_plain_file(const std::string& path, bool writing) {
    std::error_code error;
    const auto type = std::filesystem::status(path, error).type();
    if (type != std::filesystem::file_type::regular && type != std::filesystem::file_type::not_found)
        throw FileError(path, "this is no plain file", "give the results.sqlite of a study, or its folder");
    if (writing && std::filesystem::is_symlink(path, error))
        throw FileError(path, "this is a link, and results are written only into the folder itself",
                        "remove the link, or choose the folder that it leads to");
}

} // namespace

WriteLock::WriteLock(const std::string& path) : path_(path + ".lock") {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file_ < 0)
        throw FileError(path, std::string("it cannot be written (") + std::strerror(errno) + ")",
                        "look at the permissions of the folder, or choose another one");
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
        ::close(file_);
        throw FileError(path, "another graze writes to this result file",
                        "wait until it has ended, or choose another folder");
    }
}

WriteLock::~WriteLock() {
    // The file is not removed: another process may have just opened it, and would then lock a file without a name.
    ::close(file_);
}

void throw_database_error(int code, const std::string& message, const std::string& path) {
    const Place place{path, 0, 0};
    switch (code & 0xff) {
    case SQLITE_FULL:
    case SQLITE_IOERR:
        throw FileError(path, fmt::format("it cannot be written to ({})", message),
                        "make room on the disk and run the same command again: it goes on from what is there");
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
        throw FileError(path, fmt::format("the result file cannot be opened or written ({})", message),
                        "look at the permissions of file and folder, or choose another folder");
    case SQLITE_AUTH:
        throw InputError(place, fmt::format("a query may only read ({})", message), "give one SELECT");
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
        throw FileError(path, "another program uses the result file", "wait for it, or choose another folder");
    case SQLITE_CORRUPT:
        throw InputError(place, fmt::format("the file is damaged ({})", message),
                         "ask for another copy, or run the study again into another folder");
    case SQLITE_NOTADB:
        throw InputError(place, fmt::format("this is no result file of graze ({})", message),
                         "give the results.sqlite of a study, or its folder");
    case SQLITE_INTERRUPT:
        if (QueryInterruption::requested())
            throw InputError(place, "the query was interrupted", "ask again");
        throw InputError(place, "a query takes too long",
                         "ask for less; if the file is a stranger's, it may be made to do so");
    case SQLITE_TOOBIG:
        throw InputError(place, "a text in the result file, or made by a query, is too long", "ask for less");
    default:
        throw InputError(place, message, "look at the tables and columns that docs/result-file.md describes");
    }
}

namespace {

/// The text between quotes; quotes within the text are doubled.
std::string in_quotes(std::string_view text, char quote) {
    std::string result(1, quote);
    for (const char c : text) {
        result += c;
        if (c == quote)
            result += c;
    }
    return result + quote;
}

} // namespace

std::string quoted_name(std::string_view name) {
    return in_quotes(name, '"');
}

std::string text_literal(std::string_view text) {
    return in_quotes(text, '\'');
}

std::string text_literals(const std::vector<std::string>& texts) {
    std::string list;
    for (const std::string& text : texts)
        list += (list.empty() ? "" : ",") + text_literal(text);
    return list;
}

Database::Database(const std::string& path, bool writing) : path_(path) {
    require_plain_file(path, writing);
    const auto open = [&](bool unchanging) {
        sqlite3* database = nullptr;
        const int flags =
            SQLITE_OPEN_URI | (writing ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY);
        const int code = sqlite3_open_v2(uri_of(path, unchanging).c_str(), &database, flags, nullptr);
        guard_.reset();
        database_.reset(database);
        if (code != SQLITE_OK)
            return code;
        sqlite3_busy_timeout(database, 2000);
        guard_ = std::make_shared<QueryGuard>(database, patience_with(path));
        return sqlite3_exec(database, "SELECT count(*) FROM sqlite_master", nullptr, nullptr, nullptr);
    };
    int code = open(false);
    // In a folder that cannot be written, no process changes the file, so that it can be opened without locks.
    if (!writing && ((code & 0xff) == SQLITE_CANTOPEN || (code & 0xff) == SQLITE_READONLY))
        code = open(true);
    if (code != SQLITE_OK)
        throw_database_error(code, database_ ? sqlite3_errmsg(database_.get()) : "out of memory", path);
    struct stat status {};
    if (::stat(path.c_str(), &status) == 0) {
        device_ = status.st_dev;
        file_ = status.st_ino;
    }
}

Statement Database::prepare(const std::string& sql) const {
    return {database_.get(), path_, sql, guard_->only_reads() ? guard_ : nullptr};
}

Statement Database::prepare_query(const std::string& sql) const {
    if (guard_->only_reads())
        return {database_.get(), path_, sql, guard_};
    const std::shared_ptr<void> reading = QueryGuard::reading_only(database_.get());
    return {database_.get(), path_, sql, guard_};
}

void Database::require_present() const {
    struct stat status {};
    if (::stat(path_.c_str(), &status) != 0 || status.st_dev != device_ || status.st_ino != file_)
        throw InputError(Place{path_, 0, 0}, "the result file has been removed or replaced while it was written to",
                         "run the same command again, and leave its folder alone");
}

void Database::execute(const std::string& sql) const {
    const int code = sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr);
    if (code != SQLITE_OK)
        throw_database_error(code, sqlite3_errmsg(database_.get()), path_);
}

void Database::copy_to(const std::string& path) const {
    // The copy is attached while it is written, which is not allowed otherwise.
    const int allowed = sqlite3_limit(database_.get(), SQLITE_LIMIT_ATTACHED, 1);
    const std::string sql = "VACUUM INTO " + text_literal(path);
    const int code = sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr);
    const std::string message = sqlite3_errmsg(database_.get());
    sqlite3_limit(database_.get(), SQLITE_LIMIT_ATTACHED, allowed);
    if (code == SQLITE_OK)
        return;
    // A plain error comes before anything is written: a file that is there then is somebody else's.
    std::error_code error;
    if ((code & 0xff) != SQLITE_ERROR)
        std::filesystem::remove(path, error);
    throw_database_error(code, message, (code & 0xff) == SQLITE_CORRUPT ? path_ : path);
}

std::int64_t Database::value(const std::string& sql) const {
    Statement statement = prepare(sql);
    return statement.step() ? statement.integer(0) : 0;
}

Statement::Statement(sqlite3* database, const std::string& path, const std::string& sql,
                     std::shared_ptr<QueryGuard> guard)
    : path_(path), guard_(std::move(guard)), left_(guard_ ? guard_->patience() : QueryGuard::Clock::duration{}) {
    constexpr std::size_t longest_query = 1'000'000;
    if (sql.size() > longest_query || sql.find('\0') != std::string::npos)
        throw InputError(Place{path, 0, 0}, "the query is too long, or has a zero byte in it", "give one SELECT");
    sqlite3_stmt* statement = nullptr;
    const char *end = sql.c_str() + sql.size(), *rest = nullptr;
    const int code = sqlite3_prepare_v2(database, sql.c_str(), static_cast<int>(sql.size()), &statement, &rest);
    statement_.reset(statement);
    if (code != SQLITE_OK)
        throw_database_error(code, sqlite3_errmsg(database), path);
    if (!statement)
        throw InputError(Place{path, 0, 0}, "the query is empty", "give one SELECT");
    // Only blanks, comments and semicolons may follow.
    while (rest != nullptr && rest < end) {
        sqlite3_stmt* another = nullptr;
        const int wrong = sqlite3_prepare_v2(database, rest, static_cast<int>(end - rest), &another, &rest);
        sqlite3_finalize(another);
        if (wrong != SQLITE_OK || another != nullptr)
            throw InputError(Place{path, 0, 0}, "something follows the query's first statement", "give one SELECT");
    }
}

void Statement::require_bound(int code) const {
    if (code == SQLITE_RANGE)
        throw InputError(Place{path_, 0, 0}, "more values are given than the query has places for",
                         "give one for each of ?1, ?2, ...");
    if (code != SQLITE_OK)
        throw_database_error(code, sqlite3_errmsg(sqlite3_db_handle(statement_.get())), path_);
}

void Statement::require_room_for(std::string_view text) const {
    const int most = sqlite3_limit(sqlite3_db_handle(statement_.get()), SQLITE_LIMIT_LENGTH, -1);
    if (text.size() <= static_cast<std::size_t>(most))
        return;
    constexpr double megabyte = 1e6;
    throw InputError(Place{path_, 0, 0},
                     fmt::format("a text of {:.0f} MB, such as that of a whole study, does not fit into a result file, "
                                 "which takes {:.0f} MB",
                                 static_cast<double>(text.size()) / megabyte, most / megabyte),
                     "vary fewer values, or divide the study");
}

Statement& Statement::bind(int position, double value) {
    if (!std::isfinite(value))
        return bind_null(position);
    require_bound(sqlite3_bind_double(statement_.get(), position, value));
    return *this;
}

Statement& Statement::bind_extended(int position, double value) {
    if (std::isnan(value))
        return bind_null(position);
    require_bound(sqlite3_bind_double(statement_.get(), position, value));
    return *this;
}

Statement& Statement::bind(int position, std::int64_t value) {
    require_bound(sqlite3_bind_int64(statement_.get(), position, value));
    return *this;
}

Statement& Statement::bind(int position, std::string_view text) {
    require_room_for(text);
    require_bound(
        sqlite3_bind_text(statement_.get(), position, text.data(), static_cast<int>(text.size()), SQLITE_STATIC));
    return *this;
}

Statement& Statement::bind_copy(int position, std::string_view text) {
    require_room_for(text);
    require_bound(sqlite3_bind_text(statement_.get(), position, text.empty() ? "" : text.data(),
                                    static_cast<int>(text.size()), SQLITE_TRANSIENT));
    return *this;
}

Statement& Statement::bind_null(int position) {
    require_bound(sqlite3_bind_null(statement_.get(), position));
    return *this;
}

bool Statement::step() {
    const auto advance = [&] {
        if (!guard_)
            return sqlite3_step(statement_.get());
        const QueryGuard::Watch watch(*guard_, left_);
        return sqlite3_step(statement_.get());
    };
    const int code = advance();
    if (code == SQLITE_ROW)
        return true;
    if (code == SQLITE_DONE)
        return false;
    const std::string message = sqlite3_errmsg(sqlite3_db_handle(statement_.get()));
    sqlite3_reset(statement_.get());
    throw_database_error(code, message, path_);
}

void Statement::reset() {
    sqlite3_reset(statement_.get());
}

void Statement::run() {
    step();
    sqlite3_reset(statement_.get());
}

std::string Statement::text(int column) const {
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
    return text ? std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column)))
                : std::string();
}

} // namespace graze
