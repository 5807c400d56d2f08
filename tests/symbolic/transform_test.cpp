#include "graze/symbolic/transform.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/parser.hpp"
#include "symbolic/operation_list.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tuple>

namespace graze::transform_test {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

class TransformTest : public ::testing::Test {
protected:
    std::shared_ptr<Graph> graph = Graph::create();
    Expression x = graph->symbol("x"), y = graph->symbol("y"), z = graph->symbol("z");
    std::vector<Expression> symbols{x, y, z};
    Scope scope{{"x", x}, {"y", y}, {"z", z}};

    Expression parse(std::string_view text) { return parse_expression(*graph, text, scope); }
    double value(const Expression& e, double at_x, double at_y = 0, double at_z = 0) {
        return Function(symbols, std::vector{e})(std::vector{at_x, at_y, at_z})[0];
    }
    Expression derivative(Expression e, int order) {
        for (; order > 0; --order)
            e = differentiate(e, x);
        return e;
    }
    bool contains(const Expression& e, Operation operation) {
        const auto list = testing::OperationList::of(e, symbols);
        std::vector<bool> used(list.items.size());
        used.back() = true;
        for (std::size_t index = list.items.size(); index-- > 0;) {
            if (!used[index])
                continue;
            const auto& item = list.items[index];
            if (item.operation == operation)
                return true;
            if (arity(item.operation) >= 1)
                used[item.left] = true;
            if (arity(item.operation) == 2)
                used[item.right] = true;
        }
        return false;
    }
};

TEST_F(TransformTest, DirectionalDerivativesAreSumsOfPartialDerivatives) {
    const Expression u = graph->symbol("u"), e = parse("x^2*sin(y) + exp(x*y)/z");
    const std::vector<Component> vector{{x, u}, {z, graph->number(3)}, {y, x * y}};
    const Expression along = differentiate_along(std::vector{e}, vector).front(),
                     sum = differentiate(e, x) * u + differentiate(e, z) * 3 + differentiate(e, y) * x * y;
    const std::vector<Expression> inputs{x, y, z, u};
    const auto values = Function(inputs, std::vector{along, sum})(std::vector{0.7, -1.2, 1.9, 0.4});
    EXPECT_NEAR(values[0], values[1], 8 * epsilon * std::abs(values[1]));
    // Components of symbols that do not occur, and zero components, add no terms.
    EXPECT_EQ(differentiate_along(std::vector{parse("y^2")}, std::vector<Component>{{x, u}, {y, graph->number(0)}})[0],
              graph->number(0));
    EXPECT_TRUE(differentiate_along({}, vector).empty());
    EXPECT_EQ(differentiate_along(std::vector{e}, {})[0], graph->number(0));
    EXPECT_THROW(differentiate_along(std::vector{e}, std::vector<Component>{{x, u}, {x, y}}), InputError);
}

TEST_F(TransformTest, JacobiansHaveTheirPartialDerivativesRowByRow) {
    const std::vector<Expression> expressions{parse("x*y"), parse("sin(x)")};
    EXPECT_EQ(jacobian(expressions, std::vector{x, y, z}),
              (std::vector<Expression>{y, x, graph->number(0), parse("cos(x)"), graph->number(0), graph->number(0)}));
    EXPECT_TRUE(jacobian({}, symbols).empty());
    EXPECT_TRUE(jacobian(expressions, {}).empty());
}

TEST_F(TransformTest, SparseJacobiansHaveTheNonzeroEntries) {
    const std::vector<Expression> expressions{parse("x*y"), parse("3"), parse("sin(x) + z - z")}, columns{z, y, x};
    const std::vector<JacobianEntry> entries = sparse_jacobian(expressions, SymbolIndex(columns));
    ASSERT_EQ(entries.size(), 3u);
    const std::vector<Expression> dense = jacobian(expressions, columns);
    std::vector<Expression> filled(dense.size(), graph->number(0));
    for (const JacobianEntry& entry : entries)
        filled[entry.row * columns.size() + entry.column] = entry.value;
    EXPECT_EQ(filled, dense);
    EXPECT_EQ(entries[0].column, 1u);
    EXPECT_EQ(entries[1].column, 2u);
    EXPECT_EQ(entries[2].row, 2u);
    EXPECT_TRUE(sparse_jacobian({}, SymbolIndex(columns)).empty());
    EXPECT_TRUE(sparse_jacobian(expressions, SymbolIndex()).empty());
}

TEST_F(TransformTest, DerivativesOfSimpleExpressionsAreSimple) {
    EXPECT_EQ(derivative(x, 1), graph->number(1));
    EXPECT_EQ(derivative(y, 1), graph->number(0));
    EXPECT_EQ(derivative(graph->number(5), 1), graph->number(0));
    EXPECT_EQ(derivative(parse("x^2"), 1), parse("2*x"));
    EXPECT_EQ(derivative(parse("x^3"), 2), parse("6*x"));
    EXPECT_EQ(derivative(parse("x^3"), 4), graph->number(0));
    EXPECT_EQ(derivative(parse("3*x + y"), 1), graph->number(3));
    EXPECT_EQ(derivative(parse("x*y - y"), 1), y);
    EXPECT_EQ(derivative(parse("y/x"), 1), parse("-y/x/x"));
    EXPECT_EQ(derivative(parse("sin(x)"), 4), parse("sin(x)"));
    EXPECT_EQ(derivative(parse("exp(2*x)"), 1), parse("2*exp(2*x)"));
    EXPECT_EQ(derivative(parse("log(x)"), 1), parse("1/x"));
    EXPECT_EQ(derivative(parse("x^y"), 1), parse("y*x^(y - 1)"));
    EXPECT_EQ(differentiate(parse("x^y"), y), parse("x^y*log(x)"));
}

TEST_F(TransformTest, ConstantExponentsBringNoLogarithm) {
    for (const char* text : {"x^0.5", "x^7", "x^-2", "(1 - x)^y", "(x*y)^(y + 2)", "x^(-y)"})
        for (int order = 1; order <= 4; ++order)
            EXPECT_FALSE(contains(derivative(parse(text), order), Operation::log)) << text;
    EXPECT_EQ(value(derivative(parse("x^3"), 1), -2), 12);
    EXPECT_TRUE(contains(derivative(parse("y^(x*y)"), 2), Operation::log));
}

TEST_F(TransformTest, FifthDerivativesEqualClosedForms) {
    using Closed = double (*)(double);
    const std::tuple<const char*, Closed, double> cases[] = {
        {"exp(-x^2)",
         [](double a) { return -(32 * std::pow(a, 5) - 160 * std::pow(a, 3) + 120 * a) * std::exp(-a * a); }, 400},
        {"x^0.5", [](double a) { return 105.0 / 32 * std::pow(a, -4.5); }, 10},
        {"sqrt(x)", [](double a) { return 105.0 / 32 * std::pow(a, -4.5); }, 100},
        {"log(x)", [](double a) { return 24 / std::pow(a, 5); }, 100},
        {"1/x", [](double a) { return -120 / std::pow(a, 6); }, 100},
        {"sin(2*x)*cos(2*x)", [](double a) { return 512 * std::cos(4 * a); }, 4000},
        {"atan(x)", [](double a) { return 24 * (5 * std::pow(a, 4) - 10 * a * a + 1) / std::pow(1 + a * a, 5); }, 1000},
        {"tanh(x)",
         [](double a) {
             const double t = std::tanh(a), s = 1 - t * t;
             return s * (16 - 120 * t * t + 120 * t * t * t * t);
         },
         2000},
        {"erf(x)",
         [](double a) {
             return (16 * std::pow(a, 4) - 48 * a * a + 12) * std::exp(-a * a) * 2 / std::sqrt(std::numbers::pi);
         },
         400},
        {"exp(sin(x))",
         [](double a) {
             const double s = std::sin(a), c = std::cos(a);
             return std::exp(s) * c * (std::pow(c, 4) - 10 * c * c * s + 15 * s * s - 10 * c * c + 15 * s + 1);
         },
         2000},
        {"sinh(x)*cosh(x)", [](double a) { return 16 * std::cosh(2 * a); }, 400},
        {"asin(x) + acos(x)", [](double) { return 0.0; }, 1e5},
        {"2^x", [](double a) { return std::pow(std::log(2), 5) * std::pow(2, a); }, 10},
    };
    for (const auto& [text, closed, scale] : cases) {
        const Expression fifth = derivative(parse(text), 5);
        for (const double at : {0.2, 0.45, 0.8})
            EXPECT_NEAR(value(fifth, at), closed(at), scale * 16 * epsilon * std::max(1.0, std::abs(closed(at))))
                << text << " at " << at;
    }
}

TEST_F(TransformTest, DerivativesEqualComplexSteps) {
    std::size_t compared = 0;
    for (unsigned seed = 0; seed < 10000; ++seed) {
        testing::RandomOperations random(seed, symbols.size(), true);
        const testing::OperationList list = random.next(2 + seed % 8);
        graph = Graph::create(); // a small graph, because operation lists take all nodes of a graph
        symbols = {graph->symbol("x"), graph->symbol("y"), graph->symbol("z")};
        const Expression e = list.build(*graph, symbols);
        const std::vector<double> values{random.uniform(0.2, 2), random.uniform(0.1, 3), random.uniform(0.1, 1)};
        const testing::Bounded original = list.evaluate(values);
        // A complex power of a negative number is not real; the closed forms above cover these cases.
        const double step = list.derivative(values, 0);
        if (!std::isfinite(original.value) || !std::isfinite(step) || original.bound > 1e-6)
            continue;
        const Expression slope = differentiate(e, symbols[0]);
        const testing::Bounded expected = testing::OperationList::of(slope, symbols).evaluate(values);
        if (!std::isfinite(expected.value) || !std::isfinite(expected.bound))
            continue;
        bool has_power = false;
        for (const auto& item : list.items)
            has_power = has_power || item.operation == Operation::power;
        if (has_power)
            continue;
        ++compared;
        ASSERT_LE(std::abs(value(slope, values[0], values[1], values[2]) - step),
                  64 * (expected.bound + epsilon * std::max(1.0, std::abs(step))))
            << to_string(e) << " has derivative " << to_string(slope);
    }
    EXPECT_GT(compared, 500u);
}

TEST_F(TransformTest, MixedDerivativesCommute) {
    const Expression e = parse("exp(x*y)*sin(x/(1 + y^2)) + (x + 2)^(y*x)");
    const double one = value(differentiate(differentiate(e, x), y), 0.7, 0.4);
    const double other = value(differentiate(differentiate(e, y), x), 0.7, 0.4);
    EXPECT_NEAR(one, other, 200 * epsilon * std::abs(one));
    // They also equal central differences of the first derivative
    const Expression by_x = differentiate(e, x);
    const double step = 1e-5;
    EXPECT_NEAR(one, (value(by_x, 0.7, 0.4 + step) - value(by_x, 0.7, 0.4 - step)) / (2 * step), 1e-8);
}

TEST_F(TransformTest, DerivativesNearTheEndsOfDomainsAreAccurate) {
    const double a = 1 - 1e-12;
    const double exact = 1 / std::sqrt((1 - a) * (1 + a));
    EXPECT_NEAR(value(derivative(parse("asin(x)"), 1), a), exact, 8 * epsilon * exact);
    EXPECT_NEAR(value(derivative(parse("acos(x)"), 1), a), -exact, 8 * epsilon * exact);
}

TEST_F(TransformTest, SeveralExpressionsAreDifferentiatedAtOnce) {
    const auto slopes = differentiate(std::vector{parse("x^2"), parse("y"), parse("x*y")}, x);
    EXPECT_EQ(slopes, (std::vector{parse("2*x"), graph->number(0), y}));
    EXPECT_TRUE(differentiate(std::vector<Expression>{}, x).empty());
}

TEST_F(TransformTest, SubstitutionIsSimultaneous) {
    const Replacement swap[] = {{x, y}, {y, x}};
    EXPECT_EQ(substitute(parse("x - 2*y"), swap), parse("y - 2*x"));
    const Replacement nested[] = {{x, parse("x + 1")}};
    EXPECT_EQ(substitute(parse("x*sin(x)"), nested), parse("(x + 1)*sin(x + 1)"));
    const Replacement constant[] = {{x, graph->number(0)}};
    EXPECT_EQ(substitute(parse("x*y + cos(x)"), constant), graph->number(1));
    EXPECT_EQ(substitute(parse("z^2"), constant), parse("z^2"));
    EXPECT_EQ(to_string(substitute(parse("1/x"), constant)), "1/0");
    EXPECT_TRUE(substitute(std::vector<Expression>{}, constant).empty());
}

TEST_F(TransformTest, SymbolsAreFoundInOrder) {
    EXPECT_EQ(symbols_of(std::vector{parse("z + 1"), parse("sin(x)*z")}), (std::vector{x, z}));
    EXPECT_TRUE(symbols_of(std::vector{graph->number(1)}).empty());
    EXPECT_TRUE(symbols_of(std::vector<Expression>{}).empty());
}

TEST_F(TransformTest, PrintsWithAsFewParenthesesAsPossible) {
    for (const char* text : {"x + 2",
                             "x - 2",
                             "2 - x",
                             "2*x",
                             "-2*x",
                             "-x",
                             "-x*y",
                             "-(x + y)",
                             "x - (y + z)",
                             "x - (y - z)",
                             "x/y/z",
                             "x/(y*z)",
                             "x*(y/z)",
                             "x^y^z",
                             "(x^y)^z",
                             "(-x)^2",
                             "-x^2",
                             "x^-2",
                             "x^(-y)",
                             "2^(x + 1)",
                             "(x + 1)^2",
                             "(-2)^x",
                             "sin(x)^2",
                             "sin(x + y)/cos(x)",
                             "1e-07*x",
                             "1e+300*x",
                             "0.1*x",
                             "-2/x",
                             "x^2/2",
                             "x*y/z",
                             "3.141592653589793*x",
                             "sqrt(-x)",
                             "-1/(x + 1)"})
        EXPECT_EQ(to_string(parse(text)), text);
}

TEST_F(TransformTest, PrintedTextParsesBackToTheSameNode) {
    for (unsigned seed = 0; seed < 20000; ++seed) {
        testing::RandomOperations random(seed, symbols.size(), seed % 3 == 0);
        const testing::OperationList list = random.next(1 + seed % 16);
        const Expression e = list.build(*graph, symbols);
        ASSERT_EQ(parse(list.text(symbols)), e) << "parsed and built must agree: " << list.text(symbols);
        ASSERT_EQ(parse(to_string(e)), e)
            << list.text(symbols) << " printed " << to_string(e) << " came back as " << to_string(parse(to_string(e)));
        const Expression slope = differentiate(e, x);
        ASSERT_EQ(parse(to_string(slope)), slope) << to_string(slope);
    }
}

TEST_F(TransformTest, NumbersKeepAllTheirDigits) {
    for (const double number :
         {0.1, 1.0 / 3, 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, 1e22, 123456789012345680.0})
        for (const double sign : {1.0, -1.0})
            EXPECT_EQ(parse(to_string(graph->number(sign * number))), graph->number(sign * number));
}

TEST_F(TransformTest, OverlongTextsAreRefused) {
    Expression e = x;
    for (int level = 0; level < 100; ++level)
        e = sin(e * e);
    EXPECT_THROW(to_string(e), InputError);
}

/// Counts nodes instead of measuring times, since the work of every transform is constant for each node.
TEST_F(TransformTest, LargeGraphsTakeLinearWork) {
    const auto nodes_made = [](std::size_t levels) {
        const auto large = Graph::create();
        const Expression a = large->symbol("a"), b = large->symbol("b");
        Expression e = a;
        for (std::size_t level = 0; level < levels; ++level)
            e = sin(e) * b + a / (level + 2.0);
        const std::size_t before = large->size();
        const Expression slope = differentiate(e, a);
        const std::size_t after = large->size();
        const Replacement replacement[] = {{a, b * 2}};
        const Expression replaced = substitute(slope, replacement);
        EXPECT_EQ(symbols_of(std::vector{replaced}), std::vector{b});
        const Function function(std::vector{a, b}, std::vector{e, slope});
        EXPECT_TRUE(std::isfinite(function(std::vector{0.3, 0.5})[1]));
        EXPECT_EQ(parse_expression(*large, to_string(e), {{"a", a}, {"b", b}}), e);
        EXPECT_LE(large->size() - after, 2 * after);
        return std::pair(before, after - before);
    };
    const auto [small, small_made] = nodes_made(2500);
    const auto [large, large_made] = nodes_made(25000);
    EXPECT_GE(large, 100000u);
    EXPECT_LE(large_made, 11 * small_made);
    EXPECT_LE(large_made, 3 * large);
}

TEST_F(TransformTest, SmallExpressionsOfLargeGraphsTakeSmallWork) {
    Expression large = x;
    for (int level = 0; level < 100000; ++level)
        large = large * y + 1;
    // Any dependence on the size of the large graph would make this loop take 1e10 steps.
    for (int count = 0; count < 100000; ++count) {
        const Expression small = x * y;
        ASSERT_EQ(differentiate(small, x), y);
    }
}

} // namespace graze::transform_test
