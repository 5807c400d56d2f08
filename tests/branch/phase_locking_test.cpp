#include "branch/phase_locking.hpp"

#include "graze/branch/torus_branch.hpp"
#include "maps.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace graze::phase_locking_test {

using namespace graze::testing;
using ::testing::HasSubstr;

constexpr double pi = std::numbers::pi;

/// z -> z (1 + p - |z|^2) exp(i phi): its torus is the circle |z|^2 = p, whatever phi is, on which the angle advances
/// by phi. @param unit of length, and of the parameter
Model turning_map(const std::string& phase, double unit = 1) {
    const std::string size = fmt::format("(1 + p/{0} - (x^2 + y^2)/{0}^2)", unit), phi = "(" + phase + ")";
    return map_model(fmt::format("p = {}", -0.05 * unit), {fmt::format("{0}*(x*cos{1} - y*sin{1})", size, phi),
                                                           fmt::format("{0}*(x*sin{1} + y*cos{1})", size, phi)});
}

/// Im z^5.
const std::string fifth = "(5*x^4*y - 10*x^2*y^3 + y^5)";

SpecialPoint torus_point(const Model& model, const Orbit& orbit, const BranchSettings& settings) {
    const auto found = of_type(follow_branch(System(model), orbit, settings), PointType::torus);
    EXPECT_EQ(found.size(), 1U);
    return found.at(0);
}

struct FollowedTori {
    std::vector<TorusPoint> points;
    std::vector<PhaseLocking> lockings, last;
    TorusOutcome outcome = TorusOutcome::no_start;
    std::string detail;
};

/// The tori of the branch of an orbit.
FollowedTori follow_tori_of(const Orbit& orbit, const Model& model, const BranchSettings& settings,
                            const TorusResolution& resolution = {}) {
    TorusBranch branch(System(model), torus_point(model, orbit, settings), settings, resolution);
    FollowedTori tori;
    for (bool going = branch.start(); going; going = branch.step()) {
        tori.points.push_back(branch.point());
        const auto& passed = branch.point().passed;
        tori.lockings.insert(tori.lockings.end(), passed.begin(), passed.end());
    }
    tori.last = branch.last_locking();
    tori.outcome = branch.outcome();
    tori.detail = branch.detail();
    return tori;
}

/// Those of the fixed point of a map at zero.
FollowedTori follow_tori(const Model& model, const BranchSettings& settings, const TorusResolution& resolution = {}) {
    return follow_tori_of(fixed_point(model, {0, 0}), model, settings, resolution);
}

const PhaseLocking& locking_of(const std::vector<PhaseLocking>& lockings, long numerator, std::size_t denominator) {
    const Resonance wanted{numerator, denominator};
    const auto found = std::ranges::find(lockings, wanted, &PhaseLocking::resonance);
    EXPECT_NE(found, lockings.end()) << numerator << '/' << denominator;
    return found == lockings.end() ? lockings.at(0) : *found;
}

/// Returns the zero of a rising function by bisection.
double zero_of(const std::function<double(double)>& function, double low, double high) {
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        ((function(middle) < 0) == (function(low) < 0) ? low : high) = middle;
    }
    return low;
}

void expect_located(const PhaseLocking& locking, double begin, double end, double tolerance) {
    ASSERT_EQ(locking.known, PhaseLocking::Width::located) << locking.problem;
    ASSERT_EQ(locking.ends.size(), 2U);
    EXPECT_NEAR(locking.ends[0].parameter, begin, tolerance);
    EXPECT_NEAR(locking.ends[1].parameter, end, tolerance);
    EXPECT_NEAR(locking.width, std::abs(end - begin), 2 * tolerance);
    for (const SpecialPoint& one : locking.ends) {
        EXPECT_EQ(one.type, PointType::locking);
        EXPECT_EQ(one.solution.orbit.segments(), locking.resonance.denominator);
        EXPECT_TRUE(one.solution.certificate.admissible) << one.solution.certificate.reason;
        EXPECT_LT(nearest_multiplier(one.solution, 1), 1e-5);
    }
}

/// With the phase 2 pi (w + b p) + e Im z^5 the tongue 1/5 ends where 2 pi (w + b p - 1/5) = +- e p^(5/2).
struct FifthTongue {
    double w, b, e;
    std::string phase(double unit = 1) const {
        return fmt::format("2*pi*({} + {}*p/{}) + {}*{}/{}^5", w, b, unit, e, fifth, unit);
    }
    double end(double sign) const {
        const double middle = (0.2 - w) / b;
        return zero_of(
            [&](double p) { return 2 * pi * (w + b * p - 0.2) * (b < 0 ? -1 : 1) - sign * e * std::pow(p, 2.5); },
            0.5 * middle, 1.7 * middle);
    }
};

