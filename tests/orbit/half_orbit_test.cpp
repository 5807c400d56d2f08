// Orbits of models with a clock that are their own images: half orbits where the symmetry maps events to events, whole
// orbits where it does not.

#include "graze/model/model_file.hpp"
#include "graze/orbit/orbit.hpp"
#include "graze/orbit/solve.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze {
namespace {

using std::numbers::pi;

/// A linear oscillator under a square wave of force: 0.3 in mode `plus`, -0.3 in `minus`, of the frequency 1.2.
/// @param clock declaration of its state; @param half, full event functions that end the two halves; @param reset value
/// of the clock after the second half
Model square_wave(const std::string& clock, const std::string& half, const std::string& full, const std::string& reset,
                  const std::string& image) {
    return parse_model(fmt::format(R"toml(
[states]
x = 0.1
v = 0
theta = {}
[modes.plus]
rates = {{ x = "v", v = "0.3 - 0.3*v - x", theta = 1.2 }}
watch = ["half"]
[modes.minus]
rates = {{ x = "v", v = "-0.3 - 0.3*v - x", theta = 1.2 }}
watch = ["full"]
[events]
half = "{}"
full = "{}"
[jumps.reset]
theta = "{}"
[[transitions]]
mode = "plus"
event = "half"
label = "half"
next = "minus"
[[transitions]]
mode = "minus"
event = "full"
label = "full"
jump = "reset"
next = "plus"
[symmetries.turn]
map = {{ x = "-x", v = "-v", theta = "{}" }}
modes = {{ plus = "minus", minus = "plus" }}
[initial]
mode = "plus"
)toml",
                                   clock, half, full, reset, image),
                       "test.toml");
}

/// x where the force turns positive, in closed form: x = -0.3 + u after half a period from -x.
double turning_point() {
    const double d = std::sqrt(1 - 0.15 * 0.15), t = pi / 1.2, decay = std::exp(-0.15 * t), c = std::cos(d * t),
                 s = std::sin(d * t);
    // (u, v) about 0.3: u(t) = M u(0), and x(t) = -x(0), v(t) = -v(0).
    const double m11 = decay * (c + 0.15 / d * s), m12 = decay * s / d, m22 = decay * (c - 0.15 / d * s);
    // m11 (x - 0.3) + m12 v + 0.3 = -x, -m12 (x - 0.3) + m22 v = -v.
    const double ratio = m12 / (1 + m22); // v = ratio (x - 0.3)
    return (0.3 * (m11 + m12 * ratio) - 0.3) / (1 + m11 + m12 * ratio);
}

void expect_orbit(const Model& model, bool is_half) {
    for (const char* text : {"half full", "full half"}) {
        const System system(model);
        const auto solution = orbit_with_signature(system, parse_signature(model, text));
        ASSERT_TRUE(solution);
        ASSERT_EQ(solution->outcome, OrbitOutcome::converged) << solution->detail;
        EXPECT_EQ(solution->orbit.symmetry.has_value(), is_half) << text;
        const Orbit whole = whole_orbit(system, solution->orbit);
        ASSERT_EQ(whole.segments(), 2U);
        EXPECT_EQ(to_string(model, whole.signature), text);
        EXPECT_NEAR(whole.period(), 2 * pi / 1.2, 1e-11);
        const std::size_t first = text[0] == 'h' ? 0 : 1; // begins with the positive force
        EXPECT_NEAR(whole.starts[first][0], turning_point(), 1e-10);
        EXPECT_NEAR(whole.starts[1 - first][0], -turning_point(), 1e-10);
    }
}

TEST(HalfOrbit, ExistsForASquareWaveWithACyclicClock) {
    const std::string cyclic = "{ initial = 0.1, period = \"2*pi\" }";
    expect_orbit(square_wave(cyclic, "sin(theta)", "-sin(theta)", "theta", "theta + pi"), true);
    expect_orbit(square_wave(cyclic, "sin(theta)", "-sin(theta)", "theta", "theta - pi"), true);
    // Events that hold in one period of the clock only.
    expect_orbit(square_wave(cyclic, "pi - theta", "2*pi - theta", "theta - 2*pi", "theta + pi"), true);
}

TEST(HalfOrbit, DoesNotExistForAClockThatIsReset) {
    // The map is a symmetry of one half only: it takes the other half to times before the clock starts.
    expect_orbit(square_wave("0.1", "pi - theta", "2*pi - theta", "theta - 2*pi", "theta - pi"), false);
    expect_orbit(square_wave("0.1", "pi - theta", "2*pi - theta", "theta - 2*pi", "theta + pi"), false);
}

TEST(HalfOrbit, ExistsWhereAStateIsTheSignOfTheForce) {
    // Each switch reverses the sign, so that two switches restore any value of u.
    const Model model = parse_model(R"toml(
[states]
x = 0.1
v = 0
u = 1
theta = { initial = 0.1, period = "2*pi" }
[modes.m]
rates = { x = "v", v = "0.3*u - 0.3*v - x", u = 0, theta = 1.2 }
watch = ["half", "full"]
[events.half]
function = "sin(theta)"
kind = "section"
[events.full]
function = "-sin(theta)"
kind = "section"
[jumps.turn]
u = "-u"
[[transitions]]
mode = "m"
event = "half"
label = "half"
jump = "turn"
next = "m"
[[transitions]]
mode = "m"
event = "full"
label = "full"
jump = "turn"
next = "m"
[symmetries.turn]
map = { x = "-x", v = "-v", u = "-u", theta = "theta + pi" }
)toml",
                                    "test.toml");
    expect_orbit(model, true);
    Model plain = model;
    plain.symmetries.clear();
    expect_orbit(plain, false);
}

} // namespace
} // namespace graze
