// The shipped rocking block: Housner's free rocking and Hogan's forced orbits in closed form.

#include "study/study_fixture.hpp"
#include "trajectory/model_parts.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::rocking_block_study_test {

using namespace graze::testing;
using std::numbers::pi;

/// Hogan's symmetric orbits with one impact at each edge in n periods of the ground. In mode `right`, x = 1 + A e^t +
/// B e^-t + q cos(omega t) - s/omega sin(omega t), from x = 0 with the speed v to x = 0 with -v/r at T = n pi/omega;
/// the rest is its reflection. Sums and differences of the four conditions at both ends give q and s, in terms of v.
struct SymmetricRocking {
    double omega, r;
    int n;

    double length() const { return n * pi / omega; }
    double t() const { return std::tanh(length() / 2); }
    double q(double v) const { return -v * (1 - r) / (2 * r) * t(); }
    double s(double v) const { return t() - v * (1 + r) / (2 * r); }
    double fold() const { return (1 + omega * omega) * (1 - r) * t() * t() / std::hypot(1 + r, omega * (1 - r) * t()); }
    /// Faster of the two speeds at which (beta/(1 + omega^2))^2 = q^2 + (s/omega)^2.
    double speed(double beta) const {
        const double k = std::pow((1 - r) / (1 + r) * t() * omega, 2), g = beta * omega / (1 + omega * omega);
        const double w = (t() + std::sqrt(t() * t() - (1 + k) * (t() * t() - g * g))) / (1 + k);
        return w * 2 * r / (1 + r);
    }
    double phase(double beta) const {
        const double v = speed(beta);
        return std::atan2(s(v) / omega, q(v));
    }
    /// Trace of the derivative of half a period, reflected: by the implicit function theorem from the solution.
    double trace(double beta) const {
        const double v = speed(beta), c = std::cosh(length()), h = std::sinh(length());
        return 1 - r * c +
               r / v * (s(v) * (1 + c) + omega * omega * q(v) * h + r * (1 - (1 + omega * omega) * q(v)) * h);
    }
    /// Where one of its eigenvalues, whose product is r^2, is -1.
    double symmetry_breaking() const {
        double low = fold() * (1 + 1e-9), high = low;
        while (trace(high) > -1 - r * r)
            high *= 1.1;
        for (int i = 0; i < 60; ++i) {
            const double middle = (low + high) / 2;
            (trace(middle) > -1 - r * r ? low : high) = middle;
        }
        return low;
    }
};

class RockingBlock : public StudyFixture {
protected:
    /// Follows the orbits from one of them in both directions.
    void follow(const SymmetricRocking& known, double beta, double greatest) {
        expect_complete(run(fmt::format(R"(name = "s"
model = "rocking-block"
set = {{ omega = {}, r = {}, beta = {} }}
[runs.rocking]
kind = "orbit"
from = {{ x = 0, v = {:.17g}, theta = {:.17g} }}
[runs.branch]
kind = "continue"
start = {{ run = "rocking" }}
along = {{ beta = [0.01, {}] }}
)",
                                        known.omega, known.r, beta, known.speed(beta), known.phase(beta), greatest)));
    }
};

/// From Housner's equations: the time of the first fall, and the greatest tilt after each impact.
TEST_F(RockingBlock, FallsAndRisesAsHousnersDoes) {
    const double tilt = 0.7, r = 0.925;
    Experiment experiment(started(shipped_with("rocking-block", {{"beta", 0}}), {{"x", tilt}}));
    ASSERT_EQ(experiment.run(200).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
    EXPECT_EQ(experiment.simulation.model().modes[experiment.trajectory.mode()].name, "rest");
    const auto& contacts = experiment.recorder.contacts();
    ASSERT_GT(contacts.size(), 20U);
    const double energy = 1 - (1 - tilt) * (1 - tilt);
    double time = std::acosh(1 / (1 - tilt)), rest = time;
    for (int n = 1; n < 2000; ++n)
        rest += 2 * std::atanh(std::pow(r, n) * std::sqrt(energy));
    for (int n = 1; n < 20; ++n) {
        EXPECT_NEAR(contacts[n - 1].contact.time, time, 1e-12 * time) << n;
        // r^(2n) of the first energy is left, and the block rises to 1 - sqrt(1 - that).
        const double next = 1 - std::sqrt(1 - std::pow(r, 2 * n) * energy);
        time += 2 * std::acosh(1 / (1 - next));
    }
    EXPECT_NEAR(contacts.back().contact.time, rest, 1e-9 * rest);
}

TEST_F(RockingBlock, HasHogansFoldsAndLosesItsSymmetryWhereTheTraceTells) {
    for (const SymmetricRocking& known :
         {SymmetricRocking{2, 0.925, 1}, SymmetricRocking{2, 0.7, 1}, SymmetricRocking{4, 0.925, 3}}) {
        const double start = 1.5 * known.fold();
        follow(known, start, 1.2 * known.symmetry_breaking());
        const ResultFile file(path_, ResultFile::Access::read);
        const auto first = file.orbits("rocking", false).at(0).point.solution;
        ASSERT_TRUE(first.orbit.symmetry);
        EXPECT_NEAR(first.orbit.period(), 2 * known.length(), 1e-12);
        ASSERT_EQ(first.half_multipliers.size(), 2U);
        EXPECT_NEAR(std::abs(first.half_multipliers[0] * first.half_multipliers[1]), known.r * known.r, 1e-10);
        EXPECT_NEAR((first.half_multipliers[0] + first.half_multipliers[1]).real(), known.trace(start), 1e-9);
        const auto fold = file.orbit("branch", std::string("SN1")), broken = file.orbit("branch", std::string("SB1"));
        ASSERT_TRUE(fold);
        EXPECT_NEAR(fold->point.parameter, known.fold(), 1e-11);
        ASSERT_TRUE(broken);
        EXPECT_NEAR(broken->point.parameter, known.symmetry_breaking(), 1e-10);
    }
}

} // namespace graze::rocking_block_study_test
