// Result files with random or malicious changes.

#include "mutated_files.hpp"

#include <sqlite3.h>

#include <memory>

namespace graze::testing::mutated_results_test {

constexpr const char* study = R"(
name = "small"
model = "impact-oscillator"
set = { omega = 1.2, sigma = 0.5 }
[runs.swept]
kind = "sweep"
set = { amplitude = 0.1 }
vary = { omega = [1.2, 1.3] }
section = "phase0"
[runs.first]
kind = "continue"
direction = "up"
set = { amplitude = 0.1 }
along = { amplitude = [0.01, 2] }
)";

/// The file of a small study, with branches that graze and a sweep.
const std::string& whole_file() {
    static const std::string whole = [] {
        const Folder folder;
        const std::string path = folder.write("study.toml", study);
        done({"run", path, "--output", folder / "out", "--quiet", "--no-pictures"});
        return contents(folder / "out/results.sqlite");
    }();
    return whole;
}

const std::vector<UseOfFile> uses{
    {{"info", "FILE", "--all"}},
    {{"points", "FILE", "--all"}},
    {{"points", "FILE", "--format", "json"}},
    {{"orbit", "FILE", "first:2", "--samples", "5"}},
    {{"orbit", "FILE", "first:GR1", "--format", "json"}},
    {{"export", "FILE", "--run", "swept"}},
    {{"export", "FILE", "--run", "swept", "--what", "samples"}},
    {{"export", "FILE", "--run", "first"}},
    {{"export", "FILE", "--run", "first", "--what", "segments", "--format", "csv"}},
    {{"export", "FILE", "--what", "multipliers", "--format", "json"}},
    {{"export", "FILE", "--format", "hdf5", "--output", "OUT/x.h5"}},
    {{"export", "FILE", "--format", "csv", "--output", "OUT/"}},
    {{"export", "FILE", "--what", "minima"}},
    {{"export", "FILE", "--sql", "SELECT * FROM special_points"}},
    {{"grazing", "FILE", "first:GR1"}, true},
    {{"tolerance", "FILE", "first:GR1"}, true},
    {{"trip", "FILE", "first:GR1", "--cycles", "20"}, true},
    {{"ladder", "FILE", "first:GR1", "--rungs", "2"}, true},
    {{"run", "FILE", "--output", "OUT/r", "--no-pictures", "--jobs", "1"}, true},
};

/// New values of cells, as SQL.
const std::vector<std::string> strange_cells{"NULL",
                                             "0",
                                             "-1",
                                             "1e300",
                                             "-1e300",
                                             "1e-300",
                                             "9e999",
                                             "9223372036854775807",
                                             "-9223372036854775808",
                                             "'nan'",
                                             "'x'",
                                             "'a'",
                                             "''",
                                             "x'00ff00'",
                                             "2",
                                             "1000000",
                                             "0.5"};

/// Changes one cell, or all cells of a column, of a result file.
void change_cells(const std::string& path, std::mt19937& random) {
    sqlite3* opened = nullptr;
    ASSERT_EQ(sqlite3_open(path.c_str(), &opened), SQLITE_OK);
    const std::unique_ptr<sqlite3, decltype(&sqlite3_close)> database(opened, &sqlite3_close);
    std::vector<std::string> columns;
    const auto take = [](void* to, int /*count*/, char** cells, char** /*names*/) {
        static_cast<std::vector<std::string>*>(to)->push_back(
            fmt::format("UPDATE OR IGNORE \"{}\" SET \"{}\" = ", cells[0], cells[1]));
        return 0;
    };
    const char* all =
        "SELECT m.name, c.name FROM sqlite_master AS m JOIN pragma_table_info(m.name) AS c WHERE m.type = "
        "'table'";
    ASSERT_EQ(sqlite3_exec(opened, all, take, &columns, nullptr), SQLITE_OK);
    const std::string some = below(random, 2) == 0 ? "" : fmt::format(" WHERE rowid = {}", 1 + below(random, 5));
    const std::string change =
        columns[below(random, columns.size())] + strange_cells[below(random, strange_cells.size())] + some;
    sqlite3_exec(opened, change.c_str(), nullptr, nullptr, nullptr); // changes that constraints forbid are not made
}

TEST_F(MutatedFiles, ResultsWithChangedBytesAreUsedOrRefused) {
    try_bytes("r.sqlite", whole_file(), uses, 2 * uses.size());
}

TEST_F(MutatedFiles, ResultsWithChangedCellsAreUsedOrRefused) {
    std::mt19937 random = random_numbers();
    for (int i = 0; i < count(3 * uses.size()); ++i) {
        const std::string path = folder.write("r.sqlite", whole_file());
        change_cells(path, random);
        try_file(path, uses);
    }
}

} // namespace graze::testing::mutated_results_test
