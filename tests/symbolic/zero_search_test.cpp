#include "graze/symbolic/zero_search.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/parser.hpp"
#include "graze/symbolic/transform.hpp"
#include "symbolic/operation_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace graze::zero_search_test {

constexpr double unit = std::numeric_limits<double>::epsilon();
using Values = std::vector<double>;

/// Functions of unknowns and parameters, from text.
struct Equations {
    std::vector<std::string> unknowns;
    std::vector<std::string> functions;
    std::vector<std::string> parameters{};

    Function compiled() const {
        const auto graph = Graph::create();
        Scope scope;
        std::vector<Expression> inputs, outputs;
        for (const auto* names : {&unknowns, &parameters})
            for (const auto& name : *names)
                inputs.push_back(scope[name] = graph->symbol(name));
        for (const auto& text : functions)
            outputs.push_back(parse_expression(*graph, text, scope));
        for (const Expression& slope : jacobian(outputs, std::span(inputs).first(unknowns.size())))
            outputs.push_back(slope);
        return {inputs, outputs};
    }
    ZeroSearch zeros(const Values& lower, const Values& upper, const Values& values = {},
                     const ZeroSearchSettings& settings = {}) const {
        return find_zeros(compiled(), lower, upper, values, settings);
    }
};

/// Expects these zeros and no others, proven, with a tolerance of some units in the last place of `size`.
void expect_zeros(const ZeroSearch& found, std::vector<Values> expected, double size = 1) {
    EXPECT_EQ(found.ending, ZeroSearch::Ending::complete);
    EXPECT_TRUE(found.undecided.empty() && found.unexamined.empty());
    ASSERT_EQ(found.zeros.size(), expected.size());
    const auto distance = [](const Values& one, const Values& other) {
        double largest = 0;
        for (std::size_t i = 0; i < one.size(); ++i)
            largest = std::max(largest, std::abs(one[i] - other[i]));
        return largest;
    };
    for (const Values& zero : expected) {
        const auto nearest = std::ranges::min_element(
            found.zeros, {}, [&](const VerifiedZero& other) { return distance(zero, other.values); });
        EXPECT_LE(distance(zero, nearest->values), 64 * unit * size);
        for (std::size_t i = 0; i < zero.size(); ++i) {
            EXPECT_TRUE(nearest->enclosure[i].contains(nearest->values[i]));
            EXPECT_TRUE(nearest->alone[i].contains(nearest->enclosure[i]));
            EXPECT_LE(nearest->enclosure[i].lower, zero[i] + 2 * unit * size); // `zero` is rounded
            EXPECT_GE(nearest->enclosure[i].upper, zero[i] - 2 * unit * size);
            EXPECT_LE(nearest->enclosure[i].width(), 256 * unit * size);
        }
    }
    EXPECT_TRUE(std::ranges::is_sorted(found.zeros, {}, &VerifiedZero::values));
}

TEST(ZeroSearchTest, FindsRootsOfPolynomials) {
    expect_zeros(Equations{{"x"}, {"x^2 - 2"}}.zeros({-9}, {9}), {{-std::sqrt(2)}, {std::sqrt(2)}});
    expect_zeros(Equations{{"x"}, {"x^2 + 2"}}.zeros({-9}, {9}), {});
    // Wilkinson's polynomial, as a product.
    std::string product = "1";
    std::vector<Values> roots;
    for (int root = 1; root <= 20; ++root) {
        product += "*(x - " + std::to_string(root) + ")";
        roots.push_back({static_cast<double>(root)});
    }
    expect_zeros(Equations{{"x"}, {product}}.zeros({0}, {21}), roots);
    // As a sum, with terms 1e3 times its value, whose round-off is that much larger.
    expect_zeros(Equations{{"x"}, {"x^4 - 10*x^3 + 35*x^2 - 50*x + 24"}}.zeros({-8}, {7}), {{1}, {2}, {3}, {4}}, 100);
}

