#include "graze/model/catalogue.hpp"
#include "graze/results/stored_run.hpp"

#include "base/temporary_folder.hpp"
#include "run_of_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace graze::orbit_rows_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

class OrbitRows : public ::testing::Test {
protected:
    testing::TemporaryFolder folder_;
    const std::string path_ = folder_ / "results.sqlite";
};

RunRecord run_of(const Model& model) {
    RunRecord run = testing::run_of(model, "b", "continue");
    run.values = {{"largest", ""}};
    return run;
}

/// Draws orbit records at random, in which each number is finite, infinite or unknown if it can be.
class RandomOrbits {
public:
    explicit RandomOrbits(const Model& model) : model_(&model) {}

    OrbitRecord record(std::size_t number) {
        OrbitRecord record;
        record.number = number;
        record.part = "up";
        record.point.type = PointType::regular;
        record.point.monitors = {perhaps_infinite()};
        OrbitSolution& solution = record.point.solution;
        solution.outcome = OrbitOutcome::converged;
        solution.residual = 1e-15;
        for (std::size_t m = count(4); m-- > 0;)
            solution.multipliers.emplace_back(perhaps_infinite(), 0.0);
        for (std::size_t m = count(3); m-- > 0;)
            solution.half_multipliers.emplace_back(value(), value());
        Orbit& orbit = solution.orbit;
        orbit.signature = parse_signature(*model_, "impact impact");
        orbit.parameters = model_->parameter_values();
        Certificate& certificate = solution.certificate;
        for (std::size_t s = 0; s < orbit.segments(); ++s) {
            orbit.starts.push_back({value(), value(), value()});
            orbit.durations.push_back(value());
            certificate.approach_speeds.push_back(value());
            certificate.departures.push_back(value());
            certificate.guard_margins.push_back(perhaps_infinite());
        }
        for (std::size_t i = count(4); i-- > 0;)
            certificate.minima.push_back({count(1), count(1), value(), perhaps_infinite(), value()});
        for (std::size_t i = count(4); i-- > 0;)
            certificate.end_values.push_back({count(1), count(1), perhaps_infinite(), value()});
        return record;
    }

private:
    double value() {
        return std::uniform_real_distribution<double>(-1, 1)(random_) * std::pow(10.0, double(count(20)) - 10);
    }
    double perhaps_infinite() { return count(3) == 0 ? infinity : value(); }
    std::size_t count(std::size_t most) { return std::uniform_int_distribution<std::size_t>(0, most)(random_); }

    const Model* model_;
    std::mt19937 random_{3};
};

TEST_F(OrbitRows, KeepInfiniteAndUndefinedNumbers) {
    const Model model = load_model("impact-oscillator");
    RandomOrbits random_orbits(model);
    std::vector<OrbitRecord> written;
    {
        ResultFile file(path_, ResultFile::Access::write);
        file.begin_run(run_of(model));
        for (std::size_t i = 0; i < 100; ++i) {
            written.push_back(random_orbits.record(i));
            file.add_orbit("b", written.back());
        }
    }
    const ResultFile file(path_, ResultFile::Access::read);
    const auto read = file.orbits("b", false);
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
        const OrbitSolution &a = written[i].point.solution, &b = read[i].point.solution;
        EXPECT_EQ(a.multipliers, b.multipliers);
        EXPECT_EQ(a.half_multipliers, b.half_multipliers);
        EXPECT_EQ(written[i].point.monitors, read[i].point.monitors);
        EXPECT_EQ(a.certificate.guard_margins, b.certificate.guard_margins);
        EXPECT_EQ(a.certificate.approach_speeds, b.certificate.approach_speeds);
        EXPECT_EQ(testing::details_of(written[i].point), testing::details_of(read[i].point));
    }
    auto infinite = file.query("SELECT count(*) FROM multipliers WHERE real > 1e308");
    ASSERT_TRUE(infinite.next());
    EXPECT_GT(infinite.integer(0), 10);
}

TEST_F(OrbitRows, SlowestApproachIsThatOfAnEvent) {
    const Model model = load_model("impact-oscillator");
    OrbitRecord record = RandomOrbits(model).record(0), none = record;
    record.point.solution.certificate.approach_speeds = {0.5, 0.25};
    none.number = 1;
    none.point.solution.certificate.approach_speeds.clear();
    ResultFile file(path_, ResultFile::Access::write);
    file.begin_run(run_of(model));
    file.add_orbit("b", record);
    file.add_orbit("b", none);
    const StoredRun run(file, "b", {});
    auto rows = run.rows({.quantities = {"slowest_approach"}});
    ASSERT_TRUE(rows.next());
    EXPECT_EQ(rows.number(0), 0.25);
    ASSERT_TRUE(rows.next());
    EXPECT_TRUE(rows.is_null(0));
    const auto names = run.number_columns();
    EXPECT_NE(std::find(names.begin(), names.end(), "slowest_approach"), names.end()); // so that pictures can show it
    auto view = file.query("SELECT slowest_approach FROM branch_points WHERE number = 0");
    ASSERT_TRUE(view.next());
    EXPECT_EQ(view.number(0), 0.25);
}

