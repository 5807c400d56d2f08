#include "graze/symbolic/piece_table.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/parser.hpp"
#include "graze/symbolic/transform.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace graze::piece_table_test {

using Points = std::vector<PieceTable::Point>;
using Interpolation = PieceTable::Interpolation;
using Outside = PieceTable::Outside;

Points uneven(double last = -0.3) {
    return {{0, 0.2}, {0.5, 1}, {1.3, -0.5}, {2, 0.4}, {3.1, 0.9}, {4, last}};
}

PieceTable table(Interpolation interpolation, bool periodic = false, Outside outside = Outside::hold) {
    return {"f", uneven(periodic ? 0.2 : -0.3), {interpolation, periodic, outside}};
}

constexpr double places[] = {0.3, 0.9, 2.7, 3.9};

TEST(PieceTable, InterpolatesLinearly) {
    const PieceTable f = table(Interpolation::linear);
    EXPECT_DOUBLE_EQ(f.value(0.25, 0), 0.6);
    EXPECT_DOUBLE_EQ(f.value(0.25, 1), 1.6);
    EXPECT_EQ(f.value(0.25, 2), 0);
    for (const auto& [x, y] : uneven())
        EXPECT_EQ(f.value(x, 0), y);
}

TEST(PieceTable, SplinesAreThoseOfAnIndependentProgram) {
    // scipy.interpolate.CubicSpline of the same points, bc_type 'natural' and 'periodic': values, then slopes.
    const std::vector<double> natural{0.8570841914117597,   0.29640142330885116, 1.038987768790404,
                                      -0.13802148853567844, 1.5262149202451,     -2.574182944791622,
                                      0.07741878166528021,  -1.612623820110467};
    const std::vector<double> periodic{0.7677073102091255, 0.3496557372196467, 1.1077463923410853,  0.11241741922886439,
                                       1.8770534103342764, -2.645219980510512, 0.06254336672685049, 0.4999810536246234};
    for (const bool closed : {false, true}) {
        const PieceTable f = table(Interpolation::cubic, closed);
        const std::vector<double>& expected = closed ? periodic : natural;
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_NEAR(f.value(places[i], 0), expected[i], 1e-14);
            EXPECT_NEAR(f.value(places[i], 1), expected[4 + i], 1e-13);
        }
    }
}

TEST(PieceTable, SplinesAreTwiceDifferentiable) {
    for (const bool closed : {false, true}) {
        const PieceTable f = table(Interpolation::cubic, closed);
        for (std::size_t i = closed ? 0 : 1; i + 1 < uneven().size(); ++i)
            for (int derivative = 0; derivative < 3; ++derivative) {
                const double x = uneven()[i].x;
                EXPECT_NEAR(f.piece_at(x - 1e-9).at(x, derivative), f.value(x, derivative), 1e-12)
                    << x << ' ' << derivative;
            }
    }
    const PieceTable f = table(Interpolation::cubic);
    EXPECT_EQ(f.value(0, 2), 0);
    EXPECT_NEAR(f.value(4 - 1e-12, 2), 0, 1e-10);
}

TEST(PieceTable, PeriodicSplinesOfFewPoints) {
    const PieceTable one("f", {{0, 2}, {3, 2}}, {Interpolation::cubic, true, Outside::hold});
    EXPECT_EQ(one.value(1.7, 0), 2);
    const PieceTable two("f", {{0, 1}, {1, -1}, {2, 1}}, {Interpolation::cubic, true, Outside::hold});
    for (int derivative = 0; derivative < 3; ++derivative)
        for (const double x : {0.0, 1.0})
            EXPECT_NEAR(two.value(x, derivative), two.piece_at(x - 1e-6).at(x, derivative), 1e-12);
}