TEST(ZeroSearchTest, FindsIntersections) {
    const double h = std::sqrt(3) / 2, r = std::sqrt(0.5);
    expect_zeros(Equations{{"x", "y"}, {"x^2 + y^2 - 1", "(x - 1)^2 + y^2 - 1"}}.zeros({-3, -3}, {3, 3}),
                 {{0.5, -h}, {0.5, h}});
    expect_zeros(Equations{{"x", "y"}, {"x^2 + y^2 - 1", "x - y"}}.zeros({-3, -3}, {3, 3}), {{-r, -r}, {r, r}});
    expect_zeros(Equations{{"x", "y"}, {"x^2 + y^2 - 1", "x - 2"}}.zeros({-3, -3}, {3, 3}), {});
    // A part of the circle that the box does not contain.
    expect_zeros(Equations{{"x", "y"}, {"x^2 + y^2 - 1", "x - y"}}.zeros({0, -3}, {3, 3}), {{r, r}});
}

TEST(ZeroSearchTest, FindsEquilibriaOfKnownSystems) {
    const Equations lorenz{{"x", "y", "z"}, {"10*(y - x)", "x*(rho - z) - y", "x*y - 8/3*z"}, {"rho"}};
    const Values low{-50, -50, -50}, high{50, 50, 100};
    const double c = std::sqrt(8.0 / 3 * 27);
    expect_zeros(lorenz.zeros(low, high, {28}), {{-c, -c, 27}, {0, 0, 0}, {c, c, 27}}, 10);
    expect_zeros(lorenz.zeros(low, high, {0.5}), {{0, 0, 0}});
    // At the pitchfork the three are one.
    const ZeroSearch pitchfork = lorenz.zeros(low, high, {1});
    EXPECT_EQ(pitchfork.ending, ZeroSearch::Ending::complete);
    EXPECT_TRUE(pitchfork.zeros.empty());
    ASSERT_EQ(pitchfork.undecided.size(), 1u);
    for (const Interval& side : pitchfork.undecided[0])
        EXPECT_TRUE(side.contains(0) && side.width() < 1e-5);

    expect_zeros(
        Equations{{"x", "y"}, {"a - (b + 1)*x + x^2*y", "b*x - x^2*y"}, {"a", "b"}}.zeros({-9, -9}, {9, 9}, {1, 3}),
        {{1, 3}}, 3);
    // Bratu's problem in n points: symmetric; two solutions below the fold.
    std::vector<std::string> names{"a", "b", "c", "d", "e"}, functions;
    for (std::size_t k = 0; k < 5; ++k)
        functions.push_back((k > 0 ? names[k - 1] : "0") + " - 2*" + names[k] + " + " + (k < 4 ? names[k + 1] : "0") +
                            " + lambda/36*exp(" + names[k] + ")");
    const Equations bratu{names, functions, {"lambda"}};
    for (const auto& [lambda, count] : {std::pair(2.0, 2u), std::pair(3.4, 2u), std::pair(3.7, 0u)}) {
        const ZeroSearch found = bratu.zeros(Values(5, -1), Values(5, 10), {lambda});
        EXPECT_EQ(found.ending, ZeroSearch::Ending::complete);
        EXPECT_TRUE(found.undecided.empty());
        EXPECT_EQ(found.zeros.size(), count);
        for (const VerifiedZero& zero : found.zeros)
            EXPECT_NEAR(zero.values[0], zero.values[4], 1e-14);
    }
    EXPECT_TRUE(Equations({{"x", "y"}, {"x^2 + y^2 + 1", "x - y"}}).zeros({-1e6, -1e6}, {1e6, 1e6}).zeros.empty());
}

