#include "graze/model/catalogue.hpp"

#include "branch/maps.hpp"
#include "results/run_of_model.hpp"
#include "study_of_every_kind.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

namespace graze::branch_run_test {

using ::testing::HasSubstr;

/// Without damping worth mentioning, grazing is where 1/(omega^2 - 1) is the gap; here with the damping.
const std::string rest_text = R"(
name = "s"
model = "impact-oscillator"
[runs.rest]
kind = "orbit"
set = { omega = 4 }
from = { x = -0.07 }
)";
const std::string study_text = rest_text + R"(
[runs.free]
kind = "continue"
start = { run = "rest" }
along = { omega = [2.2, 4.5] }
direction = "both"

[runs.impacting]
kind = "continue"
direction = "up"
start = { run = "free", point = "GR1" }
along = { omega = [2.2, 4.5] }
monitors = { speed = { value = "v", at = "impact", report = 0.5 }, reach = { minimum = "x" } }

[runs.doubled]
kind = "continue"
direction = "up"
start = { run = "impacting", point = "PD1" }
along = { omega = [2.2, 4.5] }
stop = "PD"

[runs.wider]
kind = "continue"
direction = "up"
text = "another parameter, from a point that is not special"
start = { run = "impacting", at = { omega = 2.3 } }
along = { e = [0.5, 0.95] }

[runs.swept]
kind = "sweep"
start = { run = "impacting", point = "BD1" }
set = { omega = 2.3 }
vary = { e = [0.78, 0.8] }
)";

using BranchRun = testing::StudyFixture;

TEST_F(BranchRun, TellsWhatBecomesOfTouchesAndFollowsTheBoundaryBetweenVerdicts) {
    const std::string text = R"(
name = "classes"
model = "impact-oscillator"
set = { zeta = 0.05, sigma = 1 }
[runs.free]
kind = "continue"
direction = "up"
set = { omega = 2.4, amplitude = 0.5 }
along = { amplitude = [0.1, 10] }
grazing = true
[runs.touches]
kind = "curve"
start = { run = "free", point = "GR1" }
along = { omega = [1.6, 3], amplitude = [0, 10] }
direction = "down"
grazing = true
[runs.boundary]
kind = "curve"
direction = "up"
start = { run = "touches", point = "VS1" }
along = { zeta = [0.01, 0.5], omega = [0.1, 3] }
free = { amplitude = [0, 100] }
)";
    testing::expect_complete(run(text));
    const ResultFile file(path_, ResultFile::Access::read);
    const double own = std::sqrt(1 - 0.05 * 0.05);
    // The projection after one cycle of the free oscillator: an impact takes (1 + e) from the speed, e = 0.8.
    const auto projection = [&](double omega) {
        const double time = 2 * std::numbers::pi / omega;
        return 1.8 * std::exp(-0.05 * time) * std::sin(own * time) / own;
    };
    const auto grazing = file.orbit("free", std::string("GR1"));
    ASSERT_TRUE(grazing && grazing->touch);
    EXPECT_FALSE(file.orbit("free", std::string("EP1"))->touch);
    EXPECT_EQ(grazing->touch->map, "square-root");
    EXPECT_NEAR(grazing->touch->projection.value(), projection(2.4), 1e-9);
    EXPECT_EQ(grazing->touch->verdict == "lost" && grazing->touch->next_contact == 1, projection(2.4) < 0);
    std::size_t points = 0;
    for (const OrbitRecord& one : file.orbits("touches", false)) {
        ASSERT_TRUE(one.touch) << one.number;
        EXPECT_NEAR(one.touch->projection.value(), projection(one.point.parameter), 1e-9) << one.point.parameter;
        ++points;
    }
    EXPECT_GT(points, 5U);
    for (const OrbitRecord& one : file.orbits("boundary", false)) {
        const double zeta = one.point.parameter;
        EXPECT_NEAR(2 * std::numbers::pi / one.point.solution.orbit.period(), 2 * std::sqrt(1 - zeta * zeta), 1e-10);
    }
    // What cannot be asked for.
    const std::string first = text.substr(0, text.find("[runs.boundary]"));
    EXPECT_THAT(refusal(first + R"([runs.b]
kind = "curve"
direction = "up"
start = { run = "touches", point = "VS1" }
along = { zeta = [0.01, 0.5], omega = [0.1, 3] }
)"),
                HasSubstr("needs a third parameter"));
    EXPECT_THAT(refusal(first + R"([runs.b]
kind = "curve"
direction = "up"
start = { run = "free", point = "GR1" }
along = { zeta = [0.01, 0.5], omega = [0.1, 3] }
free = ["amplitude"]
)"),
                HasSubstr("two further parameters are free"));
}

