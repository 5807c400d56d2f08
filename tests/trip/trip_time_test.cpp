// Durations of trips: by the map, by simulation, and by closed forms.

#include "graze/trip/simulated_trip.hpp"

#include "base/message_of.hpp"
#include "branch/belt.hpp"
#include "graze/base/input_error.hpp"
#include "graze/flow/mode_flow.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/named_value.hpp"
#include "graze/orbit/solve.hpp"
#include "grazing/linear_oscillator.hpp"
#include "trip/end_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>
#include <random>

namespace graze::trip_time_test {

using namespace graze::testing;

struct Touching {
    Touching(const Model& model, const Orbit& orbit, const char* name)
        : system(model), parameter(model.independent_parameter(name)) {
        const std::vector<OrbitTouch> touches = touches_of(system, orbit);
        EXPECT_EQ(touches.size(), 1U);
        CycleMapOptions options;
        options.parameter = parameter;
        map = cycle_map(system, orbit, touches.front(), options);
        verdict = verdict_of(map);
    }
    System system;
    ParameterId parameter;
    CycleMap map;
    Verdict verdict;
};

Touching touching(const LinearOscillator& one) {
    const Model model = one.model();
    return {model, one.orbit(model), "force"};
}

/// The switch of chapter 6, at the voltage at which its free motion just touches the stop.
Touching mems_switch() {
    constexpr double voltage = 0.2013662121541341, phase = 0.7306205700512591, pi = std::numbers::pi;
    const Model model = shipped_with("mems-switch", {{"V", voltage}});
    const System system(model);
    ModeFlow flow(system, 1e-14);
    flow.set_parameters(model.parameter_values());
    std::vector<double> begin{-0.6, 0, phase};
    flow.run(0, begin, -phase);
    std::vector<double> middle = begin;
    flow.run(0, middle, pi);
    const OrbitSolution solution =
        solve_orbit(system, given_orbit(model, "on:switch_off off:switch_on", {begin, middle}, {pi, pi}));
    EXPECT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
    return {model, solution.orbit, "V"};
}

TripEnd at_speed(double speed) {
    TripEnd end;
    end.speed = speed;
    return end;
}

/// Compares prediction and simulation of the time until the same approach speed.
void expect_agreement(const Touching& one, double overshoot, double speeds_alike, double cycles_alike) {
    SCOPED_TRACE(overshoot);
    const PredictedTrip predicted = predicted_trip(one.map, one.verdict, overshoot);
    ASSERT_TRUE(predicted.ended);
    const TripEnd end = at_speed(predicted.level);
    const TripTime simulated = simulated_trip(one.system, one.map, one.parameter, overshoot, end);
    ASSERT_TRUE(simulated.ended) << simulated.ending;
    EXPECT_EQ(simulated.ending, "speed");
    EXPECT_EQ(simulated.contacts, predicted.contacts);
    EXPECT_NEAR(simulated.speed, predicted.speed, speeds_alike * predicted.speed);
    EXPECT_NEAR(simulated.time, predicted.time, cycles_alike * one.map.time);
}

TEST(TripTime, SwitchAgreesWithSimulationAndThePublishedMotion) {
    const Touching mems = mems_switch();
    // The relative error of the map is of the order of the last speed but one over its reach, and so is the phase shift
    // at a contact.
    for (const double overshoot : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10})
        expect_agreement(mems, overshoot, 0.03, 0.02);
    PredictionOptions options;
    options.level = 1e-9;
    const PredictedTrip first = predicted_trip(mems.map, mems.verdict, 1e-4, options);
    EXPECT_EQ(first.cycles, 1);
    EXPECT_NEAR(first.time, 6.267394614702, 1e-4); // to leading order
    // The touch is known to about 1e-13.
    const TripTime published = simulated_trip(mems.system, mems.map, mems.parameter, 1e-4, {});
    EXPECT_TRUE(published.ended);
    EXPECT_EQ(published.ending, "singular");
    EXPECT_EQ(published.contacts, 4U);
    EXPECT_NEAR(published.time, 27.31773570163, 1e-8);
    const TripEnd end = at_speed(1e-3);
    EXPECT_NEAR(simulated_trip(mems.system, mems.map, mems.parameter, 1e-4, end).time, 6.267394614702, 1e-9);
}

