// Curves of special points in two parameters, against closed forms and published values; every point is verified
// independently.

#include "follow.hpp"
#include "impact_oscillator.hpp"

#include "graze/branch/curve_start.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace graze::curve_test {

using namespace graze::testing;
using std::numbers::pi;

/// Verifies a point by its multipliers, or by the event minimum on the arc, not by the held condition.
void expect_kept(const BranchPoint& point, const SpecialPoint& kept, double tolerance) {
    if (kept.type == PointType::fold) {
        EXPECT_LT(nearest_multiplier(point.solution, 1), tolerance);
    }
    if (kept.type == PointType::flip) {
        EXPECT_LT(nearest_multiplier(point.solution, -1), tolerance);
    }
    if (kept.type != PointType::grazing || kept.at_end)
        return;
    double nearest = std::numeric_limits<double>::infinity();
    for (const OrbitMinimum& minimum : point.solution.certificate.minima)
        if (minimum.segment == kept.segment && minimum.event == kept.event)
            nearest = std::min(nearest, std::abs(minimum.value));
    EXPECT_LT(nearest, tolerance);
    EXPECT_TRUE(point.solution.certificate.admissible) << point.solution.certificate.reason;
}

/// Returns the special point of a type nearest to a value of the parameter.
SpecialPoint nearest(const Branch& branch, PointType type, double parameter) {
    const auto all = of_type(branch, type);
    EXPECT_FALSE(all.empty()) << short_name(type);
    return all.empty() ? SpecialPoint{}
                       : *std::min_element(all.begin(), all.end(), [&](const auto& one, const auto& other) {
                             return std::abs(one.parameter - parameter) < std::abs(other.parameter - parameter);
                         });
}

TEST(Curves, BouncingBallHasItsClosedForms) {
    // One bounce per period: see closed_forms_test.
    const double g = 9.81, w = 20 * pi, e = 0.8;
    const auto fold = [&](double at) { return g / (w * w) * pi * (1 - at) / (1 + at); };
    const auto flip = [&](double at) {
        return g / (w * w) * std::hypot(pi * (1 - at) / (1 + at), 2 * (1 + at * at) / ((1 + at) * (1 + at)));
    };
    const double a = 0.5 * (fold(e) + flip(e)), phase = std::acos((1 - e) / (1 + e) * g / (20 * a * w));
    const Model model = shipped_with("bouncing-ball", {{"g", g}, {"e", e}, {"f", 10}, {"a", a}});
    const Orbit orbit = given_orbit(model, "impact", {{a * std::sin(phase), g / 20, phase}}, {0.1});
    for (const int direction : {1, -1}) {
        BranchSettings settings = in_parameter(model, "a", 1e-5, 0.01, direction);
        settings.stop_at = {PointType::fold, PointType::flip};
        const Branch branch = follow_branch(System(model), orbit, settings);
        ASSERT_EQ(branch.outcome, BranchOutcome::stopped);
        settings.stop_at.clear();
        const SpecialPoint& point = branch.special.back();
        for (const int way : {1, -1}) {
            const Branch curve = curve_of(model, point, settings, "e", 0.1, 0.95, way);
            EXPECT_EQ(curve.outcome, BranchOutcome::bound) << curve.detail;
            EXPECT_EQ(names(curve), "BD");
            EXPECT_LT(curve.points.size(), 100U);
            for (const BranchPoint& one : curve.points) {
                const double at = value_of(model, one.solution, "e");
                const bool folds = point.type == PointType::fold;
                EXPECT_NEAR(one.parameter, folds ? fold(at) : flip(at), 1e-12 * flip(at)) << at;
                // Near a fold a multiplier is known only to the square root of the error.
                expect_kept(one, point, folds ? 1e-6 : 1e-9);
            }
        }
    }
}

/// Returns the distance of a gap from that of the flip of orbits with one impact per period. @param after velocity
/// after the impact
double off_flip(const Oscillator& known, double sigma, double after) {
    return known.trace(after, known.phase(after, sigma), sigma) + 1 + known.product();
}

