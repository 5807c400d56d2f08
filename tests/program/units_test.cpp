#include "program/process.hpp"
#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <map>

namespace graze::testing::units_test {

/// The texts of a named list in JSON.
std::vector<std::string> list_of(const std::string& json, const std::string& name) {
    const std::size_t begin = json.find('"' + name + "\":["), end = json.find(']', begin);
    std::vector<std::string> items;
    if (begin == std::string::npos)
        return items;
    for (std::size_t at = json.find('[', begin); at < end;) {
        const std::size_t open = json.find('"', at + 1), close = json.find('"', open + 1);
        if (open >= end)
            break;
        items.push_back(json.substr(open + 1, close - open - 1));
        at = close;
    }
    return items;
}

/// Units of columns of the testbed, in all tables.
const std::map<std::string, std::string> units{
    {"time", "s"},          {"t", "s"},       {"start", "s"},     {"end_time", "s"},
    {"ending_time", "s"},   {"q", "m"},       {"v", "m/s"},       {"I", "A"},
    {"theta", "rad"},       {"q_after", "m"}, {"v_after", "m/s"}, {"I_after", "A"},
    {"theta_after", "rad"}, {"V0", "V"},      {"end_q", "m"},     {"end_v", "m/s"},
    {"end_I", "A"},         {"start_q", "m"}, {"start_v", "m/s"}, {"start_I", "A"},
    {"max_v", "m/s"},       {"max_q", "m"},   {"max_I", "A"},     {"duration", "s"},
    {"lyapunov", "1/s"},    {"f", "Hz"},      {"R", "ohm"},       {"durations", "s"},
};

/// Checks the units of the columns that a command prints. @return number of columns with a known unit
std::size_t expect_units(const std::string& command) {
    const std::string run = done(command);
    EXPECT_TRUE(JsonCheck(run).valid()) << command;
    const auto columns = list_of(run, "columns"), given = list_of(run, "units");
    EXPECT_EQ(columns.size(), given.size()) << command;
    std::size_t found = 0;
    for (std::size_t c = 0; c < std::min(columns.size(), given.size()); ++c)
        if (const auto unit = units.find(columns[c]); unit != units.end()) {
            EXPECT_EQ(given[c], unit->second) << command << ": " << columns[c];
            ++found;
        }
    return found;
}

TEST(Units, JsonOfEveryCommandHasUnits) {
    const std::string simulate = "simulate electromagnetic-testbed --set V0=5 --time 0.5 --format json";
    for (const std::string table : {"samples", "contacts", "sections", "summary", "minima"})
        EXPECT_GT(expect_units(simulate + " --table " + table), table == "minima" ? 1u : 4u) << table;
    EXPECT_GT(expect_units(simulate + " --extrema q"), 4u);
    const std::string heading = run_graze(simulate).out;
    for (const std::string part : {"\"V0\":\"V\"", "\"f\":\"Hz\"", "\"I\":\"A\"", "\"time_unit\":\"s\""})
        EXPECT_THAT(heading, ::testing::HasSubstr(part));

    const Folder folder;
    std::ofstream(folder / "s.toml") << R"(
name = "s"
model = "electromagnetic-testbed"
[runs.sweep]
kind = "sweep"
vary = { V0 = [4.5, 4.6] }
[runs.free]
kind = "orbit"
set = { V0 = 1.5, f = 8 }
[runs.branch]
kind = "continue"
direction = "up"
start = { run = "free" }
along = { V0 = [1, 1.6] }
)";
    const std::string file = folder / "out";
    done("run " + (folder / "s.toml") + " --output " + file + " --no-pictures --quiet");
    EXPECT_GT(expect_units("export " + file + " --run sweep --format json"), 5u);
    EXPECT_GT(expect_units("export " + file + " --run sweep --what samples --format json"), 3u);
    EXPECT_GT(expect_units("export " + file + " --run branch --format json"), 5u);
    EXPECT_GT(expect_units("export " + file + " --run branch --what segments --format json"), 4u);
    EXPECT_GT(expect_units("points " + file + " --run branch --format json"), 1u);
    EXPECT_GT(expect_units("orbit " + file + " branch:EP1 --format json"), 4u);
    const std::string orbit = run_graze("orbit " + file + " branch:EP1 --format json").out;
    for (const std::string part : {"\"V0\":\"V\"", "\"time_unit\":\"s\"", "\"minima\":[", "\"half_multipliers\":["})
        EXPECT_THAT(orbit, ::testing::HasSubstr(part));
    EXPECT_THAT(
        run_graze({"export", file, "--sql", "SELECT V0, end_q AS place, end_q FROM points_sweep", "--format", "json"})
            .out,
        ::testing::HasSubstr("\"units\":[\"V\",\"\",\"m\"]"));
}

} // namespace graze::testing::units_test