TEST(PieceTable, OutsideOfItsPoints) {
    for (const Interpolation interpolation : {Interpolation::linear, Interpolation::cubic}) {
        const PieceTable held = table(interpolation), straight = table(interpolation, false, Outside::linear),
                         none = table(interpolation, false, Outside::error);
        EXPECT_EQ(held.value(-3, 0), 0.2);
        EXPECT_EQ(held.value(7, 0), -0.3);
        EXPECT_EQ(held.value(7, 1), 0);
        EXPECT_NEAR(straight.value(7, 0), -0.3 + 3 * straight.value(4 - 1e-13, 1), 1e-10);
        EXPECT_NEAR(straight.value(-1, 0), 0.2 - straight.value(0, 1), 1e-13);
        EXPECT_TRUE(std::isnan(none.value(4.1, 0)));
        EXPECT_TRUE(std::isnan(none.value(-0.1, 0)));
        EXPECT_NEAR(none.value(4, 0), -0.3, 1e-13);
        for (const PieceTable& f : {held, straight, none})
            EXPECT_TRUE(std::isnan(f.value(std::numeric_limits<double>::quiet_NaN(), 0)));
    }
    const PieceTable wave = table(Interpolation::cubic, true);
    for (const double x : places)
        for (const int periods : {-7, 1, 30})
            EXPECT_NEAR(wave.value(x + 4 * periods, 0), wave.value(x, 0), 1e-13);
    EXPECT_TRUE(std::isnan(wave.value(std::numeric_limits<double>::infinity(), 0)));
}

TEST(PieceTable, EnclosuresContainAllValues) {
    for (const bool closed : {false, true})
        for (const Interpolation interpolation : {Interpolation::linear, Interpolation::cubic}) {
            const PieceTable f = table(interpolation, closed, Outside::linear);
            for (const Interval x : {Interval{0.1, 0.4}, Interval{-1, 2.2}, Interval{1.3, 1.3}, Interval{-9, 9}})
                for (int derivative = 0; derivative < 3; ++derivative) {
                    const Interval all = f.enclose(x, derivative);
                    for (int i = 0; i <= 1000; ++i) {
                        const double value = f.value(x.lower + 1e-3 * i * (x.upper - x.lower), derivative);
                        EXPECT_LE(all.lower, value + 1e-13);
                        EXPECT_GE(all.upper, value - 1e-13);
                    }
                    EXPECT_LT(all.magnitude(), 100);
                }
        }
}

TEST(PieceTable, IsPartOfExpressionsWithItsDerivatives) {
    const auto graph = Graph::create();
    graph->add_table(std::make_shared<const PieceTable>(table(Interpolation::cubic)));
    const Expression x = graph->symbol("x");
    const Scope scope{{"x", x}};
    const Expression y = parse_expression(*graph, "x*f(2*x)", scope), slope = differentiate(y, x);
    EXPECT_EQ(to_string(y), "x*f(2*x)");
    const Function function(std::vector{x}, std::vector{y, slope, differentiate(slope, x)});
    for (const double at : places) {
        const double step = 1e-5;
        const auto here = function(std::vector{at / 2}), above = function(std::vector{at / 2 + step}),
                   below = function(std::vector{at / 2 - step});
        EXPECT_NEAR(here[1], (above[0] - below[0]) / (2 * step), 1e-8);
        EXPECT_NEAR(here[2], (above[1] - below[1]) / (2 * step), 1e-7);
    }
    EXPECT_TRUE(differentiate(parse_expression(*graph, "f(3)", scope), x).is_number(0));
    EXPECT_NEAR(constant_value(parse_expression(*graph, "f(0.5) + 1", scope)), 2, 1e-15);
    // Another graph takes the table over with the expression.
    const auto other = Graph::create();
    EXPECT_EQ(to_string(other->adopt(y)), "x*f(2*x)");
    EXPECT_EQ(other->tables().size(), 1u);
    EXPECT_THROW(parse_expression(*graph, "f", scope), InputError);
    EXPECT_THROW(parse_expression(*graph, "g(x)", scope), InputError);
}

TEST(PieceTable, RefusesWhatIsNoFunction) {
    const auto problem = [](Points points, PieceTable::Options options = {}) {
        try {
            PieceTable("f", std::move(points), options);
        } catch (const InputError& error) {
            return error.problem();
        }
        return std::string();
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(problem({{0, 1}}), "table 'f' has 1 points");
    EXPECT_EQ(problem({{0, 1}, {1, nan}}), "point 2 of table 'f' is not finite");
    EXPECT_EQ(problem({{0, 1}, {0, 2}}), "the abscissae of table 'f' do not increase: point 2 is at 0, after 0");
    EXPECT_EQ(problem({{0, 1}, {1, 2}}, {Interpolation::linear, true, Outside::hold}),
              "the periodic table 'f' begins with the value 1 and ends with 2");
    EXPECT_EQ(problem({{0, -1e308}, {1, 1e308}}), "table 'f' is too steep between points 1 and 2");
    EXPECT_EQ(problem({{0, 1}, {1, 2}}), "");
}

} // namespace graze::piece_table_test
