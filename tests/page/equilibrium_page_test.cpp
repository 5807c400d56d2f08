// What the page gets of equilibria, and what it offers to go on from them.

#include "base/message_of.hpp"
#include "base/temporary_folder.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/stored_study.hpp"
#include "page/motion_json.hpp"
#include "page/point_json.hpp"
#include "page/proposed_run.hpp"
#include "page/runs_json.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>

namespace graze {
namespace {

/// The normal form of a Bogdanov-Takens point. Equilibria are (x, 0) with b1 + b2 x + x^2 = 0; the Jacobian has the
/// trace -x and the determinant -(b2 + 2x): folds on 4 b1 = b2^2, Hopf points at b1 = 0 for b2 < 0, which meet at 0.
const char* const bogdanov = R"(name = "bogdanov"
[parameters]
b1 = -0.1
b2 = -1
[states]
x = -0.1
y = 0
[modes.free]
rates = { x = "y", y = "b1 + b2*x + x^2 - x*y" }
)";

const char* const text = R"(name = "s"
model = "./bogdanov.toml"
[runs.all]
kind = "equilibrium"
within = { x = [-3, 3], y = [-1, 1] }
[runs.branch]
kind = "continue"
signature = "equilibrium"
along = { b1 = [-1, 1] }
[runs.folds]
kind = "curve"
start = { run = "branch", point = "SN1" }
along = { b1 = [-1, 1], b2 = [-2, 1] }
[runs.settled]
model = "./settling.toml"
kind = "sweep"
set = { b1 = 0.1 }
from = { x = 0.1 }
vary = { b2 = { from = -1, to = -0.99, points = 2 } }
)";

class EquilibriumPage : public ::testing::Test {
protected:
    struct Computed {
        testing::TemporaryFolder folder;
        std::string of_study = text;
        Study study;
        std::unique_ptr<ResultFile> file;
        Computed() {
            std::ofstream(folder / "bogdanov.toml") << bogdanov;
            std::ofstream(folder / "settling.toml") << bogdanov << "[sections.rest]\nfunction = \"y\"\n";
            file = std::make_unique<ResultFile>(folder / "results.sqlite", ResultFile::Access::write);
            compute("");
        }
        void compute(const std::string& more) {
            of_study += more;
            study = parse_study(of_study, folder / "s.toml");
            for (const RunReport& report : run_study(study, *file, {}))
                EXPECT_EQ(report.problem, "") << report.name << more << report.remedy;
        }
    };
    static Computed& results() {
        static Computed one;
        return one;
    }
    static PointOrigin origin(const std::string& run, const std::string& label) {
        return point_origin(*results().file, results().study, run, results().file->orbit(run, label)->number);
    }
    static std::vector<std::string> offered(const PointOrigin& origin) {
        std::vector<std::string> names;
        for (const PointAction& action : actions_at(origin))
            names.push_back(action.name);
        return names;
    }
    /// Carries out what is proposed, and returns its orbits.
    static std::vector<OrbitRecord> carried_out(const PointOrigin& from, const ProposalWish& wish) {
        const Computed& known = results();
        const ProposedRun proposed = proposed_run(from, known.study, known.file.get(), wish);
        results().compute("\n" + proposed.text);
        return known.file->orbits(proposed.name, false);
    }
    using Names = std::vector<std::string>;
};

TEST_F(EquilibriumPage, OffersWhatLeadsOn) {
    EXPECT_EQ(offered(origin("all", "EP1")), (Names{"follow", "simulate"}));
    EXPECT_EQ(offered(origin("branch", "EP1")), (Names{"follow", "another", "simulate"}));
    EXPECT_EQ(offered(origin("branch", "HB1")), (Names{"switch", "curve", "follow", "another", "simulate"}));
    EXPECT_EQ(offered(origin("branch", "SN1")), (Names{"curve", "follow", "another", "simulate"}));
    EXPECT_EQ(offered(origin("folds", "BT1")), (Names{"curve-SN", "curve-HB", "follow", "another", "simulate"}));
}

TEST_F(EquilibriumPage, ASearchIsOfferedWhereNothingMovesTheModel) {
    const auto has = [](const Model& model) {
        const Names names = offered(point_origin(model));
        return std::ranges::find(names, "equilibrium") != names.end();
    };
    const auto model = [](const std::string& states, const std::string& rates) {
        return parse_model("[states]\n" + states + "\n[modes.one]\nrates = { " + rates + " }", "x.toml");
    };
    EXPECT_TRUE(has(parse_model(bogdanov, "x.toml")));
    EXPECT_FALSE(has(load_model("impact-oscillator"))); // the phase of the force
    EXPECT_FALSE(has(model("x = 1\nclock = 0", "x = \"-x\", clock = 1")));
    const std::string phase = "x = 1\nphase = { initial = 0, period = 1 }";
    EXPECT_TRUE(has(model(phase, "x = \"-x\", phase = 1"))); // which has no effect
    EXPECT_FALSE(has(model(phase, "x = \"sin(phase) - x\", phase = 1")));
    EXPECT_TRUE(has(model(phase, "x = \"-x\", phase = \"sin(phase)\"")));
}

