#include "results/query_guard.hpp"

#include "graze/results/query_interruption.hpp"

#include <string_view>

namespace graze {

namespace {

constexpr int instructions_between_checks = 20000; ///< of SQLite's virtual machine; they take about 0.1 ms
constexpr int longest_value = 64 << 20;

/// Permits reading rows and computing with them. Every other action is denied.
int authorize(void* /*nothing*/, int action, const char* /*first*/, const char* second, const char* /*database*/,
              const char* /*view*/) {
    switch (action) {
    case SQLITE_SELECT:
    case SQLITE_READ:
    case SQLITE_RECURSIVE:
        return SQLITE_OK;
    case SQLITE_FUNCTION:
        return second != nullptr && std::string_view(second) != "load_extension" &&
                       std::string_view(second) != "fts3_tokenizer"
                   ? SQLITE_OK
                   : SQLITE_DENY;
    default:
        return SQLITE_DENY;
    }
}

} // namespace

QueryGuard::QueryGuard(sqlite3* database, Clock::duration patience) : database_(database), patience_(patience) {
    sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0, nullptr);
    sqlite3_limit(database, SQLITE_LIMIT_ATTACHED, 0);
    sqlite3_limit(database, SQLITE_LIMIT_LENGTH, longest_value);
    sqlite3_progress_handler(database, instructions_between_checks, has_to_stop, this);
}

QueryGuard::~QueryGuard() {
    sqlite3_progress_handler(database_, 0, nullptr, nullptr);
}

int QueryGuard::has_to_stop(void* guard) {
    return Clock::now() > static_cast<QueryGuard*>(guard)->deadline_ || QueryInterruption::requested() ? 1 : 0;
}

std::shared_ptr<void> QueryGuard::reading_only(sqlite3* database) {
    sqlite3_set_authorizer(database, authorize, nullptr);
    return {database, [](sqlite3* one) { sqlite3_set_authorizer(one, nullptr, nullptr); }};
}

void QueryGuard::only_read() {
    sqlite3_set_authorizer(database_, authorize, nullptr);
    only_reads_ = true;
}

QueryGuard::Watch::Watch(QueryGuard& guard, Clock::duration& left)
    : guard_(&guard), left_(&left), begun_(Clock::now()) {
    guard.deadline_ = begun_ + left;
}

QueryGuard::Watch::~Watch() {
    guard_->deadline_ = Clock::time_point::max();
    *left_ -= Clock::now() - begun_;
}

} // namespace graze