TEST_F(BranchRun, GoesFromRestAcrossGrazingToAFlip) {
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

const std::string curves_text = study_text + R"(
[runs.touches]
kind = "curve"
start = { run = "free", point = "GR1" }
along = { omega = [2.2, 4.5], amplitude = [0.1, 5] }
direction = "both"

[runs.flips]
kind = "curve"
direction = "up"
start = { run = "impacting", point = "PD1" }
along = { omega = [2.2, 4.5], e = [0.7, 0.9] }

[runs.as_fast]
kind = "curve"
direction = "up"
start = { run = "impacting", point = "UZ1" }
along = { omega = [2.2, 4.5], amplitude = [0.1, 5] }
monitors = { speed = { value = "v", at = "impact", fixed = true } }
)";

TEST_F(BranchRun, CurvesAreChosenWhereSeveralMeet) {
    const std::string onto = "point = \"PD1\", onto = \"";
    const auto with = [&](const std::string& which) {
        std::string text = curves_text;
        const std::string plain = "point = \"PD1\"";
        text.replace(text.find(plain, text.find("[runs.flips]")), plain.size(), onto + which + "\"");
        return text;
    };
    run(curves_text);
    const auto plain = ResultFile(path_, ResultFile::Access::read).orbits("flips", false);
    std::filesystem::remove(path_);
    run(with("PD"));
    const auto chosen = ResultFile(path_, ResultFile::Access::read).orbits("flips", false);
    ASSERT_EQ(chosen.size(), plain.size());
    for (std::size_t i = 0; i < chosen.size(); ++i)
        EXPECT_EQ(chosen[i].point.parameter, plain[i].point.parameter);
    // What chooses a branch says nothing of a curve.
    EXPECT_THROW(run(with("other")), InputError);
    // The point must be what is asked for.
    std::filesystem::remove(path_);
    EXPECT_THAT(refusal(with("GR")), HasSubstr("the point of type PD (flip) is no grazing: its multipliers are -1, "));
    EXPECT_THAT(refusal(with("SN")), HasSubstr("curves that begin there are \"PD\""));
    for (const RunReport& report : run(with("NS")))
        EXPECT_EQ(report.outcome == RunOutcome::failed, report.name == "flips") << report.name << report.problem;
}

TEST_F(BranchRun, CurvesGoOnFromResonances) {
    // Henon's map x -> y, y -> a - b x - y^2: folds a = -(1 + b)^2/4, and b = 1 along the torus points.
    Model henon = testing::map_model("a = 0.3\nb = 0.3", {"y", "a - b*x - y^2"});
    for (const char* state : {"x", "y"})
        henon.set_initial(state, 0.2);
    const std::string model = folder_.write("henon.toml", write_model(henon));
    const auto study = [&](const std::string& last) {
        return "name = \"s\"\nmodel = \"" + model + R"("
[runs.fixed]
kind = "continue"
signature = "map"
along = { a = [-2, 5] }
direction = "down"
[runs.folds]
kind = "curve"
direction = "up"
start = { run = "fixed", point = "SN1" }
along = { b = [0.1, 1.5], a = [-2, 5] }
[runs.last]
kind = "curve"
direction = "up"
start = { run = "folds", point = "R1-1")" +
               last + " }\nalong = { a = [-2, 5], b = [0.1, 1.5] }\n";
    };
    testing::expect_complete(run(study(", onto = \"NS\"")));
    {
        const ResultFile file(path_, ResultFile::Access::read);
        const auto orbits = file.orbits("last", false);
        ASSERT_GT(orbits.size(), 10u);
        EXPECT_EQ(orbits.front().label, "EP1");
        EXPECT_EQ(orbits.back().label, "R2-1") << orbits.back().point.detail;
        for (const OrbitRecord& one : orbits)
            EXPECT_NEAR(one.point.solution.orbit.parameters[1], 1, 1e-11);
        EXPECT_TRUE(file.orbit("last", std::string("R3-1")) && file.orbit("last", std::string("R4-1")));
    }
    std::filesystem::remove(path_);
    EXPECT_THAT(refusal(study(", onto = \"PD\"")),
                ::testing::AllOf(HasSubstr("the point of type R1 (1:1 resonance) is no flip"),
                                 HasSubstr("multipliers are 1"),
                                 HasSubstr("curves that begin there are \"SN\", \"NS\"")));
    std::filesystem::remove(path_);
    EXPECT_THAT(refusal(study("")), HasSubstr("onto = \"SN\" or onto = \"NS\""));
}