/// The coefficient at a fixed point of zero, which does not tell the size of displacements.
TEST(PhaseLocking, TorusPointsHaveTheirCoefficientInAnyUnit) {
    for (const auto& [unit, coefficient] :
         {std::pair(1.0, "-2"), {1e-9, "-2e+18"}, {1e-6, "-2e+12"}, {1e-3, "-2e+06"}}) {
        const Model model = turning_map(fmt::format("2*pi*(0.14 + 0.05*(x^2 + y^2)/{}^2)", unit), unit);
        const SpecialPoint point =
            torus_point(model, fixed_point(model, {0, 0}), in_parameter(model, "p", -0.1 * unit, 0.05 * unit));
        EXPECT_EQ(point.detail, fmt::format("supercritical, d = {}", coefficient));
    }
}

/// Seven angles cannot tell a term of the seventh harmonic from a constant one. The image of each angle must lie on the
/// circle.
TEST(PhaseLocking, ToriOfAMapWithSevenfoldSymmetryHaveTheHarmonicsThatTheyNeed) {
    const std::string size = "(1 + p - (x^2 + y^2))", turn = "(2*pi*(0.14 + 0.05*(x^2 + y^2)))";
    const Model model = map_model(
        "p = -0.05", {size + "*(x*cos" + turn + " - y*sin" + turn + ") + 2*(x^6 - 15*x^4*y^2 + 15*x^2*y^4 - y^6)",
                      size + "*(x*sin" + turn + " + y*cos" + turn + ") - 2*(6*x^5*y - 20*x^3*y^3 + 6*x*y^5)"});
    const FollowedTori tori = follow_tori(model, in_parameter(model, "p", -0.1, 0.03));
    EXPECT_EQ(tori.outcome, TorusOutcome::bound) << tori.detail;
    ASSERT_GT(tori.points.size(), 3U);
    for (const TorusPoint& one : tori.points) {
        const double radius = std::sqrt(one.parameter);
        for (const double turns : {0.01, 0.17, 0.33, 0.59, 0.83}) {
            const std::vector<double> from = one.torus.state_at(turns),
                                      to = one.torus.state_at(turns + one.torus.rotation);
            const std::complex<double> z{from[0], from[1]};
            const std::complex<double> image =
                (1 + one.parameter - std::norm(z)) * z * std::polar(1.0, 2 * pi * (0.14 + 0.05 * std::norm(z))) +
                2.0 * std::pow(std::conj(z), 6);
            EXPECT_LT(std::abs(image - std::complex(to[0], to[1])), 1e-7 * radius) << one.parameter << ' ' << turns;
        }
    }
}

TEST(PhaseLocking, TonguesNarrowerThanStepsHaveTheirClosedForm) {
    for (const double e : {1e-6, 0.3})
        for (const double b : {0.1, -0.1}) {
            const FifthTongue tongue{b > 0 ? 0.19 : 0.21, b, e};
            const Model model = turning_map(tongue.phase());
            const FollowedTori tori = follow_tori(model, in_parameter(model, "p", -0.05, 0.15));
            EXPECT_EQ(tori.outcome, TorusOutcome::bound) << tori.detail;
            const PhaseLocking& locking = locking_of(tori.lockings, 1, 5);
            expect_located(locking, tongue.end(-1), tongue.end(1), 1e-14);
            EXPECT_THAT(locking.ends.at(0).detail, HasSubstr("locking 1/5 begins"));
            EXPECT_THAT(locking.ends.at(1).detail, HasSubstr("locking 1/5 ends"));
        }
}

TEST(PhaseLocking, TonguesBelowTheAccuracyAreBounded) {
    for (const double e : {0.0, 1e-11, 1e-13}) {
        const FifthTongue tongue{0.19, 0.1, e};
        const Model model = turning_map(tongue.phase());
        const FollowedTori tori = follow_tori(model, in_parameter(model, "p", -0.05, 0.15));
        const PhaseLocking& locking = locking_of(tori.lockings, 1, 5);
        ASSERT_EQ(locking.known, PhaseLocking::Width::bounded) << e;
        EXPECT_TRUE(locking.ends.empty());
        EXPECT_NEAR(locking.parameter, 0.1, 1e-12);
        EXPECT_LT(tongue.end(1) - tongue.end(-1), locking.width) << e;
        EXPECT_LT(locking.width, 1e-12) << e;
    }
}

