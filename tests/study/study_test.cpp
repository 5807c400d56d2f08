#include "graze/study/study.hpp"

#include "graze/study/stored_study.hpp"
#include "graze/study/study_catalogue.hpp"

#include "results/run_of_model.hpp"
#include "study_fixture.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace graze::study_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string head = "name = \"s\"\nmodel = \"impact-oscillator\"\n";

std::string refusal(const std::string& text) {
    return testing::message_of([&] { parse_study(text, "s.toml"); });
}

StudyRun only_run(const std::string& text) {
    return parse_study(head + text, "s.toml").runs.at(0);
}

TEST(Study, StepsOfDecimalsAreDecimals) {
    const StudyRun run =
        only_run("[runs.a]\nkind = \"sweep\"\nvary = { omega = { from = 4.5, to = 5.5, step = 0.001 } }");
    ASSERT_EQ(run.motion().axes.at(0).values.size(), 1001u);
    EXPECT_EQ(run.motion().axes[0].values[333], 4.833);
    EXPECT_EQ(run.motion().axes[0].values[1000], 5.5);
}

TEST(Study, VariesByListsPointsLogarithmsAndDraws) {
    const StudyRun run = only_run(R"([runs.a]
kind = "basin"
draws = 3
seed = 7
vary = { omega = [3, 2.5], x = { from = 0, to = 1, points = 5 }, e = { from = 0.01, to = 1, points = 3, scale = "log" }, v = { random = [2, 3] } }
)");
    ASSERT_EQ(run.motion().axes.size(), 4u);
    EXPECT_THAT(run.motion().axes[0].values, ElementsAre(2.5, 3));
    EXPECT_THAT(run.motion().axes[1].values, ElementsAre(0, 0.25, 0.5, 0.75, 1));
    EXPECT_TRUE(run.motion().axes[1].state);
    EXPECT_NEAR(run.motion().axes[2].values[1], 0.1, 1e-16);
    const Plan plan = plan_of(run, System(run.model), nullptr);
    EXPECT_EQ(plan.points(), 2u * 5 * 3 * 3);
    for (std::size_t point = 0; point < plan.points(); ++point) {
        const auto at = coordinates_of(run, point);
        EXPECT_GE(at[3], 2);
        EXPECT_LT(at[3], 3);
        const PointStart start = plan.start(point);
        EXPECT_EQ(start.state[*run.motion().axes[1].state], at[1]);
        EXPECT_EQ(start.parameters[run.motion().axes[0].parameter.place()], at[0]);
        EXPECT_EQ(coordinates_of(run, point), at);
    }
    EXPECT_NE(coordinates_of(run, 0)[3], coordinates_of(run, 1)[3]);
}

TEST(Study, SweepsGoUpDownOrBothWays) {
    const auto values = [](const char* direction) {
        const StudyRun run = only_run("[runs.a]\nkind = \"sweep\"\nvary = { omega = [1, 2, 3] }\ndirection = \"" +
                                      std::string(direction) + '"');
        std::vector<double> result;
        for (std::size_t p = 0; p < points_of(run); ++p)
            result.push_back(coordinates_of(run, p)[0]);
        return result;
    };
    EXPECT_THAT(values("up"), ElementsAre(1, 2, 3));
    EXPECT_THAT(values("down"), ElementsAre(3, 2, 1));
    EXPECT_THAT(values("both"), ElementsAre(1, 2, 3, 3, 2, 1));
}

TEST(StudyRun, HasTheRequestOfItsKindAlone) {
    for (std::size_t kind = 0; kind < kinds_of_runs().size(); ++kind) {
        StudyRun run(static_cast<RunKind>(kind));
        run.name = "a";
        const auto refused = [&run](auto ask) {
            try {
                ask(run);
                return 0;
            } catch (const InputError& error) {
                EXPECT_THAT(error.problem(), HasSubstr(fmt::format("run 'a' of kind \"{}\"", name_of(run.kind))));
                return 1;
            }
        };
        EXPECT_EQ(refused([](StudyRun& one) { one.motion(); }) + refused([](StudyRun& one) { one.branch(); }) +
                      refused([](StudyRun& one) { one.record(); }) + refused([](StudyRun& one) { one.identify(); }),
                  3);
    }
}

TEST(StudyRun, KeepsItsRequestWhereAnotherKindHasTheSame) {
    StudyRun run(RunKind::follow);
    run.branch().rungs = 3;
    run.set_kind(RunKind::ladder);
    EXPECT_EQ(run.branch().rungs, 3U);
    run.set_kind(RunKind::record);
    EXPECT_THROW(run.branch(), InputError);
    EXPECT_EQ(run.record().records(), 0U);
}

