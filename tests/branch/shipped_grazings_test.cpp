// The shipped models beyond their grazings: cycle maps, verdicts and simulation.

#include "follow.hpp"

#include "graze/flow/mode_flow.hpp"
#include "graze/trajectory/recorder.hpp"
#include "grazing/near_touch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>

namespace graze::shipped_grazings_test {

using namespace graze::testing;

Judged judged(const Model& model, const SpecialPoint& point, const char* parameter) {
    Judged result(model, point, model.independent_parameter(parameter));
    EXPECT_TRUE(result.map.exists()) << result.map.reason;
    // The map has the multipliers of the orbit.
    const auto& known = point.solution.orbit.symmetry ? point.solution.half_multipliers : point.solution.multipliers;
    EXPECT_EQ(known.size(), result.map.multipliers.size());
    if (!known.empty() && !result.map.multipliers.empty()) {
        EXPECT_NEAR(std::abs(known[0]), std::abs(result.map.multipliers[0]), 1e-9 * std::abs(known[0]));
    }
    return result;
}

/// Returns the speeds of the first contacts of a motion that starts on the orbit without contact.
std::vector<double> speeds_beyond(const Model& model, const CycleMap& map, ParameterId parameter, double distance,
                                  double cycles) {
    std::vector<double> parameters = map.contact.touch.parameters, state = map.contact.touch.state;
    parameters[parameter.place()] += distance;
    for (std::size_t i = 0; i < map.active.size(); ++i)
        state[map.active[i]] += map.steady[i] * distance;
    const Simulation simulation(System(model), {}, {}, SimulationOptions{.tolerance = 1e-15});
    ModeFlow flow(simulation.system(), 1e-15);
    flow.set_parameters(parameters);
    EXPECT_EQ(flow.run(map.contact.touch.mode, state, -0.01 * map.time), ModeFlow::Ending::done);
    Recorder recorder;
    Trajectory trajectory(simulation, parameters, borrowed(recorder));
    trajectory.start(state, map.contact.touch.mode, 0, cycles * map.time);
    run(trajectory);
    std::vector<double> speeds;
    for (const auto& one : recorder.contacts())
        if (one.contact.event == map.contact.touch.event)
            speeds.push_back(-one.contact.rate_before);
    return speeds;
}

/// Compares the minimum of the touched function one or more (half) cycles after a slow contact with the projections;
/// the error is proportional to the speed.
void expect_projections(const Model& model, const CycleMap& map, std::size_t cycles) {
    const System system(model);
    const TouchState& touch = map.contact.touch;
    const Simulation simulation(system, {}, {}, SimulationOptions{.tolerance = 1e-15});
    ModeFlow flow(system, 1e-15);
    flow.set_parameters(touch.parameters);
    const double usual =
        std::sqrt(2 * map.contact.acceleration) * std::sqrt(std::abs(map.contact.acceleration)) * map.time;
    double before = 0;
    for (const double share : {1e-5, 1e-6}) {
        // A motion reaches the surface with speed s at the time s/a before its minimum.
        const double speed = share * usual;
        std::vector<double> state = touch.state;
        EXPECT_EQ(flow.run(touch.mode, state, -speed / map.contact.acceleration), ModeFlow::Ending::done);
        const auto value = system.event(touch.event)(inputs_at(touch, state));
        double square = 0;
        for (std::size_t i = 0; i < state.size(); ++i)
            square += value[1 + i] * value[1 + i] * touch.scales[i] * touch.scales[i];
        // Start slightly off the surface, with a correspondingly smaller speed.
        const double lift = 0.01 * value[0], met = std::sqrt(0.99) * speed;
        for (std::size_t i = 0; i < state.size(); ++i)
            state[i] -= (value[0] - lift) / square * value[1 + i] * touch.scales[i] * touch.scales[i];
        Trajectory trajectory(simulation, touch.parameters);
        // A pass that impacts does so before its minimum, by a time proportional to the square root of the depth.
        const double projection = map.projections(cycles).back();
        const double short_of = std::max(20 * speed / map.contact.acceleration,
                                         3 * std::sqrt(2 * std::abs(projection) * speed / map.contact.acceleration));
        trajectory.start(state, touch.mode, 0, static_cast<double>(cycles) * map.time - short_of);
        run(trajectory);
        ASSERT_EQ(trajectory.outcome().ending, Ending::end_time) << trajectory.outcome().detail;
        ASSERT_EQ(trajectory.mode(), touch.mode);
        std::vector<double> end(trajectory.state().begin(), trajectory.state().end());
        double least = 1e300;
        constexpr int parts = 4000;
        for (int part = 0; part < parts; ++part) {
            EXPECT_EQ(flow.run(touch.mode, end, 2 * short_of / parts), ModeFlow::Ending::done);
            least = std::min(least, system.event(touch.event)(inputs_at(touch, end))[0]);
        }
        const double error = std::abs(least / met / projection - 1);
        if (before > 0) {
            EXPECT_LT(error, std::max(0.2 * before, 1e-6)) << cycles << ' ' << before;
        }
        before = error;
    }
    EXPECT_LT(before, 1e-3);
}

Branch mems_branch(Model& model, const BranchSettings& settings) {
    model.set_parameter("V", 0.15);
    model.set_initial("q", 0);
    return follow_branch(System(model), settled(model, "phase0").orbit, settings);
}

TEST(ShippedGrazings, MemsSwitchTrips) {
    Model model = load_model("mems-switch");
    const BranchSettings settings = in_parameter(model, "V", {}, 0.4);
    const Branch branch = mems_branch(model, settings);
    const auto grazings = of_type(branch, PointType::grazing);
    ASSERT_EQ(grazings.size(), 1U);
    EXPECT_NEAR(grazings[0].parameter, 0.2013662121541341, 1e-12);
    const Judged one = judged(model, grazings[0], "V");
    EXPECT_EQ(one.verdict.outcome, GrazingOutcome::lost);
    EXPECT_EQ(one.verdict.next_contact, 1U);
    EXPECT_EQ(one.verdict.side, 1);
    EXPECT_EQ(one.trial.outcome, TrialOutcome::agreed) << one.trial.reason;
    expect_projections(model, one.map, 1);
    // Snap-through ends both motions.
    for (const TrialMotion& motion : one.trial.motions)
        EXPECT_TRUE(motion.ended);
    // |v| = c (V - V*)^(1/2) for the first contact, and the growth to the next; the relative error has the same order.
    double before_first = 0, before_next = 0;
    for (const double distance : {1e-4, 1e-6, 1e-8}) {
        const auto speeds = speeds_beyond(model, one.map, settings.parameter, distance, 1.5);
        ASSERT_GE(speeds.size(), 2U);
        const double first = std::abs(speeds[0] / (*one.verdict.speed_factor * std::sqrt(distance)) - 1),
                     next = std::abs(speeds[1] / (*one.verdict.growth * std::sqrt(speeds[0])) - 1);
        if (before_first > 0) {
            EXPECT_LT(first, 0.15 * before_first);
            EXPECT_LT(next, 0.4 * before_next); // with the square root of the first speed
        }
        before_first = first;
        before_next = next;
    }
    EXPECT_LT(before_first, 1e-3);
    EXPECT_LT(before_next, 0.05);
}

TEST(ShippedGrazings, TestbedLosesItsOrbit) {
    for (const auto& [frequency, voltage] :
         {std::pair(6.25, 4.833263260865), std::pair(7.0, 3.675357252066), std::pair(8.0, 3.998955699893)}) {
        const Model model = shipped_with("electromagnetic-testbed", {{"f", frequency}, {"V0", 3}});
        const BranchSettings settings = in_parameter(model, "V0", {}, 5.5);
        const Branch branch = follow_branch(System(model), settled(model, "phase0", 600).orbit, settings);
        const auto grazings = of_type(branch, PointType::grazing);
        ASSERT_EQ(grazings.size(), 1U);
        EXPECT_NEAR(grazings[0].parameter, voltage, 1e-11);
        const Judged one = judged(model, grazings[0], "V0");
        EXPECT_TRUE(one.map.half);
        for (const std::size_t cycles : {1U, 2U, 3U})
            if (cycles < one.verdict.next_contact || cycles == 1)
                expect_projections(model, one.map, cycles);
        EXPECT_EQ(one.verdict.outcome, GrazingOutcome::lost) << one.verdict.reason;
        EXPECT_EQ(one.trial.outcome, TrialOutcome::agreed) << one.trial.reason;
    }
}

TEST(ShippedGrazings, OrbitsOfTheMicroactuatorAreUnstableAtTheirTouches) {
    const Model model = shipped_with("impact-microactuator", {{"V", 0.1}, {"omega", 0.9189}});
    const BranchSettings settings = in_parameter(model, "V", 0, 3);
    Branch branch = follow_branch(System(model), settled(model, "longest", 4000).orbit, settings);
    for (const double voltage : {0.5876212422746997, 0.7304755333366196}) { // G-1, G-2
        const auto grazings = of_type(branch, PointType::grazing);
        ASSERT_EQ(grazings.size(), 1U);
        EXPECT_NEAR(grazings[0].parameter, voltage, 1e-11);
        const Judged one = judged(model, grazings[0], "V");
        // The impact starts a slip, which ends by sticking.
        EXPECT_EQ(one.map.contact.contacts.size(), 2U);
        EXPECT_EQ(one.verdict.outcome, GrazingOutcome::undecided);
        EXPECT_EQ(one.verdict.reason, "the orbit that touches is not stable itself");
        EXPECT_GT(std::abs(one.map.multipliers[0]), 1);
        expect_projections(model, one.map, 1);
        branch = follow(model, branches_at(System(model), grazings[0], settings).at(0), settings);
        ASSERT_FALSE(branch.points.empty());
    }
}

TEST(ShippedGrazings, MapsAreTheSameFromBothSides) {
    const Model model = shipped_with("impact-oscillator", {{"sigma", 0.5}, {"omega", 1.2}, {"amplitude", 0.1}});
    const BranchSettings settings = in_parameter(model, "amplitude", {}, 1);
    const Branch free = follow_branch(System(model), settled(model, "phase0").orbit, settings);
    const SpecialPoint touch = free.special.back();
    const Judged one = judged(model, touch, "amplitude");
    BranchStart start = branches_at(System(model), touch, settings).at(0);
    for (auto& component : start.direction.starts)
        for (double& value : component)
            value = -value;
    for (double& value : start.direction.durations)
        value = -value;
    for (double& value : start.direction.parameters)
        value = -value;
    const Branch back = follow(model, start, settings);
    const auto ends = of_type(back, PointType::grazing);
    ASSERT_FALSE(ends.empty());
    EXPECT_TRUE(ends[0].at_end);
    const CycleMap other = cycle_at(model, ends[0], settings.parameter);
    ASSERT_TRUE(other.exists()) << other.reason;
    const auto here = one.map.projections(6), there = other.projections(6);
    for (std::size_t k = 0; k < here.size(); ++k)
        EXPECT_NEAR(here[k], there[k], 1e-8);
    EXPECT_NEAR(*one.map.clearance_rate, *other.clearance_rate, 1e-7);
}

/// Orbits with impacts and an additional touch: from one touch to the next along branches of random oscillators.
TEST(ShippedGrazings, VerdictsHoldForOrbitsWithImpacts) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::map<std::string, int> counts;
    for (int trial = 0; trial < 25; ++trial) {
        const Model model = shipped_with("impact-oscillator", {{"sigma", 0.5},
                                                               {"zeta", std::pow(10, -2.5 + 2.5 * uniform(random))},
                                                               {"omega", 0.4 + 4 * uniform(random)},
                                                               {"e", 0.95 * uniform(random)},
                                                               {"amplitude", 0.02}});
        BranchSettings settings = in_parameter(model, "amplitude", 0.001, 30);
        settings.steps = 300;
        Branch branch = follow_branch(System(model), settled(model, "phase0", 4000).orbit, settings);
        for (int own = 0; own < 3; ++own) {
            const auto grazings = of_type(branch, PointType::grazing);
            const auto touch =
                std::find_if(grazings.begin(), grazings.end(), [](const SpecialPoint& point) { return !point.at_end; });
            if (touch == grazings.end())
                break;
            const Judged one = judged(model, *touch, "amplitude");
            EXPECT_NE(one.trial.outcome, TrialOutcome::contradicted) << trial << ' ' << own << ' ' << one.trial.reason;
            EXPECT_EQ(one.map.contact_times.size(), static_cast<std::size_t>(own));
            ++counts[fmt::format("{} {} {}", own > 0 ? "impacting" : "free", name_of(one.verdict.outcome),
                                 name_of(one.trial.outcome))];
            try {
                branch = follow(model, branches_at(System(model), *touch, settings).at(0), settings);
            } catch (const InputError&) {
                break; // contacts accumulate beyond
            }
        }
    }
    EXPECT_GE(counts["free lost agreed"], 20);
    EXPECT_GE(counts["impacting lost agreed"] + counts["impacting persists agreed"], 6);
    EXPECT_GE(counts["impacting persists agreed"], 2);
}