TEST_F(BranchRun, FollowsSpecialPointsInTwoParameters) {
    testing::expect_complete(run(curves_text));
    const ResultFile file(path_, ResultFile::Access::read);
    const auto run_of = file.find_run("touches");
    ASSERT_TRUE(run_of);
    EXPECT_EQ(run_of->kind, "curve");
    EXPECT_EQ(run_of->coordinates[0].name, "omega");
    EXPECT_EQ(run_of->coordinates[1].name, "amplitude");
    const auto touches = file.orbits("touches", false);
    ASSERT_GT(touches.size(), 10u);
    std::size_t ends = 0;
    for (const OrbitRecord& one : touches) {
        const double w = one.point.parameter * one.point.parameter, amplitude = one.point.solution.orbit.parameters[2];
        EXPECT_NEAR(amplitude, 0.1 * std::hypot(1 - w, 2 * 0.02 * one.point.parameter), 1e-11);
        ends += one.point.type == PointType::bound ? 1 : 0;
    }
    EXPECT_EQ(ends, 2u);
    const auto flips = file.orbits("flips", false);
    ASSERT_GT(flips.size(), 5u);
    for (const OrbitRecord& one : flips) {
        double off = 1;
        for (const auto multiplier : one.point.solution.multipliers)
            off = std::min(off, std::abs(multiplier + 1.0));
        EXPECT_LT(off, 1e-9);
    }
    for (const OrbitRecord& one : file.orbits("as_fast", false))
        EXPECT_NEAR(one.point.monitors[0], 0.5, 1e-10);
}

TEST_F(BranchRun, CurvesWithoutAStartAreRefusedWithARemedy) {
    const auto with = [&](const std::string& more) {
        return refusal(study_text + "[runs.curve]\nkind = \"curve\"\n" + more);
    };
    const std::string along = "along = { omega = [2.2, 4.5], e = [0.5, 0.95] }\n",
                      start = "start = { run = \"impacting\", point = \"PD1\" }\n";
    EXPECT_THAT(with(along), HasSubstr("does not say where the curve begins"));
    EXPECT_THAT(with(start), HasSubstr("does not say what is followed"));
    EXPECT_THAT(with(start + "along = { omega = [2.2, 4.5] }\n"), HasSubstr("names 1 parameters"));
    EXPECT_THAT(with("start = { run = \"rest\" }\n" + along), HasSubstr("special point of a branch"));
    EXPECT_THAT(with(start + along + "signature = \"impact\"\n"), HasSubstr("have no `signature`"));
    EXPECT_THAT(with("start = { run = \"free\", point = \"BD1\" }\n" + along), HasSubstr("cannot be followed"));
    EXPECT_THAT(with(start + along + "free = [\"sigma\"]\n"),
                HasSubstr("two further parameters are free, and points of type PD"));
}

TEST_F(BranchRun, OrbitsAreReadAsTheyWereWritten) {
    std::vector<OrbitRecord> written, all;
    RunnerOptions options;
    options.only = {"impacting"};
    options.orbit = [&](const std::string& name, const OrbitRecord& record) {
        if (name != "rest")
            all.push_back(record);
        if (name == "impacting")
            written.push_back(record);
    };
    run(study_text, options);
    const ResultFile file(path_, ResultFile::Access::read);
    auto read = file.orbits("free", false);
    for (OrbitRecord& record : file.orbits("impacting", false))
        read.push_back(std::move(record));
    ASSERT_EQ(read.size(), all.size());
    std::size_t details = 0;
    for (std::size_t i = 0; i < read.size(); ++i) {
        EXPECT_TRUE(testing::contents_of(all[i]) == testing::contents_of(read[i])) << i;
        details += testing::details_of(all[i].point).size();
    }
    EXPECT_GT(details, 10u);
    EXPECT_EQ(file.orbits("impacting", true).size(),
              static_cast<std::size_t>(std::count_if(written.begin(), written.end(), [](const OrbitRecord& record) {
                  return record.point.type != PointType::regular;
              })));
    EXPECT_FALSE(file.orbit("impacting", std::string("GR9")));
    EXPECT_FALSE(file.orbit("impacting", std::size_t{100000}));
    EXPECT_FALSE(file.point("impacting", 0)) << "points belong to other kinds";
}