TEST(Curves, ImpactOscillatorHasItsClosedForms) {
    const Model model = oscillator_model(Oscillator(), 0.02);
    const OrbitSolution start = settled(model, "phase0", 400);
    // Where half an oscillation takes one period of the force, an impact has no effect on the next one: curves end
    // there.
    const double half = 2 * std::sqrt(1 - 0.05 * 0.05);
    SpecialPoint end_of_folds;
    for (const int direction : {1, -1}) {
        BranchSettings settings = in_parameter(model, "sigma", -1, 1, direction);
        const Branch branch = follow_branch(System(model), start.orbit, settings);
        ASSERT_EQ(names(branch), direction > 0 ? "PD GR" : "SN GR");
        for (const SpecialPoint& point : branch.special)
            for (const int way : {1, -1}) {
                const Branch curve = curve_of(model, point, settings, "omega", 0.7, 6, way);
                ASSERT_GT(curve.points.size(), 10U);
                EXPECT_LT(curve.points.size(), 200U);
                for (const BranchPoint& one : curve.points) {
                    const Oscillator known(value_of(model, one.solution, "omega"));
                    const double after = one.solution.orbit.starts[0][1];
                    const double speed = std::abs(after);
                    if (point.type == PointType::fold) {
                        EXPECT_NEAR(one.parameter, known.fold(false), 1e-10);
                    }
                    if (point.type == PointType::grazing && point.at_end) {
                        EXPECT_NEAR(one.parameter, known.radius, 1e-10);
                    }
                    if (point.type == PointType::flip && speed > 1e-3) {
                        EXPECT_NEAR(off_flip(known, one.parameter, after) * speed, 0, 1e-10);
                        EXPECT_NEAR(known.sigma(after, true), one.parameter, 1e-10);
                    }
                    if (speed > 1e-3) // towards zero speed multipliers diverge
                        expect_kept(one, point, point.type == PointType::fold ? 1e-6 : 1e-9);
                }
                if (curve.outcome == BranchOutcome::bound)
                    continue;
                EXPECT_EQ(curve.outcome, BranchOutcome::unphysical);
                const SpecialPoint& last = curve.special.back();
                EXPECT_EQ(last.type, PointType::grazing) << names(curve);
                if (point.type == PointType::flip) {
                    EXPECT_TRUE(last.at_end);
                    EXPECT_NEAR(value_of(model, last.solution, "omega"), half, 1e-9);
                    EXPECT_NEAR(last.parameter, Oscillator(half).radius, 1e-9);
                }
                if (point.type == PointType::fold)
                    end_of_folds = last;
                else if (direction < 0)
                    ADD_FAILURE() << "touches go on to the bounds";
            }
        if (direction > 0)
            continue;
        // The curve of folds ends on the curve of touches, which has a multiplier 1 there.
        ASSERT_EQ(end_of_folds.type, PointType::grazing);
        const Branch touches = curve_of(model, branch.special.back(), settings, "omega", 0.7, 6, 1);
        const SpecialPoint meeting = nearest(touches, PointType::fold, end_of_folds.parameter);
        EXPECT_NEAR(meeting.parameter, end_of_folds.parameter, 1e-11);
        EXPECT_NEAR(value_of(model, meeting.solution, "omega"), value_of(model, end_of_folds.solution, "omega"), 1e-11);
        EXPECT_LT(nearest_multiplier(meeting.solution, 1), 1e-6);
    }
}

/// The impact oscillator with a stop, an amplitude of the force and a displacement at first.
Model in_units(double sigma, double amplitude, double x) {
    Model model = oscillator_model(Oscillator(), sigma);
    model.set_parameter("amplitude", amplitude);
    return started(model, {{"x", x}});
}

TEST(Curves, FoldsThatEndInATouchHaveNoResonanceInAnyUnits) {
    // The product of the two multipliers is below 1 due to the losses, so both cannot be 1.
    for (const double length : {1.0, 1e-9, 1e6}) {
        const Model model = in_units(0.02 * length, length, (0.02 - 1) * length);
        BranchSettings settings = in_parameter(model, "sigma", -length, length, -1);
        const Branch branch = follow_branch(System(model), settled(model, "phase0", 400).orbit, settings);
        ASSERT_EQ(names(branch), "SN GR") << length;
        std::size_t ends = 0;
        for (const int way : {1, -1}) {
            const Branch curve = curve_of(model, branch.special[0], settings, "omega", 0.7, 6, way);
            ASSERT_GT(curve.points.size(), 5U) << curve.detail;
            EXPECT_TRUE(of_type(curve, PointType::resonance_1).empty()) << names(curve) << ' ' << length;
            for (const BranchPoint& one : curve.points)
                EXPECT_NEAR(one.parameter, length * Oscillator(value_of(model, one.solution, "omega")).fold(false),
                            1e-10 * length);
            ends += curve.outcome == BranchOutcome::unphysical && curve.special.back().type == PointType::grazing;
        }
        EXPECT_EQ(ends, 1U) << length;
    }
}

