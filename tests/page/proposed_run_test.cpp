#include "page/proposed_run.hpp"

#include "base/message_of.hpp"
#include "base/temporary_folder.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"
#include "graze/study/further_runs.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/stored_study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

namespace graze {
namespace {

using testing::message_of;

/// The branch of the oscillator without impacts up to where it grazes, the one with impacts from there, which doubles
/// its period, and what motions settle on.
const char* const text = R"toml(name = "proposals"
model = "impact-oscillator"

[runs.rest]
kind = "orbit"
set = { omega = 4 }
from = { x = -0.07 }

[runs.free]
kind = "continue"
start = { run = "rest" }
along = { omega = [2.2, 4.5] }
direction = "down"

[runs.impacting]
kind = "continue"
start = { run = "free", point = "GR1" }
along = { omega = [2.2, 4.5] }
monitors = { speed = { value = "v", at = "impact" }, reach = { minimum = "x" } }

[runs.sweep]
kind = "sweep"
vary = { omega = { from = 2.7, to = 2.9, points = 5 } }
)toml";

/// The study with its results, computed once for all tests.
class Results {
public:
    static Results& get() {
        static Results one;
        return one;
    }
    const Study& study() const { return study_; }
    const ResultFile& file() const { return *file_; }

    PointOrigin origin(const std::string& run, const std::string& label) const {
        const bool number = label.find_first_not_of("0123456789") == std::string::npos;
        return point_origin(file(), study(), run, number ? std::stoul(label) : file().orbit(run, label)->number);
    }
    /// Appends the text to the study and computes the run.
    const Study& compute(const ProposedRun& proposed) {
        text_ += "\n" + proposed.text;
        study_ = parse_study(text_, file_name());
        const std::vector<RunReport> reports = run_study(study_, *file_, {.only = {proposed.name}});
        for (const RunReport& report : reports)
            EXPECT_EQ(report.problem, "") << proposed.text << report.remedy;
        return study_;
    }
    ProposedRun propose(const std::string& run, const std::string& label, const ProposalWish& wish) const {
        ProposalWish of_study = wish;
        of_study.study_model = "impact-oscillator";
        return proposed_run(origin(run, label), study(), &file(), of_study);
    }

private:
    Results()
        : text_(text), study_(parse_study(text_, file_name())),
          file_(std::make_unique<ResultFile>(folder_ / "results.sqlite", ResultFile::Access::write)) {
        run_study(study_, *file_, {});
    }
    static const char* file_name() { return "proposals.toml"; }

    testing::TemporaryFolder folder_;
    std::string text_;
    Study study_;
    std::unique_ptr<ResultFile> file_;
};

/// A study of its own, with its results.
struct OneStudy {
    explicit OneStudy(std::string of_study)
        : text(std::move(of_study)), study(parse_study(text, "s.toml")),
          file(folder / "results.sqlite", ResultFile::Access::write) {
        ResultFile to = file;
        for (const RunReport& report : run_study(study, to, {}))
            EXPECT_EQ(report.problem, "") << text << report.remedy;
    }
    ProposedRun propose(const std::string& run, std::size_t number, const ProposalWish& wish) const {
        return proposed_run(point_origin(file, study, run, number), study, &file, wish);
    }