TEST_F(BranchRun, IsComputedOnceAndBeginsAgainWhenInterrupted) {
    RunnerOptions options;
    std::size_t orbits = 0;
    options.only = {"impacting"};
    options.orbit = [&](const std::string&, const OrbitRecord&) { ++orbits; };
    options.interrupted = [&] { return orbits >= 5; };
    const auto first = run(study_text, options);
    EXPECT_FALSE(first.back().complete());
    options.interrupted = {};
    orbits = 0;
    const auto second = run(study_text, options);
    EXPECT_TRUE(second.back().complete());
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

TEST_F(BranchRun, StoresOrbitsThatWereNotFound) {
    std::ofstream(folder_ / "far.csv") << "segment,t,x,v,theta\n1,0,0.1,-100,0\n1,0.01,0.1,1.2,6.28\n";
    const std::string text = "name = \"s\"\nmodel = \"impact-oscillator\"\n[runs.a]\nkind = \"orbit\"\ntable = \"" +
                             folder_ / "far.csv" + "\"\nsignature = \"impact\"\n";
    for (int again = 0; again < 2; ++again) // also when it is found in the file
        EXPECT_EQ(run(text).front().outcome, RunOutcome::failed);
    {
        const ResultFile file(path_, ResultFile::Access::read);
        const auto record = file.orbit("a", std::size_t{0});
        ASSERT_TRUE(record);
        EXPECT_NE(record->point.solution.outcome, OrbitOutcome::converged);
        EXPECT_FALSE(record->point.located);
        EXPECT_FALSE(record->point.solution.certificate.admissible);
        EXPECT_FALSE(record->point.detail.empty());
    }
    const auto reports = run(text + "[runs.b]\nkind = \"continue\"\nstart = { run = \"a\" }\nalong = \"omega\"\n" +
                             "[runs.c]\nkind = \"orbit\"\nset = { omega = 4 }\nfrom = { x = -0.07 }\n");
    ASSERT_EQ(reports.size(), 3u);
    EXPECT_EQ(reports[1].outcome, RunOutcome::skipped);
    EXPECT_THAT(reports[1].problem, HasSubstr("run 'a', from which it starts, failed"));
    EXPECT_EQ(reports[2].outcome, RunOutcome::complete) << "it does not depend on the others";
}

TEST_F(BranchRun, AnOrbitNeedsNoParameter) {
    std::ofstream(folder_ / "free.toml") << "name = \"free\"\n[states]\nx = 2\ny = 0\n[modes.only]\n"
                                            "rates = { x = \"y\", y = \"(1 - x^2)*y - x\" }\n"
                                            "[sections.top]\nfunction = \"y\"\ndirection = \"falling\"\n";
    const std::string head = "name = \"s\"\nmodel = \"" + folder_ / "free.toml" + "\"\n[runs.a]\n";
    EXPECT_EQ(run(head + "kind = \"orbit\"\nsection = \"top\"\n").front().outcome, RunOutcome::complete);
    const ResultFile file(path_, ResultFile::Access::read);
    const auto record = file.orbit("a", std::size_t{0});
    ASSERT_TRUE(record);
    EXPECT_NEAR(record->point.solution.orbit.period(), 6.6632868593, 1e-9); // van der Pol, mu = 1
    EXPECT_THROW(run(head + "kind = \"continue\"\nalong = \"mu\"\n"), InputError);
}

/// A branch that has one orbit only, because it cannot go on from that, is no result to be content with.
TEST_F(BranchRun, FailsWhereItDoesNotLeaveItsFirstOrbit) {
    const std::string rest = rest_text +
                             "[runs.a]\nkind = \"continue\"\n"
                             "start = { run = \"rest\" }\nalong = { omega = [3.9, 4] }\ndirection = \"up\"\n";
    for (int again = 0; again < 2; ++again) { // also when it is found in the file
        const auto reports = run(rest);
        ASSERT_EQ(reports.size(), 2U);
        EXPECT_EQ(reports[1].outcome, RunOutcome::failed);
        EXPECT_THAT(reports[1].problem, HasSubstr("does not leave its first orbit, up: bound reached"));
        EXPECT_THAT(reports[1].remedy, HasSubstr("the other direction"));
    }
    // The orbit is there, and others may begin with it; both ways there is one.
    const auto reports = run(rest + "[runs.b]\nkind = \"continue\"\nstart = { run = \"a\", point = \"EP1\" }\n"
                                    "along = { omega = [3.9, 4] }\ndirection = \"both\"\n");
    ASSERT_EQ(reports.size(), 3U);
    EXPECT_EQ(reports[2].outcome, RunOutcome::complete) << reports[2].problem;
}

/// Failures at every place of a chain of runs: all that do not depend on one are done, all others say why not.
TEST_F(BranchRun, RunsThatDoNotNeedAFailedRunAreComputed) {
    const std::string head = "name = \"s\"\nmodel = \"impact-oscillator\"\n";
    for (int broken = 0; broken < 4; ++broken) {
        std::string text = head;
        const std::vector<int> parent{-1, 0, 1, -1, 3};
        for (int r = 0; r < 5; ++r) {
            const std::string name(1, static_cast<char>('a' + r));
            text += "[runs." + name + "]\nkind = \"simulate\"\nset = { e = 0." + std::to_string(5 + broken) + " }\n";
            // Runs that start from it ask it for a parameter that it does not vary.
            text += r == broken ? "vary = { x = [1] }\nperiods = 1\n" : "periods = 2\n";
            if (parent[static_cast<std::size_t>(r)] >= 0)
                text += "start = { run = \"" +
                        std::string(1, static_cast<char>('a' + parent[static_cast<std::size_t>(r)])) + "\", " +
                        (parent[static_cast<std::size_t>(r)] == broken ? "at = { e = 1 }" : "point = 0") + " }\n";
        }
        const auto reports = run(text);
        ASSERT_EQ(reports.size(), 5u);
        std::vector<bool> failed(5);
        for (std::size_t r = 0; r < 5; ++r) {
            const bool hangs = parent[r] >= 0 && (parent[r] == broken || failed[static_cast<std::size_t>(parent[r])]);
            failed[r] = hangs;
            EXPECT_EQ(reports[r].outcome == RunOutcome::complete, !hangs) << broken << ' ' << r;
            EXPECT_EQ(reports[r].problem.empty(), !hangs);
            EXPECT_EQ(reports[r].remedy.empty(), !hangs);
        }
    }
}

/// Runs of every kind begin with the parameters of the point that they start from, except those that they set.
TEST_F(BranchRun, BeginsAtTheParametersOfThePoint) {
    const std::string text = R"(
name = "s"
model = "impact-oscillator"
[runs.rest]
kind = "orbit"
set = { omega = 4, e = 0.7, zeta = 0.03 }
from = { x = -0.07 }
[runs.free]
kind = "continue"
direction = "up"
start = { run = "rest" }
along = { omega = [3.9, 4.1] }
[runs.motion]
kind = "simulate"
start = { run = "free", point = "BD1" }
periods = 3
values = ["omega", "e", "zeta", "x"]
sample = "phase0"
[runs.on]
kind = "simulate"
start = { run = "motion", point = 0 }
set = { e = 0.6 }
periods = 3
values = ["omega", "e", "zeta", "x"]
[runs.swept]
kind = "sweep"
start = { run = "free", point = "BD1" }
vary = { e = [0.5, 0.55] }
values = ["omega", "e", "zeta", "x"]
[runs.after]
kind = "basin"
start = { run = "swept", at = { e = 0.5 } }
values = ["omega", "e", "zeta", "x"]
)";
    for (const RunReport& report : run(text))
        EXPECT_TRUE(report.complete()) << report.name << ": " << report.problem;
    const ResultFile file(path_, ResultFile::Access::read);
    const double omega = file.orbit("free", std::string("BD1"))->point.parameter;
    EXPECT_NEAR(omega, 4.1, 1e-12);
    const auto expect = [&](const std::string& name, std::size_t point, double e) {
        const auto record = file.point(name, point);
        ASSERT_TRUE(record && !record->result.samples.values.empty()) << name;
        EXPECT_EQ(record->result.samples.values[0], omega) << name;
        EXPECT_EQ(record->result.samples.values[1], e) << name;
        EXPECT_EQ(record->result.samples.values[2], 0.03) << name;
        // It is an orbit there: the section is passed at the same place each time.
        EXPECT_NEAR(record->result.samples.values[3],
                    file.orbit("free", std::string("BD1"))->point.solution.orbit.starts.front()[0], 1e-8)
            << name;
    };
    expect("motion", 0, 0.7);
    expect("on", 0, 0.6);
    expect("swept", 0, 0.5);
    expect("swept", 1, 0.55);
    expect("after", 0, 0.5);
}