TEST(TripTime, ContinuesBySimulationAfterUnresolvableOvershoots) {
    const Touching mems = mems_switch();
    // Where both are possible; the last overshoot is at the resolution of the voltage.
    for (const double overshoot : {1e-9, 1e-10, 1e-11}) {
        const PredictedTrip predicted = predicted_trip(mems.map, mems.verdict, overshoot);
        const TripTime whole = simulated_trip(mems.system, mems.map, mems.parameter, overshoot, {});
        const TripTime continued = continued_trip(mems.system, mems.map, mems.parameter, overshoot, predicted, {});
        ASSERT_TRUE(whole.ended && continued.ended);
        EXPECT_EQ(continued.contacts, whole.contacts);
        EXPECT_NEAR(continued.time, whole.time, 5e-3);
    }
    EXPECT_LT(least_overshoot(mems.map, mems.parameter), 1e-10);
    EXPECT_GT(least_overshoot(mems.map, mems.parameter), 1e-14);
    double before = 0;
    for (const double overshoot : {1e-12, 1e-20, 1e-40, 1e-80, 1e-160, 1e-300}) {
        const PredictedTrip predicted = predicted_trip(mems.map, mems.verdict, overshoot);
        EXPECT_GT(predicted.handed_cycles, 0);
        const TripTime trip = continued_trip(mems.system, mems.map, mems.parameter, overshoot, predicted, {});
        ASSERT_TRUE(trip.ended) << overshoot;
        EXPECT_TRUE(trip.ending == "singular" || trip.ending == "terminal");
        // Speeds grow by repeated square roots: each doubling of the decades costs one cycle of 2 pi.
        if (before > 0) {
            EXPECT_NEAR(trip.time - before, 2 * std::numbers::pi, 1.0);
        }
        before = trip.time;
    }
}

TEST(TripTime, MapDoesNotPredictFarFromTheTouch) {
    const Touching mems = mems_switch();
    const PredictedTrip far = predicted_trip(mems.map, mems.verdict, 1);
    EXPECT_FALSE(far.ended);
    EXPECT_EQ(far.ending, "too-far");
    EXPECT_EQ(far.handed_cycles, 0);
    EXPECT_TRUE(continued_trip(mems.system, mems.map, mems.parameter, 1, far, {}).ended); // all by simulation
}

TEST(TripTime, EndsAtALevelOfAQuantity) {
    const Touching mems = mems_switch();
    TripEnd end;
    end.quantity = named_value(mems.system.model(), "q", {}).value;
    end.level = 0.9;
    const TripTime level = simulated_trip(mems.system, mems.map, mems.parameter, 1e-4, end);
    EXPECT_EQ(level.ending, "level");
    // The remaining time to the end of the gap is short.
    EXPECT_LT(level.time, 27.31773570163);
    EXPECT_GT(level.time, 27.0);
    TripOptions options;
    options.cycles = 2;
    const TripTime cut = simulated_trip(mems.system, mems.map, mems.parameter, 1e-4, end, options);
    EXPECT_FALSE(cut.ended);
    EXPECT_EQ(cut.ending, "end-time");
}

/// Passes of an oscillator by its matrix, independently of the map, from the touch with the force changed by a share.
struct ClosedForm {
    std::vector<double> cycles, speeds;
};
ClosedForm closed_form(const LinearOscillator& one, double overshoot, double level) {
    const Eigen::MatrixXd once = one.return_map();
    const Eigen::Index n = one.force.size();
    // The steady motion without stop, at its maximum of q_1, is proportional to the force. In units of the overshoot.
    const Eigen::VectorXcd amplitude = one.amplitude();
    Eigen::VectorXd free(2 * n), impacts = Eigen::VectorXd::Zero(2 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const std::complex<double> turned = amplitude[i] * std::conj(amplitude[0]) / std::abs(amplitude[0]);
        free[i] = -turned.real();
        free[n + i] = one.omega * turned.imag();
    }
    ClosedForm result;
    for (int k = 1; k < 3000; ++k) {
        free = (once * free).eval();
        impacts = (once * impacts).eval();
        const double gap = overshoot * (-one.stop() - free[0]) - impacts[0];
        if (gap >= 0)
            continue;
        result.cycles.push_back(k);
        result.speeds.push_back(std::sqrt(-2 * one.acceleration() * gap));
        if (result.speeds.back() >= level)
            break;
        impacts[n] -= (1 + one.restitution) * result.speeds.back();
    }
    return result;
}

