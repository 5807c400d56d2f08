// Result files of other versions: made by changing files of this one.

#include "results/file_form.hpp"
#include "results/schema.hpp"

#include "base/message_of.hpp"
#include "base/temporary_folder.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/results/stored_run.hpp"

#include "run_of_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace graze::file_form_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using testing::TemporaryFolder;
using ::testing::UnorderedElementsAre;

/// A file with an orbit that touches, and a sweep of one point with a sample.
class FileForm : public ::testing::Test {
protected:
    FileForm() {
        orbit.part = "up";
        orbit.point.monitors = {0.5};
        orbit.touch = TouchFindings{"square-root", "lost", "", 2, -0.3, 8.25, 10.5, 68, -1, 42.5, std::nullopt};
        OrbitSolution& solution = orbit.point.solution;
        solution.outcome = OrbitOutcome::converged;
        solution.half_multipliers = {{0.5, 0}};
        solution.orbit.signature = parse_signature(model, "impact");
        solution.orbit.parameters = model.parameter_values();
        solution.orbit.starts = {{1, 2, 3}};
        solution.orbit.durations = {4};
        solution.certificate.approach_speeds = solution.certificate.departures =
            solution.certificate.guard_margins = {1};
        point.coordinates = {2.5};
        point.result.state = {1, 2, 3};
        point.result.lyapunov = 0.25;
        point.result.samples = {.width = 1, .samplings = {0}, .times = {0.5}, .values = {7}};
        ResultFile file(path, ResultFile::Access::write);
        file.begin_run(run_of("b", "continue"));
        file.add_orbit("b", orbit);
        file.begin_run(run_of("s", "sweep"));
        file.add_point("s", point);
    }

    RunRecord run_of(const std::string& name, const std::string& kind) const {
        RunRecord run = testing::run_of(model, name, kind);
        if (!run.is_branch()) // which has all parameters
            run.coordinates = {{"omega", ""}};
        run.values = {{"added_later", ""}};
        run.samplings = {"phase0"};
        run.directions = {"up"};
        return run;
    }
    void change(const std::string& sql) const { testing::change(path, sql); }
    /// What is there is as it was written.
    void expect_all(const ResultFile& file) const {
        const auto found = file.orbit("b", std::size_t{0});
        ASSERT_TRUE(found);
        EXPECT_EQ(found->touch, orbit.touch);
        EXPECT_EQ(found->point.monitors, orbit.point.monitors);
        EXPECT_EQ(found->point.solution.orbit.starts, orbit.point.solution.orbit.starts);
        EXPECT_EQ(found->point.solution.half_multipliers, orbit.point.solution.half_multipliers);
        const auto read = file.point("s", 0);
        ASSERT_TRUE(read);
        EXPECT_EQ(read->coordinates, point.coordinates);
        EXPECT_EQ(read->result.state, point.result.state);
        EXPECT_EQ(read->result.lyapunov, point.result.lyapunov);
        EXPECT_THAT(read->result.samples.values, ElementsAre(7));
    }
    static constexpr const char* without_views =
        "DROP VIEW IF EXISTS label_changes; DROP VIEW IF EXISTS label_counts; DROP VIEW IF EXISTS orbits; "
        "DROP VIEW IF EXISTS all_points; DROP VIEW IF EXISTS special_points; DROP VIEW IF EXISTS branch_points; ";

    TemporaryFolder folder;
    std::string path = folder / "results.sqlite";
    Model model = load_model("impact-oscillator");
    OrbitRecord orbit;
    PointRecord point;
};

TEST_F(FileForm, IgnoresUnknownColumnsAndTables) {
    change("ALTER TABLE branch_b ADD COLUMN strange REAL DEFAULT 1; ALTER TABLE points_s ADD COLUMN strange TEXT; "
           "ALTER TABLE samples_s ADD COLUMN strange; ALTER TABLE multipliers ADD COLUMN strange; "
           "ALTER TABLE runs ADD COLUMN strange TEXT DEFAULT 'x'; CREATE TABLE strange(run TEXT)");
    for (const auto access : {ResultFile::Access::read, ResultFile::Access::write}) {
        ResultFile file(path, access);
        expect_all(file);
        EXPECT_THAT(file.missing(), IsEmpty());
    }
    ResultFile file(path, ResultFile::Access::write);
    OrbitRecord next = orbit;
    next.number = 1;
    file.add_orbit("b", next);
    EXPECT_EQ(file.orbit("b", std::size_t{1})->touch, orbit.touch);
}

