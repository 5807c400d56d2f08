#include "page/motion_json.hpp"

#include "graze/results/stored_orbit.hpp"
#include "graze/study/study_catalogue.hpp"
#include "page/motion_rows.hpp"
#include "page/page_results.hpp"
#include "study/wave_records.hpp"

#include <cmath>
#include <numbers>

namespace graze {
namespace {

using testing::numbers_in;

class MotionJson : public testing::PageResults {
protected:
    /// The state in a row of a motion whose columns are t, x, v.
    static std::vector<double> state(const nlohmann::json& motion, std::size_t row) {
        return {motion["values"][1][row].get<double>(), motion["values"][2][row].get<double>()};
    }
};

TEST_F(MotionJson, OfABranchClosesAfterItsJumps) {
    const OrbitRecord record = special_point("chain", PointType::end);
    const Orbit& orbit = record.point.solution.orbit;
    const nlohmann::json motion = motion_json(file(), "chain", record.number, {"x", "v", "v^2/2 + x^2/2"});
    EXPECT_EQ(motion["columns"][0]["name"], "t");
    EXPECT_EQ(motion["columns"][3]["name"], "v^2/2 + x^2/2");
    EXPECT_TRUE(motion["complete"].get<bool>());
    const std::size_t rows = motion["values"][0].size();
    ASSERT_GT(rows, 1000U);
    EXPECT_EQ(motion["values"][0][0], 0);
    EXPECT_NEAR(motion["values"][0][rows - 1].get<double>(), orbit.period(), 1e-12 * orbit.period());
    // Each arc begins where its segment does, and with the last one the orbit closes.
    std::vector<std::size_t> begins{0};
    for (const nlohmann::json& row : motion["begins"])
        begins.push_back(row.get<std::size_t>());
    ASSERT_EQ(begins.size(), orbit.segments());
    for (std::size_t s = 0; s < begins.size(); ++s) {
        EXPECT_EQ(state(motion, begins[s])[0], orbit.starts[s][0]);
        EXPECT_EQ(state(motion, begins[s])[1], orbit.starts[s][1]);
    }
    EXPECT_EQ(motion["modes"].size(), begins.size());
    for (const std::size_t row : {std::size_t{0}, rows / 2, rows - 1}) {
        const double x = state(motion, row)[0], v = state(motion, row)[1];
        EXPECT_NEAR(motion["values"][3][row].get<double>(), v * v / 2 + x * x / 2, 1e-12);
    }
}

TEST_F(MotionJson, OfABranchMarksItsContacts) {
    const OrbitRecord record = *file().orbit("orbit", 0);
    const Model model = StoredRun(file(), "orbit", {}).model;
    const double restitution = model.parameter_values()[model.independent_parameter("e").place()];
    const nlohmann::json motion = motion_json(file(), "orbit", record.number, {"x", "v"});
    const std::vector<std::size_t> contacts = motion["contacts"].get<std::vector<std::size_t>>();
    // Two impacts, the last at the end of the orbit: a row before each and a row after it, where the velocity is
    // reversed.
    ASSERT_EQ(to_string(model, record.point.solution.orbit.signature), "impact^2");
    ASSERT_EQ(contacts.size(), 4U);
    EXPECT_EQ(contacts[0], 0U);
    EXPECT_EQ(contacts[2], contacts[1] + 1);
    EXPECT_EQ(contacts[2], motion["begins"][0]);
    EXPECT_EQ(contacts[3], motion["values"][0].size() - 1);
    for (const auto& [before, after] : {std::pair{contacts[1], contacts[2]}, std::pair{contacts[3], contacts[0]}}) {
        EXPECT_GT(std::abs(state(motion, before)[1]), 0.01);
        EXPECT_NEAR(state(motion, after)[1], -restitution * state(motion, before)[1], 1e-10);
    }
}

TEST_F(MotionJson, MarksNoEventsOfTheClockAlone) {
    testing::StudyResults results(load_study("mems-switch"));
    results.run({"free"});
    const nlohmann::json motion = motion_json(results.file(), "free", 0, {});
    EXPECT_EQ(motion["begins"].size(), 1U); // the switch is turned on and off
    EXPECT_TRUE(motion["contacts"].empty());
}

TEST_F(MotionJson, OfASweepLastsOnePeriod) {
    const PointRecord point = *file().point("sweep", 2);
    ASSERT_EQ(point.result.label, Label::periodic);
    const nlohmann::json motion = motion_json(file(), "sweep", 2, {"x", "v", "energy", "theta"});
    EXPECT_EQ(motion["ending"], "end-time");
    EXPECT_TRUE(motion["complete"].get<bool>());
    const std::size_t last = motion["values"][0].size() - 1;
    EXPECT_EQ(motion["values"][0][0], 0);
    EXPECT_NEAR(motion["values"][0][last].get<double>(), point.result.duration, 1e-12 * point.result.duration);
    for (const std::size_t column : {1, 2, 3})
        EXPECT_NEAR(motion["values"][column][last].get<double>(), motion["values"][column][0].get<double>(), 1e-8);
    EXPECT_TRUE(motion["columns"][1]["period"].is_null());
    EXPECT_NEAR(motion["columns"][4]["period"].get<double>(), 2 * std::numbers::pi, 1e-15);
    EXPECT_EQ(motion["begins"].size() + 1, motion["modes"].size());
    EXPECT_FALSE(motion["contacts"].empty());
}

TEST_F(MotionJson, EndsWhereItIsInterrupted) {
    int asked = 0;
    const nlohmann::json motion = motion_json(file(), "motion", 0, {"x"}, [&] { return ++asked > 5; });
    EXPECT_EQ(motion["ending"], "stopped");
    EXPECT_FALSE(motion["complete"].get<bool>());
    EXPECT_GT(motion["values"][0].size(), 10U);
}

class SingularMotionJson : public testing::StudyFixture {};

TEST_F(SingularMotionJson, EndsAsTheStoredOneDid) {
    folder_.write("m.toml", "name = \"m\"\nstates = { x = 1 }\nmodes.one.rates = { x = \"x^2\" }\n");
    run("name = \"s\"\nmodel = \"m.toml\"\n[runs.r]\nkind = \"simulate\"\ntime = 5\n");
    const nlohmann::json motion = motion_json(ResultFile(path_, ResultFile::Access::read), "r", 0, {});
    EXPECT_EQ(motion["ending"], "singular");
    EXPECT_NEAR(motion["time"].get<double>(), 1, 1e-6);
    EXPECT_TRUE(motion["complete"].get<bool>());
}

class RecordMotionJson : public testing::StudyFixture {};

TEST_F(RecordMotionJson, HasTheRowsOfTheRecord) {
    folder_.write("a.csv", testing::waves(2, 1));
    run(std::string(testing::record_head) + R"(files = "a.csv"
reference = "V"
coordinate = "V0"
values = ["V", "q"]
[runs.r.sample]
all = { record = true }
zero = { section = 0 }
)");
    const ResultFile file(path_, ResultFile::Access::read);
    const nlohmann::json motion = motion_json(file, "r", 0, {});
    EXPECT_EQ(motion["columns"][2]["name"], "q");
    EXPECT_EQ(motion["columns"][2]["unit"], "mm");
    const std::vector<double> t = numbers_in(motion["values"][0]), q = numbers_in(motion["values"][2]);
    ASSERT_EQ(t.size(), 1001U);
    for (std::size_t i = 0; i < t.size(); ++i)
        EXPECT_NEAR(q[i], 3 * std::cos(2 * std::numbers::pi * testing::wave_frequency * t[i]) + 1, 1e-12);
    EXPECT_THROW(motion_json(file, "r", 0, {"V + q"}), InputError);
    EXPECT_EQ(motion_json(file, "r", 0, {"q"})["values"][1], motion["values"][2]);
}

TEST_F(MotionJson, RefusesWhatCannotBeShown) {
    EXPECT_THROW(motion_json(file(), "nothing", 0, {}), InputError);
    EXPECT_THROW(motion_json(file(), "sweep", 100'000, {}), InputError);
    EXPECT_THROW(motion_json(file(), "sweep", 0, {"<script>"}), InputError);
    EXPECT_THROW(motion_json(file(), "sweep", 0, {"unknown + 1"}), InputError);
    EXPECT_THROW(motion_json(file(), "sweep", 0, {"\xff"}), InputError);
    EXPECT_THROW(motion_json(file(), "sweep", 0, {std::string(5000, '(')}), InputError);
    EXPECT_THROW(motion_json(file(), "sweep", 0, std::vector<std::string>(most_motion_names + 1, "x")), InputError);
}

TEST(MotionRows, KeepTheEndsOfArcsAndTheContactsWhenTheyAreThinned) {
    DenseMotion motion;
    motion.values.resize(2);
    constexpr std::size_t rows = 10'000;
    for (std::size_t row = 0; row < rows; ++row) {
        motion.values[0].push_back(static_cast<double>(row));
        motion.values[1].push_back(-static_cast<double>(row));
    }
    motion.begins = {4321, 7777};
    motion.impacts = {4320, 4321, 5001};
    thin_rows(motion, 100);
    EXPECT_LE(motion.values[0].size(), 110U);
    EXPECT_EQ(motion.values[0].front(), 0);
    EXPECT_EQ(motion.values[0].back(), rows - 1);
    EXPECT_EQ(motion.values[0].at(motion.begins[0]), 4321);
    EXPECT_EQ(motion.values[0].at(motion.begins[0] - 1), 4320);
    EXPECT_EQ(motion.values[0].at(motion.begins[1]), 7777);
    EXPECT_EQ(motion.values[0].at(motion.begins[1] - 1), 7776);
    EXPECT_EQ(motion.values[0].at(motion.impacts[2]), 5001);
    EXPECT_EQ(motion.values[1].at(motion.impacts[2]), -5001);
    EXPECT_TRUE(std::is_sorted(motion.values[0].begin(), motion.values[0].end()));
}

TEST(MotionRows, AreFewerOfMoreColumns) {
    EXPECT_EQ(most_rows_of(3), 20'000U);
    EXPECT_LE(most_rows_of(most_motion_names) * (most_motion_names + 1), 400'000U);
}

TEST(MotionRows, AreNotMoreOfMoreContacts) {
    constexpr std::size_t rows = 10'000, most = 100;
    DenseMotion motion;
    motion.values.resize(1);
    motion.modes = {7};
    for (std::size_t row = 0; row < rows; ++row) {
        motion.values[0].push_back(static_cast<double>(row));
        if (row % 3 == 1) {
            motion.begins.push_back(row);
            motion.impacts.push_back(row);
            motion.modes.push_back(row % 5);
        }
    }
    thin_rows(motion, most);
    EXPECT_LE(motion.values[0].size(), 2 * most + 2);
    ASSERT_EQ(motion.modes.size(), motion.begins.size() + 1);
    ASSERT_GT(motion.begins.size(), 10U);
    EXPECT_EQ(motion.modes[0], 7U);
    for (std::size_t arc = 0; arc < motion.begins.size(); ++arc)
        EXPECT_EQ(motion.modes[arc + 1], static_cast<std::size_t>(motion.values[0][motion.begins[arc]]) % 5);
}

} // namespace
} // namespace graze
