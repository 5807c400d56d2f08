// Equilibria of models of the literature against published numbers and closed forms.

#include "follow.hpp"

#include "orbit/all_equilibria.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::published_equilibria_test {

using namespace graze::testing;

Branch branch_of(const Model& model, const std::string& parameter, double least, double greatest, int direction = 1) {
    const OrbitSolution rest = solve_orbit(
        System(model),
        {signature_of_rest(model.initial_mode), model.parameter_values(), {model.initial_state()}, {0.0}, {}});
    EXPECT_EQ(rest.outcome, OrbitOutcome::converged) << rest.detail;
    return follow_branch(System(model), rest.orbit, in_parameter(model, parameter, least, greatest, direction));
}

// C. Hos and A. R. Champneys, Physica D 241 (2012) 2068: a relief valve oscillates below a flow of 8.49, and its cycles
// touch the seat at 7.54.
TEST(PublishedEquilibria, ReliefValveOscillatesAndTouchesItsSeat) {
    const Model model = OneMode{.parameters = "q = 10\nkappa = 1.25\nbeta = 20\ndelta = 10",
                                .states = "x = 3\nv = 0\np = 13",
                                .rates = "x = 'v', v = '-kappa*v - (x + delta) + p', p = 'beta*(q - x*sqrt(p))'",
                                .stops = {{"seat", "x", "v = '-0.8*v'", "I"}},
                                .more = section("top", "v", "falling")}
                            .model();
    const Branch branch = branch_of(model, "q", 0.5, 12, -1);
    ASSERT_EQ(names(branch), "HB BD") << branch.detail;
    const SpecialPoint& hopf = branch.special[0];
    // Routh and Hurwitz: (kappa + a)(1 + kappa a) = a + b, a = beta x/(2 sqrt(p)), b = beta sqrt(p), p = x + delta.
    const double x = hopf.solution.orbit.starts[0][0], p = hopf.solution.orbit.starts[0][2];
    const double a = 10 * x / std::sqrt(p), b = 20 * std::sqrt(p);
    EXPECT_NEAR((1.25 + a) * (1 + 1.25 * a) / (a + b), 1, 1e-12);
    EXPECT_NEAR(hopf.parameter, 8.49, 0.005);
    EXPECT_NEAR(hopf.parameter, 8.491117635183326, 1e-11);
    const BranchSettings settings = in_parameter(model, "q", 0.5, 12);
    const Branch cycles = follow(model, branches_at(System(model), hopf, settings).at(0), settings);
    ASSERT_EQ(names(cycles), "GR") << cycles.detail;
    EXPECT_NEAR(cycles.special[0].parameter, 7.54, 0.02);
}

// H. Stommel, Tellus 13 (1961) 224: two vessels with R = 2, lambda = 1/5, delta = 1/6 have a stable node at f = -1.1, a
// saddle at -0.30 and a stable spiral at 0.23, read from a graph.
TEST(PublishedEquilibria, StommelsVesselsHaveANodeASaddleAndASpiral) {
    const std::string head = "R = 2\nlambda = 0.2\ndelta = '1/6'";
    const Model model = TwoModes{.parameters = head,
                                 .states = "x = 0.4\ny = 0.7",
                                 .definitions = "f = '(R*x - y)/lambda'",
                                 .first = {"forward", "x = 'delta*(1 - x) - f*x', y = '1 - y - f*y'", "turns", "f"},
                                 .second = {"back", "x = 'delta*(1 - x) + f*x', y = '1 - y + f*y'", "returns", "-f"},
                                 .kind = "barrier"}
                            .model();
    std::vector<OrbitSolution> admissible;
    for (const std::size_t mode : {std::size_t{0}, std::size_t{1}}) {
        const EquilibriumSearch search =
            all_equilibria(System(model), mode, std::vector<StateBounds>{{0, 0, 1}, {1, 0, 1}}, model.initial_state(),
                           model.parameter_values(), {});
        EXPECT_TRUE(search.complete);
        for (const OrbitSolution& one : search.found)
            if (one.certificate.admissible)
                admissible.push_back(one);
    }
    ASSERT_EQ(admissible.size(), 3U);
    const auto flow = [](const OrbitSolution& one) {
        return (2 * one.orbit.starts[0][0] - one.orbit.starts[0][1]) / 0.2;
    };
    std::ranges::sort(admissible, {}, flow);
    for (const OrbitSolution& one : admissible) { // lambda f = R delta/(delta + |f|) - 1/(1 + |f|)
        const double f = flow(one), size = std::abs(f);
        EXPECT_NEAR(0.2 * f, 2.0 / 6 / (1.0 / 6 + size) - 1 / (1 + size), 1e-13);
    }
    EXPECT_NEAR(flow(admissible[0]), -1.1, 0.05);
    EXPECT_NEAR(flow(admissible[1]), -0.30, 0.02);
    EXPECT_NEAR(flow(admissible[2]), 0.23, 0.02);
    EXPECT_TRUE(is_stable(admissible[0]) && admissible[0].eigenvalues[0].imag() == 0);
    EXPECT_EQ(unstable_directions(admissible[1]), 1U);
    EXPECT_TRUE(is_stable(admissible[2]) && admissible[2].eigenvalues[0].imag() != 0);
    // As R falls the spiral and the saddle meet at f = 0, where R = 1: a nonsmooth fold. The branch turns back.
    Model moved = model;
    moved.set_initial("x", admissible[2].orbit.starts[0][0]);
    moved.set_initial("y", admissible[2].orbit.starts[0][1]);
    const Branch branch = branch_of(moved, "R", 0.5, 3, -1);
    const auto meeting = of_type(branch, PointType::boundary_equilibrium);
    ASSERT_EQ(meeting.size(), 1U) << names(branch) << ' ' << branch.detail;
    EXPECT_NEAR(meeting[0].parameter, 1, 1e-12);
    EXPECT_NE(meeting[0].detail.find("fold"), std::string::npos) << meeting[0].detail;
}

// E. M. Izhikevich, Dynamical Systems in Neuroscience, 2007, section 8.2: a regular spiking neuron fires above 51.5 pA.
TEST(PublishedEquilibria, RegularSpikingNeuronHasItsOnset) {
    const Model model = OneMode{.parameters = "I = 0\nC = 100\nk = 0.7\nvr = -60\nvt = -40\na = 0.03\nb = -2",
                                .states = "v = -60\nu = 0",
                                .rates = "v = '(k*(v - vr)*(v - vt) - u + I)/C', u = 'a*(b*(v - vr) - u)'"}
                            .model();
    const Branch branch = branch_of(model, "I", -100, 100);
    const auto folds = of_type(branch, PointType::fold);
    ASSERT_EQ(folds.size(), 1U) << names(branch);
    EXPECT_NEAR(folds[0].parameter, 51.5, 0.1);
    EXPECT_NEAR(folds[0].parameter, 360.0 / 7, 1e-11); // the vertex of a parabola in v
}

} // namespace graze::published_equilibria_test