TEST(Study, BranchesAndCurvesGoBothWaysUnlessTold) {
    const std::string branch = "[runs.a]\nkind = \"continue\"\nalong = { omega = [4, 5] }\n";
    EXPECT_EQ(only_run(branch).branch().direction, SweepDirection::both);
    EXPECT_EQ(only_run(branch + "direction = \"down\"\n").branch().direction, SweepDirection::down);
    const std::string curve = "[runs.b]\nkind = \"curve\"\nstart = { run = \"a\", point = \"GR1\" }\n"
                              "along = { omega = [4, 5], zeta = [0.1, 0.2] }\n";
    const Study study =
        parse_study(head + branch + curve + "[runs.c]" + curve.substr(8) + "direction = \"up\"\n", "s.toml");
    EXPECT_EQ(study.runs.at(1).branch().direction, SweepDirection::both);
    EXPECT_EQ(study.runs.at(2).branch().direction, SweepDirection::up);
    // A motion goes one way.
    EXPECT_EQ(only_run("[runs.a]\nkind = \"sweep\"\nvary = { omega = [4, 5] }").motion().direction, SweepDirection::up);
}

TEST(Study, RunsFollowThoseThatTheyStartFrom) {
    const Study study = parse_study(head + R"(
[runs.second]
kind = "simulate"
periods = 3
start = { run = "first" }
[runs.first]
kind = "simulate"
time = "2*pi"
)",
                                    "s.toml");
    EXPECT_EQ(study.runs[0].name, "first");
    EXPECT_NEAR(study.runs[0].motion().transient.time, 6.283185307179586, 1e-15);
    EXPECT_EQ(study.runs[1].name, "second");
}

/// Each key for each kind of run: it changes what is computed, or it is refused.
TEST(Study, NoKeyIsAcceptedAndIgnored) {
    const std::string parent = "[runs.p]\nkind = \"simulate\"\nperiods = 1\n";
    struct Kind {
        std::string name, needs; ///< what a run of this kind cannot do without
    };
    struct Key {
        std::string name, value, with; ///< `with`: another key without which this one has no meaning
    };
    const std::vector<Kind> kinds{{"simulate", "contacts = 3\n"},
                                  {"sweep", "vary = { omega = [2, 3] }\n"},
                                  {"basin", ""},
                                  {"orbit", ""},
                                  {"continue", "along = { omega = [2, 3] }\n"}};
    const std::vector<Key> keys{{"model", "\"impact-oscillator-two-stops\"", ""},
                                {"set", "{ zeta = 0.01 }", ""},
                                {"from", "{ x = 0.05 }", ""},
                                {"mode", "\"stuck\"", ""},
                                {"start", "{ run = \"p\" }", ""},
                                {"vary", "{ e = [0.1, 0.2] }", ""},
                                {"draws", "3", "vary = { omega = [2], e = { random = [0, 1] } }\n"},
                                {"seed", "3", "draws = 2\nvary = { omega = [2], e = { random = [0, 1] } }\n"},
                                {"direction", "\"down\"", ""},
                                {"carry", "false", ""},
                                {"section", "\"turning\"", ""},
                                {"sample", "\"turning\"", ""},
                                {"values", "\"2*x\"", ""},
                                {"bounds", "{ x = [-9, 9] }", ""},
                                {"tolerance", "1e-10", ""},
                                {"order", "20", ""},
                                {"largest_step", "0.1", ""},
                                {"cycles", "77", ""},
                                {"keep", "7", ""},
                                {"largest_period", "3", ""},
                                {"recurrence", "1e-2", ""},
                                {"disturbance", "1e-5", ""},
                                {"lyapunov_cycles", "7", ""},
                                {"longest_return", "100", ""},
                                {"time", "7", ""},
                                {"periods", "7", ""},
                                {"contacts", "7", ""},
                                {"skip", "{ periods = 2 }", ""},
                                {"events", "[\"release\"]", ""},
                                {"greatest_speed", "7", ""},
                                {"signature", "\"impact\"", ""},
                                {"table", "\"study_test.toml\"", ""},
                                {"along", "{ e = [0.1, 0.9] }", ""},
                                {"steps", "7", ""},
                                {"stop", "\"GR\"", ""},
                                {"step", "{ first = 0.001 }", ""},
                                {"unphysical", "true", ""},
                                {"accuracy", "1e-9", ""},
                                {"free", "\"zeta\"", "monitors = { a = { duration = \"period\", fixed = true } }\n"},
                                {"monitors", "{ a = { maximum = \"x\" } }", ""}};
    const auto description = [](const StudyRun& run) {
        std::string numbers;
        for (const double value : run.model.parameter_values())
            numbers += std::to_string(value) + ' ';
        for (const double value : run.model.initial_state())
            numbers += std::to_string(value) + ' ';
        return settings_of(run) + numbers + run.model.name + run.model.modes[run.model.initial_mode].name +
               (run.is_branch() ? run.branch().table : "");
    };
    std::size_t used = 0, refused = 0;
    for (const Kind& kind : kinds)
        for (const Key& key : keys) {
            // A key that is needed, or comes with another, replaces it.
            const bool instead = kind.needs.starts_with(key.name) ||
                                 (kind.name == "sweep" && key.with.find("vary") != std::string::npos);
            const std::string base = parent + "[runs.q]\nkind = \"" + kind.name + "\"\n" + kind.needs;
            const std::string other = parent + "[runs.q]\nkind = \"" + kind.name + "\"\n" +
                                      (instead ? "" : kind.needs) + key.with + key.name + " = " + key.value + '\n';
            const std::string refusal_of_it = refusal(head + other);
            if (!refusal_of_it.empty()) {
                EXPECT_TRUE(refusal_of_it.find("have no `") != std::string::npos ||
                            refusal_of_it.find("has no effect here") != std::string::npos)
                    << refusal_of_it << '\n'
                    << other;
                ++refused;
                continue;
            }
            ++used;
            EXPECT_NE(description(parse_study(head + base, "s.toml").runs.at(1)),
                      description(parse_study(head + other, "s.toml").runs.at(1)))
                << other;
        }
    EXPECT_GT(used, 60u);
    EXPECT_GT(refused, 40u);
}