TEST(PhaseLocking, WideTonguesAreEnteredAndLeft) {
    for (const double b : {0.1, -0.1}) {
        const FifthTongue tongue{b > 0 ? 0.19 : 0.21, b, 1.5};
        const Model model = turning_map(tongue.phase());
        const FollowedTori tori = follow_tori(model, in_parameter(model, "p", -0.05, 0.2));
        EXPECT_EQ(tori.outcome, TorusOutcome::bound) << tori.detail;
        const double begin = tongue.end(-1), end = tongue.end(1);
        EXPECT_GT(end - begin, 0.015);
        expect_located(locking_of(tori.lockings, 1, 5), begin, end, 1e-14);
        std::size_t before = 0, beyond = 0;
        for (const TorusPoint& one : tori.points) {
            const double p = one.parameter;
            EXPECT_TRUE(p < begin || p > end) << p;
            ++(p < begin ? before : beyond);
            for (const double turns : {0.0, 0.3, 0.7})
                EXPECT_NEAR(std::hypot(one.torus.state_at(turns)[0], one.torus.state_at(turns)[1]), std::sqrt(p), 1e-8);
            // 5 theta advances as a circle map, of which this is the rotation number to first order.
            EXPECT_EQ(one.torus.rotation < 0.2, (p < begin) == (b > 0)) << p;
        }
        EXPECT_GT(before, 5U);
        EXPECT_GT(beyond, 2U);
    }
}

/// Tori on the other side of the torus point, unstable ones: |z|^2 = -p.
TEST(PhaseLocking, OfUnstableToriIsFoundAlike) {
    const FifthTongue tongue{0.19, 0.1, 0.3};
    const std::string phi = fmt::format("(2*pi*(0.19 - 0.1*p) + 0.3*{})", fifth);
    const Model model = map_model("p = 0.05", {"(1 + p + x^2 + y^2)*(x*cos" + phi + " - y*sin" + phi + ")",
                                               "(1 + p + x^2 + y^2)*(x*sin" + phi + " + y*cos" + phi + ")"});
    const FollowedTori tori = follow_tori(model, in_parameter(model, "p", -0.15, 0.05, -1));
    EXPECT_EQ(tori.outcome, TorusOutcome::bound) << tori.detail;
    EXPECT_FALSE(tori.points.at(0).stable);
    expect_located(locking_of(tori.lockings, 1, 5), -tongue.end(-1), -tongue.end(1), 1e-13);
}

TEST(PhaseLocking, DoesNotDependOnUnits) {
    const FifthTongue narrow{0.19, 0.1, 1e-3}, wide{0.19, 0.1, 1.5};
    for (const auto& [unit, tongue] : {std::pair(1e-6, narrow), std::pair(1e6, wide)}) {
        const Model model = turning_map(tongue.phase(unit), unit);
        const FollowedTori tori = follow_tori(model, in_parameter(model, "p", -0.05 * unit, 0.2 * unit));
        EXPECT_EQ(tori.outcome, TorusOutcome::bound) << unit << tori.detail;
        expect_located(locking_of(tori.lockings, 1, 5), unit * tongue.end(-1), unit * tongue.end(1), 1e-13 * unit);
    }
}

/// The rotation number 0: 2 pi (0.05 - p/2) = +- e sqrt(p), with the phase 2 pi (0.05 - p/2) + e y.
TEST(PhaseLocking, ToTheReturnItselfIsThatOfTheRotationNumberZero) {
    const auto end = [](double e, double sign) {
        return zero_of([&](double p) { return 2 * pi * (p / 2 - 0.05) - sign * e * std::sqrt(p); }, 0.02, 0.25);
    };
    for (const double e : {1e-7, 0.05}) {
        const Model model = turning_map(fmt::format("2*pi*(0.05 - p/2) + {}*y", e));
        const FollowedTori tori = follow_tori(model, in_parameter(model, "p", -0.05, 0.3));
        EXPECT_EQ(tori.outcome, TorusOutcome::bound) << tori.detail;
        expect_located(locking_of(tori.lockings, 0, 1), end(e, -1), end(e, 1), 1e-13);
        EXPECT_LT(tori.points.back().torus.rotation, 0);
    }
}

