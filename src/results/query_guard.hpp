#pragma once

#include <sqlite3.h>

#include <chrono>
#include <cstdint>
#include <memory>

namespace graze {

/// Limits what queries can do, since a query or a file may come from an untrusted source; for example, a view in a file
/// can run endlessly. Belongs to one connection, and must not be moved.
class QueryGuard {
public:
    using Clock = std::chrono::steady_clock;

    /// Disables features that result files do not need: triggers, functions with side effects in views, loading of
    /// code, attaching of files, texts longer than 64 MiB.
    /// @param patience time that one query may take
    QueryGuard(sqlite3* database, Clock::duration patience);
    ~QueryGuard();
    QueryGuard(const QueryGuard&) = delete;
    QueryGuard& operator=(const QueryGuard&) = delete;

    /// While what it returns lives, only statements that read can be prepared.
    static std::shared_ptr<void> reading_only(sqlite3* database);
    /// Allows only statements that read, from now on.
    void only_read();
    bool only_reads() const { return only_reads_; }

    /// To exist while a statement runs, which is interrupted when it has no time left.
    class Watch {
    public:
        Watch(QueryGuard& guard, Clock::duration& left);
        ~Watch();
        Watch(const Watch&) = delete;
        Watch& operator=(const Watch&) = delete;

    private:
        QueryGuard* guard_;
        Clock::duration* left_;
        Clock::time_point begun_;
    };

    Clock::duration patience() const { return patience_; }
    void set_patience(Clock::duration patience) { patience_ = patience; }

private:
    static int has_to_stop(void* guard);

    sqlite3* database_;
    Clock::duration patience_;
    Clock::time_point deadline_ = Clock::time_point::max();
    bool only_reads_ = false;
};

} // namespace graze