TEST(Study, PicturesHaveNoKeysThatAreIgnored) {
    const std::string run = "[runs.a]\nkind = \"simulate\"\nperiods = 1\n[pictures.p]\nrun = \"a\"\n";
    for (const std::string kind :
         {"bifurcation", "basin", "spectrum", "history", "portrait", "regression", "scatter", "branch"})
        for (const std::string key :
             {"fit = [0, 1]", "group = \"e\"", "successive = true", "at = { e = 1 }", "points = [\"GR1\"]"}) {
            const bool regression = key[0] == 'f' || key[0] == 'g' || key[0] == 's';
            const bool drawn = kind == "history" || kind == "portrait" || (kind == "spectrum" && key[0] == 'a') ||
                               (kind == "branch" && key[0] == 'p');
            EXPECT_EQ(refusal(head + run + "kind = \"" + kind + "\"\n" + key).empty(),
                      regression ? kind == "regression" : drawn)
                << kind << ' ' << key;
        }
}

TEST(Study, AccuracyReachesTheContinuation) {
    const StudyRun run = only_run("[runs.a]\nkind = \"continue\"\nalong = \"omega\"\naccuracy = 1e-7");
    EXPECT_EQ(run.branch().settings.orbit.accuracy, 1e-7);
    EXPECT_EQ(run.branch().settings.continuation.accuracy, 1e-7);
}

TEST(Study, FreeParametersMayHaveBounds) {
    const std::string follow = "[runs.a]\nkind = \"continue\"\nalong = { omega = [1, 2] }\n"
                               "monitors = { reach = { maximum = \"x\", fixed = true } }\n";
    const StudyRun run = only_run(follow + "free = { amplitude = [0.1, \"10*e\"] }");
    ASSERT_EQ(run.branch().settings.free.size(), 1u);
    ASSERT_EQ(run.branch().settings.free_bounds.size(), 1u);
    EXPECT_EQ(run.branch().settings.free[0], run.model.independent_parameter("amplitude"));
    const FreeBounds& bounds = run.branch().settings.free_bounds[0];
    EXPECT_EQ(bounds.parameter, run.branch().settings.free[0]);
    EXPECT_EQ(bounds.least, 0.1);
    EXPECT_EQ(bounds.greatest, 10 * run.model.parameter_values()[run.model.independent_parameter("e").place()]);
    EXPECT_TRUE(only_run(follow + "free = [\"amplitude\"]").branch().settings.free_bounds.empty());
    // As a result file keeps them.
    RunRecord record = testing::run_of(run.model, "a", "continue");
    record.settings = settings_of(run);
    const StudyRun again = stored_run(record);
    EXPECT_EQ(again.branch().settings.free_bounds.at(0).parameter, bounds.parameter);
    EXPECT_EQ(again.branch().settings.free_bounds.at(0).greatest, bounds.greatest);
    EXPECT_THAT(refusal(head + follow + "free = { amplitude = [2, 1] }"), HasSubstr("give the smaller number first"));
    EXPECT_THAT(refusal(head + follow + "free = { amplitude = 1 }"), HasSubstr("runs.a.free.amplitude"));
    EXPECT_THAT(refusal(head + follow + "free = { ampltude = [1, 2] }"), HasSubstr("did you mean 'amplitude'?"));
    EXPECT_THAT(refusal(head + follow + "free = { omega = [1, 2] }"), HasSubstr("a free parameter is not one"));
}