TEST(TripTime, LinearOscillatorsHaveTheirClosedFormInAllUnits) {
    int several = 0;
    for (const double length : {1.0, 1e-9, 1e6})
        for (const double clock : {1.0, 1e-9, 1e6})
            for (LinearOscillator linear :
                 {one_degree(0.05, 1.3, 0.8), one_degree(0.02, 2.7, 0.5), one_degree(0.01, 0.77, 0.9),
                  two_degrees(0.3, 0.04, 1.1, 0.8, 0.4), two_degrees(2.1, 0.3, 2.7, 0, -0.7)}) {
                linear.length = length;
                linear.clock = clock;
                const Touching one = touching(linear);
                ASSERT_EQ(one.verdict.outcome, GrazingOutcome::lost) << one.verdict.reason;
                const double level = level_of_map(one.map, one.verdict);
                // The last clearances are near the underflow limit in these units.
                for (const double overshoot : {1e-2, 1e-6, 1e-13, 1e-20, 1e-100, 1e-250}) {
                    SCOPED_TRACE(fmt::format("length {} clock {} omega {} overshoot {}", length, clock, linear.omega,
                                             overshoot));
                    const PredictedTrip trip = predicted_trip(one.map, one.verdict, overshoot);
                    const ClosedForm closed = closed_form(linear, overshoot, level * clock / length);
                    ASSERT_TRUE(trip.ended);
                    ASSERT_EQ(trip.contacts, closed.cycles.size());
                    EXPECT_EQ(trip.cycles, closed.cycles.back());
                    EXPECT_EQ(trip.first_cycles, closed.cycles.front());
                    // The return map is accurate to 1e-13; cancellation amplifies its error in the gap.
                    EXPECT_NEAR(trip.first_speed * clock / length, closed.speeds.front(), 1e-8 * closed.speeds.front());
                    EXPECT_NEAR(trip.speed * clock / length, closed.speeds.back(), 1e-7 * closed.speeds.back());
                    several += trip.contacts > 4 ? 1 : 0;
                }
            }
    EXPECT_GT(several, 50);
}

TEST(TripTime, OscillatorsAndTheShakerAgreeWithSimulation) {
    for (const LinearOscillator& linear : {one_degree(0.05, 1.3, 0.8), two_degrees(0.3, 0.04, 1.1, 0.8, 0.4)}) {
        const Touching one = touching(linear);
        for (const double overshoot : {1e-4, 1e-6, 1e-8})
            expect_agreement(one, overshoot, 0.1, 0.1);
    }
    // The head itself moves, so that the motion would start beyond it.
    for (const double f : {6.0, 10.0, 14.0, 18.0, 22.0}) {
        const Model model = shipped_with("ball-and-shaker", {{"a", 0.65}, {"f", f}});
        const Orbit orbit = given_orbit(model, "free:phase0", {{0, 0, 0}}, {1 / f});
        const Touching one(model, orbit, "a");
        for (const double overshoot : {1e-6, 1e-8, 1e-10}) {
            SCOPED_TRACE(f);
            EXPECT_EQ(predicted_trip(one.map, one.verdict, overshoot).first_cycles, 0);
            expect_agreement(one, overshoot, 0.1, 0.1);
        }
    }
}

