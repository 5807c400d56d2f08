// Changed texts in a result file: each is used or refused, and error messages name the file.

#include "run_graze.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sqlite3.h>

#include <memory>

namespace graze::testing::damaged_results_test {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* study = R"(
name = "small"
model = "impact-oscillator"
set = { omega = 4 }
[runs.swept]
kind = "sweep"
vary = { omega = [4, 4.1] }
section = "phase0"
[runs.rest]
kind = "orbit"
from = { x = -0.07 }
[runs.free]
kind = "continue"
direction = "up"
start = { run = "rest" }
along = { omega = [3.9, 4.1] }
steps = 20
[pictures.both]
kind = "branch"
runs = ["free", "rest"]
y = "period"
)";

using Database = std::unique_ptr<sqlite3, decltype(&sqlite3_close)>;

Database opened(const std::string& path) {
    sqlite3* database = nullptr;
    EXPECT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
    return {database, &sqlite3_close};
}

std::vector<std::vector<std::string>> rows_of(sqlite3* database, const std::string& sql) {
    std::vector<std::vector<std::string>> rows;
    const auto take = [](void* to, int count, char** cells, char** /*names*/) {
        auto& row = static_cast<std::vector<std::vector<std::string>>*>(to)->emplace_back();
        for (int c = 0; c < count; ++c)
            row.emplace_back(cells[c] == nullptr ? "" : cells[c]);
        return 0;
    };
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), take, &rows, nullptr), SQLITE_OK) << sql;
    return rows;
}

/// SQL statements that change each column of texts and each value of the table `meta`; %s stands for the new text.
std::vector<std::string> changes_of(const std::string& path) {
    std::vector<std::string> changes;
    const Database database = opened(path);
    for (const auto& table : rows_of(database.get(), "SELECT name FROM sqlite_master WHERE type = 'table'")) {
        if (table[0] == "meta")
            continue;
        for (const auto& column : rows_of(database.get(), fmt::format("PRAGMA table_info(\"{}\")", table[0])))
            if (column[2] == "TEXT")
                changes.push_back(fmt::format("UPDATE OR IGNORE \"{}\" SET \"{}\" = %s", table[0], column[1]));
    }
    for (const auto& key : rows_of(database.get(), "SELECT key FROM meta"))
        changes.push_back(fmt::format("UPDATE meta SET value = %s WHERE key = '{}'", key[0]));
    return changes;
}

TEST(DamagedResultsSlow, AreUsedOrRefusedWithTheNameOfTheFile) {
    const Folder folder;
    std::ofstream(folder / "small.toml") << study;
    const std::string whole = folder / "whole", copy = folder / "copy", file = copy + "/results.sqlite";
    done(std::vector<std::string>{"run", folder / "small.toml", "--output", whole, "--no-pictures", "--quiet"});
    std::filesystem::create_directory(copy);
    const std::vector<std::vector<std::string>> commands{
        {"info", copy},
        {"points", copy, "--all"},
        {"orbit", copy, "rest:EP1"},
        {"export", copy, "--what", "runs"},
        {"plot", copy, "--run", "free", "--output", folder / "free.svg"},
        {"export", copy, "--what", "samples", "--format", "csv"},
        {"export", copy, "--what", "multipliers", "--format", "json"},
        {"export", copy, "--format", "hdf5", "--output", folder / "all.h5"},
        {"run", copy, "--quiet", "--no-pictures", "--output", copy}}; // comes last, since it writes into the file
    std::size_t refused = 0, used = 0, changed = 0;
    const std::vector<std::string> changes = changes_of(whole + "/results.sqlite");
    EXPECT_GT(changes.size(), 30U);
    for (const std::string& change : changes)
        for (const char* text : {"''", "NULL", "'{'", "'{\"name\": 1}'", "char(27) || '[2J'"}) {
            const std::string sql = std::string(change).replace(change.find("%s"), 2, text);
            std::filesystem::copy_file(whole + "/results.sqlite", file,
                                       std::filesystem::copy_options::overwrite_existing);
            rows_of(opened(file).get(), "PRAGMA synchronous = OFF; " + sql);
            ++changed;
            for (std::size_t c = 0; c < commands.size(); ++c) {
                const std::vector<std::string>& command = commands[c];
                // Every command meets every change, and every text; of the pairs of both, a half.
                if ((c + changed) % 2 == 0 && text != std::string_view("'{'"))
                    continue;
                if (command[0] == "plot" && text != std::string_view("'{'")) // gnuplot is slow
                    continue;
                const Printed printed = run_graze(command);
                ++(printed.code == exit_success ? used : refused);
                EXPECT_THAT(printed.code, AnyOf(exit_success, exit_bad_input, exit_irregular))
                    << command[0] << " after " << sql << ": " << printed.err;
                if (printed.code == exit_bad_input) {
                    // Messages about a missing point or run name the argument instead.
                    EXPECT_THAT(printed.err,
                                AnyOf(HasSubstr(file), StartsWith("graze: POINT: "), StartsWith("graze: --run: ")))
                        << command[0] << " after " << sql;
                }
                EXPECT_EQ(printed.err.find('\x1b'), std::string::npos) << command[0] << " after " << sql;
            }
        }
    EXPECT_GT(refused, 100U);
    EXPECT_GT(used, 100U);
    std::cout << changes.size() << " changes, " << refused << " refused, " << used << " used\n";
}

} // namespace graze::testing::damaged_results_test