/// A plate in units of metres and newtons: k q = c/(d - q)^2 with c = 4/27 s k d^3 has two equilibria below the pole
/// for s < 1, one for s = 1 at q = d/3, none for s > 1; and one beyond.
TEST(ZeroSearchTest, FindsEquilibriaOfAPlateInNanometres) {
    const Equations plate{{"q"}, {"k*q - c/(d - q)^2"}, {"k", "c", "d"}};
    const double k = 1.5, d = 2e-6;
    const auto found = [&](double s, double upper) {
        return plate.zeros({0}, {upper}, {k, 4.0 / 27 * s * k * d * d * d, d});
    };
    // q = d (1 - w) with (1 - w) w^2 = 4 s/27: w = (1 + 2 cos(angle))/3.
    const double s = 0.5, angle = std::acos(1 - 2 * s) / 3;
    std::vector<Values> expected;
    for (const int turn : {0, 1, 2})
        expected.push_back({d * (1 - (1 + 2 * std::cos(angle + 2 * std::numbers::pi * turn / 3)) / 3)});
    std::ranges::sort(expected);
    expect_zeros(found(s, 2 * d), expected, 4 * d);
    expected.pop_back();
    expect_zeros(found(s, 0.99 * d), expected, 4 * d);
    expect_zeros(found(1.0001, 0.99 * d), {}); // up to close to the pole, and beyond it to where the third is
    expect_zeros(found(1.0001, 1.2 * d), {});
    const ZeroSearch fold = found(1, 0.99 * d);
    EXPECT_EQ(fold.ending, ZeroSearch::Ending::complete);
    EXPECT_TRUE(fold.zeros.empty());
    ASSERT_EQ(fold.undecided.size(), 1u);
    EXPECT_TRUE(fold.undecided[0][0].contains(d / 3));
    EXPECT_LT(fold.undecided[0][0].width(), 1e-6 * d);
    EXPECT_EQ(found(0.999999, 0.99 * d).zeros.size(), 2u);
}

TEST(ZeroSearchTest, SingularZerosAreOneUndecidedBox) {
    const auto one_box = [](const Equations& equations, const Values& at, double extent) {
        const std::size_t n = at.size();
        const ZeroSearch found = equations.zeros(Values(n, -4), Values(n, 3));
        EXPECT_EQ(found.ending, ZeroSearch::Ending::complete);
        EXPECT_TRUE(found.zeros.empty());
        ASSERT_EQ(found.undecided.size(), 1u);
        for (std::size_t i = 0; i < n; ++i) {
            EXPECT_TRUE(found.undecided[0][i].contains(at[i]));
            EXPECT_LT(found.undecided[0][i].width(), extent);
        }
    };
    one_box({{"x"}, {"(x - 1)^2"}}, {1}, 1e-7);
    one_box({{"x"}, {"x^2 - 2*x + 1"}}, {1}, 1e-6);         // round-off hides what is nearer than 1e-8
    one_box({{"x"}, {"x^3 - 3*x^2 + 3*x - 1"}}, {1}, 1e-4); // 1e-5
    one_box({{"x", "y"}, {"x^2 + y^2 - 1", "(x - 2)^2 + y^2 - 1"}}, {1, 0}, 1e-6);
    one_box({{"x", "y"}, {"x^2 - y^2", "2*x*y"}}, {0, 0}, 1e-6);
    one_box({{"x", "y", "z"}, {"x + y + z", "y - z + x^2", "x + 2*y + x*y"}}, {0, 0, 0}, 1e-6);
    // A double zero beside a simple one.
    const ZeroSearch both = Equations{{"x"}, {"x^2*(x - 1)"}}.zeros({-3}, {3});
    ASSERT_EQ(both.zeros.size(), 1u);
    EXPECT_EQ(both.zeros[0].values[0], 1);
    ASSERT_EQ(both.undecided.size(), 1u);
    EXPECT_TRUE(both.undecided[0][0].contains(0));
    // Zeros that nearly meet are told apart.
    expect_zeros(Equations{{"x"}, {"x^2 - 1e-14"}}.zeros({-3}, {3}), {{-1e-7}, {1e-7}});
    expect_zeros(Equations{{"x", "y"}, {"x^2 - 1e-12 + y", "y"}}.zeros({-3, -3}, {3, 3}), {{-1e-6, 0}, {1e-6, 0}});
    expect_zeros(Equations{{"x", "y"}, {"x^2 + 1e-12 + y", "y"}}.zeros({-3, -3}, {3, 3}), {});
}

