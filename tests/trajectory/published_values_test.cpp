// Published values of the shipped models by simulation only, without orbits or branches. Unstable periodic motions are
// found by Newton's method on the stroboscopic map, with finite differences.

#include "graze/model/microbeam.hpp"
#include "trajectory/simulate.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <array>
#include <map>
#include <memory>
#include <numbers>
#include <set>

namespace graze::published_values_test {

using namespace graze::testing;
using std::numbers::pi;

/// Removes an event from a model: the motion without the stop.
Model without_event(Model model, const char* event) {
    const std::size_t index = model.find_event(event).value();
    for (Mode& mode : model.modes)
        std::erase(mode.watched, index);
    std::erase_if(model.transitions, [&](const Transition& transition) { return transition.event == index; });
    return model;
}

Probe extremum(const Model& model, const std::string& state, Direction direction) {
    return {state, Probe::Kind::extremum, model.symbol(state), direction, 0, {}};
}

std::size_t contacts_at(const Experiment& experiment, const char* event) {
    const std::size_t index = experiment.simulation.model().find_event(event).value();
    return static_cast<std::size_t>(std::count_if(experiment.recorder.contacts().begin(),
                                                  experiment.recorder.contacts().end(),
                                                  [&](const auto& record) { return record.contact.event == index; }));
}

/// Returns the times of contacts at an event.
std::vector<double> contact_times(const Experiment& experiment, const char* event) {
    const std::size_t index = experiment.simulation.model().find_event(event).value();
    std::vector<double> times;
    for (const auto& record : experiment.recorder.contacts())
        if (record.contact.event == index && record.contact.kind == ContactKind::crossing)
            times.push_back(record.contact.time);
    return times;
}

/// Returns the largest value of a state at passages of a probe after a time.
double largest(const Experiment& experiment, std::size_t probe, std::size_t state, double after) {
    double result = -std::numeric_limits<double>::infinity();
    for (const auto& record : experiment.recorder.passages())
        if (record.passage.probe == probe && record.passage.time > after)
            result = std::max(result, record.state[state]);
    return result;
}

// ---- chapter 6

TEST(MemsSwitch, ImpactsAndSnapThroughAreThePublishedOnes) {
    Experiment experiment(load_model("mems-switch"), with_tolerance(1e-14));
    const Outcome outcome = experiment.run(100);
    EXPECT_EQ(outcome.ending, Ending::singular);
    EXPECT_NEAR(outcome.time, 27.31773570163, 1e-9);
    const std::vector<double> times = contact_times(experiment, "stop");
    const std::vector<double> published = {6.267394614702, 12.444019629629, 18.420333867640, 24.195342497066};
    ASSERT_GE(times.size(), published.size());
    // The motion starts on the surface at the grazing point, which may count as a contact at zero speed.
    const std::size_t first = times.size() - published.size();
    EXPECT_LE(first, 1u);
    for (std::size_t i = 0; i < published.size(); ++i)
        EXPECT_NEAR(times[first + i], published[i], 1e-9);
}

TEST(MemsSwitch, ImpactsReverseAndReduceTheSpeed) {
    Experiment experiment(load_model("mems-switch"), with_tolerance(1e-14));
    experiment.run(100);
    int impacts = 0;
    double last = 0;
    const std::size_t stop = experiment.simulation.model().find_event("stop").value();
    for (const auto& record : experiment.recorder.contacts()) {
        if (record.contact.event != stop || record.contact.kind != ContactKind::crossing || record.contact.time == 0)
            continue;
        ++impacts;
        EXPECT_NEAR(record.before[0], -0.6, 4 * epsilon);
        EXPECT_EQ(record.after[0], record.before[0]);
        EXPECT_NEAR(record.after[1], -0.8 * record.before[1], epsilon);
        EXPECT_NEAR(record.contact.rate_before, record.before[1], 1e-13);
        EXPECT_NEAR(record.contact.rate_after, record.after[1], epsilon);
        EXPECT_GT(-record.before[1], last); // speeds grow from impact to impact
        last = -record.before[1];
    }
    EXPECT_EQ(impacts, 4);
}

TEST(MemsSwitch, SnapThroughTimeDoesNotDependOnTolerance) {
    // Impacts close to grazing amplify errors: by about 1e3 from the first impact to the end.
    for (const double tolerance : {1e-10, 1e-12, 1e-16}) {
        Experiment experiment(load_model("mems-switch"), with_tolerance(tolerance));
        EXPECT_NEAR(experiment.run(100).time, 27.31773570163, 1e-11 + 1e5 * tolerance) << tolerance;
    }
}

/// Loads on modes that they cannot excite cancel to round-off; this must not keep the beam at rest.
TEST(Microbeam, LeavesRestWithAnyNumberOfModesAndNodes) {
    for (const Quadrature rule : {Quadrature::simpson, Quadrature::gauss})
        for (int modes = 1; modes <= 5; ++modes)
            for (const int points : {4, 6, 20}) {
                Experiment experiment(microbeam({.modes = modes, .quadrature = rule, .points = points}));
                const Outcome outcome = experiment.run(0.3);
                EXPECT_EQ(outcome.ending, Ending::end_time)
                    << modes << " modes, " << points << " points: " << outcome.detail;
                // A symmetric load does not excite antisymmetric modes.
                for (int i = 1; i < modes; i += 2)
                    EXPECT_LT(std::abs(experiment.trajectory.state()[static_cast<std::size_t>(i)]), 1e-15);
                EXPECT_GT(std::abs(experiment.trajectory.state()[0]), 1e-5);
            }
}

/// At any speed of the electrode, with the voltage on or off, it does not pass the fixed one.
TEST(MemsSwitch, ClosureEndsTheMotionInEveryMode) {
    int singular = 0, terminal = 0;
    for (int i = 0; i < 60; ++i) {
        const double excess = std::pow(10.0, -8 + 0.1 * i);
        Experiment experiment(shipped_with("mems-switch", {{"V", 0.2013662121541341 + excess}}));
        const Outcome outcome = experiment.run(5000);
        singular += outcome.ending == Ending::singular ? 1 : 0;
        terminal += outcome.ending == Ending::terminal ? 1 : 0;
        EXPECT_LE(experiment.trajectory.state()[0], 1 + 1e-12) << excess;
        if (outcome.ending == Ending::terminal) {
            EXPECT_NEAR(experiment.trajectory.state()[0], 1, 1e-12) << excess;
        }
    }
    EXPECT_EQ(singular + terminal, 60);
    EXPECT_GT(terminal, 0);
    EXPECT_GT(singular, 0);
}

TEST(Microbeam, ClosureEndsTheMotionInEveryMode) {
    int closed = 0;
    for (int i = 0; i < 20; ++i) {
        Experiment experiment(shipped_with("microbeam", {{"V", 0.03 + 0.005 * i}, {"k", 0}}));
        const Outcome outcome = experiment.run(20);
        closed += outcome.ending == Ending::terminal || outcome.ending == Ending::singular ? 1 : 0;
        const Model& model = experiment.simulation.model();
        const double gap = model.parameters[*model.find_parameter("g0")].value.value();
        // The first mode shape is 1.588 at mid-span.
        EXPECT_LE(1.588 * experiment.trajectory.state()[0], 1.0001 * gap) << i;
    }
    EXPECT_GT(closed, 5);
}

// ---- chapter 4

TEST(BallAndShaker, ImpactsFromRestAreThePublishedOnes) {
    Experiment experiment(load_model("ball-and-shaker"), with_tolerance(1e-14));
    experiment.run(0.4);
    const double published[][2] = {
        {0.040626571561, 1.4900573956}, {0.19997381698, 12.733127832}, {0.3533191041, 37.681754587}};
    ASSERT_EQ(experiment.recorder.contacts().size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& record = experiment.recorder.contacts()[i];
        EXPECT_NEAR(record.contact.time, published[i][0], 1e-9);
        EXPECT_NEAR(record.after[1] - record.before[1], published[i][1], 1e-9 * published[i][1]);
    }
}

/// The factor of Eq. (4.25), with b = 0.65.
double growth_factor(double frequency) {
    const double zeta = 0.0881, omega_n = 25.2, e = 0.55, b = 0.65;
    const double omega = 2 * pi * frequency, own = omega_n * std::sqrt(1 - zeta * zeta);
    int n = 1;
    while (std::sin(2 * n * pi * own / omega) >= 0)
        ++n;
    return omega * (1 + e) *
           std::sqrt(-2 * b * std::exp(-2 * n * pi * zeta * omega_n / omega) / own *
                     std::sin(2 * n * pi * own / omega));
}

TEST(BallAndShaker, VelocityJumpsGrowAsTheSquareRootOfTheLast) {
    const std::map<double, double> published = {
        {6, 1.01155084345}, {10, 1.23874262010}, {14, 1.23958271687}, {18, 1.48867209817}, {22, 1.34410718122}};
    for (const auto& [frequency, intercept] : published) {
        EXPECT_NEAR(std::log10(growth_factor(frequency)), intercept, 1e-10);
        // As the amplitude approaches grazing, the ratio of a jump to the root of the previous jump tends to the
        // factor.
        Model model = shipped_with("ball-and-shaker", {{"f", frequency}, {"a", 0.65 + 1e-11}});
        Experiment experiment(model, with_tolerance(1e-15));
        experiment.run(20 / frequency);
        std::vector<double> jumps;
        for (const auto& record : experiment.recorder.contacts())
            if (record.contact.kind == ContactKind::crossing)
                jumps.push_back(record.after[1] - record.before[1]);
        ASSERT_GE(jumps.size(), 2u) << frequency;
        EXPECT_NEAR(std::log10(jumps[1] / std::sqrt(jumps[0])), intercept, 0.03) << frequency;
    }
}

TEST(BallAndShaker, MotionOfFigure42aHasGrowingImpacts) {
    // Impacts grow, and the ball stays in front of the shaker.
    Experiment experiment(load_model("ball-and-shaker"), with_tolerance(1e-13));
    experiment.run(3);
    const Model& model = experiment.simulation.model();
    double most = 0;
    for (const auto& record : experiment.recorder.contacts()) {
        most = std::max(most, record.after[1] - record.before[1]);
        const double shaker = 0.6505 * std::sin(record.before[2]) - 0.65;
        EXPECT_NEAR(record.before[0], shaker, 1e-14);
    }
    EXPECT_GT(experiment.recorder.contacts().size(), 10u);
    EXPECT_GT(most, 40); // mm/s: the motion has moved far from grazing
    EXPECT_EQ(model.modes[experiment.trajectory.mode()].name, "free");
}

// ---- chapter 5

/// Returns nondimensional displacement, velocity and current.
std::array<double, 3> nondimensional(std::span<const double> state) {
    const double length = 1.631e-3, rate = 95.94;
    const double current = std::sqrt(2 * 0.6462 * rate * rate * length * length * length / 1.902e-5);
    return {state[0] / length, state[1] / (length * rate), state[2] / current};
}

TEST(ElectromagneticTestbed, PeriodThreeOrbitRepeats) {
    const Model model = shipped_with("electromagnetic-testbed", {{"V0", 4.833}});
    for (const double current : {0.1, 2.0, -1.0}) {
        Experiment experiment(model, with_tolerance(1e-14), {section_probe(model, "phase0")});
        std::vector<double> start = model.initial_state();
        start[2] = current;
        const std::size_t periods = 1300;
        experiment.run_from(start, 0, 0.16 * (periods + 0.5));
        const auto& passages = experiment.recorder.passages();
        ASSERT_EQ(passages.size(), periods);
        std::array<double, 3> size{};
        for (std::size_t i = 290; i < 300; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                size[j] = std::max(size[j], std::abs(passages[i].state[j]));
        double worst = 0;
        for (std::size_t i = 300; i + 3 < periods; i += 3)
            for (std::size_t j = 0; j < 3; ++j)
                worst = std::max(worst, std::abs(passages[i].state[j] - passages[300].state[j]) / size[j]);
        EXPECT_LT(worst, 1e-12);
        double nearest = 1;
        for (std::size_t i = periods - 3; i < periods; ++i) {
            const auto point = nondimensional(passages[i].state);
            nearest = std::min(nearest, std::abs(point[0] + 0.02132575268965) + std::abs(point[1] + 0.51756427523650) +
                                            std::abs(point[2] + 0.73263907207969));
        }
        EXPECT_LT(nearest, 1e-12);
    }
}

TEST(ElectromagneticTestbed, PeriodThreeOrbitIsSymmetric) {
    // (q, v, I, theta) -> (q, v, -I, theta + pi): at phase pi the section point appears with the current reversed.
    const Model model = shipped_with("electromagnetic-testbed", {{"V0", 4.833}});
    Experiment experiment(model, with_tolerance(1e-14), {section_probe(model, "phasepi")});
    std::vector<double> start = model.initial_state();
    start[2] = 0.1;
    experiment.run_from(start, 0, 0.16 * 400);
    const auto& passages = experiment.recorder.passages();
    ASSERT_EQ(passages.size(), 400u);
    double nearest = 1;
    for (std::size_t i = 397; i < 400; ++i) {
        const auto point = nondimensional(passages[i].state);
        nearest = std::min(nearest, std::abs(point[0] + 0.02132575268965) + std::abs(point[1] + 0.51756427523650) +
                                        std::abs(point[2] - 0.73263907207969));
    }
    EXPECT_LT(nearest, 1e-12);
}

TEST(ElectromagneticTestbed, GrazingVoltagesAreThePublishedOnes) {
    const std::map<double, double> published = {{6.25, 4.833263260865}, {7, 3.675357252066}, {8, 3.998955699893}};
    const double delta = 0.001106239596;
    for (const auto& [frequency, voltage] : published)
        for (const double offset : {-1e-9, -1e-11, 1e-11, 1e-9}) {
            const Model full = shipped_with("electromagnetic-testbed", {{"f", frequency}, {"V0", voltage + offset}});
            const Model free = without_event(full, "stop");
            Experiment settled(free, with_tolerance(1e-15), {extremum(free, "q", Direction::falling)});
            settled.run(200 / frequency);
            const double most = largest(settled, 0, 0, 195 / frequency);
            EXPECT_EQ(most < delta, offset < 0) << frequency << ' ' << offset << ' ' << most - delta;
            Experiment watched(full, with_tolerance(1e-15));
            watched.run_from(settled.state(), 0, 20 / frequency);
            EXPECT_EQ(contacts_at(watched, "stop") == 0, offset < 0) << frequency << ' ' << offset;
        }
}

TEST(ElectromagneticTestbed, LeastGapOverStepsAgreesWithTheExtremum) {
    const Model full = shipped_with("electromagnetic-testbed", {{"V0", 4.5}});
    Simulation simulation(System(full), {extremum(full, "q", Direction::falling)}, {},
                          {.tolerance = 1e-14, .minima = true});
    Recorder recorder;
    double least = 1;
    ArcMinima minima([&](const ArcMinimum& minimum) {
        least = std::min(least, minimum.value);
        EXPECT_LE(minimum.lower_bound, minimum.value);
        EXPECT_GE(minimum.lower_bound, minimum.value - 1e-16);
    });
    Relay relay({borrowed(recorder), borrowed(minima)});
    Trajectory trajectory(simulation, full.parameter_values(), borrowed(relay));
    trajectory.start(full.initial_state(), 0, 0, 8);
    run(trajectory);
    minima.finish();
    double most = -1;
    for (const auto& record : recorder.passages())
        most = std::max(most, record.state[0]);
    EXPECT_NEAR(least, 0.001106239596 - most, 4 * epsilon * 0.0011);
}

// ---- chapter 2

/// The motion of the impactor in a sticking frame without a front stop: the stroboscopic map over one period of the
/// force and the largest displacement, as functions of displacement, velocity and voltage.
class StickingFrame {
public:
    StickingFrame() : model_(without_event(load_model("impact-microactuator"), "front")) {}

    /// Returns the map minus identity, and the largest displacement minus the clearance.
    Eigen::Vector3d operator()(const Eigen::Vector3d& at) {
        if (!experiment_ || at[2] != voltage_) {
            voltage_ = at[2];
            model_.set_parameter("V", voltage_);
            experiment_ = std::make_unique<Experiment>(model_, with_tolerance(1e-15),
                                                       std::vector<Probe>{extremum(model_, "x3", Direction::falling)});
        }
        experiment_->run_from({0, 0, at[0], at[1], 0}, model_.find_mode("stick").value(), pi / 0.9189);
        return {experiment_->state()[2] - at[0], experiment_->state()[3] - at[1],
                largest(*experiment_, 0, 2, -1) - 0.5};
    }
    Eigen::Matrix3d derivative(const Eigen::Vector3d& at) {
        Eigen::Matrix3d result;
        const double h = 1e-5;
        for (int j = 0; j < 3; ++j)
            result.col(j) =
                ((*this)(at + h * Eigen::Vector3d::Unit(j)) - (*this)(at - h * Eigen::Vector3d::Unit(j))) / (2 * h);
        return result;
    }
    /// Finds the periodic motion at the voltage of `at` by Newton's method.
    Eigen::Vector3d periodic(Eigen::Vector3d at) {
        for (int i = 0; i < 30; ++i) {
            const Eigen::Vector2d change =
                derivative(at).topLeftCorner<2, 2>().fullPivLu().solve(-(*this)(at).head<2>());
            at.head<2>() += change;
            if (change.norm() < 1e-12)
                return at;
        }
        ADD_FAILURE() << "no periodic motion found at " << at[2];
        return at;
    }
    /// Follows the branch of periodic motions from rest up to a voltage.
    Eigen::Vector3d branch(double voltage) {
        Eigen::Vector3d at(0, 0, 0.1);
        for (double v = 0.1; v < voltage; v += std::min(0.02, 0.3 * (0.589 - v))) {
            at[2] = v;
            at = periodic(at);
        }
        at[2] = voltage;
        return periodic(at);
    }

private:
    Model model_;
    std::unique_ptr<Experiment> experiment_;
    double voltage_ = 0;
};

TEST(ImpactMicroactuator, FlipsOfTheMotionWithoutImpactsAreThePublishedOnes) {
    StickingFrame frame;
    for (const double voltage : {0.316674036113019, 0.451075045332847}) {
        const Eigen::Vector3d at = frame.branch(voltage);
        EXPECT_LT(frame(at)[2], 0);
        const Eigen::Matrix2d map = frame.derivative(at).topLeftCorner<2, 2>() + Eigen::Matrix2d::Identity();
        EXPECT_NEAR(1 + map.trace() + map.determinant(), 0, 1e-9) << voltage; // this is zero for a multiplier -1
        // Only damping contracts areas: by exp(-c (1/m2) period).
        EXPECT_NEAR(map.determinant(), std::exp(-0.04 * pi / 0.9189), 1e-9);
    }
}

TEST(ImpactMicroactuator, GrazingOfTheMotionWithoutImpactsIsThePublishedOne) {
    StickingFrame frame;
    Eigen::Vector3d at = frame.branch(0.58762);
    for (int i = 0; i < 20; ++i) {
        const Eigen::Vector3d change = frame.derivative(at).fullPivLu().solve(-frame(at));
        at += change;
        if (change.norm() < 1e-12)
            break;
    }
    EXPECT_NEAR(at[2], 0.5876212422746997, 1e-8 * 0.59);
    // The grazing is beyond a fold, where the map has a multiplier above 1: the grazing motion is unstable.
    const Eigen::Matrix2d map = frame.derivative(at).topLeftCorner<2, 2>() + Eigen::Matrix2d::Identity();
    EXPECT_LT(1 - map.trace() + map.determinant(), 0);
    EXPECT_LT(at[2], 0.587638103140046);
}

TEST(ImpactMicroactuator, DisturbancesDecayBelowAndAlternateAboveTheFlip) {
    const double period = pi / 0.9189;
    StickingFrame frame;
    for (const double voltage : {0.31, 0.34}) {
        const Model model = shipped_with("impact-microactuator", {{"V", voltage}});
        Experiment experiment(model, with_tolerance(1e-15), {section_probe(model, "phase0")});
        const Eigen::Vector3d orbit = frame.branch(voltage);
        experiment.run_from({0, 0, orbit[0] + 1e-8, orbit[1], 0}, model.find_mode("stick").value(), 200.5 * period);
        const auto& passages = experiment.recorder.passages();
        ASSERT_EQ(passages.size(), 200u);
        const double last = passages[199].state[2] - orbit[0], before = passages[198].state[2] - orbit[0];
        if (voltage < 0.3166) {
            EXPECT_LT(std::abs(last), 1e-9);
        } else {
            const Eigen::Matrix2d map = frame.derivative(orbit).topLeftCorner<2, 2>() + Eigen::Matrix2d::Identity();
            const double half = map.trace() / 2;
            EXPECT_GT(std::abs(last), 1e-5);
            EXPECT_NEAR(last / before, half - std::sqrt(half * half - map.determinant()), 1e-3);
        }
    }
}

TEST(ImpactMicroactuator, StableMotionHasOneImpactAndOneSlip) {
    const double period = pi / 0.9189;
    Model model = shipped_with("impact-microactuator", {{"V", 0.865}});
    Experiment experiment(model, with_tolerance(1e-14), {section_probe(model, "phase0")});
    experiment.run(3000 * period);
    ASSERT_EQ(experiment.trajectory.outcome().ending, Ending::end_time);
    std::vector<std::string> labels;
    std::vector<double> times;
    for (std::size_t i = 0; i < experiment.recorder.contacts().size(); ++i)
        if (experiment.recorder.contacts()[i].contact.time > 2990 * period && experiment.label(i) != "J5") {
            labels.push_back(experiment.label(i));
            times.push_back(experiment.recorder.contacts()[i].contact.time);
        }
    ASSERT_GE(labels.size(), 18u);
    for (std::size_t i = 0; i + 2 < labels.size(); ++i) {
        EXPECT_EQ(labels[i] == "J1" ? labels[i + 1] : labels[i], labels[i] == "J1" ? "J8" : labels[i + 2]);
        EXPECT_NEAR(times[i + 2] - times[i], period, 1e-9);
    }
}

TEST(ImpactMicroactuator, ImpactsKeepMomentumAndLoseEnergy) {
    const double m1 = 5, m2 = 1, e = 0.8, reduced = m1 * m2 / (m1 + m2);
    for (const double voltage : {0.6, 0.8, 0.9, 1.0}) {
        Experiment experiment(shipped_with("impact-microactuator", {{"V", voltage}}), with_tolerance(1e-13));
        experiment.run(500);
        ASSERT_EQ(experiment.trajectory.outcome().ending, Ending::end_time) << voltage;
        const Model& model = experiment.simulation.model();
        const std::size_t impact = model.find_jump("impact").value();
        int impacts = 0;
        for (const auto& [contact, before, after] : experiment.recorder.contacts()) {
            if (contact.kind != ContactKind::crossing || model.transitions[contact.transition].jump != impact)
                continue;
            ++impacts;
            const auto momentum = [&](const std::vector<double>& x) { return (m1 + m2) * x[1] + m2 * x[3]; };
            const auto energy = [&](const std::vector<double>& x) {
                return m1 * x[1] * x[1] / 2 + m2 * (x[1] + x[3]) * (x[1] + x[3]) / 2;
            };
            const double size = (m1 + m2) * std::abs(before[1]) + m2 * std::abs(before[3]);
            EXPECT_NEAR(momentum(after), momentum(before), 8 * epsilon * size);
            EXPECT_NEAR(energy(before) - energy(after), (1 - e * e) / 2 * reduced * before[3] * before[3],
                        16 * epsilon * (energy(before) + energy(after)));
            EXPECT_EQ(after[0], before[0]);
            EXPECT_EQ(after[2], before[2]);
        }
        EXPECT_GT(impacts, 50) << voltage;
    }
}

/// The microactuator with an additional state: the work done on frame, impactor and spring, except by impacts.
Model with_work(double voltage) {
    Model model = shipped_with("impact-microactuator", {{"V", voltage}});
    const auto s = [&](const char* name) { return model.symbol(name); };
    const Expression attraction = s("alpha") * pow(s("V"), 2.0) * pow(sin(s("x5")), 2.0) / pow(s("d") - s("x3"), 2.0);
    // The force acts between frame and impactor: its power involves their relative velocity; friction, that of the
    // frame.
    const Expression inner = (attraction - s("c") * s("x4")) * s("x4");
    const Expression friction = s("mu_d") * s("N") * s("x2");
    State work;
    work.name = "work";
    work.initial = model.graph->number(0);
    model.states.push_back(work);
    for (Mode& mode : model.modes) {
        const bool slips = mode.name.find("plus") != std::string::npos;
        const bool back = mode.name.find("minus") != std::string::npos;
        mode.rates.push_back(slips ? inner - friction : back ? inner + friction : inner);
    }
    for (Jump& jump : model.jumps)
        jump.map.push_back(model.symbol("work"));
    for (Symmetry& symmetry : model.symmetries)
        symmetry.map.push_back(model.symbol("work"));
    return model;
}

TEST(ImpactMicroactuator, EnergyIsBalanced) {
    for (const double voltage : {0.6, 0.8, 1.0}) {
        Experiment experiment(with_work(voltage), with_tolerance(1e-14));
        experiment.run(1000);
        ASSERT_EQ(experiment.trajectory.outcome().ending, Ending::end_time) << voltage;
        const auto energy = [](const std::vector<double>& x) {
            return 2.5 * x[1] * x[1] + (x[1] + x[3]) * (x[1] + x[3]) / 2 + x[2] * x[2] / 2;
        };
        // From contact to contact the gain of energy is the work done. During contact the impactor moves with the
        // frame, so only friction does work.
        double energy_then = energy(experiment.simulation.model().initial_state()), work_then = 0, worst = 0;
        std::set<std::string> modes;
        for (const auto& [contact, before, after] : experiment.recorder.contacts()) {
            worst = std::max(worst, std::abs(energy(before) - energy_then - (before[5] - work_then)));
            energy_then = energy(after);
            work_then = after[5];
            modes.insert(experiment.simulation.model().modes[contact.mode_before].name);
        }
        EXPECT_LT(worst, 1e-10) << voltage;
        EXPECT_TRUE(modes.contains("slip_plus") && modes.contains("stick"));
        EXPECT_GT(std::abs(work_then), 0.1);
    }
}

// ---- chapter 3

constexpr double beam_period = 2 * pi / 28;
constexpr double midspan_shape = 1.5881462620646052;

MicrobeamOptions beam(double voltage, double stiffness, int modes = 1) {
    return {.modes = modes, .stop_stiffness = stiffness, .voltage = voltage};
}

TEST(Microbeam, GrazingVoltageIsThePublishedOne) {
    for (const double offset : {-1e-10, -1e-12, 1e-12, 1e-10}) {
        const Model full = microbeam(beam(0.030040810557599 + offset, 100));
        const Model free = without_event(full, "touch");
        Experiment settled(free, with_tolerance(1e-15), {extremum(free, "q1", Direction::rising)});
        settled.run(150 * beam_period);
        double least = 1;
        for (const auto& record : settled.recorder.passages())
            if (record.passage.time > 145 * beam_period)
                least = std::min(least, midspan_shape * record.state[0]);
        EXPECT_EQ(least > -0.004, offset < 0) << offset << ' ' << least + 0.004;
        Experiment watched(full, with_tolerance(1e-15));
        watched.run_from(settled.state(), settled.trajectory.mode(), 20 * beam_period);
        EXPECT_EQ(contacts_at(watched, "touch") == 0, offset < 0) << offset;
    }
}

TEST(Microbeam, LowPenetrationBranchEndsAtThePublishedVoltage) {
    // From grazing upwards in small steps, each starting from the end of the last one.
    const double grazing = 0.030040810557599;
    const Model free = without_event(microbeam(beam(grazing, 100)), "touch");
    Experiment settled(free, with_tolerance(1e-12));
    settled.run(200.1 * beam_period);
    std::vector<double> state = settled.state();
    std::size_t mode = settled.trajectory.mode();
    const auto penetration_at = [&](double voltage, int periods) {
        const Model model = microbeam(beam(voltage, 100));
        Experiment experiment(model, with_tolerance(1e-11), {extremum(model, "q1", Direction::rising)});
        experiment.run_from(state, mode, periods * beam_period);
        state = experiment.state();
        mode = experiment.trajectory.mode();
        double least = 1;
        for (const auto& record : experiment.recorder.passages())
            if (record.passage.time > (periods - 5) * beam_period)
                least = std::min(least, record.state[0]);
        return -0.004 - midspan_shape * least;
    };
    for (double step = 1e-8; step < 1e-4; step *= 1.5)
        EXPECT_LT(penetration_at(grazing + step, 60), 1e-4);
    for (double voltage = grazing + 1e-4; voltage < 0.0328; voltage += 1e-4)
        EXPECT_LT(penetration_at(voltage, 60), 0.0033);
    EXPECT_NEAR(penetration_at(0.03282, 2000), 0.0033347, 1e-6);
    EXPECT_LT(penetration_at(0.03282565, 4000), 0.0036);
    EXPECT_GT(penetration_at(0.03282566, 6000), 0.016);
}

TEST(Microbeam, HigherModesInContactWithAStiffStopHaveThePublishedSizes) {
    std::map<int, double> first_amplitude;
    for (const int modes : {1, 9}) {
        const Model model = microbeam(beam(0.03, 5000, modes));
        std::vector<Probe> probes;
        std::vector<std::size_t> states;
        for (const int i : {1, 3, 5, 7, 9}) {
            if (i > modes)
                break;
            probes.push_back(extremum(model, fmt::format("q{}", i), Direction::both));
            states.push_back(model.find_state(probes.back().name).value());
        }
        Experiment experiment(model, with_tolerance(1e-9), probes);
        std::vector<double> start = model.initial_state();
        start[states[0]] = 0.006;
        experiment.run_from(start, model.initial_mode, 120 * beam_period);
        ASSERT_EQ(experiment.trajectory.outcome().ending, Ending::end_time);
        std::vector<double> most(probes.size());
        for (const auto& record : experiment.recorder.passages())
            if (record.passage.time > 110 * beam_period) {
                const std::size_t probe = record.passage.probe;
                most[probe] = std::max(most[probe], std::abs(record.state[states[probe]]));
            }
        first_amplitude[modes] = most[0];
        if (modes == 9) {
            EXPECT_NEAR(100 * most[1] / most[0], 11.21, 0.005);
            EXPECT_NEAR(100 * most[2] / most[0], 2.28, 0.005);
            EXPECT_NEAR(100 * most[3] / most[0], 0.525, 0.0005);
            EXPECT_NEAR(100 * most[4] / most[0], 0.182, 0.0005);
        }
    }
    EXPECT_NEAR(first_amplitude[1] / first_amplitude[9], 1, 0.05);
}

} // namespace graze::published_values_test
