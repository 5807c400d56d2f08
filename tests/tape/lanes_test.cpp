// Ensemble lanes against single trajectories, and instruction sets against each other.

#include "graze/tape/jet.hpp"

#include "tape/problems.hpp"

#include <gtest/gtest.h>

namespace graze::lanes_test {

using testing::eps;
using testing::Problem;
using testing::spread;

/// Returns the coefficients of states and outputs of one lane, one after another.
std::vector<double> lane(const Jet& jet, const Problem& problem, int lane) {
    std::vector<double> numbers;
    const auto append = [&](const double* series) {
        for (int k = 0; k <= jet.order(); ++k)
            numbers.push_back(series[k * jet.width() + lane]);
    };
    for (std::size_t i = 0; i < problem.states.size(); ++i)
        append(jet.state(i));
    for (std::size_t i = 0; i < problem.outputs.size(); ++i)
        append(jet.output(i));
    return numbers;
}

std::vector<double> series_of(const Problem& problem, int order, InstructionSet set, const std::vector<double>& states,
                              const std::vector<double>& parameters) {
    const Tape tape = problem.tape();
    const auto jet = make_jet(tape, order, LaneKind::single, set);
    jet->set_parameters(parameters);
    jet->compute(states);
    return lane(*jet, problem, 0);
}

TEST(Lanes, EnsembleEqualsSingleBitForBit) {
    const Problem p = testing::everything();
    const Tape tape = p.tape();
    for (const auto set : testing::supported_sets())
        for (int order = 1; order <= highest_order; ++order) {
            const auto jet = make_jet(tape, order, LaneKind::ensemble, set);
            ASSERT_EQ(jet->width(), lanes_of(LaneKind::ensemble, set));
            const auto parameter = [&](std::size_t i, int l) { return p.parameter_values[i] + 0.003 * l; };
            const auto state = [&](std::size_t i, int l) { return p.state_values[i] - 0.002 * l; };
            jet->set_parameters(spread(p.parameter_values, jet->width(), parameter));
            jet->compute(spread(p.state_values, jet->width(), state));
            for (int l = 0; l < jet->width(); ++l)
                ASSERT_EQ(lane(*jet, p, l),
                          series_of(p, order, set,
                                    spread(p.state_values, 1, [&](std::size_t i, int) { return state(i, l); }),
                                    spread(p.parameter_values, 1, [&](std::size_t i, int) { return parameter(i, l); })))
                    << "lane " << l << " order " << order << " " << name_of(set);
        }
}

TEST(Lanes, InstructionSetsAgree) {
    const Problem p = testing::everything();
    constexpr int order = 20;
    const auto reference = series_of(p, order, InstructionSet::baseline, p.state_values, p.parameter_values);
    const auto size = testing::sizes_of(reference, order);
    for (const auto set : testing::supported_sets()) {
        const auto series = series_of(p, order, set, p.state_values, p.parameter_values);
        for (std::size_t i = 0; i < series.size(); ++i)
            EXPECT_NEAR(series[i], reference[i], 20 * eps * size[i % size.size()]) << i << " " << name_of(set);
    }
}

} // namespace graze::lanes_test