/// Zeros between parts of the box and at its edges are found once, wherever the box is.
TEST(ZeroSearchTest, FindsEachZeroOnce) {
    const Equations cubic{{"x"}, {"x*(x - 1)*(x + 1)"}};
    expect_zeros(cubic.zeros({-1}, {1}), {{-1}, {0}, {1}});
    expect_zeros(cubic.zeros({0}, {1}), {{0}, {1}});
    expect_zeros(cubic.zeros({0}, {0.5}), {{0}});
    expect_zeros(cubic.zeros({1 + 1e-12}, {3}), {});
    expect_zeros(Equations{{"x", "y"}, {"x^2 + y^2 - 1", "x*y"}}.zeros({0, 0}, {1, 1}), {{0, 1}, {1, 0}});
    const Equations lattice{{"x", "y"}, {"sin(x + 0.2*y)", "sin(y)*(2 + cos(x))"}};
    std::mt19937 engine(3);
    std::uniform_real_distribution<> place(-3, 3);
    for (int trial = 0; trial < 100; ++trial) {
        const double left = -4 + place(engine), below = -4 + place(engine);
        const double right = 4 + place(engine), above = 4 + place(engine);
        std::vector<Values> expected;
        for (int i = -9; i <= 9; ++i)
            for (int j = -9; j <= 9; ++j) {
                const double y = j * std::numbers::pi, x = i * std::numbers::pi - 0.2 * y;
                if (x >= left && x <= right && y >= below && y <= above)
                    expected.push_back({x, y});
            }
        expect_zeros(lattice.zeros({left, below}, {right, above}), expected, 10);
    }
    // The first cut of this box goes through 0.
    expect_zeros(lattice.zeros({-0.4937, -0.4937}, {0.5063, 0.5063}), {{0, 0}});
}

TEST(ZeroSearchTest, FindsAllZerosOfRandomSystems) {
    // Products of linear factors, in random directions: the zeros are where one factor of each function is zero.
    std::mt19937 engine(11);
    std::uniform_real_distribution<> share(-1, 1);
    for (int trial = 0; trial < 60; ++trial) {
        const std::size_t factors = 1 + engine() % 3;
        double a[2][2] = {{1 + 0.3 * share(engine), 0.5 * share(engine)},
                          {0.5 * share(engine), 1 + 0.3 * share(engine)}};
        std::vector<Values> roots(2);
        std::vector<std::string> functions;
        for (int row = 0; row < 2; ++row) {
            std::string text = "1";
            for (std::size_t k = 0; k < factors; ++k) {
                roots[row].push_back(static_cast<double>(k) - 1 + 0.3 * share(engine));
                text += "*(" + std::to_string(a[row][0]) + "*x + " + std::to_string(a[row][1]) + "*y - (" +
                        std::to_string(roots[row].back()) + "))";
                roots[row].back() = std::stod(std::to_string(roots[row].back()));
            }
            functions.push_back(text);
            for (int column = 0; column < 2; ++column)
                a[row][column] = std::stod(std::to_string(a[row][column]));
        }
        const double size = 2 + share(engine), determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];
        std::vector<Values> expected;
        for (const double p : roots[0])
            for (const double q : roots[1]) {
                const Values zero{(p * a[1][1] - q * a[0][1]) / determinant, (q * a[0][0] - p * a[1][0]) / determinant};
                if (std::abs(zero[0]) < size && std::abs(zero[1]) < size)
                    expected.push_back(zero);
            }
        expect_zeros(Equations{{"x", "y"}, functions}.zeros({-size, -size}, {size, size}), expected, 20);
    }
}

/// Newton's method, without any of the code that is tested. @return none where it does not converge, or round-off
/// makes the zero uncertain, as where it is nearly singular
std::optional<Values> newton_limit(const Function& function, Values at) {
    double last = 1, uncertain = 1;
    std::vector<double> bounds(function.outputs()), work(2 * function.workspace());
    for (int step = 0; step < 60 && last != 0; ++step) {
        const Values out = function(at);
        const double determinant = out[2] * out[5] - out[3] * out[4];
        const Values change{(out[0] * out[5] - out[1] * out[3]) / determinant,
                            (out[1] * out[2] - out[0] * out[4]) / determinant};
        function.error_bounds(at, Values{1e-16, 1e-16}, bounds, work);
        uncertain =
            ((std::abs(out[5]) + std::abs(out[4])) * bounds[0] + (std::abs(out[3]) + std::abs(out[2])) * bounds[1]) /
            std::abs(determinant);
        last = std::max(std::abs(change[0]), std::abs(change[1]));
        if (!std::isfinite(last))
            return std::nullopt;
        at = {at[0] - change[0], at[1] - change[1]};
    }
    return last < 1e-13 && uncertain < 1e-12 ? std::optional(at) : std::nullopt;
}

