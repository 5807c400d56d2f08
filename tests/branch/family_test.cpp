// Families of orbits at the same parameters, followed along what is conserved or along the period, against closed
// forms, independent integrations and published values.

#include "follow.hpp"
#include "graze/model/conserved.hpp"
#include "maps.hpp"

#include "base/message_of.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

namespace graze::family_test {

using namespace graze::testing;
using std::numbers::pi;

/// Settings of a family along a conserved quantity, or the period.
BranchSettings along(const std::string& conserved, std::optional<double> least = {},
                     std::optional<double> greatest = {}, int direction = 1) {
    BranchSettings settings;
    settings.family = FamilyCoordinate{conserved == "period" ? "" : conserved};
    settings.direction = direction;
    settings.least = least;
    settings.greatest = greatest;
    return settings;
}

const std::string energy_of = "[conserved]\nenergy = '";

/// Returns the period of a pendulum (length 1, gravity 1) of an energy below 1, by the arithmetic-geometric mean (C. F.
/// Gauss).
double pendulum_period(double energy) {
    double a = 1, b = std::sqrt(0.5 * (1 - energy)); // the cosine of half the amplitude
    for (int i = 0; i < 8; ++i) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    return 2 * pi / a;
}

/// A pendulum without parameters.
Model pendulum(const std::string& conserved) {
    return OneMode{.states = "phi = 0.5\nw = 0",
                   .rates = "phi = 'w', w = '-sin(phi)'",
                   .more = section("turn", "w", "falling") + conserved}
        .model();
}

TEST(Family, OfAPendulumIsFollowedByItsEnergyWithoutAnyParameter) {
    const Model model = pendulum(energy_of + "w^2/2 - cos(phi)'");
    const Orbit start = given_orbit(model, "turn", {{0.5, 0}}, {6.4});
    for (const int direction : {1, -1}) {
        const Branch branch = follow_branch(System(model), start, along("energy", -0.99, 0.99, direction));
        EXPECT_EQ(branch.outcome, BranchOutcome::bound) << branch.detail;
        EXPECT_EQ(names(branch), "BD");
        ASSERT_GT(branch.points.size(), 5U);
        for (const BranchPoint& point : branch.points) {
            const std::vector<double>& at = point.solution.orbit.starts[0];
            EXPECT_NEAR(point.parameter, 0.5 * at[1] * at[1] - std::cos(at[0]), 1e-14);
            EXPECT_NEAR(point.solution.orbit.period(), pendulum_period(point.parameter), 1e-10);
            EXPECT_TRUE(point.solution.orbit.parameters.empty());
            EXPECT_TRUE(point.monitors.empty());
            ASSERT_EQ(point.solution.multipliers.size(), 1U);
            EXPECT_EQ(point.solution.multipliers[0], 1.0);
            EXPECT_TRUE(point.stable);
        }
        EXPECT_NEAR(branch.points.back().parameter, 0.99 * direction, 1e-12);
        EXPECT_NEAR(branch.special.back().parameter, 0.99 * direction, 1e-12);
    }
}

TEST(Family, IsFollowedByItsPeriodWhereNothingIsDeclared) {
    const Model model = pendulum("");
    const Orbit start = given_orbit(model, "turn", {{0.5, 0}}, {6.4});
    const Branch branch = follow_branch(System(model), start, along("period", 6.3, 20));
    EXPECT_EQ(names(branch), "BD") << branch.detail;
    for (const BranchPoint& point : branch.points) {
        const std::vector<double>& at = point.solution.orbit.starts[0];
        EXPECT_EQ(point.parameter, point.solution.orbit.period());
        EXPECT_NEAR(point.parameter, pendulum_period(0.5 * at[1] * at[1] - std::cos(at[0])), 1e-9 * point.parameter);
    }
    EXPECT_NEAR(branch.points.back().parameter, 20, 1e-10);
}

TEST(Family, ShrinksToItsEquilibrium) {
    const Model model = pendulum(energy_of + "w^2/2 - cos(phi)'");
    const Orbit start = given_orbit(model, "turn", {{0.5, 0}}, {6.4});
    const Branch branch = follow_branch(System(model), start, along("energy", {}, 0.5, -1));
    ASSERT_EQ(names(branch), "HB") << branch.detail;
    EXPECT_NEAR(branch.special[0].parameter, -1, 1e-9);
    EXPECT_NEAR(branch.special[0].solution.orbit.starts[0][0], 0, 1e-8);
}

/// Without loss a ball flies for 2 sqrt(2 E)/g between impacts.
TEST(Family, OfABouncingBallHasThePeriodOfItsFlight) {
    const Model model = OneMode{.parameters = "g = 9.81\ne = 1",
                                .states = "x = 0\nv = 3\ns = 0",
                                .rates = "x = 'v', v = '-g', s = '0.3'",
                                .stops = {{"floor", "x", "v = '-e*v'", "impact"}},
                                .more = energy_of + "v^2/2 + g*x'\n"}
                            .model();
    EXPECT_TRUE(model.states[2].drifting) << "nothing depends on s";
    const Orbit start = given_orbit(model, "impact", {{0, 3, 0.7}}, {0.6});
    const Branch branch = follow_branch(System(model), start, along("energy", 1, 50));
    EXPECT_EQ(names(branch), "BD") << branch.detail;
    for (const BranchPoint& point : branch.points) {
        EXPECT_NEAR(point.solution.orbit.period(), 2 * std::sqrt(2 * point.parameter) / 9.81, 1e-12);
        EXPECT_EQ(point.solution.orbit.starts[0][2], 0.7) << "the free state stays at its starting value";
    }
}

/// The impact oscillator of Shaw and Holmes (1983) without force, damping and loss: x'' = -x up to the stop.
Model free_impact_oscillator() {
    return OneMode{.parameters = "stop = 0.7",
                   .states = "x = 0.3\nv = 0",
                   .rates = "x = 'v', v = '-x'",
                   .stops = {{"wall", "stop - x", "v = '-v'", "impact"}},
                   .more = section("left", "v") + energy_of + "v^2/2 + x^2/2'"}
        .model();
}

TEST(Family, ThatGrazesAStopGoesOnWithImpacts) {
    const Model model = free_impact_oscillator();
    const Orbit start = given_orbit(model, "left", {{-0.3, 0}}, {6.2});
    const BranchSettings settings = along("energy", 0.01, 2);
    const Branch branch = follow_branch(System(model), start, settings);
    ASSERT_EQ(names(branch), "GR") << branch.detail;
    EXPECT_NEAR(branch.special[0].parameter, 0.5 * 0.7 * 0.7, 1e-12);
    for (const BranchPoint& point : branch.points)
        EXPECT_NEAR(point.solution.orbit.period(), 2 * pi, 1e-11);
    const std::vector<BranchStart> starts = branches_at(System(model), branch.special[0], settings);
    ASSERT_EQ(starts.size(), 1U);
    OrbitBranch impacting(System(model), starts[0].orbit, settings);
    ASSERT_TRUE(impacting.start_along(starts[0].direction, starts[0].distance)) << impacting.detail();
    int points = 0;
    do {
        const BranchPoint& point = impacting.point();
        const double amplitude = std::sqrt(2 * point.parameter);
        EXPECT_NEAR(point.solution.orbit.period(), 2 * (pi - std::acos(0.7 / amplitude)), 1e-9) << amplitude;
        ++points;
    } while (impacting.step());
    EXPECT_EQ(impacting.outcome(), BranchOutcome::bound);
    EXPECT_GT(points, 5);
}

/// An orbit of two bounces across an ellipse, along an axis of half length b with the radius of curvature R at its
/// ends: half of it has the trace 2 (1 - 2 b/R) (M. V. Berry, Eur. J. Phys. 2, 1981).
TEST(Family, OfTwoBouncesInAnEllipticBilliardHasTheMultipliersOfItsCurvature) {
    const Model model = OneMode{.parameters = "a = 1.3\nb = 1",
                                .states = "x = 0\ny = 0\nu = 0\nv = 1",
                                .definitions = "p = 'x/a^2'\nq = 'y/b^2'\nr = '2*(u*p + v*q)/(p^2 + q^2)'",
                                .rates = "x = 'u', y = 'v', u = 0, v = 0",
                                .stops = {{"wall", "1 - x^2/a^2 - y^2/b^2", "u = 'u - r*p'\nv = 'v - r*q'", "bounce"}},
                                .more = energy_of + "(u^2 + v^2)/2'"}
                            .model();
    const Orbit start = given_orbit(model, "bounce^2", {{0, -1, 0, 1}, {0, 1, 0, -1}}, {2, 2});
    const Branch branch = follow_branch(System(model), start, along("energy", 0.1, 1));
    EXPECT_EQ(names(branch), "BD") << branch.detail;
    const double half = 2 * (1 - 2 / (1.3 * 1.3));
    for (const BranchPoint& point : branch.points) {
        EXPECT_NEAR(point.solution.orbit.period(), 4 / std::sqrt(2 * point.parameter), 1e-10);
        ASSERT_EQ(point.solution.multipliers.size(), 3U);
        std::complex<double> sum = 0;
        for (const std::complex<double> one : point.solution.multipliers)
            sum += one;
        EXPECT_NEAR(sum.real(), 1 + half * half - 2, 1e-8);
        EXPECT_TRUE(point.stable);
    }
}

/// The trace of the derivative across the straight orbit x = 0 of Henon and Heiles, by Runge and Kutta's method.
double trace_across(double energy) {
    // y'' = -y + y^2 from its lowest point; two solutions of xi'' = -(1 + 2 y) xi.
    using Vector = std::array<long double, 6>;
    long double low = -0.5L;
    for (int i = 0; i < 60; ++i)
        low -= (low * low / 2 - low * low * low / 3 - energy) / (low - low * low);
    const auto rate = [](const Vector& z) {
        const long double k = -(1 + 2 * z[0]);
        return Vector{z[1], -z[0] + z[0] * z[0], z[3], k * z[2], z[5], k * z[4]};
    };
    const auto moved = [](const Vector& z, long double h, const Vector& by) {
        Vector result = z;
        for (std::size_t i = 0; i < 6; ++i)
            result[i] += h * by[i];
        return result;
    };
    Vector z{low, 0, 1, 0, 0, 1};
    const auto step = [&](const Vector& from, long double h) {
        const Vector k1 = rate(from), k2 = rate(moved(from, h / 2, k1)), k3 = rate(moved(from, h / 2, k2)),
                     k4 = rate(moved(from, h, k3));
        Vector result = from;
        for (std::size_t i = 0; i < 6; ++i)
            result[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
        return result;
    };
    constexpr long double h = 5e-4L;
    bool rising = false;
    for (;;) { // over one period, to where the speed falls through zero from below at the lowest point again
        const Vector next = step(z, h);
        if (rising && z[1] < 0 && next[1] >= 0) {
            long double part = h * z[1] / (z[1] - next[1]);
            for (int i = 0; i < 20; ++i) {
                const Vector here = step(z, part);
                part -= here[1] / (-here[0] + here[0] * here[0]);
            }
            const Vector end = step(z, part);
            return static_cast<double>(end[2] + end[5]);
        }
        rising = rising || next[1] < 0;
        z = next;
    }
}

Model henon_heiles() {
    return OneMode{.states = "x = 0\ny = 0\nu = 0\nv = 0.3",
                   .rates = "x = 'u', y = 'v', u = '-x - 2*x*y', v = '-y - x^2 + y^2'",
                   .more = section("rise", "y") + energy_of + "(u^2 + v^2 + x^2 + y^2)/2 + x^2*y - y^3/3'"}
        .model();
}

/// The straight orbit A loses and regains its stability infinitely often below the saddle at the energy 1/6 (M. Brack,
/// Found. Phys. 31, 2001: at 6 E = 0.811715516, 0.969309, 0.986709235, ...); digits that he does not give are those of
/// the integration above.
TEST(Family, OfHenonAndHeilesChangesWhereTheOrbitAIsKnownTo) {
    const Model model = henon_heiles();
    const Orbit start = given_orbit(model, "rise", {{0, 0, 0, 0.3}}, {6.3});
    BranchSettings settings = along("energy", 0.01, 0.99 / 6);
    const Branch branch = follow_branch(System(model), start, settings);
    ASSERT_EQ(names(branch), "PD PD BP BP BD") << branch.detail;
    const double published[] = {0.811715516, 0.915214413, 0.969309091, 0.986709235};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(6 * branch.special[i].parameter, published[i], 1e-9);
        EXPECT_NEAR(trace_across(branch.special[i].parameter), i < 2 ? -2 : 2, 1e-6);
    }
    EXPECT_TRUE(of_type(branch, PointType::torus).empty()) << names(branch);
    for (const BranchPoint& point : branch.points) {
        const double trace = trace_across(point.parameter);
        if (std::abs(std::abs(trace) - 2) > 1e-3) {
            EXPECT_EQ(point.stable, std::abs(trace) < 2) << point.parameter;
        }
    }
}

/// Orbits out of the axis, of which the scale is unknown where they leave it.
TEST(Family, OfHenonAndHeilesBranchesOutOfTheAxis) {
    const Model model = henon_heiles();
    const BranchSettings settings = along("energy", 0.01, 0.1666);
    const Branch axis = follow_branch(System(model), given_orbit(model, "rise", {{0, 0, 0, 0.3}}, {6.3}), settings);
    ASSERT_GE(axis.special.size(), 5U) << names(axis) << ' ' << axis.detail;
    for (std::size_t i = 0; i < 5; ++i)
        for (const BranchStart& start : branches_at(System(model), axis.special[i], settings)) {
            const Branch other = follow(model, start, settings);
            EXPECT_EQ(other.outcome, BranchOutcome::bound) << axis.special[i].parameter << ' ' << other.detail;
            for (const BranchPoint& one : other.points) {
                const std::vector<double>& out = one.solution.orbit.starts[0];
                EXPECT_GT(std::abs(out[0]) + std::abs(out[2]), 1e-4) << "out of the axis";
                EXPECT_GT(one.parameter, axis.special[i].parameter);
            }
        }
}

constexpr double moon = 0.01215; ///< mass of the moon, that of earth and moon being 1

/// The restricted problem of three bodies in the rotating frame of earth and moon.
Model three_bodies() {
    return OneMode{.parameters = "mu = 0.01215",
                   .states = "x = 0.8\ny = 0\nz = 0\nu = 0\nv = 0\nw = 0",
                   .definitions = "p = 'sqrt((x + mu)^2 + y^2 + z^2)'\nq = 'sqrt((x - 1 + mu)^2 + y^2 + z^2)'\n"
                                  "a = '(1 - mu)/p^3'\nb = 'mu/q^3'",
                   .rates = "x = 'u', y = 'v', z = 'w', u = '2*v + x - a*(x + mu) - b*(x - 1 + mu)', "
                            "v = '-2*u + y - (a + b)*y', w = '-(a + b)*z'",
                   .more = section("axis", "y") + energy_of + "(u^2 + v^2 + w^2 - x^2 - y^2)/2 - (1 - mu)/p - mu/q'"}
        .model();
}

/// A small oscillation about the libration point between earth and moon, by its linear equations.
Orbit small_lyapunov_orbit(const Model& model) {
    double at = 0.8;
    for (int i = 0; i < 50; ++i) {
        const double p = at + moon, q = 1 - moon - at;
        at -=
            (at - (1 - moon) / (p * p) + moon / (q * q)) / (1 + 2 * (1 - moon) / (p * p * p) + 2 * moon / (q * q * q));
    }
    const double c = (1 - moon) / std::pow(at + moon, 3) + moon / std::pow(1 - moon - at, 3),
                 s = std::sqrt((2 - c + std::sqrt(9 * c * c - 8 * c)) / 2), ratio = (s * s + 1 + 2 * c) / (2 * s);
    constexpr double size = 2e-3;
    return given_orbit(model, "axis", {{at - size, 0, 0, 0, ratio * size * s, 0}}, {2 * pi / s});
}

/// The halo orbits leave the planar ones at a Jacobi constant of 3.1743 and a period of 2.743 (K. Howell, Celest. Mech.
/// 32, 1984; E. Doedel et al., Int. J. Bifurcation Chaos 17, 2007, whose mass this is).
TEST(Family, OfThreeBodiesBranchesToTheHaloOrbits) {
    const Model model = three_bodies();
    const BranchSettings settings = along("energy", -1.6, -1.575);
    const Branch branch = follow_branch(System(model), small_lyapunov_orbit(model), settings);
    const std::vector<SpecialPoint> crossings = of_type(branch, PointType::branch_point);
    ASSERT_GE(crossings.size(), 1U) << names(branch) << ' ' << branch.detail;
    EXPECT_NEAR(-2 * crossings[0].parameter, 3.1743, 2e-4);
    EXPECT_NEAR(crossings[0].solution.orbit.period(), 2.743, 1e-3);
    EXPECT_TRUE(of_type(branch, PointType::torus).empty()) << names(branch);
    const std::vector<BranchStart> starts = branches_at(System(model), crossings[0], settings);
    ASSERT_FALSE(starts.empty());
    OrbitBranch halo(System(model), starts[0].orbit, settings);
    ASSERT_TRUE(halo.start_along(starts[0].direction, starts[0].distance)) << halo.detail();
    for (int i = 0; i < 10; ++i)
        ASSERT_TRUE(halo.step()) << halo.detail();
    const std::vector<double>& out = halo.point().solution.orbit.starts[0];
    EXPECT_GT(std::abs(out[2]) + std::abs(out[5]), 1e-2) << "out of the plane";
    EXPECT_LT(halo.point().solution.residual, 1e-10);
}

/// Along a parameter the energy stays as it is, without being told so.
TEST(Family, KeepsItsEnergyAlongAParameter) {
    const Model model = OneMode{.parameters = "k = 1",
                                .states = "x = 1\nv = 0",
                                .rates = "x = 'v', v = '-k*x'",
                                .more = section("turn", "v", "falling") + energy_of + "v^2/2 + k*x^2/2'"}
                            .model();
    const Orbit start = given_orbit(model, "turn", {{1, 0}}, {2 * pi});
    const Branch branch = follow_branch(System(model), start, in_parameter(model, "k", 0.2, 9));
    EXPECT_EQ(names(branch), "BD") << branch.detail;
    for (const BranchPoint& point : branch.points) {
        EXPECT_NEAR(point.solution.orbit.period(), 2 * pi / std::sqrt(point.parameter), 1e-10);
        EXPECT_NEAR(point.solution.orbit.starts[0][0], std::sqrt(1 / point.parameter), 1e-10);
        EXPECT_EQ(point.solution.orbit.parameters.size(), 1U);
    }
    EXPECT_EQ(branch.points.back().parameter, 9);
}

TEST(Family, KeepsItsPeriodAlongAParameterIfAsked) {
    const Model model = OneMode{.parameters = "k = 1",
                                .states = "x = 1\nv = 0",
                                .rates = "x = 'v', v = '-k*x - x^3'",
                                .more = section("turn", "v", "falling") + energy_of + "v^2/2 + k*x^2/2 + x^4/4'"}
                            .model();
    const Orbit start = given_orbit(model, "turn", {{1, 0}}, {4.768022});
    BranchSettings settings = in_parameter(model, "k", 0.2, 1.6);
    settings.monitors.emplace_back().name = "time";
    settings.monitors.back().fixed = true;
    const Branch branch = follow_branch(System(model), start, settings);
    EXPECT_EQ(names(branch), "BD") << branch.detail;
    for (const BranchPoint& point : branch.points)
        EXPECT_NEAR(point.solution.orbit.period(), branch.points[0].solution.orbit.period(), 1e-10);
    EXPECT_NEAR(branch.points[0].solution.orbit.period(), 4.768022, 1e-5);
}

/// Returns the period of x'' = -x - x^3 with an amplitude, by the substitution x = amplitude sin(angle).
double hardening_period(double amplitude) {
    double sum = 0;
    constexpr int parts = 200;
    for (int i = 0; i < parts; ++i) {
        const double a = amplitude * amplitude, sine = std::sin(2 * pi * i / parts);
        sum += 1 / std::sqrt(1 + 0.5 * a * (1 + sine * sine));
    }
    return 2 * pi * sum / parts;
}

/// In a round bowl the straight swings through its centre have every direction: energy and angular momentum are
/// conserved.
TEST(Family, WithTwoConservedQuantitiesKeepsItsDirection) {
    const Model model = OneMode{.states = "x = 1\ny = 1\nu = 0\nv = 0",
                                .definitions = "s = 'x^2 + y^2'",
                                .rates = "x = 'u', y = 'v', u = '-x*(1 + s)', v = '-y*(1 + s)'",
                                .more = section("turn", "x*u + y*v", "falling") +
                                        "[conserved]\nenergy = '(u^2 + v^2)/2 + s/2 + s^2/4'\nmomentum = 'x*v - y*u'\n"}
                            .model();
    const double half = 0.5 * hardening_period(0.7 * std::sqrt(2));
    const Orbit start = given_orbit(model, "turn^2", {{0.7, 0.7, 0, 0}, {-0.7, -0.7, 0, 0}}, {half, half});
    for (const int direction : {1, -1}) {
        const Branch branch = follow_branch(System(model), start, along("energy", 0.2, 5, direction));
        EXPECT_EQ(branch.outcome, BranchOutcome::bound) << branch.detail << ' ' << names(branch);
        for (const BranchPoint& point : branch.points) {
            const double amplitude = std::sqrt(std::sqrt(1 + 4 * point.parameter) - 1);
            const std::vector<double>& at = point.solution.orbit.starts[0];
            EXPECT_NEAR(point.solution.orbit.period(), hardening_period(amplitude), 1e-9);
            EXPECT_NEAR(at[0], amplitude / std::sqrt(2), 1e-8);
            EXPECT_NEAR(at[1], at[0], 1e-8);
            EXPECT_TRUE(point.stable);
        }
    }
}

/// The height of the next apex of a runner on a massless springy leg with a stiffness of 20 and an angle of attack of
/// 68 degrees, by Runge and Kutta's method.
double next_apex(double apex, double energy) {
    using Vector = std::array<long double, 4>;
    const long double alpha = 68 * std::numbers::pi_v<long double> / 180;
    const auto rate = [](const Vector& z) {
        const long double leg = std::hypot(z[0], z[1]), push = 20 * (1 - leg) / leg;
        return Vector{z[2], z[3], push * z[0], push * z[1] - 1};
    };
    const auto moved = [](const Vector& z, long double h, const Vector& by) {
        Vector result = z;
        for (std::size_t i = 0; i < 4; ++i)
            result[i] += h * by[i];
        return result;
    };
    const auto step = [&](const Vector& z, long double h) {
        const Vector k1 = rate(z), k2 = rate(moved(z, h / 2, k1)), k3 = rate(moved(z, h / 2, k2)),
                     k4 = rate(moved(z, h, k3));
        Vector result = z;
        for (std::size_t i = 0; i < 4; ++i)
            result[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
        return result;
    };
    constexpr long double h = 1e-4L;
    Vector z{-std::cos(alpha), std::sin(alpha), std::sqrt(2 * (energy - apex)),
             -std::sqrt(2 * (apex - std::sin(alpha)))};
    for (int i = 0; i < 100000; ++i) {
        const Vector next = step(z, h);
        if (i > 10 && std::hypot(next[0], next[1]) > 1) {
            long double low = 0, high = h;
            for (int k = 0; k < 60; ++k) {
                const long double middle = (low + high) / 2;
                const Vector there = step(z, middle);
                (std::hypot(there[0], there[1]) > 1 ? high : low) = middle;
            }
            const Vector off = step(z, low);
            return static_cast<double>(off[1] + off[3] * off[3] / 2);
        }
        z = next;
    }
    return 0;
}

Model runner() {
    return model_from(
        "[parameters]\nk = 20\nalpha = '68*pi/180'\n[states]\nx = 0\ny = 0.934\nvx = 1.2537\nvy = 0\nfoot = 0\n"
        "[definitions]\nleg = 'sqrt((x - foot)^2 + y^2)'\npush = 'k*(1 - leg)/leg'\n"
        "[modes.flight]\nrates = { x = 'vx', y = 'vy', vx = 0, vy = -1, foot = 0 }\nwatch = ['touchdown']\n"
        "[modes.stance]\nrates = { x = 'vx', y = 'vy', vx = 'push*(x - foot)', vy = 'push*y - 1', foot = 0 }\n"
        "watch = ['takeoff']\n[events]\ntouchdown = { function = 'y - sin(alpha)', kind = 'section' }\n"
        "takeoff = { function = '1 - leg', kind = 'section' }\n[jumps.step]\nfoot = 'x + cos(alpha)'\n" +
        transition("flight", "touchdown", "stance", "step", "touchdown") +
        transition("stance", "takeoff", "flight", "", "takeoff") +
        "[initial]\nmode = 'flight'\n[conserved.energy]\nvalue = '(vx^2 + vy^2)/2 + y'\n"
        "modes = { stance = '(vx^2 + vy^2)/2 + y + k*(1 - leg)^2/2' }\n");
}

/// Steps of a runner (R. Blickhan 1989; A. Seyfarth et al., J. Biomech. 35, 2002), whose place and foot are free.
TEST(Family, OfARunnersStepsAgreesWithItsApexMap) {
    const Model model = runner();
    const auto found = orbit_with_signature(System(model), parse_signature(model, "touchdown takeoff"));
    ASSERT_TRUE(found && found->outcome == OrbitOutcome::converged) << (found ? found->detail : "none");
    BranchSettings settings = along("energy", 1.6, 2);
    settings.stop_at = {PointType::grazing};
    for (const int direction : {1, -1}) {
        settings.direction = direction;
        const Branch branch = follow_branch(System(model), found->orbit, settings);
        ASSERT_GT(branch.points.size(), 5U) << branch.detail << ' ' << names(branch);
        for (const BranchPoint& point : branch.points) {
            const Orbit& orbit = point.solution.orbit;
            const std::size_t flight = model.modes[orbit.signature[0].mode].name == "flight" ? 0 : 1;
            const std::vector<double>& off = orbit.starts[flight];
            const double apex = off[1] + off[3] * off[3] / 2, step = 1e-6;
            EXPECT_NEAR(next_apex(apex, point.parameter), apex, 1e-9);
            const double slope =
                (next_apex(apex + step, point.parameter) - next_apex(apex - step, point.parameter)) / (2 * step);
            double nearest = 1e300;
            for (const std::complex<double> one : point.solution.multipliers)
                nearest = std::min(nearest, std::abs(one - slope));
            EXPECT_LT(nearest, 1e-6 * std::pow(1 + std::abs(slope), 3)) << slope;
            EXPECT_EQ(point.stable, std::abs(slope) < 1) << slope;
        }
        for (const SpecialPoint& flip : of_type(branch, PointType::flip))
            EXPECT_NE(flip.parameter, 0);
    }
}

TEST(Family, IsRefusedWhereNothingIsConserved) {
    const Model model = OneMode{.parameters = "mu = 1",
                                .states = "x = 2\nv = 0",
                                .rates = "x = 'v', v = 'mu*(1 - x^2)*v - x'",
                                .more = section("turn", "v", "falling") + energy_of + "v^2/2 + x^2/2'"}
                            .model();
    const Orbit orbit = settled(model, "turn").orbit;
    EXPECT_NE(message_of([&] {
                  OrbitBranch(System(model), orbit, along("energy"));
              }).find("'energy' is not conserved: in mode 'free' it changes at the rate"),
              std::string::npos);
    EXPECT_NE(message_of([&] {
                  OrbitBranch(System(model), orbit, along("momentum"));
              }).find("the model has no conserved quantity 'momentum'"),
              std::string::npos);
    EXPECT_NE(message_of([&] { OrbitBranch(System(model), orbit, along("period")); }).find("not conserved"),
              std::string::npos);
    Model bare = model;
    bare.conserved.clear();
    EXPECT_NE(message_of([&] {
                  OrbitBranch(System(bare), orbit, along("period"));
              }).find("the orbit is isolated at its parameters: it is not one of a family along 'period'; take out"),
              std::string::npos);
}

} // namespace graze::family_test
