#include "graze/symbolic/linearisation.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/parser.hpp"
#include "symbolic/multiplied_out.hpp"
#include "symbolic/operation_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>

namespace graze::linearisation_test {

using testing::DenseDerivatives;
using testing::multiplied_out;
using testing::plain_derivatives;
using testing::plain_linearisation;

/// Checks the order of entries that every linearisation guarantees.
void expect_order(const Linearisation& linear) {
    std::vector<bool> used(linear.intermediates), changes(linear.intermediates);
    const LinearEntry* last = nullptr;
    for (const LinearEntry& entry : linear.entries) {
        EXPECT_LT(entry.row, linear.intermediates + linear.functions);
        EXPECT_LT(entry.source, linear.variables + std::min(entry.row, linear.intermediates));
        EXPECT_FALSE(entry.coefficient.is_number(0));
        if (last) {
            EXPECT_LT(std::pair(last->row, last->source), std::pair(entry.row, entry.source));
        }
        if (entry.source >= linear.variables)
            used[entry.source - linear.variables] = true;
        if (entry.row < linear.intermediates)
            changes[entry.row] = true;
        last = &entry;
    }
    EXPECT_EQ(used, std::vector<bool>(linear.intermediates, true));
    EXPECT_EQ(changes, std::vector<bool>(linear.intermediates, true));
}

/// @param tolerance relative to the size of a row, whose products are added up
void expect_same(const Linearisation& linear, std::span<const Expression> functions, const SymbolIndex& variables,
                 std::span<const double> at, double tolerance, const std::string& what = "") {
    const std::vector<double> plain = plain_derivatives(functions, variables, at);
    const DenseDerivatives derivatives = multiplied_out(linear, variables, at);
    ASSERT_EQ(derivatives.values.size(), plain.size());
    for (std::size_t i = 0; i < plain.size(); ++i) {
        const double size = derivatives.sizes[i / variables.size()];
        EXPECT_NEAR(derivatives.values[i], plain[i], tolerance * size) << what << " entry " << i;
    }
}

class LinearisationTest : public ::testing::Test {
protected:
    std::shared_ptr<Graph> graph = Graph::create();
    std::mt19937_64 random{17};
    std::vector<Expression> x;
    Scope scope;