/// True if both functions are 0 as far as round-off and these errors of the unknowns tell.
bool is_zero(const Function& function, const Values& at, const Values& errors) {
    std::vector<double> bounds(function.outputs()), work(2 * function.workspace());
    function.error_bounds(at, errors, bounds, work);
    const Values out = function(at);
    return std::abs(out[0]) <= 4 * bounds[0] && std::abs(out[1]) <= 4 * bounds[1];
}

/// A limit such as that of x^2/x is no zero.
bool is_defined_around(const Function& function, const Values& at) {
    std::vector<Interval> box, values(function.outputs()), work(function.workspace());
    for (const double place : at)
        box.push_back({place - 1e-13, place + 1e-13});
    function.enclose(box, values, work);
    return values[0].continuous && values[1].continuous;
}

/// Random expressions, with poles, domains and singular zeros: what Newton's method finds from many places is among the
/// zeros, or in a box that is left; and each zero is one.
TEST(ZeroSearchTest, LosesAndInventsNothing) {
    const Values lower{-2.03, -2.57}, upper{1.71, 2.09};
    testing::RandomOperations random(17, 2, true);
    const IntervalBox whole{{lower[0], upper[0]}, {lower[1], upper[1]}};
    std::size_t met = 0, proven = 0;
    for (int trial = 0; trial < 1500; ++trial) {
        const auto graph = Graph::create();
        const std::vector<Expression> unknowns{graph->symbol("x"), graph->symbol("y")};
        std::vector<Expression> outputs;
        for (int row = 0; row < 2; ++row)
            outputs.push_back(random.next(2 + static_cast<std::size_t>(trial) % 7).build(*graph, unknowns));
        const std::string text = to_string(outputs[0]) + " and " + to_string(outputs[1]);
        // With such numbers Newton's method ends where there is no zero.
        if (text.find("e+1") != std::string::npos)
            continue;
        for (const Expression& slope : jacobian(outputs, unknowns))
            outputs.push_back(slope);
        const Function function(unknowns, outputs);
        const ZeroSearch found = find_zeros(function, lower, upper, {}, {.boxes = 1000});
        const auto is_in = [](const IntervalBox& box, const Values& at) {
            return std::abs(at[0] - box[0].middle()) <= box[0].width() / 2 + 1e-12 &&
                   std::abs(at[1] - box[1].middle()) <= box[1].width() / 2 + 1e-12;
        };
        const auto is_left = [&](const std::vector<IntervalBox>& boxes, const Values& at) {
            return std::ranges::any_of(boxes, [&](const IntervalBox& box) { return is_in(box, at); });
        };
        for (int start = 0; start < 20; ++start) {
            const auto limit =
                newton_limit(function, {random.uniform(lower[0], upper[0]), random.uniform(lower[1], upper[1])});
            if (!limit || !is_in(whole, *limit) || !is_zero(function, *limit, {1e-15, 1e-15}) ||
                !is_defined_around(function, *limit))
                continue;
            const bool known = std::ranges::any_of(
                found.zeros, [&](const VerifiedZero& zero) { return is_in(zero.enclosure, *limit); });
            EXPECT_TRUE(known || is_left(found.undecided, *limit) || is_left(found.unexamined, *limit))
                << text << " at " << (*limit)[0] << ", " << (*limit)[1];
            met += known;
        }
        for (const VerifiedZero& zero : found.zeros) {
            ++proven;
            EXPECT_TRUE(is_zero(function, zero.values, {zero.enclosure[0].width(), zero.enclosure[1].width()})) << text;
        }
    }
    EXPECT_GT(met, 300u);
    EXPECT_GT(proven, 40u);
}