TEST_F(OrbitRows, ToriAreReadAsWritten) {
    const Model model = load_model("impact-oscillator");
    OrbitRecord torus = RandomOrbits(model).record(0), none = torus;
    torus.torus = TorusRecord{0.381966, 1, 1e-10, 0.5, {{0, 0, 1.5, 0}, {0, 2, 0.25, 0}, {1, 0, -2, 3}, {1, 2, 0, 4}}};
    none.number = 1;
    ResultFile file(path_, ResultFile::Access::write);
    file.begin_run(run_of(model));
    file.add_orbit("b", torus);
    file.add_orbit("b", none);
    EXPECT_EQ(file.orbit("b", std::size_t{0})->torus, torus.torus);
    EXPECT_FALSE(file.orbit("b", std::size_t{1})->torus);
    auto rows = file.query("SELECT state, cosine FROM circles WHERE run = 'b' AND point = 0 AND harmonic = 1");
    ASSERT_TRUE(rows.next());
    EXPECT_EQ(rows.text(0), "x");
    EXPECT_EQ(rows.number(1), -2);
    const auto names = StoredRun(file, "b", {}).number_columns();
    EXPECT_NE(std::find(names.begin(), names.end(), "rotation_number"), names.end());
    file.flush();
    testing::change(path_, "UPDATE circles SET state = 'nobody' WHERE position = 1");
    const ResultFile changed(path_, ResultFile::Access::read);
    EXPECT_EQ(changed.orbit("b", std::size_t{0})->torus->circle.size(), 3U);
}

TEST_F(OrbitRows, FindingsAtTouchesAreReadAsWritten) {
    const Model model = load_model("impact-oscillator");
    OrbitRecord lost = RandomOrbits(model).record(0), persists = lost, none = lost;
    lost.touch = TouchFindings{"square-root", "lost", "", 2, -0.3, 8.25, 10.5, 68, -1, 42.5, std::nullopt};
    persists.number = 1;
    persists.touch = TouchFindings{"none", "undecided", "it sticks", 0, {}, {}, {}, {}, {}, {}, {}};
    none.number = 2;
    ResultFile file(path_, ResultFile::Access::write);
    file.begin_run(run_of(model));
    for (const OrbitRecord& record : {lost, persists, none})
        file.add_orbit("b", record);
    EXPECT_EQ(file.orbit("b", std::size_t{0})->touch, lost.touch);
    EXPECT_EQ(file.orbit("b", std::size_t{1})->touch, persists.touch);
    EXPECT_EQ(file.orbit("b", std::size_t{2})->touch, std::nullopt);
    auto view = file.query("SELECT number FROM branch_points WHERE touch_verdict = 'lost' AND touch_growth > 8");
    ASSERT_TRUE(view.next());
    EXPECT_EQ(view.integer(0), 0);
    EXPECT_FALSE(view.next());
}

// In format 6 one column had a different name.
TEST_F(OrbitRows, EarlierFilesAreReadAndContinued) {
    const Model model = load_model("impact-oscillator");
    OrbitRecord lost = RandomOrbits(model).record(0);
    lost.touch = TouchFindings{"square-root", "lost", "", 2, -0.3, 8.25, 10.5, 68, -1, 42.5, std::nullopt};
    {
        ResultFile file(path_, ResultFile::Access::write);
        file.begin_run(run_of(model));
        file.add_orbit("b", lost);
    }
    testing::change(path_, "ALTER TABLE branch_b RENAME COLUMN touch_speed_factor TO touch_first_speed; "
                           "PRAGMA user_version = 6");
    EXPECT_EQ(ResultFile(path_, ResultFile::Access::read).orbit("b", std::size_t{0})->touch, lost.touch);
    ResultFile file(path_, ResultFile::Access::write);
    EXPECT_EQ(file.format(), 6);
    OrbitRecord next = lost;
    next.number = 1;
    file.add_orbit("b", next);
    EXPECT_EQ(file.orbit("b", std::size_t{1})->touch, lost.touch);
}

TEST_F(OrbitRows, MissingMultipliersOfEarlierFilesAreInfinite) {
    const Model model = load_model("impact-oscillator");
    OrbitRecord record = RandomOrbits(model).record(0);
    record.point.solution.multipliers = {{std::numeric_limits<double>::quiet_NaN(), 0.0}, {0.5, 0.0}};
    ResultFile file(path_, ResultFile::Access::write);
    file.begin_run(run_of(model));
    file.add_orbit("b", record);
    EXPECT_EQ(file.orbit("b", std::size_t{0})->point.solution.multipliers,
              (std::vector<std::complex<double>>{{infinity, 0.0}, {0.5, 0.0}}));
}

} // namespace graze::orbit_rows_test