    void make(std::size_t states) {
        for (std::size_t i = 0; i < states; ++i)
            x.push_back(add("x" + std::to_string(i + 1)));
    }
    Expression add(const std::string& name) { return scope.emplace(name, graph->symbol(name)).first->second; }
    Expression parse(std::string_view text) { return parse_expression(*graph, text, scope); }
    Expression sum(const std::function<Expression(const Expression&)>& term) {
        Expression total = term(x.front());
        for (std::size_t i = 1; i < x.size(); ++i)
            total = total + term(x[i]);
        return total;
    }
    /// Compares the linearisation with the sparse Jacobian at some points, including the derivatives with respect to
    /// parameters that follow the states.
    Linearisation checked(std::span<const Expression> functions, const SymbolIndex& variables, std::size_t states) {
        Linearisation linear = linearise(functions, variables, states);
        EXPECT_EQ(linear.variables, variables.size());
        EXPECT_EQ(linear.functions, functions.size());
        expect_order(linear);
        for (int trial = 0; trial < 5; ++trial) {
            std::vector<double> at;
            for (std::size_t i = 0; i < variables.size(); ++i)
                at.push_back(std::uniform_real_distribution<>(0.2, 1.2)(random));
            // Sums of n terms in two orders, with terms of order one.
            expect_same(linear, functions, variables, at, 1e-13);
        }
        return linear;
    }
    Linearisation checked(std::span<const Expression> functions) {
        return checked(functions, SymbolIndex(x), x.size());
    }
};

TEST_F(LinearisationTest, EmptyFunctionsHaveNoEntries) {
    make(2);
    const Linearisation none = linearise({}, SymbolIndex(x), 2);
    EXPECT_EQ(none.variables, 2u);
    EXPECT_EQ(none.functions, 0u);
    EXPECT_TRUE(none.entries.empty());
    EXPECT_EQ(none.cost(), 0u);
    const Linearisation no_variables = linearise(std::vector{sin(x[0])}, SymbolIndex(), 0);
    EXPECT_EQ(no_variables.functions, 1u);
    EXPECT_TRUE(no_variables.entries.empty());
}

TEST_F(LinearisationTest, ConstantRowsAreEmptyAndVariablesHaveCoefficientOne) {
    make(2);
    add("p");
    const std::vector<Expression> functions{parse("3"), x[1], parse("sin(p)"), x[1], parse("1/0")};
    const Linearisation linear = linearise(functions, SymbolIndex(x), 2);
    EXPECT_EQ(linear.intermediates, 0u);
    ASSERT_EQ(linear.entries.size(), 2u);
    for (const LinearEntry& entry : linear.entries) {
        EXPECT_EQ(entry.source, 1u);
        EXPECT_EQ(entry.coefficient, graph->number(1));
        EXPECT_FALSE(entry.varies);
    }
    EXPECT_EQ(linear.entries[0].row, 1u);
    EXPECT_EQ(linear.entries[1].row, 3u);
    EXPECT_EQ(linear.cost(), 2u);
}

TEST_F(LinearisationTest, APowerIsOneProduct) {
    make(1);
    add("k");
    const std::vector<Expression> functions{parse("-k*x1 - x1^3")};
    const Linearisation linear = linearise(functions, SymbolIndex(x), 1);
    ASSERT_EQ(linear.entries.size(), 1u);
    EXPECT_EQ(linear.intermediates, 0u);
    EXPECT_EQ(to_string(linear.entries[0].coefficient), to_string(sparse_jacobian(functions, SymbolIndex(x))[0].value));
    EXPECT_TRUE(linear.entries[0].varies);
    EXPECT_EQ(linear.cost(), Linearisation::varying_cost);
}

TEST_F(LinearisationTest, CoefficientsOfQuotientsPowersAndFunctionsAreCorrect) {
    make(3);
    for (const char* text : {"x1/x2",
                             "3/x1",
                             "x1/3",
                             "x1/x1^2",
                             "x1/x2^2",
                             "3/(x1 + x2)^3",
                             "x1*x3/(x1 + 2*x2)^2.5",
                             "x1/x2^x3",
                             "x1/(x2^2)^2",
                             "x1/(x2/(x1 + x3)^2)^3",
                             "x1/x2^(-2)",
                             "x1^x2",
                             "2^x1",
                             "x1^0.5",
                             "x1*x2*x3*x1",
                             "x1 - (x2 - x1)",
                             "-(x1*x2)",
                             "sqrt(x1 + x2)",
                             "exp(x1)/x2",
                             "log(x1*x2)",
                             "tan(x1*x3)",
                             "asin(x1/3)",
                             "acos(x1/3)",
                             "atan(x1 - x2)",
                             "sinh(x1)*cosh(x2)",
                             "tanh(x1*x2 - x3)",
                             "erf(x1)^2"})
        checked(std::vector{parse(text)});
}

TEST_F(LinearisationTest, CoefficientsAreFiniteWhereThePlainDerivativesAre) {
    make(2);
    const SymbolIndex variables(x);
    // Roots and powers of 0, products of what over- or underflows, powers of negative bases.
    for (const auto& [text, at] : {std::pair<const char*, std::vector<double>>{"x1^2*x2", {0, 0}},
                                   {"(x1*x2)^1.5", {0, 3}},
                                   {"x1^3 + 0.1*x2^2", {-2, 0}},
                                   {"(x1 - x2)^-2", {-2, 1}},
                                   {"x1/x2^(-2)", {3, 0}},
                                   {"x1/x2^2", {0, -3}},
                                   {"x1/x2", {1e-320, 1e-310}},
                                   {"x1/x2", {1e300, 1e-5}},
                                   {"exp(x1)*x2", {-700, 1e300}},
                                   {"sqrt(x1*x1 + x2)", {0, 1e-300}}}) {
        const std::vector<Expression> functions{parse(text)};
        const std::vector<double> plain = plain_derivatives(functions, variables, at);
        const std::vector<double> values = multiplied_out(linearise(functions, variables, 2), variables, at).values;
        for (std::size_t i = 0; i < 2; ++i)
            if (std::isfinite(plain[i])) {
                EXPECT_NEAR(values[i], plain[i], 1e-13 * std::abs(plain[i])) << text << ' ' << i;
            }
    }
}

TEST_F(LinearisationTest, AChainHasTheEntriesOfItsJacobianAndNoIntermediates) {
    constexpr std::size_t oscillators = 200;
    make(2 * oscillators);
    std::vector<Expression> rates;
    for (std::size_t i = 0; i < oscillators; ++i) {
        Expression force = -0.2 * x[2 * i] - 0.04 * x[2 * i + 1] - 2 * x[2 * i] - 0.1 * pow(x[2 * i], 3);
        if (i > 0)
            force = force + x[2 * i - 2];
        if (i + 1 < oscillators)
            force = force + x[2 * i + 2];
        rates.push_back(x[2 * i + 1]);
        rates.push_back(force);
    }
    const Linearisation linear = checked(rates);
    EXPECT_EQ(linear.intermediates, 0u);
    EXPECT_EQ(linear.entries.size(), 5 * oscillators - 2);
    EXPECT_EQ(linear.varying_entries(), oscillators);
}

TEST_F(LinearisationTest, CubicSpringsHaveTwoIntermediatesEach) {
    constexpr std::size_t masses = 50;
    make(masses);
    std::vector<Expression> forces(masses, graph->number(0));
    for (std::size_t i = 0; i + 1 < masses; ++i) {
        const Expression extension = x[i + 1] - x[i], force = 2 * extension + 0.5 * pow(extension, 3);
        forces[i] = forces[i] + force;
        forces[i + 1] = forces[i + 1] - force;
    }
    const Linearisation linear = checked(forces);
    // The intermediates of each spring are extension (2 products) and force (1 product of series, used in two rows).
    EXPECT_EQ(linear.varying_entries(), masses - 1);
    EXPECT_EQ(linear.entries.size(), 5 * (masses - 1));
}

TEST_F(LinearisationTest, AMeanFieldTakesTwoProductsForEachState) {
    make(40);
    const Expression mean = sum([](const Expression& one) { return sin(one); }) / 40;
    std::vector<Expression> rates;
    for (std::size_t i = 0; i < x.size(); ++i)
        rates.push_back(static_cast<double>(i) - x[i] + mean * cos(x[i]));
    const Linearisation linear = checked(rates);
    EXPECT_EQ(linear.intermediates, 1u);
    EXPECT_EQ(linear.entries.size(), 3 * x.size());
    EXPECT_EQ(linear.varying_entries(), 3 * x.size());
}

TEST_F(LinearisationTest, QuotientsByPowersOfMeansPassThroughTheMean) {
    make(20);
    const Expression mean = sum([](const Expression& one) { return sin(one); });
    std::vector<Expression> functions;
    for (const Expression& one : x)
        functions.push_back(one / pow(mean, 2) + cos(one) / pow(mean, 3));
    const Linearisation linear = checked(functions);
    EXPECT_GT(linear.intermediates, 0u);
    EXPECT_LT(linear.entries.size(), 100u);
}

TEST_F(LinearisationTest, PartialSumsAreNoIntermediates) {
    make(40);
    // The mean of linear terms, summed from both ends: products of numbers only.
    const Expression mean = sum([](const Expression& one) { return 0.3 * one; });
    Expression back = x.back() * 1.5;
    for (std::size_t i = x.size() - 1; i-- > 0;)
        back = x[i] * 1.5 + back;
    std::vector<Expression> rates;
    for (const Expression& own : x)
        rates.push_back(mean - 2 * own - 3 * back);
    const Linearisation linear = checked(rates);
    // Both sums enter every row only through one combination: at most one intermediate is needed.
    EXPECT_LE(linear.intermediates, 2u);
    EXPECT_LE(linear.entries.size(), 5 * x.size());
    EXPECT_EQ(linear.varying_entries(), 0u);
}

TEST_F(LinearisationTest, NestedMeansAreIntermediatesOfOneAnother) {
    make(30);
    const Expression first = sum([](const Expression& one) { return sin(one); });
    const Expression second = exp(first / 30) * sum([](const Expression& one) { return one * one; });
    std::vector<Expression> rates;
    for (const Expression& own : x)
        rates.push_back(second * own - first * cos(own));
    const Linearisation linear = checked(rates);
    EXPECT_GE(linear.intermediates, 2u);
    EXPECT_LE(linear.intermediates, 3u);
    EXPECT_LE(linear.entries.size(), 5 * x.size() + 2);
}

TEST_F(LinearisationTest, SumsOfSumsFormAChain) {
    make(60);
    std::vector<Expression> rates{sin(x[0])};
    for (std::size_t i = 1; i < x.size(); ++i)
        rates.push_back(rates.back() + sin(x[i]));
    const Linearisation linear = checked(rates);
    EXPECT_LE(linear.entries.size(), 3 * x.size());
    EXPECT_EQ(linear.varying_entries(), x.size());
}

TEST_F(LinearisationTest, EqualFunctionsShareTheirProducts) {
    make(12);
    const Expression one = exp(sum([](const Expression& own) { return own * own; }));
    const Linearisation linear = checked(std::vector(8, one));
    EXPECT_EQ(linear.intermediates, 1u);
    EXPECT_EQ(linear.entries.size(), 12u + 8u);
    EXPECT_EQ(linear.varying_entries(), 12u);
}

TEST_F(LinearisationTest, DenseRowsWithoutSharedPartsStayDense) {
    make(8);
    std::vector<Expression> rates;
    for (std::size_t i = 0; i < x.size(); ++i) {
        Expression rate = graph->number(0);
        for (std::size_t j = 0; j < x.size(); ++j)
            rate = rate + sin(x[j] - static_cast<double>(2 + i) * x[i]);
        rates.push_back(rate);
    }
    const Linearisation linear = checked(rates);
    EXPECT_EQ(linear.intermediates, 0u);
    EXPECT_EQ(linear.entries.size(), 64u);
}

TEST_F(LinearisationTest, IndependentPartsAreJudgedSeparately) {
    make(20);
    const Expression mean = sum([](const Expression& one) { return sin(one); });
    std::vector<Expression> rates;
    for (const Expression& own : x)
        rates.push_back(mean * own);
    const std::size_t alone = linearise(rates, SymbolIndex(x), 20).cost();
    std::vector<Expression> variables = x;
    for (const char* name : {"y1", "y2", "y3"})
        variables.push_back(add(name));
    for (const char* text : {"y1*y2 + y2*y3^2 - y3*y1", "y2/y3", "y1*sin(y3)"})
        rates.push_back(parse(text));
    rates.push_back(parse("y1*sin(y2)"));
    const Linearisation linear = checked(rates, SymbolIndex(variables), variables.size());
    const Linearisation other =
        linearise(std::span(rates).subspan(20), SymbolIndex(std::span<const Expression>(variables).subspan(20)), 3);
    EXPECT_EQ(linear.cost(), alone + other.cost());
}

TEST_F(LinearisationTest, ParametersDoNotAffectTheChoiceOfIntermediates) {
    make(3);
    std::vector<Expression> variables = x;
    Expression shared = graph->number(1);
    for (int i = 1; i <= 20; ++i) {
        variables.push_back(add("p" + std::to_string(i)));
        shared = shared + sin(variables.back());
    }
    const std::vector<Expression> rates{shared * x[1], shared * x[2] - x[0], shared - x[0] * x[1] * variables[3]};
    const Linearisation linear = checked(rates, SymbolIndex(variables), 3);
    EXPECT_EQ(linear.intermediates, 0u);
    std::size_t by_states = 0, varying = 0;
    for (const LinearEntry& entry : linear.entries)
        if (entry.source < 3) {
            ++by_states;
            varying += entry.varies ? 1 : 0;
        }
    EXPECT_EQ(by_states, 5u);
    EXPECT_EQ(varying, 2u);
    // A parameter acts on a mean of states.
    const Expression mean = sum([&](const Expression& one) { return variables[4] * pow(one, 2); });
    const Linearisation through = checked(std::vector(5, mean), SymbolIndex(variables), 3);
    EXPECT_EQ(through.intermediates, 1u);
    EXPECT_EQ(through.entries.size(), 3u + 1u + 5u);
}

TEST_F(LinearisationTest, CancelledDerivativesLeaveNoEntries) {
    make(4);
    // Simplification does not recognise either as constant; differentiation does.
    const Expression still = (x[0] - x[1]) + (x[1] - x[0]) + 1, total = sum([](const Expression&one) { return one; });
    std::vector<Expression> rates;
    for (const Expression& own : x)
        rates.push_back(still * own + total * own * still);
    checked(rates);
    checked(std::vector{still, still, sin(still)});
}

TEST_F(LinearisationTest, ForeignVariablesAndWrongNumbersThrow) {
    make(2);
    const auto other = Graph::create();
    const std::vector<Expression> foreign{other->symbol("x1")}, functions{x[0]};
    EXPECT_THROW(linearise(functions, SymbolIndex(foreign), 1), InputError);
    EXPECT_THROW(linearise(functions, SymbolIndex(x), 3), InputError);
    EXPECT_THROW(linearise(functions, SymbolIndex(x), 2, 0), InputError);
    EXPECT_THROW(linearise(functions, SymbolIndex(x), 2, 1000001), InputError);
    EXPECT_THROW(linearise(std::vector{x[0], foreign[0]}, SymbolIndex(x), 2), InputError);
    EXPECT_THROW(linearise(std::vector{Expression()}, SymbolIndex(x), 2), InputError);
}

/// Random functions with shared parts: each operation takes any two earlier results.
std::vector<Expression> random_functions(Graph& graph, std::span<const Expression> leaves, std::mt19937_64& random) {
    std::vector<Expression> parts(leaves.begin(), leaves.end());
    for (const double number : {-1.0, 0.5, 2.0, 3.0})
        parts.push_back(graph.number(number));
    static constexpr Operation of_one[] = {Operation::negate, Operation::sin, Operation::cos, Operation::tanh,
                                           Operation::atan};
    static constexpr Operation of_two[] = {Operation::add,      Operation::add,      Operation::add,
                                           Operation::subtract, Operation::multiply, Operation::multiply};
    const std::size_t operations = 5 + random() % 60;
    for (std::size_t i = 0; i < operations; ++i) {
        const Expression a = parts[random() % parts.size()], b = parts[random() % parts.size()];
        switch (random() % 6) {
        case 0:
            parts.push_back(graph.apply(of_one[random() % std::size(of_one)], a));
            break;
        case 1: // no poles
            parts.push_back(a / (2 + sin(b)));
            break;
        case 2:
            parts.push_back(pow(1.5 + cos(a), random() % 2 ? graph.number(2.5) : sin(b)));
            break;
        default:
            parts.push_back(graph.apply(of_two[random() % std::size(of_two)], a, b));
        }
    }
    std::vector<Expression> functions;
    for (std::size_t i = 1 + random() % 8; i > 0; --i)
        functions.push_back(parts[parts.size() - 1 - random() % std::min<std::size_t>(parts.size(), 25)]);
    return functions;
}

TEST(RandomLinearisation, EqualsTheJacobianAndIsSeldomMoreExpensive) {
    std::mt19937_64 random(23);
    std::size_t with_intermediates = 0, saved = 0, dearer = 0;
    for (int trial = 0; trial < 600; ++trial) {
        const auto graph = Graph::create();
        std::vector<Expression> variables;
        const std::size_t states = 1 + random() % 6, parameters = random() % 3;
        for (std::size_t i = 0; i < states + parameters; ++i)
            variables.push_back(graph->symbol("z" + std::to_string(i)));
        const std::vector<Expression> functions = random_functions(*graph, variables, random);
        const SymbolIndex index(variables);
        const SymbolIndex of_states{std::span<const Expression>(variables).first(states)};
        const Linearisation linear = linearise(functions, index, states);
        expect_order(linear);
        std::vector<double> at;
        for (std::size_t i = 0; i < variables.size(); ++i)
            at.push_back(std::uniform_real_distribution<>(-1, 1)(random));
        expect_same(linear, functions, index, at, 1e-12, "trial " + std::to_string(trial));
        // So many directions that the cost of coefficients does not matter.
        const std::size_t cost = linearise(functions, of_states, states, 1000000).cost(),
                          plain = plain_linearisation(functions, of_states, states).cost();
        dearer += cost > plain ? 1 : 0;
        with_intermediates += linear.intermediates > 0 ? 1 : 0;
        saved += plain - std::min(plain, cost);
    }
    // Where a part is constant in disguise, as x - (x - 1), its derivatives need not cancel symbolically.
    EXPECT_LT(dearer, 6u);
    EXPECT_GT(with_intermediates, 100u);
    EXPECT_GT(saved, 1000u);
}

TEST(RandomLinearisation, IsFiniteForTreesWhereTheJacobianIs) {
    testing::RandomOperations trees(5, 3, true);
    int compared = 0;
    for (int trial = 0; trial < 600; ++trial) {
        const auto graph = Graph::create();
        const std::vector<Expression> variables{graph->symbol("a"), graph->symbol("b"), graph->symbol("c")};
        std::vector<Expression> functions;
        for (int i = 0; i < 3; ++i)
            functions.push_back(trees.next(1 + static_cast<std::size_t>(trial % 12)).build(*graph, variables));
        const SymbolIndex index(variables);
        const std::vector<double> at{trees.uniform(0.1, 2), trees.uniform(-2, 2), trees.uniform(0.5, 3)};
        const Linearisation linear = linearise(functions, index, 3);
        expect_order(linear);
        const std::vector<double> plain = plain_derivatives(functions, index, at);
        const DenseDerivatives derivatives = multiplied_out(linear, index, at);
        const std::vector<double> values = Function(index, functions)(at);
        for (std::size_t row = 0; row < 3; ++row) {
            const auto finite = [](double value) { return std::isfinite(value); };
            const std::span of_plain = std::span(plain).subspan(3 * row, 3);
            /// Coefficients at a singularity are undefined, and need not cancel even where the function does not depend
            /// on the variable.
            if (!finite(values[row]) || !std::ranges::all_of(of_plain, finite))
                continue;
            const std::span own = std::span(derivatives.values).subspan(3 * row, 3);
            EXPECT_TRUE(std::ranges::all_of(own, finite)) << trial << ' ' << to_string(functions[row]);
            ++compared;
        }
    }
    EXPECT_GT(compared, 900);
}

} // namespace graze::linearisation_test
