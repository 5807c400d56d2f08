#include "graze/branch/monitor.hpp"
#include "graze/branch/orbit_branch.hpp"

#include "follow.hpp"
#include "graze/model/named_value.hpp"

#include <cmath>
#include <numbers>

namespace graze::monitor_test {

using namespace graze::testing;

using std::numbers::pi;

/// The orbit of the linear oscillator is a cosine of amplitude F / |H|.
double amplitude(double zeta, double omega, double force) {
    return force / std::hypot(1 - omega * omega, 2 * zeta * omega);
}

Monitor monitor(const std::string& name, Monitor::Kind kind, const Model& model, const std::string& expression,
                const std::string& segment = "") {
    Monitor result;
    result.name = name;
    result.kind = kind;
    if (!expression.empty())
        result.expression = named_value(model, expression, {}).value;
    result.segment = segment;
    return result;
}

TEST(OrbitMonitors, ValuesForACosineAreExact) {
    const Model model = linear_oscillator();
    const OrbitSolution solution = settled(model, "start");
    OrbitMonitors monitors(
        System(model), solution.orbit.signature,
        {monitor("period", Monitor::Kind::duration, model, ""), monitor("greatest", Monitor::Kind::maximum, model, "x"),
         monitor("least", Monitor::Kind::minimum, model, "v + 1"), monitor("mean", Monitor::Kind::mean, model, "x + 3"),
         monitor("norm", Monitor::Kind::norm, model, "x"), monitor("start", Monitor::Kind::start, model, "x"),
         monitor("end", Monitor::Kind::value, model, "x*omega", "start"),
         monitor("by number", Monitor::Kind::maximum, model, "F*x", "1")});
    const std::vector<double> values = monitors(solution.orbit);
    const double a = amplitude(0.1, 1.7, 0.8), tolerance = 1e-13;
    EXPECT_NEAR(values[0], 2 * pi / 1.7, tolerance);
    EXPECT_NEAR(values[1], a, tolerance);
    EXPECT_NEAR(values[2], 1 - 1.7 * a, tolerance);
    EXPECT_NEAR(values[3], 3, tolerance);
    EXPECT_NEAR(values[4], a / std::sqrt(2.0), tolerance);
    EXPECT_NEAR(values[6], 1.7 * values[5], tolerance);
    EXPECT_NEAR(values[7], 0.8 * a, tolerance);
}

TEST(OrbitMonitors, BothHalvesOfASymmetricOrbitCount) {
    const Model model = load_model("dry-friction-oscillator");
    const OrbitSolution half = settled(model, "phase0");
    ASSERT_TRUE(half.orbit.symmetry);
    const std::vector<Monitor> wanted{
        monitor("greatest", Monitor::Kind::maximum, model, "x"), monitor("least", Monitor::Kind::minimum, model, "x"),
        monitor("mean", Monitor::Kind::mean, model, "x"), monitor("period", Monitor::Kind::duration, model, "")};
    const std::vector<double> values = OrbitMonitors(System(model), half.orbit.signature, wanted)(half.orbit);
    EXPECT_NEAR(values[0], -values[1], 1e-12);
    EXPECT_NEAR(values[2], 0, 1e-12);
    EXPECT_NEAR(values[3], 2 * pi / 0.4, 1e-12);
    const Orbit whole = whole_orbit(System(model), half.orbit);
    const std::vector<double> again = OrbitMonitors(System(model), whole.signature, wanted)(whole);
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(values[i], again[i], 1e-12);
}

TEST(OrbitMonitors, UnknownSegmentsAreRefusedWithTheSignature) {
    const Model model = linear_oscillator();
    const OrbitSolution solution = settled(model, "start");
    for (const char* const wrong : {"2", "0", "impact", "start#2", "start#"})
        EXPECT_THROW(OrbitMonitors(System(model), solution.orbit.signature,
                                   {monitor("m", Monitor::Kind::value, model, "x", wrong)}),
                     InputError)
            << wrong;
}

TEST(MonitorsOfBranches, AreReportedAndBoundTheBranch) {
    const Model model = linear_oscillator();
    const OrbitSolution solution = settled(model, "start");
    BranchSettings settings = in_parameter(model, "F");
    settings.monitors = {monitor("amplitude", Monitor::Kind::maximum, model, "x")};
    const double unit = amplitude(0.1, 1.7, 1);
    settings.monitors[0].crossings = {0.5, 0.75};
    settings.monitors[0].greatest = 1.25;
    const Branch branch = follow_branch(System(model), solution.orbit, settings);
    ASSERT_EQ(branch.outcome, BranchOutcome::bound) << branch.detail;
    const auto crossings = of_type(branch, PointType::crossing);
    ASSERT_EQ(crossings.size(), 2u);
    EXPECT_NEAR(crossings[0].parameter, 0.5 / unit, 1e-10);
    EXPECT_NEAR(crossings[1].parameter, 0.75 / unit, 1e-10);
    EXPECT_NEAR(branch.special.back().parameter, 1.25 / unit, 1e-10);
    EXPECT_EQ(branch.special.size(), 3u);
}

/// Checks that with a fixed amplitude force and frequency follow the resonance curve F = a |H(omega)|.
void expect_resonance_curve(const Model& model, const Monitor& held, double value) {
    const OrbitSolution solution = settled(model, "start");
    BranchSettings settings = in_parameter(model, "omega");
    settings.free = {model.independent_parameter("F")};
    settings.direction = -1;
    settings.least = 0.4;
    settings.monitors = {held};
    settings.monitors[0].fixed = true;
    settings.monitors[0].held = value;
    const Branch branch = follow_branch(System(model), solution.orbit, settings);
    ASSERT_EQ(branch.outcome, BranchOutcome::bound) << branch.detail;
    EXPECT_NEAR(branch.points.back().parameter, 0.4, 1e-12);
    for (const BranchPoint& point : branch.points) {
        EXPECT_NEAR(point.monitors[0], value, 1e-10);
        const double omega = point.parameter, force = point.solution.orbit.parameters[settings.free[0].place()];
        const double size = held.kind == Monitor::Kind::norm ? value * std::sqrt(2.0) : value;
        EXPECT_NEAR(amplitude(0.1, omega, force), size, 1e-9 * size);
        EXPECT_TRUE(point.stable);
    }
    EXPECT_EQ(branch.special.size(), 1u); // the bound only: an extremum of the force is not a fold
}

TEST(MonitorsOfBranches, FixedMonitorsFreeAParameter) {
    const Model model = linear_oscillator();
    expect_resonance_curve(model, monitor("amplitude", Monitor::Kind::maximum, model, "x"), 0.3);
    expect_resonance_curve(model, monitor("norm", Monitor::Kind::norm, model, "x"), 0.2);
}

/// Settings with the amplitude fixed at 0.3, along the frequency from 1.7 down: the force is 0.3 / |H|, least near
/// resonance.
BranchSettings along_resonance(const Model& model) {
    BranchSettings settings = in_parameter(model, "omega");
    settings.free = {model.independent_parameter("F")};
    settings.direction = -1;
    settings.least = 0.4;
    settings.monitors = {monitor("amplitude", Monitor::Kind::maximum, model, "x")};
    settings.monitors[0].fixed = true;
    settings.monitors[0].held = 0.3;
    return settings;
}

TEST(MonitorsOfBranches, FreeParametersMayHaveBounds) {
    const Model model = linear_oscillator();
    const Orbit start = settled(model, "start").orbit;
    BranchSettings settings = along_resonance(model);
    const ParameterId force = settings.free[0];
    const double bound = 0.3 / amplitude(0.1, 1.2, 1); // above resonance, on the way down
    settings.free_bounds = {{force, bound, 5.0}};
    const Branch branch = follow_branch(System(model), start, settings);
    ASSERT_EQ(branch.outcome, BranchOutcome::bound) << branch.detail;
    EXPECT_EQ(names(branch), "BD");
    EXPECT_NEAR(branch.points.back().parameter, 1.2, 1e-9);
    const SpecialPoint& end = branch.special.back();
    EXPECT_EQ(end.solution.orbit.parameters[force.place()], bound);
    EXPECT_EQ(end.detail.rfind("F = ", 0), 0u) << end.detail;
    // In the other direction the force rises beyond its bound, and no branch begins.
    settings.direction = 1;
    settings.greatest = 1.5;
    const Branch back = follow_branch(System(model), end.solution.orbit, settings);
    EXPECT_EQ(back.outcome, BranchOutcome::bound);
    EXPECT_EQ(back.points.back().parameter, 1.5);
    settings.free_bounds = {{force, {}, 0.9 * bound}};
    const Branch outside = follow_branch(System(model), end.solution.orbit, settings);
    EXPECT_EQ(outside.outcome, BranchOutcome::bound);
    EXPECT_EQ(outside.points.size(), 0u);
    EXPECT_NE(outside.detail.find("lies beyond its bound"), std::string::npos) << outside.detail;
}

TEST(MonitorsOfBranches, BoundsOfParametersThatAreNotFreeAreRefused) {
    const Model model = linear_oscillator();
    const Orbit start = settled(model, "start").orbit;
    const std::vector<FreeBounds> wrong{{model.independent_parameter("omega"), 0.1, 1.0},
                                        {model.independent_parameter("F"), 1.0, 0.5},
                                        {model.independent_parameter("F"), NAN, {}},
                                        {ParameterId(99), 0.1, 1.0}};
    for (const FreeBounds& bounds : wrong) {
        BranchSettings settings = along_resonance(model);
        settings.free_bounds = {bounds};
        EXPECT_THROW(follow_branch(System(model), start, settings), InputError);
    }
}

TEST(MonitorsOfBranchesSlow, BranchEndsWherePeriodsDiverge) {
    Model model = linear_oscillator();
    model.set_parameter("omega", 0.7);
    // Along the force with the frequency free: towards force = amplitude, where the frequency is zero.
    BranchSettings settings = along_resonance(model);
    std::swap(settings.parameter, settings.free[0]);
    settings.direction = 1;
    settings.monitors[0].held = amplitude(0.1, 0.7, 0.8);
    settings.work = 20'000;
    const Branch branch = follow_branch(System(model), settled(model, "start").orbit, settings);
    ASSERT_EQ(branch.outcome, BranchOutcome::too_long) << branch.detail;
    EXPECT_LT(branch.points.back().solution.orbit.parameters[settings.free[0].place()], 0.01);
    EXPECT_NEAR(branch.points.back().parameter, *settings.monitors[0].held, 1e-3);
}

TEST(MonitorsOfBranches, FixedMonitorsMustMatchTheFreeParameters) {
    const Model model = linear_oscillator();
    const OrbitSolution solution = settled(model, "start");
    BranchSettings settings;
    settings.monitors = {monitor("amplitude", Monitor::Kind::maximum, model, "x")};
    settings.free = {ParameterId(1)};
    EXPECT_THROW(follow_branch(System(model), solution.orbit, settings), InputError);
    settings.monitors[0].fixed = true;
    settings.free = {settings.parameter};
    EXPECT_THROW(follow_branch(System(model), solution.orbit, settings), InputError);
    settings.free = {};
    EXPECT_THROW(follow_branch(System(model), solution.orbit, settings), InputError);
}

} // namespace graze::monitor_test
