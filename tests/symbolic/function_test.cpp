#include "graze/symbolic/function.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/interval.hpp"
#include "graze/symbolic/transform.hpp"
#include "symbolic/operation_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace graze::function_test {

class FunctionTest : public ::testing::Test {
protected:
    std::shared_ptr<Graph> graph = Graph::create();
    Expression x = graph->symbol("x"), y = graph->symbol("y");
};

TEST_F(FunctionTest, EvaluatesEveryOperation) {
    const std::vector<Expression> outputs{x + y,   x - y,   x * y,   x / y,   pow(x, y), -x,      sqrt(y),
                                          exp(x),  log(y),  sin(x),  cos(x),  tan(x),    asin(x), acos(x),
                                          atan(x), sinh(x), cosh(x), tanh(x), erf(x)};
    const double a = 0.3, b = 1.7;
    const std::vector<double> expected{a + b,        a - b,        a * b,        a / b,        std::pow(a, b),
                                       -a,           std::sqrt(b), std::exp(a),  std::log(b),  std::sin(a),
                                       std::cos(a),  std::tan(a),  std::asin(a), std::acos(a), std::atan(a),
                                       std::sinh(a), std::cosh(a), std::tanh(a), std::erf(a)};
    const Function function(std::vector{x, y}, outputs);
    EXPECT_EQ(function.inputs(), 2u);
    EXPECT_EQ(function.outputs(), outputs.size());
    EXPECT_EQ(function(std::vector{a, b}), expected);
}

TEST_F(FunctionTest, OutputsThatAreNotGivenAreZeroOrInputs) {
    const Expression z = graph->symbol("z");
    const SymbolIndex inputs(std::vector{x, y, z});
    const std::vector<Function::Output> given{{1, x * z}, {4, graph->number(3)}};
    const Function zeros(inputs, 6, given, Function::Others::zero);
    EXPECT_EQ(zeros.outputs(), 6u);
    EXPECT_EQ(zeros.operations(), 1u);
    EXPECT_EQ(zeros(std::vector{2.0, 5.0, 7.0}), (std::vector<double>{0, 14, 0, 0, 3, 0}));
    const std::vector<Function::Output> one{{1, x * z}};
    const Function handed(inputs, 3, one, Function::Others::inputs);
    EXPECT_EQ(handed(std::vector{2.0, 5.0, 7.0}), (std::vector<double>{2, 14, 7}));
    std::vector<double> in_place{2, 5, 7}, work(handed.workspace());
    handed.evaluate(in_place, in_place, work);
    EXPECT_EQ(in_place, (std::vector<double>{2, 14, 7}));
    std::vector<double> bounds(6), room(2 * std::max(zeros.workspace(), handed.workspace()));
    const std::vector<double> at{2, 5, 7}, errors{1e-3, 2e-3, 4e-3};
    zeros.error_bounds(at, errors, bounds, room);
    EXPECT_EQ(bounds[0], 0);
    EXPECT_NEAR(bounds[1], 7e-3 + 8e-3, 1e-12);
    handed.error_bounds(at, errors, bounds, room);
    EXPECT_EQ(bounds[0], 1e-3);
    EXPECT_EQ(bounds[2], 4e-3);
    // Only the inputs that are used are read into slots.
    EXPECT_EQ(Function(inputs, std::vector{y}).workspace(), 1u);
}

TEST_F(FunctionTest, PlacesOfOutputsMustRiseAndExist) {
    const SymbolIndex inputs(std::vector{x, y});
    const auto make = [&](std::size_t outputs, std::vector<Function::Output> given, Function::Others others) {
        return Function(inputs, outputs, given, others);
    };
    EXPECT_THROW(make(2, {{2, x}}, Function::Others::zero), InputError);
    EXPECT_THROW(make(2, {{1, x}, {1, y}}, Function::Others::zero), InputError);
    EXPECT_THROW(make(2, {{1, x}, {0, y}}, Function::Others::zero), InputError);
    EXPECT_THROW(make(3, {{1, x}}, Function::Others::inputs), InputError);
    EXPECT_THROW(make(2, {{1, Expression()}}, Function::Others::zero), InputError);
    EXPECT_THROW(make(2, {{1, Graph::create()->symbol("x")}}, Function::Others::zero), InputError);
    EXPECT_EQ(make(2, {}, Function::Others::inputs)(std::vector{1.0, 2.0}), (std::vector<double>{1, 2}));
}