/// A map of two independent states; contacts change the second.
CycleMap two_states(double slow) {
    CycleMap map;
    map.contact.order = MapOrder::square_root;
    map.contact.acceleration = 0.5;
    map.contact.gradient = {1, 1};
    map.contact.rate_gradient = {0, 0};
    map.contact.touch.state = {0, 0};
    map.contact.touch.parameters = {1};
    map.contact.touch.scales = {1, 1};
    map.time = 2;
    map.active = {0, 1};
    map.scales = {1, 1};
    map.matrix = {slow, 0, 0, 0.5};
    map.impact = {0, -1};
    map.gradient = {1, 1};
    map.multipliers = {slow, 0.5};
    map.clearance_rate = -1;
    map.steady = {0, -1};
    return map;
}

TEST(TripTime, FreeCyclesHaveTheirClosedFormHoweverMany) {
    for (const double slow : {0.9, 1 - 1e-3, 1 - 1e-6, 1 - 1e-8})
        for (const double overshoot : {1e-2, 1e-6, 1e-20, 1e-300}) {
            SCOPED_TRACE(fmt::format("multiplier 1 - {} overshoot {}", 1 - slow, overshoot));
            const CycleMap map = two_states(slow);
            PredictionOptions options;
            options.disturbance = {1, 0};
            const PredictedTrip trip = predicted_trip(map, verdict_of(map), overshoot, options);
            ASSERT_TRUE(trip.ended);
            // Free cycles end when slow^k falls below the overshoot. Squaring loses as many digits as the count has.
            const double free = std::log(overshoot) / std::log(slow);
            EXPECT_NEAR(trip.first_cycles, free, 1 + 1e-6 * free);
        }
}

TEST(TripTime, SpeedsGrowByTheSquareRoot) {
    const CycleMap map = two_states(0.1);
    const Verdict verdict = verdict_of(map);
    ASSERT_EQ(verdict.next_contact, 1U);
    EXPECT_NEAR(*verdict.reach, 0.5, 1e-15); // -2 a g P B
    for (const double overshoot : {1e-8, 1e-20, 1e-100, 1e-300}) {
        const PredictedTrip trip = predicted_trip(map, verdict, overshoot);
        // The logarithm of speed over reach halves from contact to contact. The first contact is at half the overshoot,
        // since half of the initial state remains; earlier contacts add a little to later ones.
        EXPECT_NEAR(trip.first_speed, std::sqrt(0.5 * overshoot), 1e-12 * trip.first_speed);
        const double first = std::log(trip.first_speed / *verdict.reach), level = std::log(trip.level / *verdict.reach);
        const double contacts = std::ceil(std::log2(first / level)) + 1;
        EXPECT_NEAR(static_cast<double>(trip.contacts), contacts, 1);
        EXPECT_NEAR(std::log(trip.speed / *verdict.reach),
                    first / std::pow(2.0, static_cast<double>(trip.contacts) - 1), 0.3);
        EXPECT_EQ(trip.cycles, static_cast<double>(trip.contacts));
    }
}

TEST(TripTime, CyclesOfAHalfOrbitAreHalfPeriods) {
    constexpr double zeta = 0.02, omega = 1.2, pi = std::numbers::pi;
    constexpr double in_phase = 1 - omega * omega, out_of_phase = 2 * zeta * omega,
                     square = in_phase * in_phase + out_of_phase * out_of_phase;
    const Model model = shipped_with("impact-oscillator-two-stops", {{"sigma", 1 / std::sqrt(square)}});
    Orbit orbit =
        given_orbit(model, "free:phase0", {{in_phase / square, omega * out_of_phase / square, 0}}, {pi / omega});
    orbit.symmetry = 0;
    const Touching one(model, orbit, "amplitude");
    ASSERT_TRUE(one.map.half);
    ASSERT_EQ(one.verdict.outcome, GrazingOutcome::lost);
    for (const double overshoot : {1e-3, 1e-5, 1e-7, 1e-9}) {
        expect_agreement(one, overshoot, 0.1, 0.1);
        const PredictedTrip predicted = predicted_trip(one.map, one.verdict, overshoot);
        const TripEnd end = at_speed(predicted.level);
        const TripTime whole = simulated_trip(one.system, one.map, one.parameter, overshoot, end);
        const TripTime continued = continued_trip(one.system, one.map, one.parameter, overshoot, predicted, end);
        EXPECT_EQ(std::fmod(predicted.handed_cycles, 2), 0);
        EXPECT_EQ(continued.contacts, whole.contacts);
        EXPECT_NEAR(continued.time, whole.time, 1e-2);
    }
    const PredictedTrip tiny = predicted_trip(one.map, one.verdict, 1e-20);
    EXPECT_GT(tiny.handed_cycles, 0);
    EXPECT_EQ(std::fmod(tiny.handed_cycles, 2), 0);
    const TripEnd end = at_speed(tiny.level);
    EXPECT_NEAR(continued_trip(one.system, one.map, one.parameter, 1e-20, tiny, end).time, tiny.time,
                0.1 * one.map.time);
}

