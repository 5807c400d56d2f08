// The shipped circuit of Chua: its published equilibria, their Hopf point in closed form, and the cycles beyond.

#include "study/study_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

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
            EXPECT_NEAR(std::abs(((value + 1.0 + 9 * m) * value + (9 * m + beta - 9)) * value + 9 * beta * m), 0,
                        1e-11);
            const bool real = value.imag() == 0;
            EXPECT_NEAR(value.real(), middle ? (real ? 2.22 : -0.97) : (real ? -3.94 : 0.19), 0.005);
            EXPECT_NEAR(std::abs(value.imag()), real ? 0 : (middle ? 2.71 : 3.05), 0.005);
        }
    }
    EXPECT_EQ(inner, 1U);
    EXPECT_EQ(outer, 2U);
}

/// Routh and Hurwitz: (1 + alpha m1)(alpha m1 + beta - alpha) = alpha beta m1, quadratic in alpha.
const double hopf = (std::sqrt(29225.0) - 35) / 20;

TEST_F(ChuaCircuit, RestLosesItsStabilityWhereRouthAndHurwitzSay) {
    expect_complete(run(R"(name = "s"
model = "chua-circuit"
set = { alpha = 6 }
[runs.branch]
kind = "continue"
signature = "equilibrium"
from = { x = 1.5 }
along = { alpha = [5, 10] }
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    ASSERT_TRUE(file.orbit("branch", std::string("HB1")));
    EXPECT_NEAR(file.orbit("branch", std::string("HB1"))->point.parameter, hopf, 1e-12);
}

/// At the Hopf point the field about the equilibrium is a linear centre: the cycles of all sizes up to that at which
/// they touch x = 1 are there, and the branch of those that are larger ends in this touch. At its other end it
/// approaches an orbit that is homoclinic to the origin, where an eigenvalue is positive and two are s + i w, s < 0:
/// the branch turns once in each half turn of the motion about the origin, which takes pi/w, by distances that shrink
/// by exp(pi s/w) (P. Glendinning and C. Sparrow, J. Stat. Phys. 35 (1984) 645).
TEST_F(ChuaCircuit, CyclesLeadFromTheHopfPointToShilnikovsOrbit) {
    expect_complete(run(R"(name = "s"
model = "chua-circuit"
[runs.cycle]
kind = "orbit"
set = { alpha = 7 }
from = { x = 1.6 }
[runs.smaller]
kind = "continue"
start = { run = "cycle" }
along = { alpha = [6, 12] }
direction = "down"
[runs.branch]
kind = "continue"
start = { run = "cycle" }
along = { alpha = [6, 12] }
direction = "up"
steps = 80
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    const auto touch = file.orbit("smaller", std::string("GR1"));
    ASSERT_TRUE(touch);
    EXPECT_NEAR(touch->point.parameter, hopf, 1e-10);
    EXPECT_NEAR(touch->point.solution.orbit.period(), 2 * std::numbers::pi / std::sqrt(hopf * 2 / 7 + 100.0 / 7 - hopf),
                1e-8);
    std::vector<double> alpha, period;
    for (int k = 2; k <= 5; ++k) {
        const auto fold = file.orbit("branch", "SN" + std::to_string(k));
        ASSERT_TRUE(fold) << k;
        alpha.push_back(fold->point.parameter);
        period.push_back(fold->point.solution.orbit.period());
    }
    // The complex eigenvalues of the origin, by the real one: (l - r)(l^2 - 2 s l + s^2 + w^2).
    const double a = alpha.back(), m0 = -1.0 / 7, beta = 100.0 / 7;
    double real = 3;
    for (int i = 0; i < 50; ++i)
        real -= (((real + 1 + a * m0) * real + a * m0 + beta - a) * real + a * beta * m0) /
                ((3 * real + 2 * (1 + a * m0)) * real + a * m0 + beta - a);
    const double s = -(1 + a * m0 + real) / 2, w = std::sqrt(-a * beta * m0 / real - s * s);
    const double limit = -std::exp(std::numbers::pi * s / w), ratio = (alpha[3] - alpha[2]) / (alpha[2] - alpha[1]);
    EXPECT_NEAR(ratio, limit, 0.006); // both are limits
    EXPECT_NEAR(period[3] - period[2], std::numbers::pi / w, 0.003);
    // The branch ends at the homoclinic orbit itself, to which the folds lead.
    const auto loop = file.orbit("branch", std::string("HC1"));
    ASSERT_TRUE(loop);
    EXPECT_NEAR(loop->point.parameter, alpha[3] + (alpha[3] - alpha[2]) * limit / (1 - limit), 5e-5);
}

} // namespace graze::chua_circuit_test
