// The shipped walk on two springs against shooting for symmetric walks with an integrator of its own.

#include "study/study_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace graze::spring_walker_test {

using namespace graze::testing;

constexpr double mass = 80, gravity = 9.81, stiffness = 14000, angle = 69 * std::numbers::pi / 180;

using Motion = std::array<double, 4>; ///< x, y and their rates

Motion rates(const Motion& s, const std::vector<double>& feet) {
    Motion rate{s[2], s[3], 0, -gravity};
    for (const double foot : feet) {
        const double push = stiffness / mass * (1 / std::hypot(s[0] - foot, s[1]) - 1);
        rate[2] += push * (s[0] - foot);
        rate[3] += push * s[1];
    }
    return rate;
}

/// A step of the classical method of Runge and Kutta.
Motion stepped(const Motion& s, double h, const std::vector<double>& feet) {
    const auto moved = [&](const Motion& rate, double by) {
        Motion result = s;
        for (std::size_t i = 0; i < 4; ++i)
            result[i] += by * rate[i];
        return result;
    };
    const Motion a = rates(s, feet), b = rates(moved(a, h / 2), feet), c = rates(moved(b, h / 2), feet),
                 d = rates(moved(c, h), feet);
    Motion mean{};
    for (std::size_t i = 0; i < 4; ++i)
        mean[i] = (a[i] + 2 * b[i] + 2 * c[i] + d[i]) / 6;
    return moved(mean, h);
}

/// Follows a motion until a function falls through zero. @returns the time that it takes
double follow(Motion& s, const std::vector<double>& feet, const std::function<double(const Motion&)>& function) {
    constexpr double h = 1e-3; // the fastest motion of a leg turns by 0.02 in a step, so that errors are below 1e-9
    double time = 0;
    for (; time < 2; time += h) {
        const Motion next = stepped(s, h, feet);
        if (function(next) <= 0)
            break;
        s = next;
    }
    double low = 0, high = h;
    for (int i = 0; i < 50; ++i) {
        const double middle = (low + high) / 2;
        (function(stepped(s, middle, feet)) > 0 ? low : high) = middle;
    }
    s = stepped(s, low, feet);
    return time + low;
}

/// Half of a step, from above the foot to the middle between both feet.
struct HalfStep {
    HalfStep(double energy, double height) {
        const double kinetic = energy - mass * gravity * height - stiffness / 2 * std::pow(1 - height, 2);
        Motion s{0, height, std::sqrt(2 * kinetic / mass), 0};
        time = follow(s, {0}, [](const Motion& one) { return one[1] - std::sin(angle); });
        length = s[0] + std::cos(angle);
        time += follow(s, {0, length}, [this](const Motion& one) { return length / 2 - one[0]; });
        climb = s[3];
    }
    double time = 0, length = 0;
    double climb = 0; ///< zero in a symmetric walk
};

HalfStep symmetric_walk(double energy) {
    double low = 0.966, high = 0.98;
    const bool rises = HalfStep(energy, low).climb > 0;
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        ((HalfStep(energy, middle).climb > 0) == rises ? low : high) = middle;
    }
    return {energy, low};
}

class SpringWalker : public StudyFixture {};

const std::string walk = R"(name = "s"
model = "spring-walker"
[runs.walk]
kind = "orbit"
signature = "touchdown takeoff"
)";

TEST_F(SpringWalker, WalksAsShootingFinds) {
    expect_complete(run(walk + R"([runs.family]
kind = "continue"
start = { run = "walk" }
along = { energy = [815, 818] }
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    auto rows = file.query("SELECT energy, period FROM branch_walk UNION ALL SELECT energy, period FROM branch_family "
                           "WHERE label IN ('BD1', 'BD2')");
    std::vector<double> energies;
    while (rows.next()) {
        energies.push_back(rows.number(0));
        EXPECT_NEAR(rows.number(1), 2 * symmetric_walk(rows.number(0)).time, 1e-8) << rows.number(0);
    }
    std::ranges::sort(energies);
    ASSERT_EQ(energies.size(), 3U);
    EXPECT_NEAR(energies[0], 815, 1e-9);
    EXPECT_NEAR(energies[1], 816, 1e-6); // that of the motion from the initial state of the file
    EXPECT_NEAR(energies[2], 818, 1e-9);
    // As published, such walks attract others of the same energy: one multiplier is 1, the others are inside.
    for (const OrbitRecord& one : file.orbits("family", false)) {
        std::size_t neutral = 0;
        for (const std::complex<double> multiplier : one.point.solution.multipliers) {
            neutral += std::abs(multiplier - 1.0) < 1e-6 ? 1 : 0;
            EXPECT_TRUE(std::abs(multiplier - 1.0) < 1e-6 || std::abs(multiplier) < 0.9999) << multiplier;
        }
        EXPECT_EQ(neutral, 1U);
    }
}

/// A curve of torus points of a family ends where its pair of multipliers meets the 1 of the conserved energy. Along
/// the family there, by energy at the same angle of attack, other walks branch off at the same orbit.
TEST_F(SpringWalker, ItsTorusPointsEndWhereTheyMeetTheFamily) {
    const std::string study = walk + R"([runs.family]
kind = "continue"
start = { run = "walk" }
along = { energy = [780, 816] }
direction = "down"
[runs.torus_points]
kind = "curve"
start = { run = "family", point = "NS1" }
along = { attack = [1.2, 1.25], energy = [700, 900] }
)";
    expect_complete(run(study));
    double attack = 0, energy = 0, period = 0;
    {
        const ResultFile file(path_, ResultFile::Access::read);
        auto rows = file.query("SELECT label, attack, energy, period FROM branch_torus_points WHERE label <> '' AND "
                               "label NOT LIKE 'EP%' AND label NOT LIKE 'BD%'");
        ASSERT_TRUE(rows.next());
        EXPECT_EQ(rows.text(0), "R1-1");
        attack = rows.number(1);
        energy = rows.number(2);
        period = rows.number(3);
        EXPECT_FALSE(rows.next()) << rows.text(0);
    }
    expect_complete(run(study + fmt::format(R"([runs.steeper]
kind = "continue"
start = {{ run = "walk" }}
along = {{ attack = [1.19, {}] }}
direction = "up"
[runs.beside]
kind = "continue"
start = {{ run = "steeper", point = "BD1" }}
along = {{ energy = [800, 830] }}
)",
                                            attack)));
    const ResultFile file(path_, ResultFile::Access::read);
    auto rows = file.query("SELECT energy, period FROM branch_beside WHERE label = 'BP1'");
    ASSERT_TRUE(rows.next());
    EXPECT_NEAR(rows.number(0), energy, 1e-7 * energy);
    EXPECT_NEAR(rows.number(1), period, 1e-9 * period);
}

} // namespace graze::spring_walker_test