TEST(TripTime, AgreesWithSimulationOnRandomOscillators) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(0, 1);
    int compared = 0, alike = 0, continued_alike = 0;
    for (int trial = 0; trial < 150; ++trial) {
        const double zeta = std::pow(10, -2.5 + 2.5 * uniform(random)), omega = 0.4 + 5 * uniform(random),
                     e = 0.95 * uniform(random);
        const LinearOscillator linear = trial % 2 == 0
                                            ? one_degree(zeta, omega, e)
                                            : two_degrees(3 * uniform(random), zeta, omega, e, 2 * uniform(random) - 1);
        const Touching one = touching(linear);
        if (one.verdict.outcome != GrazingOutcome::lost)
            continue;
        for (const double overshoot : {1e-5, 1e-8}) {
            const PredictedTrip predicted = predicted_trip(one.map, one.verdict, overshoot);
            const TripEnd end = at_speed(predicted.level);
            const TripTime whole = simulated_trip(one.system, one.map, one.parameter, overshoot, end);
            const TripTime continued = continued_trip(one.system, one.map, one.parameter, overshoot, predicted, end);
            ++compared;
            alike += whole.ended && std::abs(whole.time - predicted.time) < 0.2 * one.map.time ? 1 : 0;
            continued_alike +=
                whole.ended && continued.ended && std::abs(whole.time - continued.time) < 0.05 * one.map.time ? 1 : 0;
        }
    }
    std::cout << compared << " compared, " << alike << " by the map and " << continued_alike
              << " from there on alike\n";
    EXPECT_GE(compared, 200);
    // A contact within some percent of the level, or of missing, may count in one and not in the other.
    EXPECT_GE(alike, 0.97 * compared);
    EXPECT_EQ(continued_alike, compared);
}

TEST(TripTime, DisturbanceAloneMayStartATrip) {
    const Touching one = touching(one_degree(0.05, 1.3, 0.8));
    PredictionOptions predicted;
    predicted.disturbance = {0, 1e-5, 0}; // towards the stop
    TripOptions simulated;
    simulated.disturbance = predicted.disturbance;
    const PredictedTrip map = predicted_trip(one.map, one.verdict, 0, predicted);
    EXPECT_EQ(map.first_cycles, 0);
    EXPECT_NEAR(map.first_speed, 1e-5, 1e-10);
    const TripEnd end = at_speed(map.level);
    const TripTime motion = simulated_trip(one.system, one.map, one.parameter, 0, end, simulated);
    EXPECT_TRUE(map.ended && motion.ended);
    EXPECT_EQ(motion.contacts, map.contacts);
    EXPECT_NEAR(motion.time, map.time, 0.1 * one.map.time);
}

