// Ends of the curves of folds and flips of impacting orbits on curves of touches: detected along the touches, compared
// with closed forms, approached along the other curves, and used as their start.

#include "impact_oscillator.hpp"
#include "maps.hpp"

#include "graze/branch/curve_start.hpp"
#include "graze/branch/impacting_curve.hpp"
#include "graze/grazing/trial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace graze::degenerate_grazing_test {

using namespace graze::testing;
using std::numbers::pi;

/// Two equal masses with springs to the walls and a spring k between them, damping proportional to stiffness; the first
/// mass is forced by cos(omega t) and has a stop. The modes (x + y)/2 and (x - y)/2 are single oscillators.
struct TwoMasses {
    double c = 0.2, k = 0.6, e = 0.8;

    Model model(double omega, double sigma) const {
        return OneMode{
            .parameters = fmt::format("omega = {}\nsigma = {}", omega, sigma),
            .states = "x = 0\nv = 0\ny = 0\nw = 0",
            .definitions = fmt::format("pull = '{}*(x - y) + {}*(v - w)'", k, c * k),
            .rates = fmt::format("x = 'v', v = 'cos(theta) - x - {0}*v - pull', y = 'w', w = '-y - {0}*w + pull'", c),
            .clock = "omega",
            .stops = {{"stop", "sigma - x", fmt::format("v = '-{}*v'", e), "impact"}},
            .more = at_phase(0, "phase0")}
            .model();
    }
    double square_of(std::size_t mode) const { return mode == 0 ? 1 : 1 + 2 * k; }
    /// Returns the amplitude of the first mass without impacts.
    double reach(double omega) const {
        std::complex<double> sum = 0;
        for (const std::size_t mode : {0U, 1U})
            sum += 0.5 / std::complex(square_of(mode) - omega * omega, c * square_of(mode) * omega);
        return std::abs(sum);
    }
    enum class Sum { first, all, alternating };
    /// Returns the effect on x of an impact of unit change of speed one period earlier, or the sum of the effects of
    /// impacts in all earlier periods with equal or alternating signs: a geometric series for each mode.
    double effect(Sum which, double omega, double* size = nullptr) const {
        double sum = 0, sizes = 0;
        for (const std::size_t mode : {0U, 1U}) {
            const double decay = 0.5 * c * square_of(mode), own = std::sqrt(square_of(mode) - decay * decay);
            const auto z = std::exp(std::complex(-decay, own) * 2.0 * pi / omega);
            const auto all = which == Sum::first ? z : which == Sum::all ? z / (1.0 - z) : z / (1.0 + z);
            sum += all.imag() / own;
            sizes += std::abs(all) / own;
        }
        if (size)
            *size = sizes;
        return sum;
    }
    std::size_t sign_changes(Sum which, double from, double to) const {
        constexpr int parts = 20000;
        std::size_t count = 0;
        for (int i = 0; i < parts; ++i)
            count +=
                effect(which, from + (to - from) * i / parts) * effect(which, from + (to - from) * (i + 1) / parts) < 0
                    ? 1U
                    : 0U;
        return count;
    }
};

/// Follows the touches of the motion without impacts between two frequencies.
struct Touches {
    Model model;
    SpecialPoint first;
    BranchSettings settings; ///< in sigma, with omega free
    std::vector<SpecialPoint> special;

    std::vector<SpecialPoint> of(PointType type) const { return of_type(special, type); }
};

Touches touches(const Model& model, double from, double to) {
    Touches result{model, {}, in_parameter(model, "sigma", 1e-3, 1e3), {}};
    BranchSettings down = result.settings;
    down.direction = -1;
    const Branch branch = follow_branch(System(model), settled(model, "phase0", 400).orbit, down);
    EXPECT_EQ(names(branch), "GR");
    result.first = branch.special.at(0);
    for (const int way : {-1, 1}) {
        const Branch curve = curve_of(model, result.first, result.settings, "omega", from, to, way);
        EXPECT_EQ(curve.outcome, BranchOutcome::bound) << curve.detail;
        result.special.insert(result.special.end(), curve.special.begin(), curve.special.end());
    }
    return result;
}

