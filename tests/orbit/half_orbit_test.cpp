// Orbits of models with a clock that are their own images: half orbits where the symmetry maps events to events, whole
// orbits where it does not.

#include "graze/orbit/solve.hpp"
#include "trajectory/model_parts.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::half_orbit_test {

using namespace graze::testing;

using std::numbers::pi;

/// A linear oscillator under a square wave of force: 0.3 in mode `plus`, -0.3 in `minus`, of the frequency 1.2.
/// @param clock declaration of its state; @param half, full event functions that end the two halves; @param reset value
/// of the clock after the second half
Model square_wave(const std::string& clock, const std::string& half, const std::string& full, const std::string& reset,
                  const std::string& image) {
    return TwoModes{.states = "x = 0.1\nv = 0\ntheta = " + clock,
                    .first = {"plus", "x = 'v', v = '0.3 - 0.3*v - x', theta = 1.2", "half", half},
                    .second = {"minus", "x = 'v', v = '-0.3 - 0.3*v - x', theta = 1.2", "full", full,
                               fmt::format("theta = '{}'", reset)},
                    .kind = "barrier",
                    .more = fmt::format("[symmetries.turn]\nmap = {{ x = '-x', v = '-v', theta = '{}' }}\n"
                                        "modes = {{ plus = 'minus', minus = 'plus' }}",
                                        image)}
        .model();
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
    const Model model =
        OneMode{.states = "x = 0.1\nv = 0\nu = 1\ntheta = { initial = 0.1, period = '2*pi' }",
                .rates = "x = 'v', v = '0.3*u - 0.3*v - x', u = 0, theta = 1.2",
                .stops = {{"half", "sin(theta)", "u = '-u'", "half", "free", "section"},
                          {"full", "-sin(theta)", "u = '-u'", "full", "free", "section"}},
                .more = "[symmetries.turn]\nmap = { x = '-x', v = '-v', u = '-u', theta = 'theta + pi' }"}
            .model();
    expect_orbit(model, true);
    Model plain = model;
    plain.symmetries.clear();
    expect_orbit(plain, false);
}

} // namespace graze::half_orbit_test