    testing::TemporaryFolder folder;
    std::string text;
    Study study;
    ResultFile file;
};

std::vector<std::string> names_of_actions(const PointOrigin& origin) {
    std::vector<std::string> names;
    for (const PointAction& action : actions_at(origin))
        names.push_back(action.name);
    return names;
}

/// Carries out what is proposed and returns its orbits.
std::vector<OrbitRecord> orbits_of(const std::string& run, const std::string& label, const ProposalWish& wish) {
    const ProposedRun proposed = Results::get().propose(run, label, wish);
    Results::get().compute(proposed);
    return Results::get().file().orbits(proposed.name, false);
}

double period(const OrbitRecord& record) {
    return record.point.solution.orbit.period();
}

double omega_of(const OrbitRecord& record) {
    const auto place = Results::get().study().runs.front().model.independent_parameter("omega").place();
    return record.point.solution.orbit.parameters[place];
}

std::size_t impacts(const OrbitRecord& record) {
    const Model& model = Results::get().study().runs.front().model;
    return static_cast<std::size_t>(std::ranges::count_if(record.point.solution.orbit.signature, [&](const auto& one) {
        return one.end == SegmentEnd::event && model.transitions[one.index].label == "impact";
    }));
}

TEST(PointActions, AreThoseOfThePoint) {
    const Results& results = Results::get();
    EXPECT_EQ(names_of_actions(results.origin("free", "GR1")),
              (std::vector<std::string>{"switch", "curve", "ladder", "follow", "another", "sweep", "simulate"}));
    EXPECT_EQ(names_of_actions(results.origin("impacting", "PD1")),
              (std::vector<std::string>{"double", "curve", "follow", "another", "sweep", "simulate"}));
    EXPECT_EQ(names_of_actions(point_origin(results.file(), results.study(), "impacting", 1)),
              (std::vector<std::string>{"follow", "another", "sweep", "simulate"}));
    EXPECT_EQ(names_of_actions(point_origin(results.file(), results.study(), "rest", 0)),
              (std::vector<std::string>{"follow", "sweep", "simulate"}))
        << "an orbit alone has no parameter, besides which there would be another one";
    EXPECT_EQ(names_of_actions(point_origin(load_model("impact-oscillator"))),
              (std::vector<std::string>{"simulate", "sweep", "orbit"}));
    EXPECT_EQ(
        names_of_actions(point_origin(parse_model("[states]\nx = 1\n[modes.one]\nrates = { x = \"-x\" }", "x.toml"))),
        (std::vector<std::string>{"simulate", "equilibrium"}));
}

TEST(PointActions, ProposeTheBoundsOfTheRun) {
    const nlohmann::json all = actions_json(actions_at(Results::get().origin("free", "GR1")));
    const auto curve = std::ranges::find(all, "curve", [](const auto& one) { return one.at("name"); });
    EXPECT_EQ(curve->at("along"), 2);
    EXPECT_EQ(curve->at("parameters")[0], (nlohmann::json{{"name", "omega"}, {"least", 2.2}, {"greatest", 4.5}}));
    EXPECT_EQ(curve->at("parameters")[1], (nlohmann::json{{"name", "zeta"}, {"least", 0.01}, {"greatest", 0.04}}));
}

TEST(PointActions, GoAlongTheFrequencyWhereTheRunHasNoParameter) {
    const auto first = [](const std::string& model) {
        return proposed_parameters(point_origin(load_model(model))).front().name;
    };
    EXPECT_EQ(first("impact-oscillator"), "omega");
    EXPECT_EQ(first("bouncing-ball"), "f") << "of the rate 2 pi f";
    const PointOrigin rest = point_origin(Results::get().file(), Results::get().study(), "rest", 0);
    EXPECT_EQ(actions_at(rest).front().along.front().name, "omega");
    const Model still =
        parse_model("[parameters]\nk = 1\n[states]\nx = 1\n[modes.one]\nrates = { x = \"-k*x\" }", "x.toml");
    EXPECT_EQ(proposed_parameters(point_origin(still)).front().name, "k");
}

TEST(ProposedRun, IsATableOfAStudy) {
    const ProposedRun proposed = Results::get().propose("free", "GR1", {.action = "switch"});
    EXPECT_EQ(proposed.name, "free-GR1-switch");
    EXPECT_EQ(proposed.text, "[runs.free-GR1-switch]\n"
                             "kind = \"continue\"\n"
                             "start = { run = \"free\", point = \"GR1\", onto = \"other\" }\n"
                             "along = { omega = [2.2, 4.5] }\n");
    const Results& results = Results::get();
    const std::string named =
        proposed_run(results.origin("free", "GR1"), results.study(), nullptr, {.action = "switch"}).text;
    EXPECT_NE(named.find("model = \"impact-oscillator\"\n"), std::string::npos) << named;
}

TEST(ProposedRun, NamesTheModelWhereTheStudyDoesNot) {
    EXPECT_EQ(study_model_of("name = \"s\"\nmodel = \"./a.toml\"\n[runs.one]\nkind = \"orbit\"\n"), "./a.toml");
    EXPECT_EQ(study_model_of("name = \"s\"\n[runs.one]\nmodel = \"b\"\n"), "");
    EXPECT_EQ(study_model_of("[["), "");
    const testing::TemporaryFolder folder;
    folder.write("a.toml", "[states]\nx = 1\n[modes.one]\nrates = { x = \"-x\" }\n");
    const std::string text_of_study = "name = \"s\"\nmodel = \"./a.toml\"\n[runs.one]\nkind = \"simulate\"\ntime = 1\n"
                                      "sample = { low = { minima = \"x\" } }\n";
    const Study study = read_study(folder.write("s.toml", text_of_study));
    PointOrigin origin = point_origin(study.runs[0].model);
    origin.asked = study.runs[0];
    origin.run = "one";
    origin.point = PointRecord{};
    origin.point->result.label = Label::periodic;
    const auto text_with = [&](const std::string& model) {
        return proposed_run(origin, study, nullptr, {.action = "simulate", .study_model = model}).text;
    };
    EXPECT_EQ(text_with("./a.toml").find("model"), std::string::npos);
    EXPECT_NE(text_with("impact-oscillator").find("model = \"./a.toml\"\n"), std::string::npos);
    EXPECT_NE(text_with("").find("model = \"./a.toml\"\n"), std::string::npos);
}

TEST(ProposedRun, SwitchLeadsBeyondAGrazing) {
    const std::vector<OrbitRecord> orbits = orbits_of("free", "GR1", {.action = "switch"});
    ASSERT_GT(orbits.size(), 5U);
    EXPECT_EQ(impacts(orbits[3]), 1U);
}

TEST(ProposedRun, FollowStaysOnTheBranch) {
    const std::vector<OrbitRecord> orbits = orbits_of(
        "free", "GR1", {.action = "follow", .bounds = {{"omega", {2, 5}}}, .options = {{"direction", "\"up\""}}});
    ASSERT_GT(orbits.size(), 3U);
    EXPECT_EQ(impacts(orbits[2]), 0U);
    EXPECT_NEAR(omega_of(orbits.back()), 5, 1e-9); // beyond the bounds of the branch that it begins at
}

TEST(ProposedRun, DoubleHasTwiceThePeriod) {
    const double half = period(*Results::get().file().orbit("impacting", "PD1"));
    const std::vector<OrbitRecord> orbits =
        orbits_of("impacting", "PD1", {.action = "double", .options = {{"steps", "9"}}});
    ASSERT_GT(orbits.size(), 3U);
    EXPECT_NEAR(period(orbits[2]), 2 * half, 0.1 * half);
    EXPECT_EQ(impacts(orbits[2]), 2U);
    // What the branch has recorded goes along.
    const ProposedRun proposed = Results::get().propose("impacting", "PD1", {.action = "switch"});
    EXPECT_NE(
        proposed.text.find("monitors = { speed = { value = \"v\", at = \"impact\" }, reach = { minimum = \"x\" } }"),
        std::string::npos)
        << proposed.text;
}

TEST(ProposedRun, AnotherParameterVaries) {
    const double omega = omega_of(*Results::get().file().orbit("impacting", "PD1"));
    const std::vector<OrbitRecord> orbits =
        orbits_of("impacting", "PD1", {.action = "another", .along = {"sigma"}, .options = {{"steps", "5"}}});
    ASSERT_GT(orbits.size(), 3U);
    for (const OrbitRecord& orbit : orbits)
        EXPECT_EQ(omega_of(orbit), omega);
    EXPECT_NE(orbits.front().point.parameter, orbits.back().point.parameter);
}

TEST(ProposedRun, ACurveKeepsTheGrazing) {
    const std::vector<OrbitRecord> orbits =
        orbits_of("free", "GR1", {.action = "curve", .along = {"omega", "sigma"}, .options = {{"steps", "10"}}});
    ASSERT_GT(orbits.size(), 5U);
    const Model& model = Results::get().study().runs.front().model;
    const auto sigma = model.independent_parameter("sigma").place();
    std::set<double> stops;
    for (const OrbitRecord& orbit : orbits) {
        const Orbit& one = orbit.point.solution.orbit;
        // Closed form: the amplitude of the forced oscillator without impacts is the place of the stop.
        const double w = omega_of(orbit), zeta = 0.02;
        EXPECT_NEAR(1 / std::hypot(1 - w * w, 2 * zeta * w), one.parameters[sigma], 1e-7);
        stops.insert(one.parameters[sigma]);
    }
    EXPECT_GT(stops.size(), 5U);
}

TEST(ProposedRun, ALadderClimbsTheGrazings) {
    const OneStudy slow("name = \"s\"\nmodel = \"impact-oscillator\"\n"
                        "set = { zeta = 0.5, omega = 0.3, e = 0.5, sigma = 1.5 }\n"
                        "[runs.free]\nkind = \"continue\"\nalong = { sigma = [0.1, 3] }\ndirection = \"down\"\n");
    const ProposedRun ladder = slow.propose("free", slow.file.orbit("free", std::string("GR1"))->number,
                                            {.action = "ladder", .options = {{"rungs", "3"}}});
    const OneStudy climbed(slow.text + ladder.text);
    EXPECT_TRUE(climbed.file.orbit(ladder.name, std::string("GR3")));
}

TEST(ProposedRun, ASweepGoesOnFromTheOrbit) {
    const ProposedRun proposed = Results::get().propose(
        "impacting", "1", {.action = "sweep", .bounds = {{"omega", {2.8, 2.9}}}, .options = {{"cycles", "60"}}});
    EXPECT_EQ(proposed.name, "impacting-1-sweep-omega");
    Results::get().compute(proposed);
    EXPECT_EQ(Results::get().file().point_count(proposed.name), 201U);
}

// Names that begin with that of an atlas and a dot are those of the runs that it adds.
TEST(ProposedRun, FromARunOfAnAtlasHasANameOfItsOwn) {
    const OneStudy one("name = \"s\"\nmodel = \"impact-oscillator\"\n[runs.\"map.b1\"]\nkind = \"simulate\"\n"
                       "periods = 3\n");
    const ProposedRun proposed = one.propose("map.b1", 0, {.action = "simulate"});
    EXPECT_EQ(proposed.name, "map-b1-0-simulate");
    const OneStudy both(one.text + proposed.text);
    EXPECT_EQ(both.study.find_run(proposed.name)->start->run, "map.b1");
}

TEST(ProposedRun, TheOrbitOfAPointOfASweep) {
    Results& results = Results::get();
    const auto periodic = [&] {
        for (std::size_t n = 0; n < results.file().point_count("sweep"); ++n)
            if (results.file().point("sweep", n)->result.label == Label::periodic)
                return n;
        return std::size_t{99};
    }();
    const PointOrigin origin = point_origin(results.file(), results.study(), "sweep", periodic);
    EXPECT_EQ(names_of_actions(origin), (std::vector<std::string>{"orbit", "follow", "sweep", "simulate"}));
    const ProposedRun orbit = proposed_run(origin, results.study(), &results.file(), {.action = "orbit"});
    results.compute(orbit);
    const std::vector<OrbitRecord> found = results.file().orbits(orbit.name, false);
    ASSERT_EQ(found.size(), 1U) << orbit.text;
    EXPECT_NEAR(period(found[0]), origin.point->result.duration, 1e-8);
    EXPECT_EQ(omega_of(found[0]), origin.point->coordinates[0]);
    const ProposedRun followed = proposed_run(origin, results.study(), &results.file(), {.action = "follow"});
    EXPECT_NE(followed.text.find("along = { omega = [2.7, 2.9] }"), std::string::npos) << followed.text;
    results.compute(followed);
    EXPECT_GT(results.file().orbits(followed.name, false).size(), 3U);
}

TEST(ProposedRun, AModelWithoutResultsGetsFirstRuns) {
    const PointOrigin origin = point_origin(load_model("bouncing-ball"));
    std::string study = "name = \"first\"\nmodel = \"bouncing-ball\"\n";
    Study parsed; // without runs
    parsed.file = "first.toml";
    for (const char* action : {"simulate", "sweep", "orbit"}) {
        const ProposedRun proposed =
            proposed_run(origin, parsed, nullptr, {.action = action, .study_model = "bouncing-ball"});
        EXPECT_EQ(proposed.name, action);
        study += proposed.text;
        parsed = parse_study(study, "first.toml");
    }
    EXPECT_EQ(parsed.runs.size(), 3U);
    EXPECT_EQ(proposed_run(origin, parsed, nullptr, {.action = "simulate"}).name, "simulate_2");
}

TEST(ProposedRun, GoesOnFromAResultFileAlone) {
    const Results& results = Results::get();
    const Study stored = stored_study(results.file());
    const PointOrigin origin =
        point_origin(results.file(), stored, "free", results.file().orbit("free", "GR1")->number);
    const ProposedRun proposed = proposed_run(origin, stored, &results.file(), {.action = "switch"});
    const Study further = parse_further_runs("name = \"more\"\n" + proposed.text, "more.toml", stored,
                                             {{origin.model.name, origin.model}});
    ASSERT_NE(further.find_run(proposed.name), nullptr);
    EXPECT_EQ(further.find_run(proposed.name)->start->point, "GR1");
}

TEST(ProposedRun, ATwinIsTheSymmetricImage) {
    const OneStudy one("name = \"s\"\nmodel = \"impact-oscillator-two-stops\"\n[runs.one]\nkind = \"orbit\"\n"
                       "set = { e = 0.9, zeta = 0.05, sigma = 1.5, omega = 0.8 }\nfrom = { x = -0.5 }\ncycles = 300\n");
    const ProposedRun twin = one.propose("one", 0, {.action = "twin", .options = {{"steps", "3"}}});
    const OneStudy both(one.text + twin.text);
    const std::vector<OrbitRecord> images = both.file.orbits(twin.name, false);
    ASSERT_FALSE(images.empty());
    const Model& model = both.study.runs.front().model;
    EXPECT_EQ(to_string(model, both.file.orbit("one", std::size_t{0})->point.solution.orbit.signature), "free:right");
    EXPECT_EQ(to_string(model, images.front().point.solution.orbit.signature), "free:left");
}

TEST(ProposedRun, RefusesWhatIsNotPossible) {
    const auto refused = [](const std::string& run, const std::string& label, const ProposalWish& wish) {
        return message_of([&] { Results::get().propose(run, label, wish); });
    };
    EXPECT_EQ(refused("free", "GR1", {.action = "double"}),
              "'double' is not possible from GR1; choose from switch, curve, ladder, follow, another, sweep, simulate");
    EXPECT_NE(refused("free", "GR1", {.action = "switch", .along = {"omgea"}}).find("did you mean 'omega'?"),
              std::string::npos);
    EXPECT_NE(refused("free", "GR1", {.action = "switch", .along = {"omega", "e"}}).find("goes along 1 parameters"),
              std::string::npos);
    EXPECT_NE(refused("free", "GR1", {.action = "curve", .along = {"e", "e"}}).find("named twice"), std::string::npos);
    EXPECT_NE(refused("free", "GR1", {.action = "switch", .bounds = {{"omega", {3, 3}}}}).find("goes from 3 to 3"),
              std::string::npos);
    EXPECT_NE(refused("free", "GR1", {.action = "switch", .bounds = {{"e", {0, 1}}}}).find("nothing goes along it"),
              std::string::npos);
    EXPECT_NE(
        refused("free", "GR1", {.action = "switch", .options = {{"steps", "1\n[runs.evil]"}}}).find("several lines"),
        std::string::npos);
    for (const char* key : {"a b", "nonsense", "name", "cycles_of_another_kind", ""})
        EXPECT_NE(refused("free", "GR1", {.action = "switch", .options = {{key, "1"}}}).find("is no key"),
                  std::string::npos)
            << key;
    EXPECT_NE(message_of([] { point_origin(Results::get().file(), Results::get().study(), "free", 9999); }), "");
    EXPECT_NE(message_of([] { point_origin(Results::get().file(), Results::get().study(), "none", 0); }), "");
}

} // namespace
} // namespace graze
