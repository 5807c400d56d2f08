#include "page/simulation_json.hpp"

#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "page/page_results.hpp"

#include <cmath>
#include <numbers>

namespace graze {
namespace {

using testing::numbers_in;

TEST(SimulationJson, EndsWhereTheTrajectoryDoes) {
    Model model = load_model("impact-oscillator");
    SimulationWish wish;
    wish.parameters = {{"omega", 2.75}};
    wish.initial = {{"x", -0.5}};
    wish.duration = 30;
    wish.names = {"x", "v", "omega * x"};
    wish.most_seconds = 60; // where tests are slow, too
    const nlohmann::json json = simulation_json(model, wish);
    EXPECT_TRUE(json["complete"].get<bool>());
    EXPECT_EQ(json["ending"], "end-time");
    EXPECT_EQ(json["limit"], "");
    model.set_parameter("omega", 2.75);
    model.set_initial("x", -0.5);
    const Simulation simulation{System(model)};
    Trajectory trajectory(simulation, model.parameter_values());
    trajectory.start(model.initial_state(), model.initial_mode, 0, 30);
    JetSet jets(simulation, LaneKind::single);
    run(trajectory, jets);
    EXPECT_NEAR(json["values"][0].back().get<double>(), 30, 1e-13);
    EXPECT_NEAR(json["values"][1].back().get<double>(), trajectory.state()[0], 1e-12);
    EXPECT_NEAR(json["values"][2].back().get<double>(), trajectory.state()[1], 1e-12);
    EXPECT_NEAR(json["values"][3].back().get<double>(), 2.75 * trajectory.state()[0], 1e-11);
    EXPECT_EQ(json["values"][1][0], -0.5);
}

/// x'' = -x without damping, whose period is 2 pi.
constexpr const char* free_oscillator = R"(
name = "free"
[parameters]
k = 1
[states]
x = { initial = "1" }
v = { initial = "0" }
[modes.free]
rates = { x = "v", v = "-k*x" }
)";

TEST(SimulationJson, FollowsAClosedForm) {
    SimulationWish wish;
    wish.parameters = {{"k", 4}};
    wish.duration = 10;
    const nlohmann::json json = simulation_json(parse_model(free_oscillator, "free.toml"), wish);
    const std::vector<double> t = numbers_in(json["values"][0]), x = numbers_in(json["values"][1]);
    ASSERT_GT(t.size(), 50U);
    for (std::size_t i = 0; i < t.size(); ++i)
        EXPECT_NEAR(x[i], std::cos(2 * t[i]), 1e-10); // twenty steps of a tolerance of 1e-12
    EXPECT_TRUE(json["contacts"].empty());
    EXPECT_TRUE(json["begins"].empty());
}

TEST(SimulationJson, MarksImpactsByTheRowsBeforeAndAfter) {
    SimulationWish wish;
    wish.duration = 3;
    wish.names = {"v"};
    const Model model = load_model("bouncing-ball");
    const nlohmann::json json = simulation_json(model, wish);
    const std::vector<std::size_t> contacts = json["contacts"].get<std::vector<std::size_t>>();
    ASSERT_GE(contacts.size(), 2U);
    EXPECT_EQ(contacts[1], contacts[0] + 1);
    EXPECT_EQ(json["begins"][0], contacts[1]);
    EXPECT_LT(json["values"][1][contacts[0]].get<double>(), 0);
    EXPECT_GE(json["values"][1][contacts[1]].get<double>(), 0);
    EXPECT_EQ(json["begins"].size() + 1, json["modes"].size());
}

TEST(SimulationJson, SaysByWhatItWasEnded) {
    SimulationWish wish;
    wish.duration = 1e9;
    wish.most_steps = 50;
    const Model model = load_model("impact-oscillator");
    nlohmann::json json = simulation_json(model, wish);
    EXPECT_EQ(json["limit"], "steps");
    EXPECT_EQ(json["ending"], "stopped");
    EXPECT_FALSE(json["complete"].get<bool>());
    EXPECT_EQ(json["steps"], 50);
    wish.most_steps = SimulationWish().most_steps;
    wish.interrupted = [] { return true; };
    EXPECT_EQ(simulation_json(model, wish)["limit"], "interrupted");
    wish.interrupted = {};
    wish.most_seconds = 0.001;
    EXPECT_EQ(simulation_json(model, wish)["limit"], "seconds");
}

TEST(SimulationJson, RefusesWrongWishes) {
    const Model model = load_model("impact-oscillator");
    const double infinite = std::numeric_limits<double>::infinity();
    const auto refuses = [&](const SimulationWish& wish) { EXPECT_THROW(simulation_json(model, wish), InputError); };
    refuses({.parameters = {{"<script>", 1}}});
    refuses({.parameters = {{"omega", infinite}}});
    refuses({.initial = {{"nothing", 1}}});
    refuses({.duration = -1});
    refuses({.duration = infinite});
    refuses({.mode = "nowhere"});
    refuses({.names = {"x +"}});
}

TEST(SimulationJson, LastsAsLongAsGrazeSimulatesOrSomeSteps) {
    const Model oscillator = load_model("impact-oscillator");
    const double omega = oscillator.parameter_values()[oscillator.independent_parameter("omega").place()];
    EXPECT_NEAR(usual_duration(oscillator), 20 * 2 * std::numbers::pi / omega, 1e-12);
    EXPECT_GT(usual_duration(parse_model(free_oscillator, "free.toml")), 10);
}

TEST(SimulationJson, ShowsShippedModelsWhole) {
    for (const std::string& name : shipped_models()) {
        SimulationWish patient;
        patient.most_seconds = 60;
        EXPECT_EQ(simulation_json(load_model(name), patient)["limit"], "") << name;
    }
}

} // namespace
} // namespace graze