TEST(TripTime, ImpossibleTripsAreRefused) {
    const Touching one = touching(one_degree(0.05, 1.3, 0.8));
    EXPECT_THROW(predicted_trip(one.map, one.verdict, -1e-6), InputError);
    EXPECT_THROW(predicted_trip(one.map, one.verdict, 0), InputError);
    EXPECT_THROW(predicted_trip(one.map, one.verdict, std::nan("")), InputError);
    EXPECT_THROW(simulated_trip(one.system, one.map, one.parameter, -1e-6, {}), InputError);
    PredictionOptions wrong;
    wrong.disturbance = {1};
    EXPECT_THROW(predicted_trip(one.map, one.verdict, 1e-6, wrong), InputError);
    TripOptions none;
    none.cycles = 0;
    EXPECT_THROW(simulated_trip(one.system, one.map, one.parameter, 1e-6, {}, none), InputError);
    const Touching calm = touching(one_degree(1.3, 3, 0.8));
    ASSERT_EQ(calm.verdict.outcome, GrazingOutcome::persists);
    EXPECT_THAT(message_of([&] { predicted_trip(calm.map, calm.verdict, 1e-6); }),
                ::testing::HasSubstr("the verdict is persists"));
    CycleMap without = one.map;
    without.clearance_rate.reset();
    EXPECT_THROW(predicted_trip(without, one.verdict, 1e-6), InputError);
}

/// The level of a stop is reached at the contact, whatever round-off does.
TEST(TripTime, TheLevelOfAStopIsReachedAtTheFirstContact) {
    struct FirstContact : Observer {
        double time = -1;
        void contact(const Contact& contact) override {
            if (time < 0)
                time = contact.time;
        }
        bool stop() override { return time >= 0; }
    };
    const Model model = load_model("impact-oscillator");
    const System system(model);
    TripEnd end;
    end.quantity = model.events[0].function;
    const Simulation simulation = simulation_until(system, end, TripOptions{});
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-1, 1);
    int contacts = 0;
    for (int i = 0; i < 300; ++i) {
        std::vector<double> state = model.initial_state();
        state[0] -= std::abs(number(random));
        state[1] = number(random);
        const std::vector<double> parameters = model.parameter_values();
        FirstContact first;
        Trajectory trajectory(simulation, parameters, borrowed(first));
        trajectory.start(state, model.initial_mode, 0, 50);
        run(trajectory);
        EndWatch watch(end, {}, nullptr);
        const TripTime trip = run_until(simulation, parameters, state, model.initial_mode, 50, watch);
        if (first.time <= 0)
            continue;
        ++contacts;
        EXPECT_EQ(trip.ending, "level");
        EXPECT_NEAR(trip.time, first.time, 1e-12) << i;
    }
    EXPECT_GT(contacts, 100);
}

/// The depth of sliding grows by a factor from one time to the next, so the number of cycles grows logarithmically. The
/// orbit's other, much harder contacts do not count.
TEST(TripTime, SlidingOnABeltGrowsLogarithmically) {
    Model model = belt();
    model.set_parameter("nu", 2.2);
    const BranchSettings settings = in_parameter(model, "nu", 2, 2.4, -1);
    const Branch branch = follow_branch(System(model), settled(model, "phase0").orbit, settings);
    std::size_t folds = 0;
    for (const SpecialPoint& point : of_type(branch, PointType::grazing)) {
        const CycleMap map = cycle_at(model, point, settings.parameter);
        const Verdict verdict = verdict_of(map);
        if (verdict.outcome == GrazingOutcome::undecided)
            continue;
        ++folds;
        for (const double overshoot : {-1e-5, -1e-7, -1e-9}) {
            const PredictedTrip predicted = predicted_trip(map, verdict, overshoot);
            ASSERT_TRUE(predicted.ended) << predicted.ending;
            const TripEnd end = at_speed(predicted.level);
            const TripTime simulated = simulated_trip(System(model), map, settings.parameter, overshoot, end);
            EXPECT_EQ(simulated.ending, "speed");
            EXPECT_NEAR(simulated.cycles, predicted.cycles, 1.1) << overshoot;
            const double log_growth = std::log(*verdict.leading),
                         deep = predicted.level * predicted.level / (2 * map.contact.acceleration);
            EXPECT_NEAR(predicted.cycles, std::log(deep / std::abs(overshoot)) / log_growth, 5);
        }
    }
    EXPECT_GE(folds, 1U);
}

} // namespace graze::trip_time_test
