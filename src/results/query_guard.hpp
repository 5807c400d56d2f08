#pragma once

#include <sqlite3.h>

#include <chrono>
#include <cstdint>
#include <memory>

namespace graze {

/// Keeps within bounds what queries do, which strangers may have written, and what a stranger's file makes of ours:
/// a view can run for ever. Belongs to one connection, at an address that stays.
class QueryGuard {
public:
    using Clock = std::chrono::steady_clock;

    /// Takes from the connection what no result file needs: triggers, functions with side effects in views, loading of
    /// code, attaching of files, texts longer than 64 MiB.
    /// @param patience with one query
    QueryGuard(sqlite3* database, Clock::duration patience);
    ~QueryGuard();
    QueryGuard(const QueryGuard&) = delete;
    QueryGuard& operator=(const QueryGuard&) = delete;

    /// While it lives, only statements that read can be prepared.
    class ReadingOnly {
    public:
        explicit ReadingOnly(sqlite3* database);
        ~ReadingOnly();
        ReadingOnly(const ReadingOnly&) = delete;
        ReadingOnly& operator=(const ReadingOnly&) = delete;

    private:
        sqlite3* database_;
    };
    /// From now on, for good.
    void only_read();
    bool only_reads() const { return only_reads_; }

    /// While it lives, a statement runs; it is broken off when nothing is left of its time.
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
    static int look_at_clock(void* guard);

    sqlite3* database_;
    Clock::duration patience_;
    Clock::time_point deadline_ = Clock::time_point::max();
    bool only_reads_ = false;
};

} // namespace graze
