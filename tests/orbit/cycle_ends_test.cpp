// The equations at the ends of orbits that are homoclinic to a cycle: derivatives against differences, and turns.

#include "orbit/cycle_ends.hpp"

#include "orbit/cycle_homoclinics.hpp"
#include "orbit/newton.hpp"
#include "orbit/saddle_cycles.hpp"
#include "orbit/shooting.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace graze::cycle_ends_test {

using namespace graze::testing;

constexpr double a = 1.4, b = 0.3;

/// An orbit of three turns beside the saddle of Henon's map, which only has to lead to it.
Orbit beside_saddle(const Model& model) {
    Orbit orbit = saddle_of_henon(model, a, b);
    const std::vector<double> start = orbit.starts[0];
    orbit.starts.assign(3, start);
    orbit.durations.assign(3, 1.0);
    orbit.signature.assign(3, orbit.signature[0]);
    orbit.cycle = 1;
    return orbit;
}

TEST(CycleEnds, EquationsAgreeWithDifferences) {
    const Model model = henon_map(a, b);
    const std::vector<ParameterId> free{model.independent_parameter("a"), model.independent_parameter("b")};
    CycleEnds ends(Simulation(System(model), {}, {}, integration(1e-13)), beside_saddle(model), free);
    ends.set_scales(Eigen::Vector3d(1, 0.4, 2));
    const HenonSaddle saddle(a, b);
    // The spaces turn with the parameters, which counts in proportion to the distances.
    constexpr double distance = 1e-7, step = 1e-5;
    const std::vector<double> values{a, b}, begin{saddle.x + distance, saddle.y - distance, 0},
        end{saddle.x - distance, saddle.y, 0};
    const Eigen::MatrixXd no_periods = Eigen::MatrixXd::Zero(3, 2);
    ASSERT_TRUE(ends.set_parameters(values)) << ends.problem();
    const CycleEnds::Equations here = ends.equations(begin, end, no_periods);
    for (std::size_t i = 0; i < 8; ++i) {
        const auto at = [&](double change) {
            std::vector<double> parameters = values, first = begin, last = end;
            (i < 3 ? first[i] : i < 6 ? last[i - 3] : parameters[i - 6]) += change;
            EXPECT_TRUE(ends.set_parameters(parameters));
            return ends.equations(first, last, no_periods).values;
        };
        const Eigen::VectorXd difference = (at(step) - at(-step)) / (2 * step);
        const auto place = static_cast<Eigen::Index>(i);
        const Eigen::VectorXd exact = i < 3   ? here.by_begin.col(place)
                                      : i < 6 ? here.by_end.col(place - 3)
                                              : here.by_parameters.col(place - 6);
        EXPECT_LT((difference - exact).norm(), 1e-6) << i;
    }
}

TEST(CycleEnds, VanishInTheSpaces) {
    const Model model = henon_map(a, b);
    CycleEnds ends(Simulation(System(model), {}, {}, integration(1e-13)), beside_saddle(model), {});
    ends.set_scales(Eigen::Vector3d(1, 0.4, 2));
    const HenonSaddle saddle(a, b);
    const std::vector<double> begin{saddle.x + 1e-3 * saddle.unstable, saddle.y + 1e-3 * b, 0},
        end{saddle.x + 1e-3 * saddle.stable, saddle.y + 1e-3 * b, 0};
    EXPECT_LT(ends.equations(begin, end, Eigen::MatrixXd::Zero(3, 0)).values.norm(), 1e-15);
    EXPECT_GT(ends.equations(end, begin, Eigen::MatrixXd::Zero(3, 0)).values.norm(), 1e-4);
}

/// With more turns or fewer the same orbit is found, and turns that are superfluous are left out again.
TEST(CycleEnds, TurnsAreAddedAndLeftOut) {
    const Model model = gated_saddle(0.2);
    const Simulation simulation(System(model), {}, {}, integration(1e-13));
    const Orbit orbit = homoclinic_orbits(System(model), origin_of(model)).front().orbit;
    const auto changed = [&](const Orbit& from) {
        Shooting equations(simulation, from, {});
        OrbitEvaluation at = equations.evaluation();
        EXPECT_TRUE(equations.evaluate(equations.unknowns_of(from), at)) << at.problem;
        return with_suitable_turns(*equations.cycle_ends(), from, at.pieces.back().after);
    };
    Orbit shorter = orbit;
    constexpr std::size_t fewer = 3;
    for (auto erase =
             [](auto& list) { list.erase(list.begin(), list.begin() + fewer), list.resize(list.size() - fewer); };
         shorter.segments() == orbit.segments();)
        erase(shorter.signature), erase(shorter.starts), erase(shorter.durations);
    const TurnsChanged longer = changed(shorter);
    EXPECT_EQ(longer.before, 3);
    EXPECT_GE(longer.after, 2);
    const OrbitSolution again = solve_orbit(System(model), longer.orbit);
    ASSERT_EQ(again.outcome, OrbitOutcome::converged) << again.detail;
    for (std::size_t k = 0; k < shorter.segments(); ++k)
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(again.orbit.starts[k + 3][i], shorter.starts[k][i], 1e-12);
    const OrbitDirection direction = longer.of({shorter.starts, shorter.durations, {1}});
    EXPECT_EQ(direction.starts.size(), longer.orbit.segments());
    EXPECT_EQ(direction.durations.front(), 0);
    EXPECT_EQ(direction.durations[3], shorter.durations.front());
}

} // namespace graze::cycle_ends_test