TEST_F(BranchRun, MultipliersAreReportedAndBounded) {
    const std::string head = rest_text + R"(monitors = { largest = { multiplier = 1 }, next = { multiplier = 2 } }
[runs.free]
kind = "continue"
start = { run = "rest" }
along = { zeta = [0.001, 0.1] }
direction = "down"
)";
    // Without contact both multipliers have the modulus exp(-zeta*2 pi/omega).
    const auto modulus = [](double zeta) { return std::exp(-zeta * 2 * std::numbers::pi / 4); };
    run(head + "monitors = { largest = { multiplier = 1, report = [0.98, 0.99], bounds = [0.1, 0.995] } }");
    const ResultFile file(path_, ResultFile::Access::read);
    const auto rest = file.orbit("rest", std::size_t{0});
    EXPECT_NEAR(rest->point.monitors.at(0), modulus(0.02), 1e-11);
    EXPECT_NEAR(rest->point.monitors.at(1), modulus(0.02), 1e-11);
    for (const OrbitRecord& record : file.orbits("free", false))
        EXPECT_NEAR(record.point.monitors.at(0), modulus(record.point.parameter), 1e-11);
    EXPECT_NEAR(file.orbit("free", std::string("UZ1"))->point.monitors.at(0), 0.98, 1e-11);
    EXPECT_NEAR(file.orbit("free", std::string("UZ2"))->point.monitors.at(0), 0.99, 1e-11);
    EXPECT_NEAR(file.orbit("free", std::string("BD1"))->point.monitors.at(0), 0.995, 1e-11);
    EXPECT_THAT(refusal(head + "monitors = { largest = { multiplier = 1, fixed = true } }\nfree = \"e\""),
                HasSubstr("which cannot be held; report values"));
    EXPECT_THAT(refusal(head + "monitors = { largest = { multiplier = 4 } }"), HasSubstr("the model has 3 states"));
    EXPECT_THAT(refusal(head + "monitors = { largest = { multiplier = 1, at = \"impact\" } }"),
                HasSubstr("multipliers are those of the whole orbit"));
}

