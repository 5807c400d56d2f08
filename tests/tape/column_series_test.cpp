// Columns of W' = A W against closed forms, and against jets whose states are those columns.

#include "tape/column_series.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/symbol_index.hpp"
#include "graze/symbolic/transform.hpp"
#include "tape/problems.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace graze::column_series_test {

using testing::eps;
using testing::Problem;
using testing::spread;

/// The field with the entries of its Jacobian as outputs.
struct Linearised {
    explicit Linearised(Problem given) : problem(std::move(given)) {
        problem.outputs.clear();
        for (JacobianEntry& entry : sparse_jacobian(problem.rates, SymbolIndex(problem.states))) {
            entries.push_back({entry.row, entry.column, problem.outputs.size()});
            problem.outputs.push_back(std::move(entry.value));
        }
        tape = problem.tape();
    }
    /// Returns the problem with the columns as additional states.
    Problem grown(std::size_t columns) const {
        Problem all = problem;
        all.outputs.clear();
        for (std::size_t d = 0; d < columns; ++d) {
            std::vector<Component> column;
            for (const Expression& state : problem.states)
                column.emplace_back(state, all.state("w" + std::to_string(d) + "_" + state.name(), 0));
            for (Expression& rate : differentiate_along(problem.rates, column))
                all.rates.push_back(std::move(rate));
        }
        return all;
    }

    Problem problem;
    std::vector<MatrixEntry> entries;
    Tape tape;
};

/// Returns arbitrary initial values of a matrix.
double start_of(std::size_t entry, int lane) {
    return std::cos(1.0 + 2.3 * static_cast<double>(entry) + 0.1 * lane);
}

TEST(ColumnSeries, EqualJetsOfTheVariationalEquations) {
    const Linearised linear(testing::everything());
    const std::size_t rows = linear.problem.states.size();
    for (const auto set : testing::supported_sets())
        for (const int order : {1, 2, 3, 8, 17, highest_order})
            for (const std::size_t columns : {1, 2, 3, 4, 5, 7}) {
                const Problem all = linear.grown(columns);
                const Tape grown = all.tape();
                const auto whole = make_jet(grown, order, LaneKind::ensemble, set);
                const auto jet = make_jet(linear.tape, order, LaneKind::ensemble, set);
                const int width = jet->width();
                const auto state = [&](std::size_t i, int l) { return linear.problem.state_values[i] - 0.002 * l; };
                const auto parameters = spread(linear.problem.parameter_values, width, [&](std::size_t i, int l) {
                    return linear.problem.parameter_values[i] + 0.003 * l;
                });
                std::vector<double> states = spread(linear.problem.state_values, width, state), start;
                for (std::size_t i = 0; i < rows * columns; ++i)
                    for (int l = 0; l < width; ++l)
                        start.push_back(start_of(i, l));
                jet->set_parameters(parameters);
                jet->compute(states);
                ColumnSeries series(*jet, linear.tape, linear.entries, rows, columns, set);
                series.compute(start);
                states.insert(states.end(), start.begin(), start.end());
                whole->set_parameters(parameters);
                whole->compute(states);
                for (std::size_t i = 0; i < rows * columns; ++i)
                    for (int k = 0; k <= order; ++k)
                        for (int l = 0; l < width; ++l) {
                            const std::size_t at = static_cast<std::size_t>(k * width + l);
                            double size = 0; // size of this coefficient in the column
                            for (std::size_t r = 0; r < rows; ++r)
                                size = std::max(size, std::abs(whole->state(rows + i / rows * rows + r)[at]));
                            // The tolerance allows for sums of as many products as the order, whose terms cancel by a
                            // few digits.
                            ASSERT_NEAR(series.series()[i].first[at], whole->state(rows + i)[at],
                                        1e3 * (k + 1) * eps * size)
                                << "entry " << i << " order " << k << " lane " << l << " " << name_of(set);
                        }
            }
}