TEST(Curves, TouchesOfALinearOscillatorFollowItsResponse) {
    const Model model = in_units(0.1, 0.1, 0);
    BranchSettings settings = in_parameter(model, "amplitude", 0, 10);
    const Branch free = follow_branch(System(model), settled(model, "phase0").orbit, settings);
    ASSERT_EQ(names(free), "GR");
    std::size_t turns = 0;
    for (const int way : {1, -1}) {
        const Branch curve = curve_of(model, free.special[0], settings, "omega", 0.2, 5, way);
        EXPECT_EQ(curve.outcome, BranchOutcome::bound) << curve.detail;
        for (const BranchPoint& one : curve.points) {
            EXPECT_NEAR(one.parameter * Oscillator(value_of(model, one.solution, "omega")).radius, 0.1, 1e-11);
            expect_kept(one, free.special[0], 1e-12);
        }
        // The force is least at resonance.
        for (const SpecialPoint& turn : of_type(curve, PointType::extremum)) {
            ++turns;
            EXPECT_NEAR(value_of(model, turn.solution, "omega"), std::sqrt(1 - 2 * 0.05 * 0.05), 1e-9);
            EXPECT_NEAR(turn.parameter, 0.1 * 2 * 0.05 * std::sqrt(1 - 0.05 * 0.05), 1e-12);
            EXPECT_EQ(turn.detail.substr(0, 9), "amplitude");
        }
    }
    EXPECT_EQ(turns, 1U);
}

Model duffing(double frequency, double force) {
    return driven(fmt::format("zeta = 0.1\nw = {:.17g}\nF = {:.17g}", frequency, force),
                  "F*cos(theta) - 2*zeta*v - x - x^3", "w");
}

Branch over_frequency(double force) {
    const Model model = duffing(0.9, force);
    const BranchSettings settings = in_parameter(model, "w", 0.5, 3);
    return follow_branch(System(model), settled(model, "start").orbit, settings);
}

TEST(Curves, FoldsOfDuffingsOscillatorPassTheCusp) {
    const Model model = duffing(0.9, 0.4);
    const Branch branch = over_frequency(0.4), stronger = over_frequency(0.6);
    ASSERT_EQ(names(branch), "SN SN BD");
    ASSERT_EQ(names(stronger), "SN SN BD");
    BranchSettings settings = in_parameter(model, "w", 0.5, 4);
    std::vector<SpecialPoint> cusps;
    for (const std::size_t which : {0, 1}) {
        // In one direction the curve leads away from the cusp, in the other through it to the other fold.
        const Branch away = curve_of(model, branch.special[which], settings, "F", 0.01, 0.6, 1);
        ASSERT_EQ(names(away), "BD") << away.detail;
        EXPECT_NEAR(away.points.back().parameter, stronger.special[which].parameter, 1e-10);
        const Branch curve = curve_of(model, branch.special[which], settings, "F", 0.01, 0.6, -1);
        ASSERT_EQ(names(curve), "CP BD") << curve.detail;
        EXPECT_NEAR(curve.points.back().parameter, stronger.special[1 - which].parameter, 1e-10);
        cusps.push_back(curve.special[0]);
        for (const BranchPoint& one : curve.points)
            expect_kept(one, branch.special[which], 1e-5);
        // Both parameters have an extremum there.
        EXPECT_TRUE(cusps.back().located);
        const double force = value_of(model, cusps.back().solution, "F");
        for (const BranchPoint& one : curve.points) {
            EXPECT_GE(value_of(model, one.solution, "F"), force - 1e-12);
            EXPECT_GE(one.parameter, cusps.back().parameter - 1e-12);
        }
        for (const double rise : cusps.back().tangent.parameters)
            EXPECT_LT(std::abs(rise), 1e-7);
    }
    EXPECT_NEAR(cusps[0].parameter, cusps[1].parameter, 1e-10);
    const double force = value_of(model, cusps[0].solution, "F");
    EXPECT_NEAR(value_of(model, cusps[1].solution, "F"), force, 1e-10);
    // There are two folds above it, and none below.
    EXPECT_EQ(of_type(over_frequency(force * 1.001), PointType::fold).size(), 2U);
    EXPECT_EQ(of_type(over_frequency(force * 0.999), PointType::fold).size(), 0U);
}