TEST(ZeroSearchTest, DoesNotDependOnUnits) {
    // With powers of two as units all numbers are the same but for their exponents.
    const Equations equations{
        {"x", "y"}, {"f*((x/u)^2 + (y/v)^2 - 4)", "g*((x/u)*(y/v)^2 - x/u - 0.25)"}, {"u", "v", "f", "g"}};
    const auto found = [&](double u, double v, double f, double g) {
        return equations.zeros({-3 * u, -4 * v}, {4 * u, 3 * v}, {u, v, f, g});
    };
    const ZeroSearch plain = found(1, 1, 1, 1);
    EXPECT_EQ(plain.zeros.size(), 6u);
    for (const double u : {std::ldexp(1, -30), std::ldexp(1, 20)}) {
        const double v = 1 / u;
        const ZeroSearch scaled = found(u, v, u * u, v);
        EXPECT_EQ(scaled.boxes, plain.boxes);
        ASSERT_EQ(scaled.zeros.size(), plain.zeros.size());
        for (std::size_t k = 0; k < plain.zeros.size(); ++k) {
            EXPECT_EQ(scaled.zeros[k].values[0], u * plain.zeros[k].values[0]);
            EXPECT_EQ(scaled.zeros[k].values[1], v * plain.zeros[k].values[1]);
            EXPECT_EQ(scaled.zeros[k].enclosure[0].lower, u * plain.zeros[k].enclosure[0].lower);
        }
    }
}

TEST(ZeroSearchTest, PassesPolesAndEdgesOfDomains) {
    // On either side of a pole the function has other signs, without a zero between them.
    expect_zeros(Equations{{"x"}, {"1/(x - 1) + 1"}}.zeros({-3}, {3}), {{0}});
    expect_zeros(Equations{{"x"}, {"1/(x - 1/3) + 1/(x + 1/3)"}}.zeros({-3}, {3}), {{0}});
    std::vector<Values> tangent;
    for (int k = -3; k <= 3; ++k)
        tangent.push_back({std::numbers::pi * k + std::atan(2)});
    expect_zeros(Equations{{"x"}, {"tan(x) - 2"}}.zeros({-10}, {11}), tangent, 10);
    // A line of poles across the box: x = y, where |x| is at most 3.
    const ZeroSearch line = Equations{{"x", "y"}, {"1/(x - y) + x", "x^2 + y^2 - 4"}}.zeros({-3, -3}, {3, 3});
    EXPECT_EQ(line.ending, ZeroSearch::Ending::complete);
    EXPECT_TRUE(line.undecided.empty());
    EXPECT_LT(line.boxes, 1000u);
    // Beyond the edge of a domain there is no zero; up to it there is.
    const double x = (3 - std::sqrt(5)) / 2;
    expect_zeros(Equations{{"x", "y"}, {"sqrt(x) + y - 1", "y - x"}}.zeros({-3, -3}, {3, 3}), {{x, x}});
    expect_zeros(Equations{{"x", "y"}, {"log(x) - y", "y + 1"}}.zeros({-3, -3}, {3, 3}), {{std::exp(-1), -1}});
    expect_zeros(Equations{{"x"}, {"(x - 1)^1.5 + x - 2"}}.zeros({-3}, {4}), {{1 + 0.5698402909980532659}});
    expect_zeros(Equations{{"x"}, {"log(x)"}}.zeros({-3}, {-1}), {});
    // Proofs hold where all is defined.
    const ZeroSearch beside = Equations{{"x"}, {"(x - 1)^1.5 + x - 1.01"}}.zeros({-3}, {4});
    ASSERT_EQ(beside.zeros.size(), 1u);
    EXPECT_GE(beside.zeros[0].alone[0].lower, 1);
    // A function that jumps has a sign change without a zero.
    const ZeroSearch jump = Equations{{"x"}, {"atan(1/x)"}}.zeros({-1}, {1});
    EXPECT_TRUE(jump.zeros.empty());
    // Zeros that accumulate are left in one small box.
    const ZeroSearch many = Equations{{"x"}, {"sin(1/x)"}}.zeros({-1}, {1}, {}, {.resolution = 1e-4});
    EXPECT_EQ(many.ending, ZeroSearch::Ending::complete);
    EXPECT_GT(many.zeros.size(), 60u);
    ASSERT_EQ(many.undecided.size(), 1u);
    EXPECT_TRUE(many.undecided[0][0].contains(0));
}