TEST(Study, RunsHaveNamesThatAResultFileDistinguishes) {
    const std::string settings = "kind = \"orbit\"\n";
    EXPECT_THAT(refusal(head + "[runs.a]\n" + settings + "[runs.A]\n" + settings), HasSubstr("differ in case only"));
    EXPECT_THAT(refusal(head + "[runs.points]\n" + settings), HasSubstr("give it another name"));
    EXPECT_EQ(refusal(head + "[runs.points]\nkind = \"simulate\"\ntime = 1\n"), "");
}

TEST(Study, NoneOfTwoContradictingKeysIsIgnored) {
    const std::string p = "[runs.p]\nkind = \"sweep\"\nvary = { omega = [2, 3] }\n", q = "[runs.q]\nkind = \"orbit\"\n",
                      simulated = "[runs.q]\nkind = \"simulate\"\ntime = 1\n", start = "start = { run = \"p\" }\n";
    for (const std::string& wrong : std::vector<std::string>{
             p + q + start + "from = { x = 1 }", p + simulated + start + "from = { x = 1 }",
             p + simulated + start + "mode = \"stuck\"", p + q + start + "signature = \"impact\"",
             p + q + start + "table = \"t.csv\"", q + "table = \"t.csv\"\nfrom = { x = 1 }",
             q + "table = \"t.csv\"\norder = 20", q + "signature = \"impact\"\ncycles = 30",
             q + "monitors = { a = { maximum = \"x\", report = 1 } }", simulated + "events = [\"release\"]",
             simulated + "seed = 3", simulated + "sample = \"phase0\"\nsection = \"phase0\"",
             p + simulated + "start = { run = \"p\", point = \"GR1\" }",
             p + simulated + "start = { run = \"p\", point = 1, at = { omega = 2 } }",
             p + simulated + "start = { run = \"p\", direction = \"up\" }",
             p + simulated + "start = { run = \"p\", onto = \"other\" }",
             p + "[runs.q]\nkind = \"simulate\"\ntime = 1\nmodel = \"bouncing-ball\"\n" + start,
             p + "[runs.q]\nkind = \"orbit\"\n" + start +
                 "[runs.r]\nkind = \"orbit\"\nstart = { run = \"q\" }\ncycles = 9"})
        EXPECT_THAT(refusal(head + wrong), ::testing::HasSubstr("; ")) << wrong;
}

TEST(Study, ShippedStudiesCanBeRead) {
    EXPECT_THAT(shipped_studies(),
                ElementsAre("ball-and-shaker", "electromagnetic-testbed", "mems-switch", "microactuator", "microbeam",
                            "microbeam-amplitudes", "microbeam-modes", "microbeam-stops", "testbed-experiment"));
    for (const std::string& name : shipped_studies())
        EXPECT_FALSE(load_study(name).runs.empty()) << name;
}