/// Returns the curve of impacting orbits from its contact of zero speed, in the direction that exists.
Branch onward(const Touches& from, const SpecialPoint& point, PointType type, double least, double greatest) {
    const SpecialPoint start = on_impacting_curve(System(from.model), point, type, from.settings);
    Branch result;
    for (const int way : {1, -1}) {
        Branch curve = curve_of(from.model, start, from.settings, "omega", least, greatest, way);
        if (curve.points.size() < 2) {
            EXPECT_EQ(curve.outcome, BranchOutcome::stopped) << curve.detail;
            EXPECT_EQ(curve.detail, "in this direction the new contact has a negative speed");
            continue;
        }
        EXPECT_TRUE(result.points.empty());
        result = std::move(curve);
    }
    EXPECT_GT(result.points.size(), 2U) << short_name(type);
    return result;
}

TEST(DegenerateGrazing, CurvesOfFoldsAndFlipsOfOneMassEndThere) {
    const Oscillator known(1.7);
    const Touches all = touches(oscillator_model(known, 3), 0.6, 3);
    const auto found = all.of(PointType::sensitivity);
    ASSERT_EQ(found.size(), 3U); // omega = 2 omega_d/k
    EXPECT_TRUE(all.of(PointType::fold_degenerate).empty());
    EXPECT_TRUE(all.of(PointType::flip_degenerate).empty());
    const System system(all.model);
    for (const SpecialPoint& point : found) {
        EXPECT_EQ(impacting_curves_at(system, point), (std::vector{PointType::fold, PointType::flip}));
        for (const PointType type : {PointType::fold, PointType::flip}) {
            const Branch curve = onward(all, point, type, 0.6, 3);
            ASSERT_FALSE(curve.points.empty());
            // The curve begins at the point itself.
            EXPECT_NEAR(curve.points[0].parameter, point.parameter, 1e-10 * point.parameter);
            EXPECT_NEAR(value_of(all.model, curve.points[0].solution, "omega"),
                        value_of(all.model, point.solution, "omega"), 1e-10);
            for (std::size_t i = 1; i < curve.points.size(); ++i) {
                const BranchPoint& one = curve.points[i];
                const double omega = value_of(all.model, one.solution, "omega"), sigma = one.parameter;
                Oscillator there(omega);
                // The mass starts after the impact.
                const double after = one.solution.orbit.starts[0][1];
                const bool upper =
                    std::abs(there.sigma(after, true) - sigma) < std::abs(there.sigma(after, false) - sigma);
                EXPECT_NEAR(there.sigma(after, upper), sigma, 1e-9 * there.radius) << omega;
                if (type == PointType::fold)
                    EXPECT_NEAR(sigma, there.fold(upper), 1e-10 * there.radius) << omega;
                else
                    EXPECT_NEAR(there.trace(after, there.phase(after, sigma), sigma), -1 - there.product(),
                                1e-8 * std::max(1.0, std::abs(there.radius / after)))
                        << omega;
            }
        }
    }
}

TEST(DegenerateGrazing, TwoMassesHaveTheirClosedForm) {
    const TwoMasses known;
    constexpr double from = 0.35, to = 3.2;
    const Touches all = touches(known.model(1.2, 5), from, to);
    const std::pair<PointType, TwoMasses::Sum> kinds[] = {{PointType::sensitivity, TwoMasses::Sum::first},
                                                          {PointType::fold_degenerate, TwoMasses::Sum::all},
                                                          {PointType::flip_degenerate, TwoMasses::Sum::alternating}};
    for (const auto& [type, sum] : kinds) {
        const auto found = all.of(type);
        EXPECT_EQ(found.size(), known.sign_changes(sum, from, to)) << short_name(type);
        EXPECT_GE(found.size(), 2U);
        for (const SpecialPoint& one : found) {
            const double omega = value_of(all.model, one.solution, "omega");
            double size = 0;
            const double effect = known.effect(sum, omega, &size);
            // Points are located to 1e-13 of a step, and terms computed to 1e-13.
            EXPECT_NEAR(effect, 0, 1e-12 * size) << short_name(type) << ' ' << omega;
            EXPECT_NEAR(one.parameter, known.reach(omega), 1e-11 * one.parameter);
        }
    }
}

