// Reset values of tripped motions without a branch of orbits: a mass held by a stop against closed forms, in two
// systems of units; and a motion that does not settle.

#include "design/reset_steps.hpp"

#include "switches.hpp"
#include "trajectory/model_parts.hpp"

#include <fmt/format.h>

#include <utility>

namespace graze::testing::reset_steps_test {

struct Units {
    double length = 1, time = 1, mass = 1;
    double force() const { return mass * length / (time * time); }
};

constexpr double stiffness = 1, damping = 0.6, drive = 0.1, frequency = 0.7, stop = 0.5, adhesion = 0.45;

/// A driven linear oscillator that a steady force, the control parameter, presses towards its stop. It sticks there,
/// held by that force and by adhesion, until the spring pulls it off.
/// @param shakes whether the drive acts on the held mass, too
std::string latch_text(const Units& units, bool shakes) {
    const std::string release = shakes ? "P + H - k*delta + A*cos(theta)" : "P + H - k*delta",
                      next = fmt::format("[{{ when = '{} > 0', mode = 'held' }}, {{ mode = 'free' }}]", release);
    return fmt::format(R"(name = "latch"
[parameters]
P = {:.17g}
m = {:.17g}
k = {:.17g}
c = {:.17g}
A = {:.17g}
H = {:.17g}
w = {:.17g}
delta = {:.17g}
[states]
x = 0
v = 0
theta = {{ initial = 0, period = "2*pi" }}
[modes.free]
rates = {{ x = "v", v = "(P - k*x - c*v + A*cos(theta))/m", theta = "w" }}
watch = ["stop"]
[modes.held]
rates = {{ x = 0, v = 0, theta = "w" }}
watch = ["release"]
[events]
stop = "delta - x"
release = "{}"
[jumps.rest]
x = "delta"
v = 0
[initial]
mode = "free"
)",
                       0.1 * units.force(), units.mass, stiffness * units.force() / units.length,
                       damping * units.force() / units.length * units.time, drive * units.force(),
                       adhesion * units.force(), frequency / units.time, stop * units.length, release) +
           transition("free", "stop", next, "rest", "catch") +
           transition("held", "release", "free", "rest", "release") + at_phase(0, "phase0");
}

void expect_latch(const Units& units, bool shakes) {
    SCOPED_TRACE(fmt::format("units of {} and {}, {}", units.length, units.time, shakes ? "shaken" : "still"));
    const TemporaryFolder folder;
    folder.write("latch.toml", latch_text(units, shakes));
    const Design design = parse_design(fmt::format(R"(name = "latch"
model = "latch.toml"
control = "P"
[approach]
range = [{:.17g}, {:.17g}]
event = "stop"
[dimensions.H]
range = [0, {:.17g}]
)",
                                                   0.1 * units.force(), units.force(), units.force()),
                                       folder / "design.toml");
    const TripPoint trip = trip_of(design);
    const double closed_trip = stop - drive / std::hypot(stiffness - frequency * frequency, damping * frequency);
    EXPECT_NEAR(trip.value() / units.force(), closed_trip, 1e-9);
    ResetOptions options;
    options.overshoot = 0.01 * units.force();
    const Reset reset = reset_of(trip, trip.point.solution.orbit, options);
    ASSERT_TRUE(reset.value) << reset.reason;
    // At release the spring's force and the least force of the drive equal steady force and adhesion.
    const double closed = stiffness * stop - adhesion + (shakes ? drive : 0);
    constexpr double rounding = 1e-12;
    if (shakes) {
        // A held orbit, which ends where the release function touches zero.
        EXPECT_EQ(reset.how, "grazing");
        EXPECT_NEAR(*reset.value / units.force(), closed, 1e-9);
    } else {
        EXPECT_EQ(reset.motion, "equilibrium");
        ASSERT_TRUE(reset.lost_at);
        // It lies between both ends, which differ by at most 1e-6 of the way.
        EXPECT_LE(*reset.lost_at / units.force(), closed + rounding);
        EXPECT_GE(*reset.value / units.force(), closed - rounding);
        EXPECT_LE((*reset.value - *reset.lost_at) / units.force(), 1e-6 * closed_trip * (1 + 1e-9));
        EXPECT_FALSE(reset.point);
    }
    // If it is not followed that far, the motion is still there.
    options.least = (closed + 0.01) * units.force();
    const Reset remains = reset_of(trip, trip.point.solution.orbit, options);
    EXPECT_FALSE(remains.value);
    EXPECT_FALSE(remains.lost_at);
    EXPECT_NE(remains.reason.find("still there"), std::string::npos) << remains.reason;
}

