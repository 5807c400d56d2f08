#include "graze/flow/variational_system.hpp"

#include "graze/base/input_error.hpp"
#include "graze/model/model_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace graze::variational_system_test {

using Numbers = std::vector<double>;

/// A model with names that the derivatives might otherwise use for themselves.
Model model() {
    return parse_model(R"(
name = "names"
parameters = { along_0 = 3, c = 2, d = "c*along_0" }
states = { x = 1, along_1 = 0.5 }
definitions = { along_2 = "x*along_1" }
events = { wall = "d*x^2 - along_2" }
modes.free = { rates = { x = "along_1", along_1 = "-d*x*along_2" }, watch = ["wall"] }
jumps.impact.along_1 = "-c*along_1^3*x"
transitions = [{ mode = "free", event = "wall", jump = "impact", next = "free" }]
sections.top.function = "sin(c*x)*along_1"
symmetries.half = { map = { x = "-x^3", along_1 = "-along_1" }, modes = { free = "free" } }
)",
                       "names.toml");
}

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// x, y: states; a, c: parameters, c is free; then the three components of the vector.
struct At {
    double x = 0.7, y = -1.1, a = 3, c = 1.9, vx = 0.4, vy = -0.9, vc = 1.7;
    Numbers inputs() const { return {x, y, a, c, vx, vy, vc}; }
};

void expect_near(const Function& function, const Numbers& exact) {
    const Numbers values = function(At().inputs());
    ASSERT_EQ(values.size(), exact.size());
    for (std::size_t i = 0; i < exact.size(); ++i)
        EXPECT_NEAR(values[i], exact[i], 32 * epsilon * (1 + std::abs(exact[i]))) << i;
}

TEST(VariationalSystem, HasSecondDerivativesOfEventsSectionsAndMaps) {
    const VariationalSystem system(System(model()), {ParameterId(1)});
    EXPECT_EQ(system.variables(), 3u);
    const auto [x, y, a, c, vx, vy, vc] = At();
    // a c x^2 - x y
    expect_near(system.event(0), {a * c * x * x - x * y, 2 * a * c * x - y, -x, a * x * x,
                                  2 * a * c * vx - vy + 2 * a * x * vc, -vx, 2 * a * x * vx});
    // sin(c x) y
    const double s = std::sin(c * x), k = std::cos(c * x);
    const double by_xx = -c * c * s * y, by_xy = c * k, by_xc = (k - c * x * s) * y, by_yc = x * k,
                 by_cc = -x * x * s * y;
    expect_near(system.section(0), {s * y, c * k * y, s, x * k * y, by_xx * vx + by_xy * vy + by_xc * vc,
                                    by_xy * vx + by_yc * vc, by_xc * vx + by_yc * vy + by_cc * vc});
    // x; -c x y^3
    expect_near(system.jump(1),
                {x, -c * x * y * y * y, 1, 0, 0, -c * y * y * y, -3 * c * x * y * y, -x * y * y * y, 0, 0, 0,
                 -3 * c * y * y * vy - y * y * y * vc, -3 * c * y * y * vx - 6 * c * x * y * vy - 3 * x * y * y * vc,
                 -y * y * y * vx - 3 * x * y * y * vy});
    expect_near(system.jump(0), {x, y, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0});
    expect_near(system.symmetry(0), {-x * x * x, -y, -3 * x * x, 0, 0, 0, -1, 0, -6 * x * vx, 0, 0, 0, 0, 0});
}

TEST(VariationalSystem, CompilesFurtherExpressions) {
    const VariationalSystem system(System(model()), {ParameterId(1)});
    Model own = model();
    const auto [x, y, a, c, vx, vy, vc] = At();
    // At the image of the state under a symmetry, and for expressions of another graph.
    const Expression image = sin(own.symbol("c") * -pow(own.symbol("x"), 3)) * -own.symbol("along_1");
    const Numbers expected = system.function_of(std::vector{image})(At().inputs());
    expect_near(system.section(0, 0), expected);
    expect_near(system.function_of(std::vector{own.symbol("along_2"), own.symbol("d")}),
                {x * y, a * c, y, x, 0, 0, 0, a, vy, vx, 0, 0, 0, 0});
    EXPECT_TRUE(system.function_of({})(At().inputs()).empty());
}

TEST(VariationalSystem, HasTheVariationalEquationsOfEachMode) {
    const VariationalSystem system(System(model()), {ParameterId(1)});
    const System& modes = system.modes();
    EXPECT_EQ(modes.states(), 4u);
    EXPECT_EQ(modes.parameters(), 3u);
    const auto [x, y, a, c, vx, vy, vc] = At();
    const Numbers rates = modes.mode(0).rates(Numbers{x, y, vx, vy, a, c, vc});
    const Numbers exact{y, -a * c * x * x * y, vy, -2 * a * c * x * y * vx - a * c * x * x * vy - a * x * x * y * vc};
    for (std::size_t i = 0; i < exact.size(); ++i)
        EXPECT_NEAR(rates[i], exact[i], 8 * epsilon * (1 + std::abs(exact[i]))) << i;
}

TEST(VariationalSystem, NewSymbolsDoNotCollideWithNamesOfTheModel) {
    const VariationalSystem system(System(model()), {ParameterId(1), ParameterId(0)});
    EXPECT_THROW(system.function_of(std::vector{Graph::create()->symbol("along_3")}), InputError);
}

// The functions of one model and one list of free parameters are compiled once, whichever handle asks for them.
TEST(VariationalSystem, IsSharedByAllHandlesOfASystem) {
    const System system(model()), copy = system, observing = system.observing({});
    const std::vector<ParameterId> free{ParameterId(1)}, both{ParameterId(0), ParameterId(1)};
    const VariationalSystem first(system, free), other(system, both);
    EXPECT_EQ(&VariationalSystem(system, free).event(0), &first.event(0));
    EXPECT_EQ(&VariationalSystem(copy, free).modes().mode(0), &first.modes().mode(0));
    EXPECT_EQ(&VariationalSystem(observing, free).event(0), &first.event(0));
    EXPECT_NE(&other.event(0), &first.event(0));
    EXPECT_EQ(other.variables(), 4U);
    EXPECT_NE(&VariationalSystem(System(model()), free).event(0), &first.event(0));
}

} // namespace graze::variational_system_test