/// The orbit from which a branch is followed both ways is listed once, and images of other points are said to be such.
TEST_F(BranchRun, ListsEachSpecialPointOnce) {
    run(rest_text + R"(
[runs.free]
kind = "continue"
start = { run = "rest" }
along = { omega = [3.8, 4.2] }
direction = "both"
)");
    const ResultFile file(path_, ResultFile::Access::read);
    std::size_t at_start = 0, parts_begun = 0;
    for (const OrbitRecord& record : file.orbits("free", false)) {
        parts_begun += record.point.step == 0 ? 1 : 0;
        at_start += record.point.step == 0 && record.point.type != PointType::regular ? 1 : 0;
    }
    EXPECT_EQ(parts_begun, 2u);
    EXPECT_EQ(at_start, 1u);
}

TEST_F(BranchRun, MistakesAreReportedWithPlaceAndRemedy) {
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

TEST_F(BranchRun, FollowsSymmetricOrbitsByTheirHalfWhereverTheyComeFrom) {
    const std::string head = "name = \"s\"\nmodel = \"impact-oscillator-two-stops\"\n";
    run(head +
        "[runs.asked]\nkind = \"orbit\"\nsignature = \"free:right free:left\"\n[runs.settled]\nkind = \"orbit\"\n");
    const ResultFile file(path_, ResultFile::Access::read);
    const auto asked = file.orbit("asked", std::size_t{0}), settled = file.orbit("settled", std::size_t{0});
    ASSERT_TRUE(asked && settled);
    ASSERT_TRUE(asked->point.solution.orbit.symmetry);
    EXPECT_NEAR(asked->point.solution.orbit.period(), settled->point.solution.orbit.period(), 1e-12);
    EXPECT_NEAR(std::abs(asked->point.solution.multipliers[0]), std::abs(settled->point.solution.multipliers[0]), 1e-9);
    // The same as a table of the whole orbit.
    const Model model = load_model("impact-oscillator-two-stops");
    const Orbit whole = whole_orbit(System(model), asked->point.solution.orbit);
    folder_.write("whole.csv", testing::table_of(model, whole));
    const std::string tabled = head +
                               "[runs.tabled]\nkind = \"continue\"\nalong = { omega = [1.1, 1.3] }\nsteps = 3\n"
                               "table = \"" +
                               folder_ / "whole.csv" + "\"\n";
    run(tabled);
    const ResultFile again(path_, ResultFile::Access::read);
    EXPECT_TRUE(again.orbit("tabled", std::size_t{0})->point.solution.orbit.symmetry);
}

} // namespace graze::branch_run_test