/// The predicted distance of the fold becomes accurate as the stop becomes stiffer and the fold nearer.
TEST(ShippedGrazings, MicrobeamHasTheFoldOfTheCubic) {
    double before = 1;
    for (const double stiffness : {100.0, 1000.0, 10000.0}) {
        const Model model = shipped_with("microbeam", {{"V", 0.01}, {"k", stiffness}});
        BranchSettings settings = in_parameter(model, "V", 0.005, 0.06);
        const Branch branch = follow_branch(System(model), settled(model, "phase0").orbit, settings);
        const auto grazings = of_type(branch, PointType::grazing);
        ASSERT_EQ(grazings.size(), 1U);
        const Judged one = judged(model, grazings[0], "V");
        ASSERT_EQ(one.verdict.outcome, GrazingOutcome::folds);
        EXPECT_GT(*one.verdict.alpha, 0);
        EXPECT_NEAR(*one.verdict.fold_clearance, -4 / (27 * *one.verdict.alpha * *one.verdict.alpha), 1e-12);
        settings.steps = 200;
        settings.stop_at = {PointType::fold};
        const Branch deeper = follow(model, branches_at(System(model), grazings[0], settings).at(0), settings);
        const auto folds = of_type(deeper, PointType::fold);
        ASSERT_GE(folds.size(), 1U) << stiffness;
        const double distance = folds[0].parameter - grazings[0].parameter;
        const double error = std::abs(distance / *one.verdict.fold_distance - 1);
        EXPECT_LT(error, before);
        before = error;
        EXPECT_EQ(one.trial.outcome, TrialOutcome::agreed) << one.trial.reason;
    }
    EXPECT_LT(before, 0.05);
}

} // namespace graze::shipped_grazings_test