TEST_F(FileForm, ReadsNewerFilesThatHaveOnlyAddedSomething) {
    // A column was added that is called like a value, which is called otherwise then.
    change(std::string(without_views) +
           "ALTER TABLE branch_b RENAME COLUMN added_later TO added_later_2; "
           "ALTER TABLE branch_b ADD COLUMN added_later REAL DEFAULT 99; "
           "UPDATE columns SET column_name = 'added_later_2' WHERE run = 'b' AND place = 'value'; "
           "PRAGMA user_version = 12");
    const ResultFile file(path, ResultFile::Access::read);
    EXPECT_EQ(file.format(), 12);
    expect_all(file);
    EXPECT_THAT(file.missing(), IsEmpty());
    auto rows = StoredRun(file, "b", {}).rows({.values = {"added_later"}});
    ASSERT_TRUE(rows.next());
    EXPECT_EQ(rows.number(0), 0.5);
    EXPECT_THAT(message_of([&] { ResultFile(path, ResultFile::Access::write); }),
                HasSubstr("has format 12, which this version of graze reads, but does not write"));
}

TEST_F(FileForm, RefusesNewerFilesThatHaveChangedSomething) {
    for (const char* reader :
         {"UPDATE meta SET value = '12' WHERE key = 'oldest reader'",
          "UPDATE meta SET value = 'x' WHERE key = 'oldest reader'", "DELETE FROM meta WHERE key = 'oldest reader'"}) {
        change(std::string("PRAGMA user_version = 12; ") + reader);
        for (const auto access : {ResultFile::Access::read, ResultFile::Access::write})
            EXPECT_THAT(message_of([&] { ResultFile(path, access); }),
                        HasSubstr("has format 12, this version of graze knows"))
                << reader;
        change("INSERT OR REPLACE INTO meta VALUES('oldest reader', '7')");
    }
}

TEST_F(FileForm, ReadsWhatAnOlderFileLacksAsAbsent) {
    change(std::string(without_views) +
           "ALTER TABLE branch_b DROP COLUMN touch_growth; ALTER TABLE points_s DROP COLUMN lyapunov; "
           "ALTER TABLE branch_b RENAME COLUMN touch_speed_factor TO touch_first_speed; "
           "DROP TABLE half_multipliers; DROP TABLE estimates; PRAGMA user_version = 6");
    orbit.touch->growth.reset();
    orbit.point.solution.half_multipliers.clear();
    point.result.lyapunov.reset();
    const auto lacking = UnorderedElementsAre("half_multipliers", "estimates", "b.touch_growth", "s.lyapunov");
    {
        const ResultFile file(path, ResultFile::Access::read);
        EXPECT_EQ(file.format(), 6);
        EXPECT_THAT(file.missing(), lacking);
        expect_all(file);
        EXPECT_TRUE(file.estimates("b").numbers.empty());
        auto rows = StoredRun(file, "b", {}).rows({.columns = {"touch_growth", "touch_speed_factor"}});
        ASSERT_TRUE(rows.next());
        EXPECT_TRUE(rows.is_null(0));
        EXPECT_EQ(rows.number(1), 42.5);
    }
    {
        ResultFile file(path, ResultFile::Access::write);
        EXPECT_EQ(file.format(), result_format);
        EXPECT_THAT(file.missing(), lacking);
        expect_all(file);
        OrbitRecord next = orbit;
        next.number = 1;
        next.touch->growth = 8.25;
        next.point.solution.half_multipliers = {{0.5, 0}};
        file.add_orbit("b", next);
    }
    const ResultFile file(path, ResultFile::Access::read);
    EXPECT_THAT(file.missing(), IsEmpty());
    expect_all(file);
    EXPECT_EQ(file.orbit("b", std::size_t{1})->touch->growth, 8.25);
}

TEST_F(FileForm, RefusesFilesThatLackRequiredColumns) {
    change(std::string(without_views) + "ALTER TABLE branch_b DROP COLUMN residual; PRAGMA user_version = 6");
    const ResultFile file(path, ResultFile::Access::read);
    EXPECT_THAT(message_of([&] { file.orbit("b", std::size_t{0}); }), HasSubstr("residual"));
    EXPECT_TRUE(file.point("s", 0)); // other runs are read
}

} // namespace graze::file_form_test