/// Returns the extremes of the parameter at which an angle returns after q advances to itself, p turns on: the ends of
/// the tongue of a map of angles. @param advance of an angle at a parameter
std::pair<double, double> ends_of_tongue(const std::function<double(double, double)>& advance, long numerator,
                                         std::size_t q, double low, double high) {
    const auto parameter_at = [&](double angle) {
        return zero_of(
            [&](double p) {
                double at = angle;
                for (std::size_t k = 0; k < q; ++k)
                    at += advance(at, p);
                return at - angle - 2 * pi * static_cast<double>(numerator);
            },
            low, high);
    };
    const auto extreme = [&](double sign) {
        constexpr int samples = 64;
        const double step = 2 * pi / static_cast<double>(q) / samples;
        double best = 0, value = sign * parameter_at(0);
        for (int k = 1; k < samples; ++k)
            if (const double one = sign * parameter_at(k * step); one < value) {
                value = one;
                best = k * step;
            }
        double from = best - step, to = best + step;
        for (int i = 0; i < 60; ++i) { // golden sections
            const double part = 0.3819660112501051 * (to - from), left = from + part, right = to - part;
            (sign * parameter_at(left) < sign * parameter_at(right) ? to : from) =
                sign * parameter_at(left) < sign * parameter_at(right) ? right : left;
        }
        return parameter_at(0.5 * (from + to));
    };
    return {extreme(1), extreme(-1)};
}

/// Tongues of several resonances, of which those other than 1/5 come from terms of higher order, against the map of
/// angles alone.
TEST(PhaseLocking, SeveralTonguesAreThoseOfTheMapOfAngles) {
    const auto advance = [](double angle, double p) {
        return 2 * pi * (0.19 + 0.4 * p) + std::pow(p, 1.5) * std::sin(3 * angle) +
               std::pow(p, 2.5) * std::sin(5 * angle);
    };
    const Model model = turning_map(fmt::format("2*pi*(0.19 + 0.4*p) + 3*x^2*y - y^3 + {}", fifth));
    const FollowedTori tori = follow_tori(model, in_parameter(model, "p", -0.05, 0.17));
    EXPECT_EQ(tori.outcome, TorusOutcome::bound) << tori.detail;
    for (const auto& [numerator, q] : {std::pair<long, std::size_t>{1, 5}, {2, 9}, {1, 4}}) {
        const PhaseLocking& locking = locking_of(tori.lockings, numerator, q);
        const double middle = (locking.resonance.value() - 0.19) / 0.4;
        const auto [begin, end] = ends_of_tongue(advance, numerator, q, 0.5 * middle, 1.5 * middle);
        if (locking.known == PhaseLocking::Width::bounded) {
            EXPECT_LT(end - begin, locking.width) << numerator << '/' << q;
        } else {
            expect_located(locking, begin, end, 1e-13);
        }
    }
    // In the order of the branch, and each once.
    for (std::size_t k = 1; k < tori.lockings.size(); ++k)
        EXPECT_LT(tori.lockings[k - 1].resonance.value(), tori.lockings[k].resonance.value());
}

/// (x, y) turns about an orbit of period 2 pi with the phase theta: z' = (p + i w) z - z |z|^2 + i e z Im(z^5 exp(-i
/// theta)), with w = 0.19 + 0.1 p. Then 5 arg z - theta is slow, and rests if |w - 1/5| < e p^(5/2).
TEST(PhaseLocking, OfDrivenAndOfFreeOscillatorsHasItsClosedForm) {
    const std::string re = "(a^5 - 10*a^3*b^2 + 5*a*b^4)", im = "(5*a^4*b - 10*a^2*b^3 + b^5)";
    for (const auto& [e, is_driven] : {std::pair(1e-3, true), std::pair(0.2, false)}) {
        const double share = e;
        const auto end = [&](double sign) {
            return zero_of([&](double p) { return 0.1 * p - 0.01 - sign * share * std::pow(p, 2.5); }, 0.05, 0.17);
        };
        const std::string turning = fmt::format("(0.19 + 0.1*p + {}*({}*c - {}*d))", e, im, re);
        const std::string rate_a = "p*a - " + turning + "*b - a*(a^2 + b^2)",
                          rate_b = "p*b + " + turning + "*a - b*(a^2 + b^2)";
        const Model forced = OneMode{.parameters = "p = -0.1",
                                     .states = "x = 1\ny = 0",
                                     .definitions = "a = 'x - cos(theta)'\nb = 'y'\nc = 'cos(theta)'\nd = "
                                                    "'sin(theta)'",
                                     .rates = "x = '" + rate_a + " - sin(theta)', y = '" + rate_b + "'",
                                     .clock = "1"}
                                 .model(),
                    free = OneMode{.parameters = "p = -0.1",
                                   .states = "c = 1\nd = 0.1\nx = 1.1\ny = 0.1",
                                   .definitions = "a = 'x - c'\nb = 'y'\nf = '1 - c^2 - d^2'",
                                   .rates = "c = '-d + c*f', d = 'c + d*f', x = '" + rate_a + " - d + c*f', y = '" +
                                            rate_b + "'",
                                   .more = section("start", "d")}
                               .model();
        const Model& model = is_driven ? forced : free;
        const BranchSettings settings = in_parameter(model, "p", -0.1, 0.17);
        const FollowedTori tori = follow_tori_of(settled(model, "start").orbit, model, settings);
        EXPECT_EQ(tori.outcome, TorusOutcome::bound) << tori.detail;
        expect_located(locking_of(tori.lockings, 1, 5), end(-1), end(1), 1e-11);
        EXPECT_NEAR(locking_of(tori.lockings, 1, 5).ends[0].solution.orbit.period(), 10 * pi, 1e-9);
    }
}