TEST_F(EquilibriumPage, CyclesBeginAtAHopfPoint) {
    const auto orbits = carried_out(origin("branch", "HB1"), {.action = "switch", .options = {{"steps", "5"}}});
    ASSERT_GT(orbits.size(), 3U);
    // The frequency there is the root of the determinant, 1.
    EXPECT_NEAR(orbits[0].point.solution.orbit.period(), 6.283, 0.1);
}

TEST_F(EquilibriumPage, CurvesOfHopfPointsBeginThereAndWhereFoldsMeetThem) {
    const auto from_hopf =
        carried_out(origin("branch", "HB1"), {.action = "curve", .along = {"b1", "b2"}, .options = {{"steps", "5"}}});
    const auto from_folds = carried_out(origin("folds", "BT1"), {.action = "curve-HB", .along = {"b1", "b2"}});
    for (const auto* orbits : {&from_hopf, &from_folds}) {
        ASSERT_GT(orbits->size(), 3U);
        for (const OrbitRecord& one : *orbits)
            EXPECT_NEAR(one.point.solution.orbit.parameters[0], 0, 1e-7); // b1
    }
}

TEST_F(EquilibriumPage, AnotherParameterVaries) {
    const auto orbits = carried_out(origin("branch", "EP1"), {.action = "another", .along = {"b2"}});
    ASSERT_GT(orbits.size(), 3U);
    for (const OrbitRecord& one : orbits) {
        const Orbit& orbit = one.point.solution.orbit;
        const double x = orbit.starts[0][0];
        EXPECT_NEAR(orbit.parameters[0] + orbit.parameters[1] * x + x * x, 0, 1e-9);
    }
}

TEST_F(EquilibriumPage, AnEquilibriumIsFoundFromAModel) {
    PointOrigin model = point_origin(results().study.runs[0].model);
    const ProposedRun proposed =
        proposed_run(model, results().study, nullptr, {.action = "equilibrium", .study_model = "./bogdanov.toml"});
    EXPECT_NE(proposed.text.find("kind = \"equilibrium\"\n"), std::string::npos) << proposed.text;
    EXPECT_EQ(proposed.text.find("start"), std::string::npos) << proposed.text;
}

TEST_F(EquilibriumPage, AnEquilibriumIsFoundWhereAMotionSettles) {
    const PointOrigin settled = point_origin(*results().file, results().study, "settled", 0);
    ASSERT_EQ(settled.point->result.label, Label::equilibrium);
    EXPECT_EQ(offered(settled), (Names{"equilibrium", "sweep", "simulate"}));
    const auto found = carried_out(settled, {.action = "equilibrium"});
    ASSERT_EQ(found.size(), 1U);
    const Orbit& orbit = found[0].point.solution.orbit;
    EXPECT_NEAR(orbit.starts[0][0], (1 - std::sqrt(0.6)) / 2, 1e-10);
    EXPECT_EQ(orbit.parameters[0], 0.1); // b1
}

TEST_F(EquilibriumPage, APointHasEigenvaluesAndNoPeriod) {
    const StoredRun run(*results().file, "branch", {});
    const nlohmann::json point = point_json(run, results().file->orbit("branch", "HB1")->number);
    ASSERT_EQ(point.at("eigenvalues").size(), 2U);
    EXPECT_NEAR(point.at("eigenvalues")[0][0].get<double>(), 0, 1e-9);
    EXPECT_NEAR(point.at("eigenvalues")[0][1].get<double>(), 1, 1e-9);
    EXPECT_TRUE(point.at("multipliers").empty());
    EXPECT_TRUE(point.at("period").is_null());
    EXPECT_EQ(point.at("signature"), "equilibrium");
    for (const auto& fact : point.at("facts"))
        EXPECT_NE(fact[0], "period");
}

TEST_F(EquilibriumPage, EachKindOfRunHasItsWords) {
    const nlohmann::json runs = runs_json(*results().file, nullptr);
    const auto words = [&](const std::string& run) {
        for (const nlohmann::json& one : runs)
            if (one.at("name") == run)
                return one.at("kind_words").get<std::string>();
        return std::string();
    };
    EXPECT_EQ(words("all"), "equilibria");
    EXPECT_EQ(words("branch"), "a branch of periodic orbits or equilibria");
    EXPECT_EQ(words("folds"), "a curve of special points");
    EXPECT_EQ(words("settled"), "attractors as a parameter changes");
}

TEST_F(EquilibriumPage, ItsMotionIsOneRow) {
    const StoredRun run(*results().file, "branch", {});
    const nlohmann::json motion = motion_json(run, results().file->orbit("branch", "HB1")->number, {"x", "y"}, {});
    EXPECT_EQ(motion.at("at_rest"), true);
    for (const auto& column : motion.at("values"))
        EXPECT_EQ(column.size(), 1U);
    EXPECT_EQ(motion.at("modes"), nlohmann::json::array({"free"}));
}

} // namespace
} // namespace graze