/// x' = y, y' = -x + t: W is a rotation, whatever the state.
TEST(ColumnSeries, SumToTheExponentialOfAConstantMatrix) {
    Problem p;
    const Expression x = p.state("x", 0.4), y = p.state("y", -0.3);
    p.rates = {y};
    p.rates.push_back(testing::add_time(p, testing::Time::linear, 0.2) - x);
    std::swap(p.rates[1], p.rates[2]); // the rate of time was put first
    const Linearised linear(p);
    for (const auto set : testing::supported_sets()) {
        const auto jet = make_jet(linear.tape, 20, LaneKind::ensemble, set);
        const int width = jet->width();
        const auto lanes = static_cast<std::size_t>(width);
        ColumnSeries series(*jet, linear.tape, linear.entries, 3, 2, set);
        jet->compute(spread(p.state_values, width, [&](std::size_t i, int) { return p.state_values[i]; }));
        std::vector<double> start(6 * lanes, 0.0), times(lanes), values(start.size()), slopes(start.size());
        std::fill_n(start.begin(), width, 1.0);           // along x
        std::fill_n(&start[(3 + 1) * lanes], width, 1.0); // along y
        for (std::size_t l = 0; l < lanes; ++l)
            times[l] = 0.5 + 0.01 * static_cast<double>(l); // there the 20th term is below 1e-24
        series.compute(start);
        series.evaluate(times, values, slopes);
        for (std::size_t l = 0; l < lanes; ++l) {
            const double c = std::cos(times[l]), s = std::sin(times[l]);
            const std::vector<double> exact{c, -s, 0, s, c, 0}, rates{-s, -c, 0, c, -s, 0};
            for (std::size_t i = 0; i < 6; ++i) {
                EXPECT_NEAR(values[i * lanes + l], exact[i], 4 * eps) << i << " " << l;
                EXPECT_NEAR(slopes[i * lanes + l], rates[i], 4 * eps) << i << " " << l;
            }
        }
        // Rates at the end depend on the values only.
        ColumnSeries end(*jet, linear.tape, linear.entries, 3, 2, set);
        end.begin(values);
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t l = 0; l < lanes; ++l)
                EXPECT_NEAR(end.series()[i].first[lanes + l], slopes[i * lanes + l], 8 * eps) << i << " " << l;
    }
}

/// x' = a x has the column exp(a t): tails and misfits in closed form, each lane at its own length.
TEST(ColumnSeries, TailsAndMisfitsEqualClosedForms) {
    constexpr int order = 6;
    constexpr double rate = 2, factor = 1.5, scale = 3;
    Problem p;
    const Expression x = p.state("x", 0.4);
    p.rates = {p.graph->number(rate) * x};
    const Linearised linear(p);
    for (const auto set : testing::supported_sets()) {
        const auto jet = make_jet(linear.tape, order, LaneKind::ensemble, set),
                   end_jet = make_jet(linear.tape, order, LaneKind::ensemble, set);
        const auto width = static_cast<std::size_t>(jet->width());
        const std::vector<double> states(width, 0.4), scales{scale};
        std::vector<double> start(width, factor), lengths(width), values(width), slopes(width), worst(width);
        for (std::size_t l = 0; l < width; ++l)
            lengths[l] = 0.05 + 0.01 * static_cast<double>(l);
        start[1] = std::numeric_limits<double>::quiet_NaN();
        jet->compute(states);
        ColumnSeries series(*jet, linear.tape, linear.entries, 1, 1, set),
            end(*end_jet, linear.tape, linear.entries, 1, 1, set);
        series.compute(start);
        series.tails(lengths, scales, worst);
        for (std::size_t l = 0; l < width; ++l)
            if (l != 1) {
                const double h = rate * lengths[l], beginning = 1 + h + h * h / 2;
                EXPECT_NEAR(worst[l], std::pow(h, 5) / 120 / beginning, 8 * eps) << l; // larger than h^6/720
            }
        series.evaluate(lengths, values, slopes);
        end_jet->begin(states);
        end.begin(values);
        constexpr double allowed = 1e-6;
        series.misfit(end, {allowed, 0, 0}, lengths, scales, values, slopes, worst);
        for (std::size_t l = 0; l < width; ++l) {
            if (l == 1) {
                EXPECT_EQ(worst[l], std::numeric_limits<double>::infinity());
                continue;
            }
            // The slope lacks the last term of the rate; the value has it.
            const double h = rate * lengths[l], value = values[l] / factor, missing = h * std::pow(h, 6) / 720;
            EXPECT_NEAR(worst[l] * allowed, missing / (value * (1 + 0.25 * h)), 8 * eps) << l;
        }
        EXPECT_THROW(series.tails(lengths, {}, worst), InputError);
        EXPECT_THROW(series.misfit(end, {allowed, 0, 0}, {}, scales, values, slopes, worst), InputError);
    }
}

TEST(ColumnSeries, RefuseWrongSizesAndEntries) {
    const Linearised linear(testing::everything());
    const std::size_t rows = linear.problem.states.size();
    const auto jet = make_jet(linear.tape, 5, LaneKind::ensemble), alone = make_jet(linear.tape, 5, LaneKind::single);
    const auto make = [&](const Jet& of, std::vector<MatrixEntry> entries, std::size_t size) {
        ColumnSeries(of, linear.tape, entries, size, 1);
    };
    EXPECT_NO_THROW(make(*jet, linear.entries, rows));
    EXPECT_THROW(make(*alone, linear.entries, rows), InputError);
    EXPECT_THROW(make(*jet, {{rows, 0, 0}}, rows), InputError);
    EXPECT_THROW(make(*jet, {{0, rows, 0}}, rows), InputError);
    EXPECT_THROW(make(*jet, {{0, 0, linear.entries.size()}}, rows), InputError);
    EXPECT_THROW(make(*jet, {{1, 0, 0}, {0, 0, 0}}, rows), InputError);
    ColumnSeries series(*jet, linear.tape, linear.entries, rows, 1);
    EXPECT_THROW(series.compute(std::vector<double>(3)), InputError);
}

} // namespace graze::column_series_test