/// Returns the points of vanishing sensitivity along the touches of an oscillator over its frequency.
std::vector<SpecialPoint> sensitivities(const Model& model, int way) {
    const Branch branch =
        follow_branch(System(model), settled(model, "phase0", 400).orbit, in_parameter(model, "sigma", -1, 3, -1));
    EXPECT_EQ(names(branch), "GR");
    return of_type(curve_of(model, branch.special.at(0), in_parameter(model, "sigma", -1, 30), "omega", 0.6, 3, way),
                   PointType::sensitivity);
}

TEST(Curves, TouchesHaveVanishingSensitivityAtTheKnownFrequencies) {
    // The effect of an impact on the position vanishes after each half oscillation: at omega = 2 omega_d / k.
    Oscillator known;
    const Model model = oscillator_model(known, 1);
    std::vector<double> found;
    for (const int way : {1, -1})
        for (const SpecialPoint& one : sensitivities(model, way))
            found.push_back(value_of(model, one.solution, "omega"));
    std::sort(found.begin(), found.end());
    const double own = std::sqrt(1 - known.zeta * known.zeta);
    ASSERT_EQ(found.size(), 3U);
    for (const std::size_t k : {1U, 2U, 3U})
        EXPECT_NEAR(found[3 - k], 2 * own / static_cast<double>(k), 1e-9) << k;
}

TEST(Curves, BoundaryBetweenClassesOfTouchesHasItsClosedForm) {
    // For any damping omega = 2 sqrt(1 - zeta^2) / k, and sigma is the amplitude there.
    Oscillator known;
    const Model model = oscillator_model(known, 1);
    const auto found = sensitivities(model, 1);
    ASSERT_FALSE(found.empty());
    for (const SpecialPoint& one : found) {
        const double k =
            std::round(2 * std::sqrt(1 - known.zeta * known.zeta) / value_of(model, one.solution, "omega"));
        BranchSettings boundary = in_parameter(model, "zeta", 0.01, 0.5);
        boundary.free = {model.independent_parameter("omega"), model.independent_parameter("sigma")};
        boundary.kept = as_type(one, PointType::grazing);
        boundary.kept_too = PointType::sensitivity;
        for (const int way : {1, -1}) {
            boundary.direction = way;
            const Branch curve = follow_branch(System(model), one.solution.orbit, boundary);
            EXPECT_EQ(curve.outcome, BranchOutcome::bound) << curve.detail;
            ASSERT_GT(curve.points.size(), 5U);
            EXPECT_NEAR(curve.points.back().parameter, way > 0 ? 0.5 : 0.01, 1e-12);
            for (const BranchPoint& point : curve.points) {
                const double zeta = point.parameter, omega = 2 * std::sqrt(1 - zeta * zeta) / k;
                EXPECT_NEAR(value_of(model, point.solution, "omega"), omega, 1e-11) << zeta;
                const double amplitude = 1 / std::hypot(1 - omega * omega, 2 * zeta * omega);
                EXPECT_NEAR(value_of(model, point.solution, "sigma") / amplitude, 1, 1e-11) << zeta;
                expect_kept(point, *boundary.kept, 1e-11 * amplitude);
            }
        }
        boundary.free.pop_back(); // a curve of codimension two needs three parameters
        EXPECT_THROW(follow_branch(System(model), one.solution.orbit, boundary), InputError);
        boundary.kept_too = PointType::fold;
        EXPECT_THROW(follow_branch(System(model), one.solution.orbit, boundary), InputError);
    }
}

