// `graze grazing` on shipped studies and on a study of a user.

#include "run_graze.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <sstream>

namespace graze::testing::grazing_command_test {

using ::testing::HasSubstr;

/// The value of a quantity in the command's table.
std::string value_of(const Csv& csv, const std::string& quantity) {
    for (std::size_t row = 0; row < csv.rows.size(); ++row)
        if (csv.text(row, "quantity") == quantity)
            return csv.text(row, "value");
    return "";
}

struct GrazingCommand : public ::testing::Test {
    std::string run_only(const std::string& study, const std::vector<std::string>& runs) {
        return testing::run_only(study, runs, folder / "results");
    }
    Csv table(const std::vector<std::string>& words) {
        std::vector<std::string> all{"grazing"};
        all.insert(all.end(), words.begin(), words.end());
        all.insert(all.end(), {"--format", "csv"});
        return Csv(done(all));
    }
    Folder folder;
};

TEST_F(GrazingCommand, FindsTheGrowthOfJumpsOfBallAndShaker) {
    const std::string results = run_only("ball-and-shaker", {"rest_6Hz", "touch_6Hz", "rest_18Hz", "touch_18Hz"});
    for (const auto& [point, n, log_c] :
         {std::tuple("touch_6Hz:GR1", "1", 1.01155084345), std::tuple("touch_18Hz:GR1", "3", 1.48867209817)}) {
        const Csv csv = table({results, point, "--verify"});
        EXPECT_EQ(value_of(csv, "map"), "square-root");
        EXPECT_EQ(value_of(csv, "verdict"), "lost");
        EXPECT_EQ(value_of(csv, "next_contact"), n);
        EXPECT_NEAR(std::stod(value_of(csv, "log10_jump_growth")), log_c, 1e-10);
        EXPECT_EQ(value_of(csv, "contacts_when"), "above");
        EXPECT_EQ(value_of(csv, "trial"), "agreed");
    }
    const Printed json = run_graze({"grazing", results, "touch_6Hz:GR1", "--format", "json", "--verify"});
    EXPECT_THAT(json.out, HasSubstr("\"verdict\":\"lost\""));
    EXPECT_THAT(json.out, HasSubstr("\"trial_motions\":[{"));
}

/// Table 4.1 of the dissertation: regression lines of the logarithms of successive jumps at simulated impacts. It does
/// not tell the range of the fit, hence the tolerance of 0.003. The line of the map is the limit of small speeds.
TEST_F(GrazingCommand, PredictsTheLinesOfSimulatedImpacts) {
    struct Line {
        int f;
        double slope, intercept;
    };
    constexpr Line printed[] = {
        {6, 0.5015, 1.0140}, {10, 0.4990, 1.2373}, {14, 0.5005, 1.2404}, {18, 0.4986, 1.4869}, {22, 0.5017, 1.3456}};
    std::vector<std::string> runs{"impacts"};
    for (const Line& line : printed)
        for (const char* kind : {"rest", "touch"})
            runs.push_back(fmt::format("{}_{}Hz", kind, line.f));
    const std::string results = run_only("ball-and-shaker", runs);
    const std::string lines = done({"plot",
                                    results,
                                    "--run",
                                    "impacts",
                                    "--kind",
                                    "regression",
                                    "--y",
                                    "velocity_jump",
                                    "--successive",
                                    "--group",
                                    "f",
                                    "--fit",
                                    "0.01:1",
                                    "--log",
                                    "x",
                                    "--log",
                                    "y",
                                    "--output",
                                    folder / "lines.svg",
                                    "--data",
                                    folder / "lines.gp"});
    std::istringstream rows(lines);
    std::string row;
    std::getline(rows, row);
    std::getline(rows, row); // names and units
    for (const Line& line : printed) {
        int f = 0, points = 0;
        double slope = 0, slope_error = 0, intercept = 0, intercept_error = 0;
        ASSERT_TRUE(rows >> f >> slope >> slope_error >> intercept >> intercept_error >> points) << lines;
        EXPECT_EQ(f, line.f);
        EXPECT_GE(points, 50);
        EXPECT_NEAR(slope, line.slope, 0.003) << f;
        EXPECT_NEAR(intercept, line.intercept, 0.003) << f;
        const Csv csv = table({results, fmt::format("touch_{}Hz:GR1", f)});
        // The next order of the map grows with the root of the speed, up to 1 mm/s in the fit.
        EXPECT_NEAR(slope, 0.5, 1e-3) << f;
        EXPECT_NEAR(intercept, std::stod(value_of(csv, "log10_jump_growth")), 2e-3) << f;
    }
}

TEST_F(GrazingCommand, AcceptsAnyPointWhoseOrbitTouches) {
    const std::string results = run_only("mems-switch", {"free", "no_impact", "touches_gap"});
    const Csv touch = table({results, "no_impact:GR1"});
    EXPECT_EQ(value_of(touch, "parameter"), "V");
    // The curve of touches begins at that grazing. Its points have other types, but their orbits touch.
    for (const char* point : {"touches_gap:EP1", "touches_gap:BD1", "touches_gap:3"}) {
        const Csv csv = table({results, point, "--parameter", "V"});
        EXPECT_EQ(value_of(csv, "verdict"), "lost") << point;
    }
    EXPECT_NEAR(std::stod(value_of(touch, "jump_growth")),
                std::stod(value_of(table({results, "touches_gap:EP1", "--parameter", "V"}), "jump_growth")), 1e-9);
}

TEST_F(GrazingCommand, RefusesOrbitsWithoutATouch) {
    const std::string results = run_only("mems-switch", {"free", "no_impact"});
    expect_refusal({"grazing", results, "no_impact:EP1"}, "the orbit at EP1 touches nothing; choose a grazing (GR)");
    expect_refusal({"grazing", results, "no_impact:GR1", "--parameter", "omegaa"}, "omega");
    const Printed missing = run_graze({"grazing", results, "no_impact:GR9"});
    EXPECT_EQ(missing.code, 2);
}

TEST_F(GrazingCommand, FindsTheFoldOfACompliantStop) {
    const std::string results = run_only("microbeam", {"free", "no_contact"});
    const Csv csv = table({results, "no_contact:GR1", "--verify"});
    EXPECT_EQ(value_of(csv, "map"), "three-halves");
    EXPECT_EQ(value_of(csv, "verdict"), "folds");
    EXPECT_GT(std::stod(value_of(csv, "fold_distance")), 0);
    EXPECT_EQ(value_of(csv, "trial"), "agreed");
}

TEST_F(GrazingCommand, FindsThePersistenceOfAStickingOrbit) {
    const std::string study = folder / "rubbing.toml";
    std::ofstream(study) << R"toml(
name = "rubbing"
model = "dry-friction-oscillator"
set = { friction_static = 0.3, friction_dynamic = 0.3 }
[runs.slow]
kind = "continue"
direction = "up"
set = { omega = 0.2 }
along = { omega = [0.15, 0.3] }
)toml";
    const std::string results = folder / "rubbing";
    done({"run", study, "--output", results, "--quiet"});
    const Csv csv = table({results, "GR1", "--verify"});
    EXPECT_EQ(value_of(csv, "map"), "linear");
    EXPECT_EQ(value_of(csv, "border"), "persistence");
    EXPECT_EQ(value_of(csv, "beyond"), "1 in 1");
    EXPECT_EQ(value_of(csv, "trial"), "agreed");
    // Trip times exist only for rigid contacts.
    const Printed trip = run_graze({"trip", results, "GR1", "--overshoot", "1e-4"});
    EXPECT_EQ(trip.code, 2);
}

} // namespace graze::testing::grazing_command_test