/// Forced van der Pol oscillator, against the folds of the branch of orbits on which simulation settles in the tongue.
TEST(PhaseLocking, OfVanDerPolEndsAtTheFoldsOfTheOrbitThatIsSimulated) {
    const Model model = driven("F = 2\nomega = 1.5", "0.3*(1 - x^2)*v - x + F*cos(theta)", "omega");
    const BranchSettings settings = in_parameter(model, "F", 0.5, 2, -1);
    const FollowedTori tori = follow_tori_of(settled(model, "start").orbit, model, settings);
    EXPECT_EQ(tori.outcome, TorusOutcome::bound) << tori.detail;
    const PhaseLocking& locking = locking_of(tori.lockings, 1, 3);
    Model within = model;
    within.set_parameter("F", 0.9717);
    const OrbitSolution orbit = settled(within, "start");
    ASSERT_EQ(orbit.orbit.segments(), 3U);
    std::vector<double> folds;
    for (const int direction : {1, -1}) {
        const Branch orbits =
            follow_branch(System(within), orbit.orbit, in_parameter(within, "F", 0.9, 1.1, direction));
        const auto fold = of_type(orbits, PointType::fold);
        ASSERT_FALSE(fold.empty()) << names(orbits);
        folds.push_back(fold[0].parameter);
    }
    expect_located(locking, folds[0], folds[1], 1e-11);
}

TEST(PhaseLocking, BeyondTheBoundEndsTheBranch) {
    const FifthTongue tongue{0.19, 0.1, 1.5};
    const Model model = turning_map(tongue.phase());
    const FollowedTori tori = follow_tori(model, in_parameter(model, "p", -0.05, 0.1));
    EXPECT_EQ(tori.outcome, TorusOutcome::not_resolved);
    EXPECT_EQ(tori.detail, "the torus locks at the rotation number 1/5: up to the bound");
    ASSERT_EQ(tori.last.size(), 1U);
    expect_located(tori.last[0], tongue.end(-1), tongue.end(1), 1e-13);
}

/// 2 pi 0.1 (p - 0.1) = e p^(5/2) has no solution for e = 10: the orbits do not end.
TEST(PhaseLocking, ThatDoesNotEndIsToldByItsBegin) {
    const FifthTongue tongue{0.19, 0.1, 10};
    const Model model = turning_map(tongue.phase());
    const FollowedTori tori = follow_tori(model, in_parameter(model, "p", -0.05, 0.3));
    EXPECT_EQ(tori.outcome, TorusOutcome::not_resolved);
    EXPECT_THAT(tori.detail, HasSubstr("locks at the rotation number 1/5: they go on beyond"));
    ASSERT_EQ(tori.last.size(), 1U);
    EXPECT_EQ(tori.last[0].known, PhaseLocking::Width::one_end);
    ASSERT_EQ(tori.last[0].ends.size(), 1U);
    EXPECT_NEAR(tori.last[0].ends[0].parameter, tongue.end(-1), 1e-13);
    EXPECT_THAT(tori.last[0].ends[0].detail, HasSubstr("the other end was not found"));
}

/// The first torus lies beyond the tongue, or so near that the step that is asked for would lie in it.
TEST(PhaseLocking, BeforeTheFirstTorusIsTold) {
    const FifthTongue tongue{0.19, 0.1, 0.3};
    const Model model = turning_map(tongue.phase());
    for (const double first : {0.45, 0.5}) {
        BranchSettings settings = in_parameter(model, "p", -0.05, 0.3);
        settings.continuation.first_step = first;
        settings.continuation.largest_step = 0.5;
        const FollowedTori tori = follow_tori(model, settings);
        ASSERT_FALSE(tori.points.empty()) << tori.detail;
        expect_located(locking_of(tori.lockings, 1, 5), tongue.end(-1), tongue.end(1), 1e-13);
    }
}

} // namespace graze::phase_locking_test
