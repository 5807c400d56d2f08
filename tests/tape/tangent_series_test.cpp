#include "tape/tangent_series.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/linearisation.hpp"
#include "graze/symbolic/transform.hpp"
#include "tape/problems.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace graze::tangent_series_test {

using testing::eps;
using testing::Problem;
using testing::sizes_of;

/// The first variational equations of a problem, compiled as in a mode.
struct Linear {
    TangentEquations equations;
    Tape tape;
    std::vector<std::uint32_t> groups;

    explicit Linear(const Problem& p) {
        std::vector<Expression> inputs = p.states;
        inputs.insert(inputs.end(), p.parameters.begin(), p.parameters.end());
        const Linearisation linearisation = linearise(p.rates, SymbolIndex(inputs), p.states.size());
        equations = {p.states.size(), p.parameters.size(), linearisation.intermediates, {}};
        std::vector<DeferredExpression> deferred;
        for (const LinearEntry& entry : linearisation.entries) {
            equations.entries.push_back({entry.row, entry.source, deferred.size()});
            const bool by_parameter = entry.source >= p.states.size() && entry.source < inputs.size();
            deferred.push_back({entry.coefficient,
                                by_parameter ? 1 + static_cast<std::uint32_t>(entry.source - p.states.size()) : 0U});
        }
        for (std::uint32_t group = 0; group <= p.parameters.size(); ++group)
            if (std::any_of(deferred.begin(), deferred.end(),
                            [&](const DeferredExpression& f) { return f.group == group; }))
                groups.push_back(group);
        tape = compile_tape(p.states, p.parameters, p.rates, p.outputs, deferred);
    }

    std::unique_ptr<Jet> jet(const Problem& p, int order, InstructionSet set) const {
        auto jet = make_jet(tape, order, LaneKind::single, set);
        jet->set_parameters(p.parameter_values);
        jet->compute(p.state_values);
        jet->compute_deferred(groups);
        return jet;
    }
};

/// Returns the coefficients of `count` states from `first` on, one after another.
std::vector<double> states_of(const Jet& jet, std::size_t first, std::size_t count) {
    std::vector<double> numbers;
    for (std::size_t i = first; i < first + count; ++i)
        numbers.insert(numbers.end(), jet.state(i), jet.state(i) + jet.order() + 1);
    return numbers;
}

/// Returns the coefficients of one direction.
std::vector<double> changes_of(const TangentSeries& series, std::size_t states, std::size_t direction) {
    std::vector<double> numbers;
    for (std::size_t i = 0; i < states; ++i)
        for (std::size_t k = 0; k <= static_cast<std::size_t>(series.order()); ++k)
            numbers.push_back(series.state(i)[k * series.width() + direction]);
    return numbers;
}

/// Initial changes of the states and of the parameters, in several directions.
struct Seeds {
    std::vector<double> states, parameters;
};
Seeds seeds_of(const Problem& p, std::size_t directions) {
    Seeds seeds;
    for (std::size_t i = 0; i < p.states.size() * directions; ++i)
        seeds.states.push_back(std::sin(3.0 * double(i) + 0.5));
    for (std::size_t i = 0; i < p.parameters.size() * directions; ++i)
        seeds.parameters.push_back(std::cos(2.0 * double(i)));
    return seeds;
}

constexpr std::array some_directions = {1, 2, 7, 13, 40};

/// Returns the series of one direction, computed as states of a larger vector field with symbolic derivatives.
std::vector<double> variational(const Problem& p, const Seeds& seeds, std::size_t directions, std::size_t d, int order,
                                InstructionSet set) {
    Problem larger = p;
    larger.outputs.clear();
    for (std::size_t j = 0; j < p.states.size(); ++j)
        larger.state("d" + std::to_string(j), seeds.states[j * directions + d]);
    for (const Expression& rate : p.rates) {
        Expression sum = p.graph->number(0);
        for (std::size_t j = 0; j < p.states.size(); ++j)
            sum = sum + differentiate(rate, p.states[j]) * larger.states[p.states.size() + j];
        for (std::size_t j = 0; j < p.parameters.size(); ++j)
            sum = sum + differentiate(rate, p.parameters[j]) * p.graph->number(seeds.parameters[j * directions + d]);
        larger.rates.push_back(sum);
    }
    const auto jet = make_jet(larger.tape(), order, LaneKind::single, set);
    jet->set_parameters(larger.parameter_values);
    jet->compute(larger.state_values);
    return states_of(*jet, p.states.size(), p.states.size());
}