TEST(Study, MistakesAreReportedWithPlaceAndRemedy) {
    struct Case {
        std::string text, message;
    };
    const std::string sweep = "[runs.a]\nkind = \"sweep\"\nvary = { omega = [1, 2] }\n";
    for (const Case& wrong : std::vector<Case>{
             {"", "s.toml:1:1: the study has no name; give name = \"...\" in its first line"},
             {"name = \"s\"", "s.toml:1:1: the study has no runs; add a table [runs.NAME]"},
             {"name = 3", "s.toml:1:8: name must be a string, not a number; give a string"},
             {"nme = 3", "s.toml:1:1: unknown key 'nme'; did you mean 'name'?"},
             {head + "[runs.a]", "s.toml:3:7: runs.a has no kind; give kind = \"simulate\", \"sweep\", \"basin\", "
                                 "\"orbit\", \"equilibrium\", \"continue\", \"curve\", \"ladder\", \"torus\", "
                                 "\"record\", \"identify\" or \"atlas\""},
             {head + "[runs.a]\nkind = \"swep\"", "s.toml:4:8: runs.a.kind cannot be 'swep'; did you mean 'sweep'?"},
             {head + "[runs.\"a b\"]\nkind = \"sweep\"",
              "s.toml:3:7: 'a b' cannot be the name of a run; use up to 100 letters, digits, '.', '_' and '-'"},
             {head + "[runs.a]\nkind = \"sweep\"",
              "s.toml:3:7: runs.a sweeps nothing; give vary = { PARAMETER = { from = A, to = B, step = S } }"},
             {head + sweep + "cycels = 3", "s.toml:6:1: unknown key 'cycels' in runs.a; did you mean 'cycles'?"},
             {head + sweep + "cycles = 0", "s.toml:6:10: runs.a.cycles is 0; give a whole number from 1 to 100000000"},
             {head + sweep + "section = \"phas0\"",
              "s.toml:6:11: model 'impact-oscillator' has no section 'phas0'; did you mean 'phase0'?"},
             {head + sweep + "values = [\"speed*\"]", "s.toml:6:12: unknown name 'speed'"},
             {head + sweep + "sample = { a = { contacts = \"wal\" } }", "has no event 'wal'"},
             {head + sweep + "sample = { a = { image = \"mirror\" } }", "declares no symmetry 'mirror'"},
             {head + sweep + "bounds = { y = [0, 1] }", "the model has no state 'y'"},
             {head + sweep + "start = { run = \"b\" }", "s.toml:6:1: the study has no run 'b'"},
             {head + sweep + "start = { run = \"a\" }", "run 'a' starts from itself"},
             {head + "[runs.a]\nkind = \"sweep\"\nvary = { omga = [1, 2] }",
              "the model has no parameter or state 'omga'"},
             {head + "[runs.a]\nkind = \"sweep\"\nvary = { omega = [1, 1] }", "is empty or has a value twice"},
             {head + "[runs.a]\nkind = \"sweep\"\nvary = { omega = { from = 2, to = 1, step = 0.1 } }",
              "runs.a.vary.omega goes from 2 to 1; let it rise; `direction` says which way a sweep goes"},
             {head + "[runs.a]\nkind = \"sweep\"\nvary = { omega = { from = 1, to = 2, step = 1e-12 } }",
              "has more than 10000000 values"},
             {head + "[runs.a]\nkind = \"sweep\"\nvary = { omega = { from = 1 } }", "lacks `to`"},
             {head + "[runs.a]\nkind = \"basin\"\nvary = { x = { random = [0, 1] } }", "does not say how many"},
             {head + "[runs.a]\nkind = \"simulate\"", "nothing ends the simulation"},
             {head + sweep + "set = { zta = 1 }", "s.toml:6:9"},
             {head + sweep + "tolerance = 3", "tolerance"},
             {head + sweep + "[pictures.p]\nkind = \"bifurcation\"\nrun = \"b\"", "the study has no run 'b'"},
             {head + sweep + "[pictures.p]\nkind = \"bifurcation\"", "pictures.p shows no run"},
             {"name = \"s\"\nmodel = \"no-model\"\n" + sweep, "s.toml:2:9"}})
        EXPECT_THAT(refusal(wrong.text), HasSubstr(wrong.message)) << wrong.text;
}

TEST(StudyTest, InitialStatesMayFollowFromWhatVaries) {
    const std::string begin = "name = \"s\"\n[runs.a]\nmodel = \"impact-oscillator\"\nkind = \"basin\"\n"
                              "vary = { x = [-1, -0.5], omega = [2, 3] }\n";
    const Study study = parse_study(begin + "from = { v = \"0.5*x + omega\", theta = \"pi\" }\n", "s.toml");
    const StudyRun& run = study.runs[0];
    ASSERT_EQ(run.motion().following.size(), 1U);
    const Plan plan = plan_of(run, System(run.model), nullptr);
    const std::size_t x = *run.model.find_state("x"), v = *run.model.find_state("v");
    for (std::size_t point = 0; point < 4; ++point) {
        const std::vector<double> coordinates = coordinates_of(run, point);
        const PointStart start = plan.start(point);
        EXPECT_EQ(start.state[x], coordinates[0]);
        EXPECT_EQ(start.state[v], 0.5 * coordinates[0] + coordinates[1]);
    }
    // What does not vary has no value that differs from point to point, and what varies is not said twice.
    EXPECT_THROW(parse_study(begin + "from = { v = \"theta\" }\n", "s.toml"), InputError);
    EXPECT_THROW(parse_study(begin + "from = { x = \"omega\" }\n", "s.toml"), InputError);
}

} // namespace graze::study_test