TEST(Curves, MicroactuatorHasItsPublishedValues) {
    const Model model = shipped_with("impact-microactuator", {{"V", 0.1}, {"omega", 0.9189}});
    const BranchSettings settings = in_parameter(model, "V", 0, 3);
    const Branch branch = follow_branch(System(model), settled(model, "longest", 4000).orbit, settings);
    ASSERT_EQ(names(branch), "PD PD SN GR");
    const SpecialPoint grazing = branch.special.back();
    const Branch first = curve_of(model, grazing, settings, "omega", 0.15, 3, 1);
    EXPECT_EQ(first.outcome, BranchOutcome::bound) << first.detail;
    for (const BranchPoint& one : first.points)
        expect_kept(one, grazing, 1e-10);
    const SpecialPoint least = nearest(first, PointType::extremum, 0.17);
    EXPECT_NEAR(value_of(model, least.solution, "omega"), 0.48719539788245, 1e-12);
    EXPECT_NEAR(least.parameter, 0.17099889286674, 1e-13);
    // Curves of folds and flips with one impact end at the touch of vanishing sensitivity.
    const Branch slower = curve_of(model, grazing, settings, "omega", 0.15, 3, -1);
    const auto less = of_type(first, PointType::sensitivity), more = of_type(slower, PointType::sensitivity);
    std::vector<SpecialPoint> joints(less);
    joints.insert(joints.end(), more.begin(), more.end());
    const std::pair<double, double> published[] = {{0.61364946180363, 0.58163432990654},
                                                   {0.48780870043972, 0.17106668895821}};
    for (const std::pair<double, double>& at : published)
        EXPECT_TRUE(std::any_of(joints.begin(), joints.end(), [&](const SpecialPoint& one) {
            return std::abs(one.parameter - at.second) < 1e-9 &&
                   std::abs(value_of(model, one.solution, "omega") - at.first) < 1e-9;
        })) << at.first;
    // Curves of flips and folds end on the curve of touches, where it has a multiplier -1 or 1.
    for (std::size_t i = 0; i < 3; ++i) {
        const SpecialPoint& point = branch.special[i];
        const Branch curve = curve_of(model, point, settings, "omega", 0.15, 3, 1);
        for (const BranchPoint& one : curve.points)
            expect_kept(one, point, point.type == PointType::fold ? 1e-6 : 1e-9);
        ASSERT_EQ(curve.outcome, BranchOutcome::unphysical) << curve.detail;
        const SpecialPoint& last = curve.special.back();
        EXPECT_EQ(last.type, PointType::grazing);
        const SpecialPoint meeting = nearest(first, point.type, last.parameter);
        EXPECT_NEAR(meeting.parameter, last.parameter, 1e-11);
        EXPECT_NEAR(value_of(model, meeting.solution, "omega"), value_of(model, last.solution, "omega"), 1e-11);
    }
    // The curve of orbits with an impact ends in the published point.
    const Branch impacting = follow(model, branches_at(System(model), grazing, settings).at(0), settings);
    const Branch flips = curve_of(model, nearest(impacting, PointType::flip, 0.85), settings, "omega", 0.15, 3, -1);
    ASSERT_EQ(flips.outcome, BranchOutcome::unphysical);
    const SpecialPoint& last = flips.special.back();
    EXPECT_TRUE(last.at_end);
    EXPECT_NEAR(value_of(model, last.solution, "omega"), 0.61364946180363, 1e-11);
    EXPECT_NEAR(last.parameter, 0.58163432990654, 1e-11);
}

TEST(Curves, TorusPointsHaveTheirClosedForm) {
    const Model model = torus_model();
    const Branch branch =
        follow_branch(System(model), settled(model, "start").orbit, in_parameter(model, "p", -0.2, 0.1));
    const auto points = of_type(branch, PointType::torus);
    ASSERT_EQ(points.size(), 1U);
    for (const int way : {1, -1}) {
        const Branch curve = curve_of(model, points[0], in_parameter(model, "w", 0.05, 0.45), "p", {}, {}, way);
        EXPECT_EQ(curve.outcome, BranchOutcome::bound) << curve.detail;
        for (const BranchPoint& one : curve.points) {
            EXPECT_NEAR(value_of(model, one.solution, "p"), 0, 1e-12);
            for (const auto multiplier : one.solution.multipliers)
                EXPECT_NEAR(std::abs(multiplier), 1, 1e-10);
        }
    }
}

