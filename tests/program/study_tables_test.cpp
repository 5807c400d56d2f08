// Tables of a study: files beside its pictures.

#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

namespace graze::testing::study_tables_test {

using ::testing::HasSubstr;
using ::testing::Not;

class StudyTables : public ::testing::Test {
protected:
    StudyTables() { write("columns = [\"x\", \"t = s.time\"]"); }
    void write(const std::string& more) const {
        std::ofstream(folder / "model.toml") << "name = \"o\"\n[states]\nx = 1\nv = 0\n[modes.only]\n"
                                                "rates = { x = \"v\", v = \"-x\" }\n";
        std::ofstream(folder / "study.toml") << "name = \"s\"\nmodel = \"model.toml\"\n[runs.r]\nkind = \"simulate\"\n"
                                                "time = 8\nsample = { low = { minima = \"x\" } }\n[tables.lows]\n"
                                                "run = \"r\"\n"
                                             << more << '\n';
    }
    Printed run(const std::string& what) const { return run_graze({"run", what, "--output", folder / "out"}); }
    std::filesystem::path table() const { return folder / "out/lows.csv"; }
    Folder folder;
};

TEST_F(StudyTables, AreWrittenBesideTheResults) {
    const std::string printed = done(run(folder / "study.toml"));
    EXPECT_THAT(printed, HasSubstr("out/lows.csv\n"));
    // A study with tables and no pictures gets no default pictures.
    EXPECT_THAT(printed, Not(HasSubstr(".png")));
    std::ifstream stream(table());
    std::string heading, x, t;
    std::getline(stream, heading);
    std::getline(std::getline(stream, x, ','), t);
    EXPECT_EQ(heading, "x,t");
    EXPECT_NEAR(std::stod(x), -1, 1e-11);
    EXPECT_NEAR(std::stod(t), 3.141592653589793, 1e-11);
}

TEST_F(StudyTables, AreWrittenAgainOnlyIfTheyDiffer) {
    run(folder / "study.toml");
    const std::string first = contents(table());
    const auto old = std::filesystem::last_write_time(table()) - std::chrono::hours(1);
    std::filesystem::last_write_time(table(), old);
    EXPECT_EQ(run(folder / "study.toml").code, 0);
    EXPECT_EQ(std::filesystem::last_write_time(table()), old);
    std::ofstream(table()) << "something else";
    EXPECT_EQ(run(folder / "out").code, 0); // from the results alone
    EXPECT_EQ(contents(table()), first);
}

TEST_F(StudyTables, ThatCannotBeMadeGiveAWarning) {
    write("columns = [\"y\"]");
    const Printed printed = run(folder / "study.toml");
    EXPECT_EQ(printed.code, 2);
    EXPECT_THAT(printed.err, HasSubstr("graze: warning: table 'lows' was not written: "));
    EXPECT_THAT(printed.err, HasSubstr("study.toml:7:9: run 'r': no such column: y"));
    EXPECT_FALSE(std::filesystem::exists(table()));
}

TEST_F(StudyTables, NeverReplaceInputsOfTheStudy) {
    std::filesystem::create_directory(folder / "out");
    std::filesystem::create_hard_link(folder / "study.toml", table());
    const std::string before = contents(folder / "study.toml");
    const Printed printed = run(folder / "study.toml");
    EXPECT_EQ(printed.code, 2);
    EXPECT_THAT(printed.err, HasSubstr("table 'lows' was not written"));
    EXPECT_EQ(contents(folder / "study.toml"), before);
}

} // namespace graze::testing::study_tables_test