TEST_F(FunctionTest, ErrorBoundsHoldAndAreNotMuchLarger) {
    const std::vector<Expression> outputs{x + y - x,       (x + 1e6) - (y + 1e6),
                                          x * y - 2 * x,   x / y,
                                          pow(x, y),       sqrt(x),
                                          exp(x) - exp(y), log(x + y),
                                          sin(x),          cos(y),
                                          tan(x),          asin(x / 2),
                                          acos(x / 2),     atan(y),
                                          sinh(x),         cosh(y),
                                          tanh(x),         erf(x - y)};
    const Function function(std::vector{x, y}, outputs);
    std::vector<double> bounds(outputs.size()), work(2 * function.workspace());
    for (const double a : {1e-3, 0.3, 1.3}) {
        const double b = 1.7, error = 1e-9;
        const std::vector<double> at{a, b};
        function.error_bounds(at, std::vector{error, error}, bounds, work);
        std::vector<double> worst(outputs.size());
        const auto values = function(at);
        for (const double da : {-error, error})
            for (const double db : {-error, error}) {
                const auto moved = function(std::vector{a + da, b + db});
                for (std::size_t i = 0; i < worst.size(); ++i)
                    worst[i] = std::max(worst[i], std::abs(moved[i] - values[i]));
            }
        for (std::size_t i = 0; i < worst.size(); ++i) {
            EXPECT_GE(bounds[i], worst[i] * (1 - 1e-5)) << i;
            EXPECT_LE(bounds[i], 20 * worst[i] + 1e-14) << i; // the bound treats dependent operands as independent
        }
    }
    // With exact inputs only round-off is left, including that of cancelling terms.
    function.error_bounds(std::vector{0.3, 1.7}, std::vector{0.0, 0.0}, bounds, work);
    EXPECT_GT(bounds[1], 1e6 * 1e-16);
    EXPECT_LT(bounds[1], 1e6 * 1e-15);
    EXPECT_LT(bounds[3], 1e-15);
    // The bound is finite even at the end of an operation's domain.
    const Function ends(std::vector{x, y}, std::vector{sqrt(x), asin(y)});
    std::vector<double> two(2), room(2 * ends.workspace());
    ends.error_bounds(std::vector{0.0, 1.0}, std::vector{1e-16, 1e-16}, two, room);
    EXPECT_LT(two[0], 1e-7);
    EXPECT_LT(two[1], 1e-7);
}

TEST_F(FunctionTest, OutputsMayBeInputsNumbersOrRepeated) {
    const Function function(std::vector{x, y}, std::vector{y, graph->number(4), x, y, x * y});
    EXPECT_EQ(function(std::vector{2.0, 3.0}), (std::vector{3.0, 4.0, 2.0, 3.0, 6.0}));
    EXPECT_TRUE(Function(std::vector{x}, std::vector<Expression>{})(std::vector{1.0}).empty());
    EXPECT_EQ(Function(std::vector<Expression>{}, std::vector{graph->number(4)})(std::vector<double>{})[0], 4);
}

TEST_F(FunctionTest, ResultsMayOverwriteInputs) {
    const Function swap(std::vector{x, y}, std::vector{y, x});
    std::vector<double> values{1, 2}, work(swap.workspace());
    swap.evaluate(values, values, work);
    EXPECT_EQ(values, (std::vector{2.0, 1.0}));
}

TEST_F(FunctionTest, SharedPartsAreEvaluatedOnce) {
    Expression e = x;
    for (int level = 0; level < 200; ++level)
        e = e * e + y;
    const Function function(std::vector{x, y}, std::vector{e});
    EXPECT_LE(function.workspace(), 2 + 2 * 200u);
    EXPECT_EQ(function(std::vector{0.0, 0.0})[0], 0);
}

/// Values of all nodes of a graph, with more digits than enclosures have. NaN where an operation is undefined or too
/// small for a number, and where one of its operands is NaN: the C library has 1^NaN = 1.
std::vector<long double> exact_values(const testing::OperationList& list, std::span<const double> symbols) {
    std::vector<long double> values;
    for (const auto& item : list.items) {
        if (item.operation == Operation::number)
            values.push_back(item.value);
        else if (item.operation == Operation::symbol)
            values.push_back(symbols[item.left]);
        else
            values.push_back(testing::OperationList::apply(
                item.operation, values[item.left], values[arity(item.operation) == 2 ? item.right : item.left]));
        const int operands = arity(item.operation);
        const long double left = operands > 0 ? values[item.left] : 0, right = operands == 2 ? values[item.right] : 1;
        const bool can_be_zero = operands == 0 || left == 0 || right == 0 || item.operation < Operation::multiply ||
                                 item.operation > Operation::exp;
        if (!std::isfinite(values.back()) || std::isnan(left) || std::isnan(right) ||
            (values.back() == 0 && !can_be_zero))
            values.back() = std::numeric_limits<long double>::quiet_NaN();
    }
    return values;
}

