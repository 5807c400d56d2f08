// Orbits that are homoclinic to a cycle: closed forms, and what is refused.

#include "orbit/cycle_homoclinics.hpp"

#include "base/message_of.hpp"
#include "graze/base/input_error.hpp"
#include "orbit/saddle_cycles.hpp"

#include "orbit/newton.hpp"
#include "orbit/shooting.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::cycle_homoclinics_test {

using namespace graze::testing;

/// The phase at which an orbit passes the gate, between -pi and pi, and its state there.
struct Gate {
    double phase = 0, x = 0, y = 0;
};
Gate gate_of(const Model& model, const Orbit& orbit) {
    double time = 0;
    for (std::size_t k = 0; k < orbit.segments(); ++k) {
        time += orbit.durations[k];
        if (orbit.signature[k].end == SegmentEnd::event) {
            const std::vector<double>& after = orbit.starts[k + 1];
            const double y = orbit.starts[k][model.find_state("y").value()] * std::exp(-0.3 * orbit.durations[k]);
            return {std::remainder(time, 2 * std::numbers::pi), after[0], y};
        }
    }
    return {};
}

TEST(CycleHomoclinics, PassTheGateWhereTheClosedFormSays) {
    const Model model = gated_saddle(0.2);
    const std::vector<OrbitSolution> found = homoclinic_orbits(System(model), origin_of(model));
    ASSERT_EQ(found.size(), 2U);
    std::vector<double> phases;
    for (const OrbitSolution& one : found) {
        EXPECT_TRUE(one.certificate.admissible) << one.certificate.reason;
        EXPECT_EQ(one.orbit.cycle, 1U);
        const Gate gate = gate_of(model, one.orbit);
        EXPECT_NEAR(gate.x, 0, 1e-13);
        EXPECT_NEAR(gate.y, 0, 1e-13);
        phases.push_back(gate.phase);
        ASSERT_EQ(one.multipliers.size(), 2U); // of the cycle
        EXPECT_NEAR(one.multipliers[0].real(), std::exp(0.4 * std::numbers::pi), 1e-11);
        EXPECT_NEAR(one.multipliers[1].real(), std::exp(-0.6 * std::numbers::pi), 1e-11);
        EXPECT_FALSE(is_stable(one));
    }
    std::ranges::sort(phases);
    EXPECT_NEAR(phases[0], -std::acos(-0.4), 1e-12);
    EXPECT_NEAR(phases[1], std::acos(-0.4), 1e-12);
}

TEST(CycleHomoclinics, LiveOnBothSidesWhereTheMultiplierIsNegative) {
    const Model model = henon_map(1.4, 0.3);
    const HenonSaddle saddle(1.4, 0.3);
    const std::vector<OrbitSolution> found = homoclinic_orbits(System(model), saddle_of_henon(model, 1.4, 0.3));
    ASSERT_GE(found.size(), 2U);
    for (const OrbitSolution& one : found) {
        EXPECT_NEAR(one.multipliers[0].real(), saddle.unstable, 1e-12);
        // Each start is the image of the one before.
        for (std::size_t k = 0; k + 1 < one.orbit.segments(); ++k) {
            const std::vector<double>&here = one.orbit.starts[k], &next = one.orbit.starts[k + 1];
            EXPECT_NEAR(next[0], 1 - 1.4 * here[0] * here[0] + here[1], 1e-13);
            EXPECT_NEAR(next[1], 0.3 * here[0], 1e-13);
        }
        const auto off = [&](const std::vector<double>& at) { return std::hypot(at[0] - saddle.x, at[1] - saddle.y); };
        EXPECT_LT(off(one.orbit.starts.front()), 1e-2); // decay is three times growth: wanted_distances
        EXPECT_LT(off(one.orbit.starts.back()), 1e-3);
        EXPECT_GT(off(one.orbit.starts[one.orbit.segments() / 2]), 0.1);
    }
}

/// The orbits have the same phases at the gate however near the cycle they begin: the turns are those that are needed.
TEST(CycleHomoclinics, BeginAndEndAtSuitableDistances) {
    const Model model = gated_saddle(0.2);
    const Simulation simulation(System(model), {}, {}, integration(1e-13));
    for (const OrbitSolution& one : homoclinic_orbits(System(model), origin_of(model))) {
        Shooting equations(simulation, one.orbit, {});
        OrbitEvaluation at = equations.evaluation();
        ASSERT_TRUE(equations.evaluate(equations.unknowns_of(one.orbit), at));
        EXPECT_FALSE(turns_need_renewal(*equations.cycle_ends(), one.orbit, at.pieces.back().after));
    }
}

TEST(CycleHomoclinics, RefuseWhatIsNoSaddleWithOneUnstableDirection) {
    const auto message = [](const Model& model, const Orbit& orbit) {
        return message_of([&] { homoclinic_orbits(System(model), orbit); });
    };
    const Model none = gated_saddle(0.7); // beyond the tangency at c = A
    EXPECT_NE(message(none, origin_of(none)).find("no orbit that is homoclinic to the cycle was found"),
              std::string::npos);
    const Model stable = OneMode{.states = "x = 0\ny = 0", .rates = "x = '-x', y = '-y'", .clock = "1"}.model();
    EXPECT_NE(message(stable, origin_of(stable)).find("the cycle is stable"), std::string::npos);
    const Model two =
        OneMode{.states = "x = 0\ny = 0\nz = 0", .rates = "x = 'x', y = '2*y', z = '-z'", .clock = "1"}.model();
    EXPECT_NE(
        message(two, given_orbit(two, "start", {{0, 0, 0, 0}}, {2 * std::numbers::pi})).find("2 unstable directions"),
        std::string::npos);
    const Model source = OneMode{.states = "x = 0", .rates = "x = 'x'", .clock = "1"}.model();
    EXPECT_NE(
        message(source, given_orbit(source, "start", {{0, 0}}, {2 * std::numbers::pi})).find("no stable direction"),
        std::string::npos);
}

} // namespace graze::cycle_homoclinics_test
