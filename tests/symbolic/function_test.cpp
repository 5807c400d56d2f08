#include "graze/symbolic/function.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze {
namespace {

class FunctionTest : public ::testing::Test {
protected:
    std::shared_ptr<Graph> graph = Graph::create();
    Expression x = graph->symbol("x");
    Expression y = graph->symbol("y");
};

TEST_F(FunctionTest, EvaluatesEveryOperation) {
    const std::vector<Expression> outputs{x + y,   x - y,   x * y,   x / y,   pow(x, y), -x,
                                          sqrt(y), exp(x),  log(y),  sin(x),  cos(x),    tan(x),
                                          asin(x), acos(x), atan(x), sinh(x), cosh(x),   tanh(x)};
    const double a = 0.3, b = 1.7;
    const std::vector<double> expected{a + b,        a - b,        a * b,        a / b,        std::pow(a, b),
                                       -a,           std::sqrt(b), std::exp(a),  std::log(b),  std::sin(a),
                                       std::cos(a),  std::tan(a),  std::asin(a), std::acos(a), std::atan(a),
                                       std::sinh(a), std::cosh(a), std::tanh(a)};
    const Function function(std::vector{x, y}, outputs);
    EXPECT_EQ(function.inputs(), 2u);
    EXPECT_EQ(function.outputs(), outputs.size());
    EXPECT_EQ(function(std::vector{a, b}), expected);
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

TEST_F(FunctionTest, FollowsIeeeRulesOutsideDomains) {
    const Function function(std::vector{x}, std::vector{1 / x, log(x), sqrt(x), graph->number(1) / graph->number(0)});
    const std::vector<double> at_zero = function(std::vector{0.0});
    EXPECT_TRUE(std::isinf(at_zero[0]));
    EXPECT_TRUE(std::isinf(at_zero[1]));
    EXPECT_EQ(at_zero[2], 0);
    EXPECT_TRUE(std::isinf(at_zero[3]));
    EXPECT_TRUE(std::isnan(function(std::vector{-1.0})[1]));
}

TEST_F(FunctionTest, RefusesMisuse) {
    EXPECT_THROW(Function(std::vector{x}, std::vector{x + y}), std::invalid_argument);
    EXPECT_THROW(Function(std::vector{x, x}, std::vector{x}), std::invalid_argument);
    EXPECT_THROW(Function(std::vector{x + 1}, std::vector{x}), std::invalid_argument);
    EXPECT_THROW(Function(std::vector{Graph::create()->symbol("x")}, std::vector{x}), std::invalid_argument);
    EXPECT_THROW(Function(std::vector{x}, std::vector{Expression()}), std::invalid_argument);
    EXPECT_THROW(Function(std::vector{x}, std::vector{x})(std::vector<double>{}), std::invalid_argument);
}

TEST_F(FunctionTest, ConstantValue) {
    EXPECT_EQ(constant_value(graph->number(2) * graph->number(3)), 6);
    EXPECT_TRUE(std::isnan(constant_value(log(graph->number(-1)))));
    // Evaluated step by step this would be 1/inf = 0.
    EXPECT_TRUE(std::isnan(constant_value(1 / (graph->number(1) / graph->number(0)))));
    EXPECT_THROW(constant_value(x), std::invalid_argument);
    EXPECT_THROW(constant_value(log(x - 2)), std::invalid_argument);
}

} // namespace
} // namespace graze