TEST_F(FunctionTest, EnclosesRandomExpressions) {
    testing::RandomOperations random(5, 2, true);
    int contained = 0, smaller = 0;
    for (int trial = 0; trial < 5000; ++trial) {
        const auto own = Graph::create();
        const std::vector<Expression> symbols{own->symbol("x"), own->symbol("y")};
        const Expression expression = random.next(1 + static_cast<std::size_t>(trial) % 12).build(*own, symbols);
        const Function function(symbols, std::vector{expression});
        const auto list = testing::OperationList::of(expression, symbols);
        const double extent = std::exp(random.uniform(-8, 1));
        std::vector<Interval> box, bounds(1), work(function.workspace());
        for (int k = 0; k < 2; ++k) {
            const double lower = random.uniform(-3, 3);
            box.push_back({lower, lower + extent});
        }
        function.enclose(box, bounds, work);
        ASSERT_FALSE(std::isnan(bounds[0].lower) || std::isnan(bounds[0].upper)) << to_string(expression);
        for (int sample = 0; sample < 10; ++sample) {
            const std::vector<double> at{random.uniform(box[0].lower, box[0].upper),
                                         random.uniform(box[1].lower, box[1].upper)};
            const long double value = exact_values(list, at).back();
            if (std::isnan(value) || std::abs(value) > 1e300L)
                continue;
            EXPECT_LE(bounds[0].lower, value) << to_string(expression);
            EXPECT_GE(bounds[0].upper, value) << to_string(expression);
            ++contained;
            // Narrowing to this value keeps the point.
            const double reach = 1e-12 * std::abs(static_cast<double>(value)) + 1e-300;
            const std::vector wanted{Interval{static_cast<double>(value) - reach, static_cast<double>(value) + reach}};
            auto narrowed = box;
            function.enclose(narrowed, bounds, work);
            EXPECT_TRUE(function.narrow(narrowed, wanted, work)) << to_string(expression);
            EXPECT_TRUE(narrowed[0].contains(at[0]) && narrowed[1].contains(at[1])) << to_string(expression);
            smaller += narrowed[0].width() < box[0].width() || narrowed[1].width() < box[1].width();
        }
    }
    EXPECT_GT(contained, 10000);
    EXPECT_GT(smaller, 3000);
}

TEST_F(FunctionTest, EnclosuresKnowWhereTheyHold) {
    const Function function(std::vector{x, y}, std::vector{x * x, 1 / (x - y), sqrt(y), graph->number(3)});
    std::vector<Interval> bounds(4), work(function.workspace());
    function.enclose(std::vector<Interval>{{-1, 2}, {-1, 4}}, bounds, work);
    EXPECT_EQ(bounds[0].lower, 0);
    EXPECT_NEAR(bounds[0].upper, 4, 1e-14);
    EXPECT_FALSE(bounds[1].continuous || bounds[1].bounded());
    EXPECT_FALSE(bounds[2].continuous);
    EXPECT_TRUE(bounds[3].is_point(3));
    // 1/(x - y) = 1/4 where x = y + 4; the square root is not asked for, and need not exist.
    std::vector<Interval> box{{-1, 2}, {-4, 0}};
    function.enclose(box, bounds, work);
    const std::vector<Interval> wanted{Interval::entire(), {0.25, 0.25}};
    ASSERT_TRUE(function.narrow(box, wanted, work));
    EXPECT_NEAR(box[0].lower, 0, 1e-13);
    EXPECT_NEAR(box[1].upper, -2, 1e-13);
    function.enclose(box, bounds, work);
    EXPECT_FALSE(function.narrow(box, std::vector<Interval>{{5, 6}}, work));
    EXPECT_THROW(function.enclose(box, std::span(bounds).first(1), work), InputError);
}

TEST_F(FunctionTest, FollowsIeeeRulesOutsideDomains) {
    const Function function(std::vector{x}, std::vector{1 / x, log(x), sqrt(x), graph->number(1) / graph->number(0)});
    const std::vector<double> at_zero = function(std::vector{0.0});
    EXPECT_TRUE(std::isinf(at_zero[0]));
    EXPECT_TRUE(std::isinf(at_zero[1]));
    EXPECT_EQ(at_zero[2], 0);
    EXPECT_TRUE(std::isinf(at_zero[3]));
    EXPECT_TRUE(std::isnan(function(std::vector{-1.0})[1]));
}

TEST_F(FunctionTest, ConstantValueNeedsNoSymbols) {
    EXPECT_EQ(constant_value(graph->number(2) * graph->number(3)), 6);
    EXPECT_TRUE(std::isnan(constant_value(log(graph->number(-1)))));
    // Evaluated step by step this would be 1/inf = 0.
    EXPECT_TRUE(std::isnan(constant_value(1 / (graph->number(1) / graph->number(0)))));
    EXPECT_THROW(constant_value(x), InputError);
    EXPECT_THROW(constant_value(log(x - 2)), InputError);
}

} // namespace graze::function_test
