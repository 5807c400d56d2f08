#include "graze/study/runner.hpp"
#include "graze/symbolic/input_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

namespace graze {
namespace {

using testing::HasSubstr;

/// Without damping worth mentioning, grazing is where 1/(omega^2 - 1) is the gap; here with the damping.
const std::string study_text = R"(
name = "s"
model = "impact-oscillator"

[runs.rest]
kind = "orbit"
set = { omega = 4 }
from = { x = -0.07 }

[runs.free]
kind = "continue"
start = { run = "rest" }
along = { omega = [2.2, 4.5] }
direction = "both"

[runs.impacting]
kind = "continue"
start = { run = "free", point = "GR1" }
along = { omega = [2.2, 4.5] }
monitors = { speed = { value = "v", at = "impact", report = 0.5 }, reach = { minimum = "x" } }

[runs.doubled]
kind = "continue"
start = { run = "impacting", point = "PD1" }
along = { omega = [2.2, 4.5] }
stop = "PD"

[runs.wider]
kind = "continue"
text = "another parameter, from a point that is not special"
start = { run = "impacting", at = { omega = 2.3 } }
along = { e = [0.5, 0.95] }

[runs.swept]
kind = "sweep"
start = { run = "impacting", point = "BD1" }
set = { omega = 2.3 }
vary = { e = [0.78, 0.8] }
)";

class BranchRun : public testing::Test {
protected:
    void SetUp() override {
        folder_ =
            std::filesystem::temp_directory_path() / ("graze-branch-" + std::to_string(getpid()) + "-" +
                                                      testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::create_directories(folder_);
        path_ = (folder_ / "results.sqlite").string();
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::vector<RunReport> run(const std::string& text, const RunnerOptions& options = {}) {
        ResultFile file(path_, ResultFile::Access::write);
        return run_study(parse_study(text, "s.toml"), file, options);
    }
    std::string refusal(const std::string& text) {
        try {
            run(text);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    }

    std::filesystem::path folder_;
    std::string path_;
};

TEST_F(BranchRun, goes_from_rest_across_grazing_to_a_flip) {
    const auto reports = run(study_text);
    ASSERT_EQ(reports.size(), 6u);
    const ResultFile file(path_, ResultFile::Access::read);
    // Amplitude 1/|H| at the gap 0.1: |H|^2 = (1 - w)^2 + 4 zeta^2 w with w = omega^2.
    const double zeta = 0.02, b = 1 - 2 * zeta * zeta, w = b + std::sqrt(b * b - 1 + 100);
    const auto grazing = file.orbit("free", std::string("GR1"));
    ASSERT_TRUE(grazing);
    EXPECT_NEAR(grazing->point.parameter, std::sqrt(w), 1e-12);
    EXPECT_EQ(grazing->part, "down");
    EXPECT_LE(grazing->point.bracket.first, grazing->point.parameter);
    EXPECT_GE(grazing->point.bracket.second, grazing->point.parameter);
    EXPECT_EQ(file.orbit("free", std::string("BD1"))->part, "up");
    // With one impact, found from the grazing point without being told.
    const auto flip = file.orbit("impacting", std::string("PD1"));
    ASSERT_TRUE(flip);
    EXPECT_EQ(to_string(parse_study(study_text, "s.toml").runs[2].model, flip->point.solution.orbit.signature),
              "impact");
    EXPECT_NEAR(flip->point.solution.multipliers.front().real(), -1, 1e-8);
    const auto fast = file.orbit("impacting", std::string("UZ1"));
    ASSERT_TRUE(fast);
    EXPECT_NEAR(fast->point.monitors[0], 0.5, 1e-12);
    EXPECT_NEAR(fast->point.solution.certificate.approach_speeds[0], 0.5, 1e-12);
    // The doubled orbit, another parameter, and a sweep that begins on the branch.
    EXPECT_EQ(file.orbits("doubled", false).front().point.solution.orbit.segments(), 2u);
    const auto wider = file.orbits("wider", false);
    ASSERT_GE(wider.size(), 3u);
    EXPECT_NEAR(wider.front().point.solution.orbit.parameters[1], 2.3, 1e-15);
    EXPECT_NEAR(wider.back().point.parameter, 0.95, 1e-12);
    EXPECT_EQ(file.point("swept", 1)->result.signature, "impact");
}

TEST_F(BranchRun, what_is_read_is_what_was_written) {
    std::vector<OrbitRecord> written;
    RunnerOptions options;
    options.only = {"impacting"};
    options.orbit = [&](const std::string& name, const OrbitRecord& record) {
        if (name == "impacting")
            written.push_back(record);
    };
    run(study_text, options);
    const ResultFile file(path_, ResultFile::Access::read);
    const auto read = file.orbits("impacting", false);
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
        const SpecialPoint &a = written[i].point, &b = read[i].point;
        EXPECT_EQ(written[i].label, read[i].label);
        EXPECT_EQ(written[i].stable, read[i].stable);
        EXPECT_EQ(a.type, b.type);
        EXPECT_EQ(a.detail, b.detail);
        EXPECT_EQ(a.parameter, b.parameter);
        EXPECT_EQ(a.tangent, b.tangent);
        EXPECT_EQ(a.monitors, b.monitors);
        EXPECT_EQ(a.solution.multipliers, b.solution.multipliers);
        EXPECT_EQ(a.solution.orbit.signature, b.solution.orbit.signature);
        EXPECT_EQ(a.solution.orbit.parameters, b.solution.orbit.parameters);
        EXPECT_EQ(a.solution.orbit.starts, b.solution.orbit.starts);
        EXPECT_EQ(a.solution.orbit.durations, b.solution.orbit.durations);
        EXPECT_EQ(a.solution.certificate.approach_speeds, b.solution.certificate.approach_speeds);
        EXPECT_EQ(a.solution.certificate.admissible, b.solution.certificate.admissible);
    }
    EXPECT_EQ(file.orbits("impacting", true).size(),
              static_cast<std::size_t>(std::count_if(written.begin(), written.end(), [](const OrbitRecord& record) {
                  return record.point.type != PointType::regular;
              })));
    EXPECT_FALSE(file.orbit("impacting", std::string("GR9")));
    EXPECT_FALSE(file.orbit("impacting", std::size_t{100000}));
    EXPECT_FALSE(file.point("impacting", 0)) << "points belong to other kinds";
}

TEST_F(BranchRun, is_done_once_and_begun_again_when_interrupted) {
    RunnerOptions options;
    std::size_t orbits = 0;
    options.only = {"impacting"};
    options.orbit = [&](const std::string&, const OrbitRecord&) { ++orbits; };
    options.interrupted = [&] { return orbits >= 5; };
    const auto first = run(study_text, options);
    EXPECT_FALSE(first.back().complete);
    options.interrupted = {};
    orbits = 0;
    const auto second = run(study_text, options);
    EXPECT_TRUE(second.back().complete);
    EXPECT_EQ(second.back().computed, second.back().points);
    orbits = 0;
    const auto third = run(study_text, options);
    EXPECT_EQ(orbits, 0u);
    EXPECT_EQ(third.back().points, second.back().points);
    EXPECT_EQ(third.back().computed, 0u);
    ResultFile file(path_, ResultFile::Access::write);
    const auto numbers = file.query("SELECT count(*), max(number) + 1 FROM branch_points WHERE run = 'impacting'");
    file.remove_run("impacting");
    EXPECT_FALSE(file.find_run("impacting"));
    auto rows = file.query("SELECT count(*) FROM multipliers WHERE run = 'impacting'");
    ASSERT_TRUE(rows.next());
    EXPECT_EQ(rows.integer(0), 0);
}

TEST_F(BranchRun, keeps_what_fails) {
    std::ofstream(folder_ / "far.csv") << "segment,t,x,v,theta\n1,0,0.1,-100,0\n1,0.01,0.1,1.2,6.28\n";
    const std::string text = "name = \"s\"\nmodel = \"impact-oscillator\"\n[runs.a]\nkind = \"orbit\"\ntable = \"" +
                             (folder_ / "far.csv").string() + "\"\nsignature = \"impact\"\n";
    EXPECT_TRUE(run(text).front().complete);
    {
        const ResultFile file(path_, ResultFile::Access::read);
        const auto record = file.orbit("a", std::size_t{0});
        ASSERT_TRUE(record);
        EXPECT_NE(record->point.solution.outcome, OrbitOutcome::converged);
        EXPECT_FALSE(record->point.located);
        EXPECT_FALSE(record->point.solution.certificate.admissible);
        EXPECT_FALSE(record->point.detail.empty());
    }
    EXPECT_THAT(refusal(text + "[runs.b]\nkind = \"continue\"\nstart = { run = \"a\" }\nalong = \"omega\"\n"),
                HasSubstr("s.toml:9:1: run 'a' found no orbit there"));
}

TEST_F(BranchRun, mistakes_are_told_with_their_place_and_remedy) {
    const std::string head = "name = \"s\"\nmodel = \"impact-oscillator\"\n",
                      orbit = head + "[runs.a]\nkind = \"orbit\"\n",
                      both = orbit + "set = { omega = 2.2 }\n[runs.b]\nkind = \"continue\"\nstart = { run = \"a\" }\n";
    EXPECT_THAT(refusal(orbit + "along = \"omega\""), HasSubstr("s.toml:5:9: runs of kind \"orbit\" have no `along`"));
    EXPECT_THAT(refusal(head + "[runs.a]\nkind = \"sweep\"\nsignature = \"impact\"\nvary = { omega = [1, 2] }"),
                HasSubstr("runs of kind \"sweep\" have no `signature`"));
    EXPECT_THAT(refusal(both), HasSubstr("does not say what is followed"));
    EXPECT_THAT(refusal(both + "along = { Omega = [1, 2] }"), HasSubstr("did you mean 'omega'?"));
    EXPECT_THAT(refusal(both + "along = { omega = [3, 2] }"), HasSubstr("give the smaller number first"));
    EXPECT_THAT(refusal(both + "along = { omega = [1, 2], e = [0, 1] }"), HasSubstr("names 2 parameters"));
    EXPECT_THAT(refusal(both + "along = \"omega\"\nstop = \"XX\""), HasSubstr("there is no type of point 'XX'"));
    EXPECT_THAT(refusal(both + "along = \"omega\"\nmonitors = { a = { maximum = \"y\" } }"), HasSubstr("'y'"));
    EXPECT_THAT(refusal(both + "along = \"omega\"\nmonitors = { a = { maximum = \"x\", minimum = \"x\" } }"),
                HasSubstr("is measured in 2 ways"));
    EXPECT_THAT(refusal(both + "along = \"omega\"\nmonitors = { a = { value = \"x\", at = \"bang\" } }"),
                HasSubstr("the orbit has no segment 'bang'"));
    EXPECT_THAT(refusal(both + "along = \"omega\"\nfree = \"e\""), HasSubstr("0 monitors are fixed and 1"));
    EXPECT_THAT(refusal(orbit + "signature = \"impact release\""), HasSubstr("does not have the signature"));
    EXPECT_THAT(refusal(orbit + "signature = \"impact bang\""), HasSubstr("bang"));
    EXPECT_THAT(refusal(orbit + "table = \"/no/such.csv\""), HasSubstr("cannot be read"));
    EXPECT_THAT(
        refusal(both + "along = \"omega\"\n[runs.c]\nkind = \"continue\"\nstart = { run = \"b\" }\nalong = \"e\""),
        HasSubstr("run 'b' has many points"));
    EXPECT_THAT(refusal(both + "along = { omega = [2.1, 2.3] }\n[runs.c]\nkind = \"continue\"\nstart = { run = \"b\", "
                               "point = \"GR1\" }\nalong = \"e\""),
                HasSubstr("run 'b' has no point 'GR1'; it has EP1, BD1"));
    EXPECT_THAT(refusal(both + "along = { omega = [2.1, 2.3] }\n[runs.c]\nkind = \"continue\"\nstart = { run = \"b\", "
                               "point = \"BD1\", onto = \"other\" }\nalong = \"omega\""),
                HasSubstr("no other branch leaves from a point of type BD"));
}

} // namespace
} // namespace graze