/// Returns the touch at another frequency.
SpecialPoint touch_at(const Touches& all, double omega) {
    BranchSettings along = in_parameter(all.model, "omega", std::min(omega, 1.2), std::max(omega, 1.2));
    const Branch curve = curve_of(all.model, all.first, along, "sigma", 1e-3, 1e3, omega < 1.2 ? -1 : 1);
    EXPECT_NEAR(curve.points.back().parameter, omega, 1e-12);
    SpecialPoint touch = all.first;
    touch.solution = curve.points.back().solution;
    touch.parameter = value_of(all.model, touch.solution, "sigma");
    for (const OrbitMinimum& one : touch.solution.certificate.minima)
        if (std::abs(one.value) < 1e-9 * one.size)
            touch.time = one.time;
    return touch;
}

TEST(DegenerateGrazing, CurvesOfFoldsAndFlipsOfTwoMassesLeadToIt) {
    const TwoMasses known;
    const Touches all = touches(known.model(1.2, 5), 0.9, 3.2);
    const System system(all.model);
    for (const PointType type : {PointType::fold, PointType::flip}) {
        const auto ends = all.of(type == PointType::fold ? PointType::fold_degenerate : PointType::flip_degenerate);
        ASSERT_FALSE(ends.empty());
        for (const SpecialPoint& end : ends) {
            const double omega = value_of(all.model, end.solution, "omega");
            const Branch away = onward(all, end, type, omega - 0.02, omega + 0.02);
            ASSERT_FALSE(away.points.empty());
            for (std::size_t i = 1; i < away.points.size(); ++i)
                EXPECT_LT(nearest_multiplier(away.points[i].solution, type == PointType::fold ? 1 : -1), 1e-5);
            // Branches of orbits with an impact, from the touch at the frequency of the last point of the curve.
            const double there = value_of(all.model, away.points.back().solution, "omega");
            const SpecialPoint touch = touch_at(all, there);
            const Branch impacting = follow(all.model, branches_at(system, touch, all.settings).at(0), all.settings);
            const auto points = of_type(impacting, type);
            const auto point = std::find_if(points.begin(), points.end(), [&](const SpecialPoint& one) {
                return std::abs(one.parameter - away.points.back().parameter) < 1e-9;
            });
            ASSERT_NE(point, points.end()) << short_name(type) << ' ' << there << ": " << names(impacting);
            const Branch back = curve_of(all.model, *point, in_parameter(all.model, "omega", omega - 0.1, omega + 0.1),
                                         "sigma", 1e-3, 1e3, there > omega ? -1 : 1);
            ASSERT_EQ(back.outcome, BranchOutcome::unphysical) << back.detail;
            const SpecialPoint& last = back.special.back();
            EXPECT_EQ(last.type, PointType::grazing);
            EXPECT_TRUE(last.at_end);
            EXPECT_NEAR(last.parameter, omega, 1e-10);
            EXPECT_NEAR(value_of(all.model, last.solution, "sigma"), end.parameter, 1e-10 * end.parameter);
        }
    }
}

TEST(DegenerateGrazing, ImpactingOrbitsOfTwoMassesChangeSidesThere) {
    // Near it the clearance without impacts is -(sum of projections) s, to first order in the speed s.
    const TwoMasses known;
    const Touches all = touches(known.model(1.2, 5), 0.9, 3.2);
    const System system(all.model);
    for (const SpecialPoint& end : all.of(PointType::fold_degenerate)) {
        const double omega = value_of(all.model, end.solution, "omega");
        for (const double side : {-1e-2, 1e-2}) {
            const SpecialPoint touch = touch_at(all, omega + side);
            const BranchStart start = branches_at(system, touch, all.settings).at(0);
            const double moved = start.orbit.parameters[all.settings.parameter.place()] - touch.parameter;
            EXPECT_EQ(moved<0, known.effect(TwoMasses::Sum::all, omega + side)> 0) << omega + side;
        }
    }
}