TEST(TangentSeries, SolveTheVariationalEquations) {
    const Problem p = testing::everything();
    const Linear linear(p);
    const std::vector<char> moving(p.parameters.size(), 1);
    for (const auto set : testing::supported_sets())
        for (const int order : {1, 2, 5, 20})
            for (const std::size_t directions : some_directions) {
                const auto jet = linear.jet(p, order, set);
                TangentSeries series(linear.tape, linear.equations, *jet, moving, directions, set);
                const Seeds seeds = seeds_of(p, directions);
                for (std::size_t first = 0; first < directions; first += series.width()) {
                    const std::size_t count = std::min(series.width(), directions - first);
                    series.load(seeds.states, seeds.parameters, directions, first, count);
                    series.compute(*jet);
                    for (const std::size_t d : {first, first + count - 1}) {
                        const auto exact = variational(p, seeds, directions, d, order, set),
                                   found = changes_of(series, p.states.size(), d - first);
                        const auto size = sizes_of(exact, order);
                        ASSERT_EQ(found.size(), exact.size());
                        // Sums and products have another order, and their round-off propagates from order to order.
                        for (std::size_t i = 0; i < found.size(); ++i)
                            ASSERT_NEAR(found[i], exact[i], 1000 * eps * size[i % size.size()])
                                << "direction " << d << " of " << directions << ", number " << i << ", order " << order
                                << ' ' << name_of(set);
                    }
                }
            }
}

/// A check that is independent of symbolic differentiation.
TEST(TangentSeries, AgreeWithFiniteDifferences) {
    const Problem p = testing::everything();
    const Linear linear(p);
    constexpr int order = 12;
    constexpr double step = 1e-5;
    const std::size_t states = p.states.size(), variables = states + p.parameters.size();
    const std::vector<char> moving(p.parameters.size(), 1);
    for (const auto set : testing::supported_sets()) {
        const auto jet = linear.jet(p, order, set);
        TangentSeries series(linear.tape, linear.equations, *jet, moving, 1, set);
        for (std::size_t variable = 0; variable < variables; ++variable) {
            std::vector<double> seeds(variables, 0.0);
            seeds[variable] = 1;
            series.load(std::span(seeds).first(states), std::span(seeds).subspan(states), 1, 0, 1);
            series.compute(*jet);
            const auto moved = [&](double by) {
                Problem other = p;
                (variable < states ? other.state_values[variable] : other.parameter_values[variable - states]) += by;
                return states_of(*linear.jet(other, order, set), 0, states);
            };
            const auto ahead = moved(step), behind = moved(-step), found = changes_of(series, states, 0);
            const auto size = sizes_of(found, order);
            for (std::size_t i = 0; i < found.size(); ++i)
                EXPECT_NEAR(found[i], (ahead[i] - behind[i]) / (2 * step), 1e-7 * (1 + size[i % size.size()]))
                    << "variable " << variable << " number " << i << ' ' << name_of(set);
        }
    }
}