TEST(ZeroSearchTest, ManyUnknownsThatDoNotDependOnEachOtherAreFast) {
    std::vector<std::string> names, functions;
    for (int k = 0; k < 10; ++k) {
        names.push_back("x" + std::to_string(k));
        functions.push_back(k < 6 ? names.back() + "^2 - 2"
                                  : names.back() + " - " + names[static_cast<std::size_t>(k) - 6]);
    }
    const ZeroSearch found = Equations{names, functions}.zeros(Values(10, -5), Values(10, 4));
    EXPECT_EQ(found.ending, ZeroSearch::Ending::complete);
    EXPECT_EQ(found.zeros.size(), 64u);
    EXPECT_LT(found.boxes, 1000u);
}

TEST(ZeroSearchTest, EndsAtItsLimits) {
    // A circle of zeros is covered as finely as the number of boxes allows.
    const Equations circle{{"x", "y"}, {"x^2 + y^2 - 1", "2*(x^2 + y^2 - 1)"}};
    ZeroSearchSettings settings{.boxes = 2000};
    ZeroSearch found = circle.zeros({-2, -2}, {2, 2}, {}, settings);
    EXPECT_EQ(found.ending, ZeroSearch::Ending::too_many_boxes);
    EXPECT_EQ(found.boxes, 2000u);
    EXPECT_TRUE(found.zeros.empty());
    ASSERT_EQ(found.unexamined.size(), 1u); // touching boxes are one
    EXPECT_NEAR(found.unexamined[0][0].lower, -1, 0.1);
    EXPECT_NEAR(found.unexamined[0][1].upper, 1, 0.1);
    int calls = 0;
    settings.interrupted = [&] { return ++calls > 10; };
    found = circle.zeros({-2, -2}, {2, 2}, {}, settings);
    EXPECT_EQ(found.ending, ZeroSearch::Ending::interrupted);
    EXPECT_EQ(found.boxes, 10u);
    EXPECT_FALSE(found.unexamined.empty());
    // A function that is zero everywhere.
    found = Equations{{"x"}, {"0*x"}}.zeros({-2}, {2});
    EXPECT_EQ(found.ending, ZeroSearch::Ending::complete);
    ASSERT_EQ(found.undecided.size(), 1u);
    EXPECT_EQ(found.undecided[0][0].width(), 4);
    // A resolution that numbers do not have.
    found = Equations{{"x"}, {"(x - 1e6)^2"}}.zeros({1e6 - 1e-7}, {1e6 + 1e-7});
    EXPECT_EQ(found.ending, ZeroSearch::Ending::complete);
    EXPECT_EQ(found.undecided.size(), 1u);
}

TEST(ZeroSearchTest, RefusesWrongInput) {
    const Equations equations{{"x"}, {"x - p"}, {"p"}};
    const double infinite = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(equations.zeros({0}, {1}), InputError);
    EXPECT_THROW(equations.zeros({0, 0}, {1, 1}, {}), InputError); // 2 outputs are not 2 functions with derivatives
    EXPECT_THROW(equations.zeros({0}, {1, 2}, {1}), InputError);
    EXPECT_THROW(equations.zeros({}, {}, {1}), InputError);
    EXPECT_THROW(equations.zeros({1}, {1}, {1}), InputError);
    EXPECT_THROW(equations.zeros({2}, {1}, {1}), InputError);
    EXPECT_THROW(equations.zeros({0}, {infinite}, {1}), InputError);
    EXPECT_THROW(equations.zeros({nan}, {1}, {1}), InputError);
    EXPECT_THROW(equations.zeros({0}, {1}, {nan}), InputError);
    EXPECT_THROW(equations.zeros({0}, {1}, {1}, {.resolution = 0}), InputError);
    EXPECT_THROW(equations.zeros({0}, {1}, {1}, {.boxes = 0}), InputError);
    expect_zeros(equations.zeros({0}, {1}, {0.25}), {{0.25}});
}

} // namespace graze::zero_search_test