TEST(DegenerateGrazing, SeparatesTouchesThatTripAsSimulationConfirms) {
    const TwoMasses known;
    const Touches all = touches(known.model(1.2, 5), 0.9, 3.2);
    const System system(all.model);
    std::size_t decided = 0;
    for (const SpecialPoint& end : all.of(PointType::sensitivity)) {
        const double omega = value_of(all.model, end.solution, "omega");
        for (const double side : {-2e-2, 2e-2}) {
            const SpecialPoint touch = touch_at(all, omega + side);
            const CycleMap map = cycle_at(all.model, touch, all.settings.parameter);
            const Verdict verdict = verdict_of(map);
            if (verdict.outcome == GrazingOutcome::undecided)
                continue;
            // The next pass is a contact where an impact brings it nearer.
            EXPECT_EQ(verdict.outcome == GrazingOutcome::lost && verdict.next_contact == 1,
                      known.effect(TwoMasses::Sum::first, omega + side) < 0);
            const Trial trial = try_verdict(system, map, verdict, all.settings.parameter);
            // Trials are undecided where the reach is too small for double precision.
            EXPECT_NE(trial.outcome, TrialOutcome::contradicted) << omega + side << ": " << trial.reason;
            decided += trial.outcome == TrialOutcome::agreed ? 1 : 0;
        }
    }
    EXPECT_GE(decided, 2U);
}

TEST(DegenerateGrazing, FoldsOfTheTestbedEndThere) {
    const Model model = shipped_with("electromagnetic-testbed", {{"f", 8}, {"V0", 1}});
    BranchSettings settings = in_parameter(model, "V0", 0.5, 8);
    settings.stop_at = {PointType::grazing, PointType::fold};
    const Branch free = follow_branch(System(model), settled(model, "phase0", 600).orbit, settings);
    ASSERT_EQ(names(free), "GR");
    const System system(model);
    const Branch impacting = follow(model, branches_at(system, free.special[0], settings).at(0), settings);
    const auto folds = of_type(impacting, PointType::fold);
    ASSERT_FALSE(folds.empty());
    settings.stop_at.clear();
    const Branch touching = curve_of(model, free.special[0], settings, "f", 7.5, 9, -1);
    const auto ends = of_type(touching, PointType::fold_degenerate);
    ASSERT_EQ(ends.size(), 1U) << names(touching);
    const auto next = of_type(touching, PointType::sensitivity);
    ASSERT_EQ(next.size(), 1U);
    const double f = value_of(model, ends[0].solution, "f");
    EXPECT_NEAR(f, 7.5947, 5e-5);
    EXPECT_NEAR(value_of(model, next[0].solution, "f"), 7.5942, 5e-5);
    EXPECT_TRUE(of_type(touching, PointType::flip_degenerate).empty() ||
                of_type(touching, PointType::flip_degenerate)[0].detail.starts_with("losses of symmetry"));
    // Along the folds from 8 Hz.
    bool reached = false;
    for (const int way : {1, -1}) {
        const Branch curve = curve_of(model, folds.back(), settings, "f", 7.5, 9, way);
        if (curve.special.empty() || !curve.special.back().at_end)
            continue;
        reached = true;
        EXPECT_NEAR(value_of(model, curve.special.back().solution, "f"), f, 1e-9);
        EXPECT_NEAR(curve.special.back().parameter, ends[0].parameter, 1e-9);
    }
    EXPECT_TRUE(reached);
    // And on from the point.
    const Touches all{model, free.special[0], settings, {}};
    SpecialPoint start = on_impacting_curve(system, ends[0], PointType::fold, settings);
    std::size_t followed = 0;
    for (const int way : {1, -1}) {
        settings.steps = 20;
        const Branch curve = curve_of(model, start, settings, "f", 7.5, 9, way);
        followed += curve.points.size() > 10 ? 1 : 0;
        for (std::size_t i = 1; i < curve.points.size(); ++i)
            EXPECT_LT(nearest_multiplier(curve.points[i].solution, 1), 1e-5);
    }
    EXPECT_EQ(followed, 1U);
}

TEST(DegenerateGrazing, OtherPointsAreRefusedWithTheReason) {
    const Oscillator known(1.7);
    const Touches all = touches(oscillator_model(known, 3), 1.6, 1.8);
    const System system(all.model);
    EXPECT_TRUE(impacting_curves_at(system, all.first).empty());
    EXPECT_THROW(on_impacting_curve(system, all.first, PointType::fold, all.settings), InputError);
}

} // namespace graze::degenerate_grazing_test