/// Deferred expressions have kernels for many orders at once: at every order and with every instruction set, they must
/// equal the same expressions as outputs, which are computed order by order.
TEST(TangentSeries, DeferredExpressionsEqualOutputs) {
    constexpr double radius = 2; // less than all radii of convergence
    for (int order = 1; order <= highest_order; ++order) {
        Problem p;
        const Expression x = p.state("x", 0.3), y = p.state("y", 0.2), a = p.parameter("a", 0.7);
        p.rates = {y, -x};
        const std::vector<Expression> wanted{x * y,
                                             pow(x - y, 2),
                                             1 / (2 + x),
                                             a / pow(3 + y, 2),
                                             x / pow(3 + y, 2),
                                             x * y / (2 + x),
                                             y / pow(pow(2 + x, 2), 2),
                                             pow(3 + x * y, -3),
                                             sqrt(4 + x * y) / (2 + x)};
        p.outputs = wanted;
        std::vector<DeferredExpression> deferred;
        for (const Expression& one : wanted)
            deferred.push_back({one, 0});
        const Tape tape = compile_tape(p.states, p.parameters, p.rates, {}, deferred);
        const auto expected = testing::output_series(p, order, InstructionSet::baseline);
        for (const InstructionSet set : testing::supported_sets()) {
            const auto jet = make_jet(tape, order, LaneKind::single, set);
            jet->set_parameters(p.parameter_values);
            jet->compute(p.state_values);
            const std::uint32_t group = 0;
            jet->compute_deferred({&group, 1});
            for (std::size_t i = 0; i < wanted.size(); ++i) {
                double size = 0;
                for (std::size_t k = expected[i].size(); k-- > 0;)
                    size = std::max(size, std::abs(expected[i][k]) * std::pow(radius, static_cast<double>(k)));
                for (std::size_t k = 0; k < expected[i].size(); ++k)
                    ASSERT_NEAR(jet->deferred(i)[k], expected[i][k],
                                100 * eps * size / std::pow(radius, static_cast<double>(k)))
                        << name_of(set) << ", order " << order << ", deferred " << i << ", coefficient " << k;
            }
        }
    }
}

/// The groups that are requested affect neither the states nor each other.
TEST(TangentSeries, DeferredExpressionsDoNotAffectTheMotion) {
    const Problem p = testing::everything();
    const Linear linear(p);
    const Tape plain = p.tape();
    for (const auto set : testing::supported_sets())
        for (int order = 1; order <= highest_order; ++order) {
            const auto alone = make_jet(plain, order, LaneKind::single, set), all = linear.jet(p, order, set);
            alone->set_parameters(p.parameter_values);
            alone->compute(p.state_values);
            ASSERT_EQ(states_of(*alone, 0, p.states.size()), states_of(*all, 0, p.states.size())) << order;
            for (std::size_t i = 0; i < p.outputs.size(); ++i)
                for (int k = 0; k <= order; ++k)
                    ASSERT_EQ(alone->output(i)[k], all->output(i)[k]) << order << name_of(set);
            for (const std::uint32_t group : linear.groups) {
                const auto one = make_jet(linear.tape, order, LaneKind::single, set);
                one->set_parameters(p.parameter_values);
                one->begin(p.state_values);
                one->begin_deferred({&group, 1}); // `compute_deferred` continues from here
                one->compute(p.state_values);
                one->compute_deferred({&group, 1});
                for (const TangentEntry& entry : linear.equations.entries) {
                    const bool by_parameter =
                        entry.source >= p.states.size() && entry.source < p.states.size() + p.parameters.size();
                    if ((by_parameter ? 1 + entry.source - p.states.size() : 0) != group)
                        continue;
                    const bool constant = linear.tape.deferred[entry.deferred].constant;
                    for (int k = 0; k <= (constant ? 0 : order); ++k)
                        ASSERT_EQ(one->deferred(entry.deferred)[k], all->deferred(entry.deferred)[k]);
                }
            }
        }
}

