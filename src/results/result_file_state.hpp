#pragma once

#include "graze/base/input_error.hpp"
#include "graze/results/result_file.hpp"
#include "results/database.hpp"
#include "results/run_columns.hpp"
#include "results/schema.hpp"

#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace graze {

/// The connection to the file, and the transaction in which points are written, which is committed when the last handle
/// goes.
struct ResultFile::State {
    using Clock = std::chrono::steady_clock;
    static constexpr auto between_commits = std::chrono::milliseconds(50);

    std::unique_ptr<WriteLock> lock; ///< declared first, so that it is released after the connection is closed
    Database database;
    bool in_transaction = false;
    Clock::time_point begun{};
    struct Writer {
        RunRecord run;
        Statement point, sample; ///< on a branch, sample writes segments of orbits
        Statement multiplier, half_multiplier, eigenvalue, minimum, end_value, circle;
        std::optional<Model> model; ///< set when the first orbit is written
    };
    std::map<std::string, Writer, std::less<>> writers; ///< of runs that are written to, some at the same time
    std::vector<std::string> missing{};                 ///< what a file of another format does not have
    int format = result_format;                         ///< of the file
    bool opened = false;                                ///< it is a result file, and can be finished as one

    State(const std::string& path, bool writing)
        : lock(writing ? std::make_unique<WriteLock>(path) : nullptr), database(path, writing) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (!opened)
            return;
        try {
            commit();
            writers.clear();
            // One plain file, which can be read where nothing can be written; not while somebody reads it.
            if (lock)
                database.execute("PRAGMA journal_mode = DELETE");
        } catch (...) { // whoever wants to know has called flush
            sqlite_rollback();
        }
    }

    void begin() {
        if (in_transaction)
            return;
        database.execute("BEGIN IMMEDIATE");
        in_transaction = true;
        begun = Clock::now();
    }
    /// The writer of a run. @throws InputError if there is no such run
    Writer& writer_of(const ResultFile& file, const std::string& name) {
        auto found = writers.find(name);
        if (found == writers.end()) {
            const auto run = file.find_run(name);
            if (!run)
                throw InputError(fmt::format("there is no run '{}'", name), "begin it first");
            const RunTables tables(*run);
            const auto insert = [&](const DetailTable& table) {
                return database.prepare(
                    insert_into(fmt::format("{}(run, point, position, {})", table.name, listed(table.columns)),
                                3 + table.columns.size()));
            };
            const std::vector<DetailTable>& details = detail_tables();
            found = writers
                        .emplace(name, Writer{*run, database.prepare(tables.insert_point()),
                                              database.prepare(tables.insert_sample()), insert(details[0]),
                                              insert(details[1]), insert(details[2]), insert(details[3]),
                                              insert(details[4]), insert(details[5]), std::nullopt})
                        .first;
        }
        return found->second;
    }
    void commit_when_due() {
        if (Clock::now() - begun > between_commits)
            commit();
    }
    void commit() {
        if (!in_transaction)
            return;
        database.require_present();
        database.execute("COMMIT");
        in_transaction = false;
    }
    /// Runs statements in one transaction of their own. @param change function that runs the statements
    template <class Change>
    void at_once(Change change) {
        commit();
        database.execute("BEGIN IMMEDIATE");
        try {
            change();
            database.require_present();
            database.execute("COMMIT");
        } catch (...) {
            sqlite_rollback();
            throw;
        }
    }
    void mark(const std::string& run, RunStatus status, const std::string& failure) {
        at_once([&] {
            database.prepare("UPDATE runs SET status = ? WHERE name = ?").run(name_of(status), run);
            const std::string key = key_of_failure(run);
            if (status != RunStatus::failed)
                database.prepare("DELETE FROM meta WHERE key = ?").run(key);
            else
                database.prepare("INSERT OR REPLACE INTO meta(key, value) VALUES(?,?)").run(key, failure);
        });
    }
    void sqlite_rollback() noexcept {
        try {
            database.execute("ROLLBACK");
        } catch (...) { // SQLite has already ended the transaction after the first error
        }
        in_transaction = false;
    }
};

} // namespace graze