constexpr Units micro{.length = 1e-6, .time = 1e-5, .mass = 1e-9};

TEST(ResetSteps, AMassHeldByASteadyForceIsReleasedWhenTheSpringIsStronger) {
    expect_latch({}, false);
    expect_latch(micro, false);
}

TEST(ResetSteps, AMassHeldWhileItIsShakenIsReleasedAtTheWorstPhase) {
    expect_latch({}, true);
    expect_latch(micro, true);
}

/// Number of contacts of the motion from the orbit at the trip point, long after the control parameter has been brought
/// to a value.
std::size_t late_contacts(const TripPoint& trip, const std::vector<double>& values) {
    struct Count : public Observer {
        void contact(const Contact&) override { ++contacts; }
        std::size_t contacts = 0;
    };
    const Simulation simulation(trip.system, {}, {}, {});
    const Orbit& orbit = trip.point.solution.orbit;
    std::vector<double> state = orbit.starts.front(), parameters = orbit.parameters;
    std::size_t mode = orbit.signature.front().mode, contacts = 0;
    for (const double value : values) {
        parameters[trip.control.place()] = value;
        Count count;
        // It settles first, then contacts are counted.
        for (const double periods : {1000.0, 100.0}) {
            count.contacts = 0;
            Trajectory trajectory(simulation, parameters, borrowed(count));
            trajectory.start(state, mode, 0, periods * orbit.period());
            run(trajectory);
            state.assign(trajectory.state().begin(), trajectory.state().end());
            mode = trajectory.mode();
        }
        contacts = count.contacts;
    }
    return contacts;
}

/// The trip value of this oscillator, in closed form.
std::string oscillator(double zeta, double omega, double restitution) {
    return fmt::format(R"(name = "oscillator"
model = "impact-oscillator"
control = "amplitude"
set = {{ zeta = {}, sigma = 0.2, omega = {}, e = {} }}
[approach]
range = [0.01, 3]
event = "stop"
[dimensions.sigma]
range = [0.1, 0.4]
)",
                       zeta, omega, restitution);
}

/// Another sequence of steps than those of the reset, to 1 % above the value where the motion remained and 1 % below
/// the one where it was lost. @return numbers of contacts at both
std::pair<std::size_t, std::size_t> contacts_beside(const TripPoint& trip, double overshoot, const Reset& reset) {
    std::vector<double> way{trip.value() + overshoot};
    while (way.back() * 0.9 > *reset.value)
        way.push_back(way.back() * 0.9);
    way.push_back(1.01 * *reset.value);
    const std::size_t there = late_contacts(trip, way);
    way.push_back(0.99 * *reset.lost_at);
    return {there, late_contacts(trip, way)};
}

TEST(ResetStepsSlow, AMotionThatDoesNotSettleIsTakenBackUntilItSettles) {
    const TripPoint trip = trip_of(parse_design(oscillator(0.05, 2.7, 0.8), "d.toml"));
    EXPECT_NEAR(trip.value(), oscillator_value(0.2, 0.05, 2.7), 1e-9);
    ResetOptions options;
    options.overshoot = 0.05;
    options.least = 0.01;
    const Reset reset = reset_of(trip, trip.point.solution.orbit, options);
    ASSERT_TRUE(reset.value && reset.lost_at) << reset.reason;
    EXPECT_EQ(reset.motion, "chaotic");
    EXPECT_LT(*reset.lost_at, *reset.value);
    const auto [there, lost] = contacts_beside(trip, options.overshoot, reset);
    EXPECT_GT(there, 0U);
    EXPECT_EQ(lost, 0U);
}

TEST(ResetStepsSlow, AnOrbitThatChangesBeyondTheTripValueIsNotAReset) {
    const TripPoint trip = trip_of(parse_design(oscillator(0.1, 2.4, 0.9), "d.toml"));
    EXPECT_NEAR(trip.value(), oscillator_value(0.2, 0.1, 2.4), 1e-9);
    ResetOptions options;
    options.overshoot = 0.1;
    options.least = 0.01;
    const Reset reset = reset_of(trip, trip.point.solution.orbit, options);
    ASSERT_TRUE(reset.value && reset.lost_at) << reset.reason;
    EXPECT_LT(*reset.lost_at, *reset.value);
    EXPECT_LT(*reset.value, trip.value());
    // Other motions with contacts may exist below, which this one has not reached: they are not tested.
    EXPECT_GT(contacts_beside(trip, options.overshoot, reset).first, 0U);
}

} // namespace graze::testing::reset_steps_test