/// `begin` at the end of a step agrees with the slopes of the polynomials there: closed forms of x'' = -x.
TEST(TangentSeries, BeginAgreesWithSlopesAtTheEndOfAStep) {
    Problem p;
    const Expression x = p.state("x", 0.3), y = p.state("y", -0.2);
    p.rates = {y, -x};
    const Linear linear(p);
    constexpr int order = 20;
    constexpr double step = 0.4;
    for (const auto set : testing::supported_sets())
        for (const std::size_t directions : {1, 2}) {
            const auto jet = linear.jet(p, order, set), end = linear.jet(p, order, set);
            TangentSeries here(linear.tape, linear.equations, *jet, {}, directions, set),
                there(linear.tape, linear.equations, *end, {}, directions, set);
            const std::vector<double> unit = directions == 1 ? std::vector{1.0, 0.0} : std::vector{1.0, 0.0, 0.0, 1.0};
            here.load(unit, {}, directions, 0, directions);
            here.compute(*jet);
            const std::size_t width = here.width();
            std::vector<double> sums(2 * width), slopes(2 * width);
            here.evaluate(step, sums, slopes);
            there.load(sums, here);
            there.begin(*end); // the coefficients are constant
            EXPECT_NEAR(sums[0], std::cos(step), 4 * eps);
            EXPECT_NEAR(sums[width], -std::sin(step), 4 * eps);
            EXPECT_NEAR(there.state(0)[width], slopes[0], 4 * eps);
            EXPECT_EQ(here.find_misfit(there, {1e-12, 0, 1e-100}, step, sums, slopes, 0), 2U);
            // The last two terms of the cosine have orders 18 and 20.
            EXPECT_NEAR(here.tails(step, {}) * (1 + step * step / 2) / std::pow(step, 20), 1 / std::tgamma(21.0),
                        1 / std::tgamma(19.0));
            slopes[1 * width] += 1e-6;
            EXPECT_EQ(here.find_misfit(there, {1e-12, 0, 1e-100}, step, sums, slopes, 0), 1U);
        }
}

/// Each square doubles the factor of its derivative: 2^1200 overflows, but the derivative is finite.
TEST(TangentSeries, DeepNestingGivesFiniteDerivatives) {
    Problem p;
    const Expression x = p.state("x", 0.3);
    Expression nested = x;
    for (int k = 0; k < 1200; ++k)
        nested = nested * nested + x * 0.1;
    p.rates = {nested};
    const Linear linear(p);
    for (const auto set : testing::supported_sets()) {
        const auto jet = linear.jet(p, 10, set);
        TangentSeries series(linear.tape, linear.equations, *jet, {}, 1, set);
        series.load(std::vector{1.0}, {}, 1, 0, 1);
        series.compute(*jet);
        // y = y^2 + x / 10, the limit of nesting: y' = 0.1 / (1 - 2 y)
        const double root = std::sqrt(1 - 0.4 * 0.3), slope = 0.1 / root;
        EXPECT_NEAR(jet->state(0)[1], (1 - root) / 2, 10 * eps);
        EXPECT_NEAR(series.state(0)[1], slope, 10 * eps) << name_of(set);
    }
}

TEST(TangentSeries, MisuseThrows) {
    Problem p;
    const Expression x = p.state("x", 0.3), a = p.parameter("a", 2);
    p.rates = {a * x * x};
    const Linear linear(p);
    const auto jet = linear.jet(p, 8, best_instruction_set());
    const std::vector<char> moving = {1}, none = {};
    const auto make = [&](const TangentEquations& equations) {
        TangentSeries series(linear.tape, equations, *jet, moving, 1);
    };
    EXPECT_THROW(TangentSeries(linear.tape, linear.equations, *jet, none, 1), InputError);
    for (const auto spoil : {+[](TangentEntry& e) { e.row = 1; }, +[](TangentEntry& e) { e.source = 2; },
                             +[](TangentEntry& e) { e.deferred = 2; }}) {
        TangentEquations wrong = linear.equations;
        spoil(wrong.entries[0]);
        EXPECT_THROW(make(wrong), InputError);
    }
    TangentSeries series(linear.tape, linear.equations, *jet, moving, 1);
    const std::vector<double> one = {1}, two = {1, 2};
    EXPECT_THROW(series.load(two, one, 1, 0, 1), InputError);
    EXPECT_THROW(series.load(one, two, 1, 0, 1), InputError);
    EXPECT_THROW(series.load(one, one, 1, 0, 2), InputError);
    std::vector<double> values(1), nothing;
    EXPECT_THROW(series.evaluate(0.1, nothing, values), InputError);
    EXPECT_THROW(series.evaluate(0.1, values, nothing), InputError);
    const auto fresh = make_jet(linear.tape, 8, LaneKind::single);
    EXPECT_THROW(fresh->compute_deferred(linear.groups), OrderError);
    const std::uint32_t empty = 7;
    EXPECT_NO_THROW(jet->compute_deferred({&empty, 1}));
}

} // namespace graze::tangent_series_test
