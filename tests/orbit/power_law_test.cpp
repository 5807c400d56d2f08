// Orbits through forces that begin with a power of a state, which have no power series in time there.

#include "graze/flow/mode_flow.hpp"
#include "graze/model/model_file.hpp"
#include "orbits.hpp"
#include "trajectory/model_parts.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <string>
#include <vector>

namespace graze::power_law_test {

using namespace graze::testing;

/// x'' = -k |x|^p sign(x), whose half periods are contacts with an elastic law.
Model oscillator(const std::string& power) {
    return TwoModes{.parameters = "k = 3",
                    .states = "x = 0\nv = 1",
                    .first = {"right", fmt::format("x = 'v', v = '-k*x^{}'", power), "in", "x"},
                    .second = {"left", fmt::format("x = 'v', v = 'k*(-x)^{}'", power), "out", "-x"}}
        .model();
}

/// Half a period at speed v: see uniformised_flow_test.cpp.
double half_period(double p, double k, double v) {
    const double n = p + 1, depth = std::pow(n * v * v / (2 * k), 1 / n);
    return 2 * depth / v * std::sqrt(std::acos(-1.0)) * std::tgamma(1 + 1 / n) / std::tgamma(0.5 + 1 / n);
}

TEST(PowerLaw, OscillatorsHaveThePeriodOfTheBetaFunction) {
    struct Law {
        const char* text;
        double power;
    };
    for (const auto& [text, p] : {Law{"1.5", 1.5}, Law{"0.5", 0.5}, Law{"(1/3)", 1.0 / 3}, Law{"pi", std::acos(-1.0)},
                                  Law{"2", 2}, Law{"3", 3}, Law{"7", 7}})
        for (const double v : {1.0, 0.02}) {
            const Model model = oscillator(text);
            const double half = half_period(p, 3, v), away = p < 1 || p == std::trunc(p) ? 0 : 1e-3;
            const OrbitSolution solution = solve_orbit(
                System(model), given_orbit(model, "in out", {{0, v}, {0, -v}}, {(1 + away) * half, (1 - away) * half}));
            ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << text << ' ' << v << solution.detail;
            const double speed = solution.orbit.starts[0][1];
            EXPECT_NEAR(solution.orbit.period(), 2 * half_period(p, 3, speed), 1e-11 * half) << text;
            ASSERT_EQ(solution.multipliers.size(), 1U);
            EXPECT_NEAR(std::abs(solution.multipliers[0] - 1.0), 0, p < 1 ? 1e-4 : 1e-9) << text;
        }
}

/// A forced oscillator that hits an elastic sphere with damping. `loss` is the integral of minus the divergence.
Model hertz(const std::string& exponent) {
    return parse_model(fmt::format(R"toml(
[parameters]
k = 50
c = 0.5
F = 0.5
n = 1.5
[states]
x = 0
v = 0
theta = {{ initial = 0, period = "2*pi" }}
loss = {{ initial = 0, drifting = true }}
[definitions]
d = "x - 0.5"
elastic = "k*d^{}"
[modes.free]
watch = ["touch"]
rates = {{ x = "v", v = "-0.1*v - x + F*cos(theta)", theta = 1.2, loss = 0.1 }}
[modes.contact]
watch = ["lost"]
rates = {{ x = "v", v = "-0.1*v - x + F*cos(theta) - elastic*(1 + c*v)", theta = 1.2, loss = "0.1 + elastic*c" }}
[events]
touch = "-d"
lost = "d"
[[transitions]]
mode = "free"
event = "touch"
next = "contact"
[[transitions]]
mode = "contact"
event = "lost"
next = "free"
[sections.phase0]
state = "theta"
value = 0
[initial]
mode = "free"
)toml",
                                   exponent),
                       "hertz.toml");
}

TEST(PowerLaw, MultipliersOfAForcedContactAreThoseOfAnotherIntegrator) {
    for (const char* exponent : {"1.5", "n"}) {
        const Model model = hertz(exponent);
        const OrbitSolution solution = settled(model, "phase0");
        ASSERT_EQ(solution.orbit.signature.size(), 2U);
        EXPECT_LT(solution.residual, 1e-12);
        ASSERT_EQ(solution.multipliers.size(), 2U);
        // Central differences of DOP853 (SciPy 1.10) with a relative tolerance of 1e-13, steps of at most 0.01, and
        // the force k max(d, 0)^1.5 (1 + c v): six digits.
        EXPECT_NEAR(std::abs(solution.multipliers[0] - std::complex(0.0602967, 0.4458215)) *
                        std::abs(solution.multipliers[0] - std::complex(0.0602967, -0.4458215)),
                    0, 1e-6)
            << exponent;
        // The product of multipliers follows from the divergence (Liouville), which the orbit itself integrates.
        ModeFlow flow(System(model), 1e-14);
        flow.set_parameters(solution.orbit.parameters);
        double loss = 0;
        for (std::size_t s = 0; s < 2; ++s) {
            std::vector<double> state = solution.orbit.starts[s];
            const double before = state[3];
            ASSERT_EQ(flow.run(solution.orbit.signature[s].mode, state, solution.orbit.durations[s]),
                      ModeFlow::Ending::done);
            loss += state[3] - before;
        }
        EXPECT_NEAR(std::abs(solution.multipliers[0] * solution.multipliers[1] - std::exp(-loss)), 0, 1e-13)
            << exponent;
        EXPECT_TRUE(solution.certificate.admissible) << solution.certificate.reason;
    }
}

} // namespace graze::power_law_test
