// The shipped box of Welander: rest, slide and oscillation from the linear equations of both modes.

#include "study/study_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace graze::welander_convection_test {

using namespace graze::testing;

constexpr double alpha = 0.8, beta = 0.5, mixing = 5;

struct Water {
    double T, S;
    double density() const { return S - alpha * T; }
};

/// After a time with mixing at the rate k.
Water later(const Water& from, double k, double time) {
    const double T = 1 / (1 + k), S = beta / (beta + k);
    return {T + (from.T - T) * std::exp(-(1 + k) * time), S + (from.S - S) * std::exp(-(beta + k) * time)};
}

/// The way in one mode from a threshold back to it: begins where the density falls (calm) or rises (convecting).
struct Way {
    Way(const Water& from, double k) {
        const double threshold = from.density(), side = k > 0 ? 1 : -1;
        double low = 1e-3, high = low;
        while (side * (later(from, k, high).density() - threshold) > 0)
            high *= 1.01;
        for (int i = 0; i < 80; ++i) {
            const double middle = (low + high) / 2;
            (side * (later(from, k, middle).density() - threshold) > 0 ? low : high) = middle;
        }
        time = low;
        end = later(from, k, time);
    }
    double time;
    Water end;
};

class WelanderConvection : public StudyFixture {};

TEST_F(WelanderConvection, OscillatesWithThePeriodOfItsLinearParts) {
    expect_complete(run(R"(name = "s"
model = "welander-convection"
[runs.cycle]
kind = "orbit"
[runs.branch]
kind = "continue"
start = { run = "cycle" }
along = { threshold = [-0.042, -0.001] }
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    EXPECT_TRUE(file.orbits("cycle", false).at(0).stable);
    std::size_t compared = 0;
    for (const OrbitRecord& one : file.orbits("branch", false)) {
        const double threshold = one.point.parameter;
        Water water{0.9, threshold + alpha * 0.9};
        double period = 0;
        for (int i = 0; i < 60; ++i) { // the orbit attracts
            const Way convecting(water, mixing), calm(convecting.end, 0);
            period = convecting.time + calm.time;
            water = calm.end;
        }
        EXPECT_NEAR(one.point.solution.orbit.period(), period, 1e-9 * period) << threshold;
        ++compared;
    }
    EXPECT_GT(compared, 10U);
}

/// beta/(beta + k) - alpha/(1 + k) = threshold: a slide of rate k, from the rest without convection to k = 1/3.
TEST_F(WelanderConvection, RestsInItsSlideUpToTheFoldsOfBothModes) {
    expect_complete(run(R"(name = "s"
model = "welander-convection"
set = { threshold = 0.1 }
[runs.branch]
kind = "continue"
signature = "equilibrium"
mode = "balance"
from = { T = 0.9, S = 0.82 }
along = { threshold = [-0.1, 0.3] }
)"));
    // The rest without convection has the density 1 - alpha; at 0 both fields are tangent to the threshold.
    const ResultFile file(path_, ResultFile::Access::read);
    EXPECT_NEAR(file.orbit("branch", std::string("BE1"))->point.parameter, 1 - alpha, 1e-12);
    EXPECT_NEAR(file.orbit("branch", std::string("BE2"))->point.parameter, 0, 1e-12);
    std::size_t compared = 0;
    for (const OrbitRecord& one : file.orbits("branch", false)) {
        const std::vector<double>& state = one.point.solution.orbit.starts[0];
        if (one.point.parameter >= 1 - alpha)
            continue;
        ++compared;
        EXPECT_TRUE(one.stable);
        const double k = 1 / state[0] - 1;
        EXPECT_NEAR(beta / (beta + k) - alpha / (1 + k), one.point.parameter, 1e-12);
        EXPECT_NEAR(state[1], beta / (beta + k), 1e-12);
    }
    EXPECT_GT(compared, 10U);
}

} // namespace graze::welander_convection_test