TEST(Curves, TorusPointsOfTheTestbedConnectTwoResonances) {
    // Near the end of the folds in a touch, where the argument of the pair changes by pi within a thousandth of the
    // frequency.
    const Model model = shipped_with("electromagnetic-testbed", {{"f", 8}, {"V0", 1}});
    BranchSettings settings = in_parameter(model, "V0", 0.5, 8);
    settings.stop_at = {PointType::grazing, PointType::fold};
    const Branch free = follow_branch(System(model), settled(model, "phase0", 600).orbit, settings);
    ASSERT_EQ(names(free), "GR");
    const Branch impacting = follow(model, branches_at(System(model), free.special[0], settings).at(0), settings);
    const SpecialPoint fold = nearest(impacting, PointType::fold, 2.16);
    settings.stop_at.clear();
    SpecialPoint start;
    for (const int way : {1, -1})
        for (const SpecialPoint& one : of_type(curve_of(model, fold, settings, "f", 5, 9, way), PointType::resonance_1))
            start = one;
    ASSERT_EQ(start.type, PointType::resonance_1);
    start.type = PointType::torus;
    std::size_t followed = 0;
    for (const int way : {1, -1}) {
        const Branch curve = curve_of(model, start, settings, "f", 5, 9, way);
        EXPECT_EQ(curve.outcome, BranchOutcome::stopped) << curve.detail;
        if (curve.points.size() < 2)
            continue;
        ++followed;
        EXPECT_EQ(curve.special.back().type, PointType::resonance_2) << names(curve);
        for (const PointType type : {PointType::resonance_3, PointType::resonance_4})
            EXPECT_EQ(of_type(curve, type).size(), 1U) << names(curve);
        for (const BranchPoint& one : curve.points) {
            const auto& multipliers = one.solution.half_multipliers;
            EXPECT_NEAR(std::abs(multipliers.at(0) * multipliers.at(1)), 1, 1e-9);
        }
    }
    EXPECT_EQ(followed, 1U);
}

TEST(Curves, SymmetryBreakingHasTheMultiplierOfTheHalfMap) {
    const Model model = started(load_model("electromagnetic-testbed"), {{"I", 0.1}});
    BranchSettings settings = in_parameter(model, "V0");
    settings.stop_at = {PointType::asymmetry};
    const OrbitSolution start = settled(model, "phase0", 600);
    ASSERT_TRUE(start.orbit.symmetry);
    std::size_t followed = 0;
    for (const int direction : {1, -1}) {
        settings.direction = direction;
        const Branch branch = follow_branch(System(model), start.orbit, settings);
        for (const SpecialPoint& point : of_type(branch, PointType::asymmetry)) {
            BranchSettings along = settings;
            along.steps = 20;
            along.stop_at.clear();
            for (const int way : {1, -1}) {
                const Branch curve = curve_of(model, point, along, "f", {}, {}, way);
                ASSERT_GT(curve.points.size(), 5U) << curve.detail;
                ++followed;
                for (const BranchPoint& one : curve.points) {
                    if (one.solution.half_multipliers.empty()) { // at a contact of zero speed
                        EXPECT_EQ(&one, &curve.points.back());
                        const auto& speeds = one.solution.certificate.approach_speeds;
                        EXPECT_NEAR(*std::min_element(speeds.begin(), speeds.end()), 0, 1e-12);
                        continue;
                    }
                    double off = 1;
                    for (const auto multiplier : one.solution.half_multipliers)
                        off = std::min(off, std::abs(multiplier + 1.0));
                    EXPECT_LT(off, 1e-8);
                }
            }
        }
    }
    EXPECT_GE(followed, 2U);
}

TEST(Curves, PointsThatCannotBeKeptAndMissingParametersAreRefused) {
    const Model model = oscillator_model(Oscillator(), 0.02);
    BranchSettings settings = in_parameter(model, "sigma");
    settings.kept = SpecialPoint{};
    settings.kept->type = PointType::cusp;
    settings.free = {model.independent_parameter("omega")};
    EXPECT_THROW(settings.validate(model), InputError);
    settings.kept->type = PointType::fold;
    EXPECT_NO_THROW(settings.validate(model));
    settings.free.clear();
    EXPECT_THROW(settings.validate(model), InputError);
}

} // namespace graze::curve_test
