// The shipped circuit of Chua: its published equilibria, their Hopf point in closed form, and the cycles beyond.

#include "study/study_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <string>

namespace graze::chua_circuit_test {

using namespace graze::testing;

class ChuaCircuit : public StudyFixture {};

/// The published eigenvalues (Matsumoto, Chua and Komuro 1985), and the cubic that they solve.
TEST_F(ChuaCircuit, HasThePublishedEquilibria) {
    expect_complete(run(R"(name = "s"
model = "chua-circuit"
[runs.rest]
kind = "equilibrium"
within = { x = [-5, 5], y = [-2, 2], z = [-5, 5] }
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    const double beta = 100.0 / 7;
    std::size_t outer = 0, inner = 0;
    for (const OrbitRecord& one : file.orbits("rest", false)) {
        if (!one.point.solution.certificate.admissible)
            continue;
        const std::vector<double>& state = one.point.solution.orbit.starts[0];
        const bool middle = std::abs(state[0]) < 1;
        ++(middle ? inner : outer);
        EXPECT_NEAR(std::abs(state[0]), middle ? 0 : 1.5, 1e-14);
        EXPECT_NEAR(state[1], 0, 1e-14);
        EXPECT_NEAR(state[2], -state[0], 1e-14);
        ASSERT_EQ(one.point.solution.eigenvalues.size(), 3U);
        for (const std::complex<double> value : one.point.solution.eigenvalues) {
            const double m = middle ? -1.0 / 7 : 2.0 / 7;
            EXPECT_NEAR(std::abs(((value + 1.0 + 9 * m) * value + (9 * m + beta - 9)) * value + 9 * beta * m), 0, 1e-11);
            const bool real = value.imag() == 0;
            EXPECT_NEAR(value.real(), middle ? (real ? 2.22 : -0.97) : (real ? -3.94 : 0.19), 0.005);
            EXPECT_NEAR(std::abs(value.imag()), real ? 0 : (middle ? 2.71 : 3.05), 0.005);
        }
    }
    EXPECT_EQ(inner, 1U);
    EXPECT_EQ(outer, 2U);
}

/// Routh and Hurwitz: (1 + alpha m1)(alpha m1 + beta - alpha) = alpha beta m1, quadratic in alpha. There the field
/// about the equilibrium is a linear centre, of which the cycles are a family up to the size at which they touch x = 1.
TEST_F(ChuaCircuit, OscillatesFromItsHopfPointOn) {
    expect_complete(run(R"(name = "s"
model = "chua-circuit"
set = { alpha = 6 }
[runs.branch]
kind = "continue"
signature = "equilibrium"
from = { x = 1.5 }
along = { alpha = [5, 10] }
[runs.cycles]
kind = "continue"
start = { run = "branch", point = "HB1" }
along = { alpha = [5, 10] }
[runs.beyond]
kind = "continue"
start = { run = "cycles", point = "GR1" }
along = { alpha = [6, 10] }
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    const auto hopf = file.orbit("branch", std::string("HB1"));
    ASSERT_TRUE(hopf);
    EXPECT_NEAR(hopf->point.parameter, (std::sqrt(29225.0) - 35) / 20, 1e-12);
    const double alpha = hopf->point.parameter;
    for (const OrbitRecord& one : file.orbits("cycles", false)) {
        EXPECT_NEAR(one.point.parameter, alpha, 1e-9);
        EXPECT_NEAR(one.point.solution.orbit.period(),
                    2 * std::numbers::pi / std::sqrt(alpha * 2 / 7 + 100.0 / 7 - alpha), 1e-8);
    }
}

} // namespace graze::chua_circuit_test
