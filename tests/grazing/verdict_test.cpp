// Verdicts on linear oscillators, whose maps and classification have closed forms.

#include "graze/grazing/verdict.hpp"

#include "graze/base/input_error.hpp"
#include "graze/grazing/map_motion.hpp"
#include "graze/grazing/trial.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "linear_oscillator.hpp"

#include <gtest/gtest.h>

#include <iostream>
#include <map>

namespace graze::verdict_test {

using testing::LinearOscillator;

CycleMap map_of(const LinearOscillator& oscillator, const Model& model) {
    const System system(model);
    const Orbit orbit = oscillator.orbit(model);
    const std::vector<OrbitTouch> touches = touches_of(system, orbit);
    EXPECT_EQ(touches.size(), 1U);
    if (touches.empty())
        return {};
    CycleMapOptions options;
    options.parameter = model.independent_parameter("force");
    return cycle_map(system, orbit, touches.front(), options);
}

void expect_closed_form(const LinearOscillator& oscillator) {
    const Model model = oscillator.model();
    const CycleMap map = map_of(oscillator, model);
    ASSERT_TRUE(map.exists()) << map.reason;
    EXPECT_EQ(map.contact.order, MapOrder::square_root);
    const double a = oscillator.acceleration() * oscillator.length / (oscillator.clock * oscillator.clock);
    EXPECT_NEAR(map.contact.acceleration, a, 1e-11 * a);
    EXPECT_NEAR(map.contact.restitution, oscillator.restitution, 1e-9);
    const std::vector<double> projections = map.projections(12);
    // The flow has a relative tolerance of 1e-13, and errors accumulate over the cycles.
    double size = oscillator.clock;
    for (int k = 1; k <= 12; ++k)
        EXPECT_NEAR(projections[static_cast<std::size_t>(k - 1)], oscillator.projection(k) * oscillator.clock,
                    1e-11 * size)
            << k;
    ASSERT_TRUE(map.clearance_rate);
    EXPECT_NEAR(*map.clearance_rate, -oscillator.stop() * oscillator.length,
                1e-10 * oscillator.stop() * oscillator.length);
}

TEST(Verdict, MapsOfLinearOscillatorsHaveTheirClosedFormInAllUnits) {
    for (const double length : {1.0, 1e-9, 1e6})
        for (const double clock : {1.0, 1e-9, 1e6})
            for (LinearOscillator one :
                 {testing::one_degree(0.05, 1.3, 0.8), testing::one_degree(0.4, 3.1, 0.3),
                  testing::one_degree(1.5, 0.7, 0.6), testing::two_degrees(0.3, 0.04, 1.1, 0.8, 0.4),
                  testing::two_degrees(2.1, 0.3, 2.7, 0, -0.7)}) {
                one.length = length;
                one.clock = clock;
                for (const double wall : {0.0, 0.4}) {
                    one.wall = wall * one.stop();
                    SCOPED_TRACE(fmt::format("length {} clock {} omega {} wall {}", length, clock, one.omega, wall));
                    expect_closed_form(one);
                }
            }
}

/// Returns the contact of an oscillator with a spring behind the stop. @param stiffness relative to the oscillator's
/// own spring
std::string spring(double stiffness, const LinearOscillator& oscillator) {
    return fmt::format(
               "[parameters.k]\nvalue = {:.17g}\n[initial]\nmode = 'free'\n[events.leave]\nfunction = 'q0 - sigma'\n",
               stiffness / (oscillator.clock * oscillator.clock)) +
           "[modes.free]\nwatch = ['stop']\n[modes.free.rates]\nRATES\n"
           "[modes.held]\nwatch = ['leave']\n[modes.held.rates]\nHELD\n" +
           testing::transition("free", "stop", "held") + testing::transition("held", "leave", "free");
}

TEST(Verdict, CompliantStopsOfLinearOscillatorsHaveTheirClosedForm) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    int folds = 0, agreed = 0;
    for (int trial = 0; trial < 60; ++trial) {
        LinearOscillator one = trial % 2 == 0
                                   ? testing::one_degree(0.02 + 0.5 * uniform(random), 0.4 + 3 * uniform(random), 0)
                                   : testing::two_degrees(3 * uniform(random), 0.02 + 0.3 * uniform(random),
                                                          0.4 + 3 * uniform(random), 0, 2 * uniform(random) - 1);
        one.length = trial % 3 == 0 ? 1e-9 : 1;
        one.clock = trial % 5 == 0 ? 1e6 : 1;
        const double k = std::pow(10, 1 + 3 * uniform(random));
        const Model model = one.model(spring(k, one));
        const CycleMap map = map_of(one, model);
        ASSERT_EQ(map.contact.order, MapOrder::three_halves) << map.reason;
        // The force -k h acts on q_1' while h is negative: in total 4/3 (2/a)^(1/2) d^(3/2).
        const Eigen::Index n = one.force.size();
        Eigen::VectorXd gain = Eigen::VectorXd::Zero(2 * n);
        gain[n] = -k * 4 / 3 * std::sqrt(2 / one.acceleration());
        const Eigen::MatrixXd once = one.return_map(), identity = Eigen::MatrixXd::Identity(2 * n, 2 * n);
        const double chi = -(identity - once).fullPivLu().solve(once * gain)[0];
        const Verdict verdict = verdict_of(map);
        ASSERT_TRUE(verdict.alpha) << verdict.reason;
        const double unit = 1 / std::sqrt(one.length);
        EXPECT_NEAR(*verdict.alpha, -chi * unit, 1e-8 * unit * (std::abs(chi) + k / one.acceleration()));
        if (verdict.outcome == GrazingOutcome::folds) {
            ++folds;
            EXPECT_LT(chi, 0);
            EXPECT_NEAR(*verdict.fold_distance, 4 / (27 * chi * chi) / one.stop(), 1e-6 * *verdict.fold_distance);
        }
        const Trial tried = try_verdict(System(model), map, verdict, model.independent_parameter("force"));
        EXPECT_NE(tried.outcome, TrialOutcome::contradicted) << tried.reason;
        agreed += tried.outcome == TrialOutcome::agreed ? 1 : 0;
    }
    EXPECT_GE(folds, 10);
    EXPECT_GE(agreed, 40);
    std::cout << "compliant: " << folds << " fold, " << agreed << " of 60 agreed with simulation\n";
}

/// Counts the outcomes of verdicts on random oscillators and of their trials by simulation.
std::map<std::string, int> try_random(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::map<std::string, int> counts;
    for (int trial = 0; trial < count; ++trial) {
        // From weak to supercritical damping, where multipliers are real.
        const double zeta = std::pow(10, -2.5 + 3.1 * uniform(random)), omega = 0.4 + 5 * uniform(random),
                     e = 0.95 * uniform(random);
        LinearOscillator one = trial % 2 == 0
                                   ? testing::one_degree(zeta, omega, e)
                                   : testing::two_degrees(3 * uniform(random), zeta, omega, e, 2 * uniform(random) - 1);
        one.wall = trial % 3 == 0 ? one.stop() * (0.1 + uniform(random)) : 0;
        const Model model = one.model();
        const CycleMap map = map_of(one, model);
        const Verdict verdict = verdict_of(map);
        const Trial tried = try_verdict(System(model), map, verdict, model.independent_parameter("force"));
        ++counts[std::string(name_of(verdict.outcome))];
        ++counts[std::string(name_of(tried.outcome))];
        ++counts[fmt::format("{}, {}", name_of(verdict.outcome), name_of(tried.outcome))];
        EXPECT_NE(tried.outcome, TrialOutcome::contradicted)
            << "zeta " << zeta << " omega " << omega << " e " << e << ": " << name_of(verdict.outcome) << ", "
            << tried.reason;
    }
    for (const auto& [what, number] : counts)
        std::cout << what << ": " << number << '\n';
    return counts;
}

TEST(Verdict, AgreesWithSimulationOnRandomOscillators) {
    const auto counts = try_random(100, 7);
    EXPECT_GE(counts.at("persists, agreed"), 10);
    EXPECT_GE(counts.at("lost, agreed"), 50);
}

TEST(VerdictSlow, AgreesWithSimulationOnAThousandRandomOscillators) {
    const auto counts = try_random(1200, 20);
    EXPECT_GE(counts.at("agreed"), 1000);
    EXPECT_GE(counts.at("persists, agreed"), 100);
}

/// A trial must contradict a wrong verdict.
TEST(Verdict, ReversedVerdictsAreContradictedByTrials) {
    for (const bool weak : {true, false}) {
        const LinearOscillator one = weak ? testing::one_degree(0.05, 1.3, 0.8) : testing::one_degree(1.3, 3, 0.8);
        const Model model = one.model();
        const CycleMap map = map_of(one, model);
        const Verdict right = verdict_of(map);
        EXPECT_EQ(right.outcome, weak ? GrazingOutcome::lost : GrazingOutcome::persists);
        if (!weak) {
            CycleMap turned = map;
            for (double& component : turned.impact)
                component = -component;
            const Verdict wrong = verdict_of(turned);
            EXPECT_EQ(wrong.outcome, GrazingOutcome::lost);
            const Trial tried = try_verdict(System(model), turned, wrong, model.independent_parameter("force"));
            EXPECT_EQ(tried.outcome, TrialOutcome::contradicted) << tried.reason;
        }
        Verdict claimed = right;
        claimed.outcome = GrazingOutcome::persists;
        const Trial claim = try_verdict(System(model), map, claimed, model.independent_parameter("force"));
        EXPECT_EQ(claim.outcome, weak ? TrialOutcome::contradicted : TrialOutcome::agreed) << claim.reason;
    }
}

TEST(Verdict, TrialIsUndecidedWherePrecisionLimitsGrowth) {
    const LinearOscillator one = testing::one_degree(0.95, 5, 0.8);
    const Model model = one.model();
    const CycleMap map = map_of(one, model);
    const Verdict verdict = verdict_of(map);
    EXPECT_EQ(verdict.outcome, GrazingOutcome::lost);
    // The first pass on which sin(k d T) is negative, d the damped frequency.
    const double angle = std::sqrt(1 - 0.95 * 0.95) * one.period();
    EXPECT_EQ(static_cast<double>(verdict.next_contact), std::floor(std::numbers::pi / angle) + 1);
    const Trial tried = try_verdict(System(model), map, verdict, model.independent_parameter("force"));
    EXPECT_EQ(tried.outcome, TrialOutcome::undecided) << tried.reason;
}

TEST(Verdict, AttractorIsLostWhereTheContactEndsTheMotion) {
    const LinearOscillator one = testing::one_degree(1.2, 1, 0.5);
    const Model model = one.model("[modes.free]\nwatch = ['stop']\n[modes.free.rates]\nRATES\n" +
                                  testing::transition("free", "stop", "end"));
    const System system(model);
    const Orbit orbit = one.orbit(model);
    CycleMapOptions options;
    options.parameter = model.independent_parameter("force");
    const CycleMap map = cycle_map(system, orbit, touches_of(system, orbit).at(0), options);
    EXPECT_FALSE(map.exists());
    EXPECT_TRUE(map.contact.ends);
    const Verdict verdict = verdict_of(map);
    EXPECT_EQ(verdict.outcome, GrazingOutcome::lost);
    EXPECT_EQ(verdict.side, 1);
    const Trial trial = try_verdict(system, map, verdict, *options.parameter);
    EXPECT_EQ(trial.outcome, TrialOutcome::agreed) << trial.reason;
}

/// The classification of a linear oscillator changes where sin(d T) = 0: there the first projection vanishes.
TEST(Verdict, ClassificationOfOneDegreeHasItsKnownBoundaries) {
    for (const double zeta : {0.02, 0.2, 0.6}) {
        const double d = std::sqrt(1 - zeta * zeta);
        for (const int k : {1, 2, 3}) {
            const double omega = 2 * d / k;
            for (const int way : {-1, 1}) {
                const LinearOscillator one = testing::one_degree(zeta, omega * (1 + way * 1e-6), 0.7);
                const Verdict verdict = verdict_of(map_of(one, one.model()));
                ASSERT_EQ(verdict.outcome, GrazingOutcome::lost);
                // Above the boundary, k half oscillations take longer than one period of the force.
                const bool at_once = std::sin(d * one.period()) < 0;
                EXPECT_EQ(verdict.next_contact == 1, at_once) << zeta << ' ' << k << ' ' << way;
                EXPECT_EQ(at_once, (way > 0) == (k % 2 == 0)) << zeta << ' ' << k << ' ' << way;
            }
            const LinearOscillator one = testing::one_degree(zeta, omega, 0.7);
            const Verdict verdict = verdict_of(map_of(one, one.model()));
            EXPECT_EQ(verdict.outcome, GrazingOutcome::undecided);
            EXPECT_NE(verdict.reason.find("pass 1"), std::string::npos) << verdict.reason;
        }
    }
}

/// Above critical damping the leading multiplier is exp(-(zeta - sqrt(zeta^2 - 1)) T).
TEST(Verdict, LeadingMultiplierClassifiesTheAttractor) {
    for (const auto& [omega, kind] :
         {std::pair(1.0, AttractorKind::period_adding), std::pair(4.0, AttractorKind::periodic_windows),
          std::pair(12.0, AttractorKind::chaotic)}) {
        const LinearOscillator one = testing::one_degree(1.2, omega, 0.7);
        const CycleMap map = map_of(one, one.model());
        const Verdict verdict = verdict_of(map);
        ASSERT_EQ(verdict.outcome, GrazingOutcome::persists);
        const double leading = std::exp(-(1.2 - std::sqrt(0.44)) * one.period());
        EXPECT_NEAR(*verdict.leading, leading, 1e-10);
        EXPECT_EQ(verdict.attractor, kind) << leading;
        const MapMotion near = map_motion(map, -1e-10), far = map_motion(map, -1e-5);
        EXPECT_TRUE(near.bounded);
        if (kind == AttractorKind::period_adding) {
            EXPECT_EQ(near.contacts, 1U);
            EXPECT_GT(near.period, far.period);
        }
        if (kind == AttractorKind::chaotic) {
            EXPECT_EQ(near.period, 0U);
        }
    }
}

/// A map of one state with slope a without sliding and b with it: the skew tent map, whose attractors are known (Yu. L.
/// Maistrenko, V. L. Maistrenko and L. O. Chua, Int. J. Bifurcation Chaos 3, 1993).
CycleMap tent(double a, double b) {
    CycleMap map;
    map.contact.order = MapOrder::linear;
    map.contact.acceleration = 2;
    map.active = {0};
    map.scales = {3};
    map.matrix = {a};
    map.gradient = {1};
    map.impact = {1 - b / a};
    map.multipliers = {a};
    map.clearance_rate = -1;
    return map;
}

TEST(Verdict, SlidingFollowsTheTentMap) {
    const auto judged = [](double a, double b) { return verdict_of(tent(a, b)); };
    const auto expect_period = [&](double a, double b, std::size_t period) {
        const Verdict verdict = judged(a, b);
        EXPECT_EQ(verdict.outcome, GrazingOutcome::persists) << a << ' ' << b;
        EXPECT_EQ(verdict.attractor, AttractorKind::periodic) << a << ' ' << b;
        EXPECT_EQ(verdict.in, period) << a << ' ' << b;
        EXPECT_EQ(verdict.slides, 1U) << a << ' ' << b;
        EXPECT_EQ(verdict.border, BorderCollision::persistence);
        EXPECT_EQ(verdict.doubles, period > 1);
        EXPECT_NEAR(*verdict.leading, std::abs(b), 1e-12);
    };
    for (const double b : {-0.9, -0.2, 0.3, 0.95})
        expect_period(0.4, b, 1);
    // An orbit of period m has the slope a^(m-1) b and exists for b < -(1 + a + ... + a^(m-2))/a^(m-2).
    expect_period(0.4, -1.2, 2);
    expect_period(0.4, -2.4, 2);
    expect_period(0.4, -4, 3);
    expect_period(0.4, -6, 3);
    expect_period(0.4, -12, 4);
    for (const auto& [a, b] : {std::pair(0.4, -3.0), std::pair(0.9, -1.5), std::pair(0.9, -5.0)}) {
        const Verdict verdict = judged(a, b);
        EXPECT_EQ(verdict.outcome, GrazingOutcome::persists);
        EXPECT_EQ(verdict.attractor, AttractorKind::chaotic) << a << ' ' << b;
    }
    for (const double b : {1.02, 1.5, 20.0}) {
        const Verdict verdict = judged(0.4, b);
        EXPECT_EQ(verdict.outcome, GrazingOutcome::lost);
        EXPECT_EQ(verdict.border, BorderCollision::fold);
        EXPECT_FALSE(verdict.doubles);
        EXPECT_EQ(verdict.side, 1);
        EXPECT_DOUBLE_EQ(*verdict.speed_factor, 2);
    }
    EXPECT_EQ(judged(0.4, 1).outcome, GrazingOutcome::undecided);
    EXPECT_EQ(judged(0.4, -1).outcome, GrazingOutcome::undecided);
    EXPECT_EQ(judged(1.2, 0.5).reason, "the orbit that touches is not stable itself");
}

TEST(Verdict, MotionsOfTheMapCanBeInterrupted) {
    const CycleMap map = tent(0.4, -2);
    MapMotionOptions options;
    options.interrupted = [] { return false; };
    EXPECT_FALSE(map_motion(map, -1, options).interrupted);
    EXPECT_EQ(map_motion(map, -1, options).period, 2U);
    for (const auto& [transient, cycles] : {std::pair(10'000'000, 1), std::pair(0, 10'000'000)}) {
        options.transient = static_cast<std::size_t>(transient);
        options.cycles = static_cast<std::size_t>(cycles);
        int asked = 0;
        options.interrupted = [&] { return ++asked == 3; };
        EXPECT_TRUE(map_motion(map, -1, options).interrupted);
        EXPECT_EQ(asked, 3);
    }
}

/// The map scales with the clearance.
TEST(Verdict, SlidingMotionsScaleWithTheClearance) {
    const CycleMap map = tent(0.4, -2);
    for (const double clearance : {-1.0, -1e-8}) {
        const MapMotion motion = map_motion(map, clearance);
        EXPECT_EQ(motion.period, 2U);
        // x' = a x without sliding, x' = b x + (b - a) C with it. The orbit of period 2 has this x on the side without
        // sliding.
        const double a = 0.4, b = -2, x = a * (b - a) * clearance / (1 - a * b), depth = -(clearance + x);
        EXPECT_NEAR(motion.largest, std::sqrt(4 * depth), 1e-9 * motion.largest) << clearance;
    }
    EXPECT_THROW(map.image({}, -1), InputError);
    EXPECT_THROW(CycleMap{}.image({}, -1), InputError);
}

/// Counts the contacts after a transient.
class Counter : public Observer {
public:
    explicit Counter(double from) : from_(from) {}
    void contact(const Contact& contact) override {
        count_ += contact.kind == ContactKind::crossing && contact.time > from_ ? 1 : 0;
    }
    std::size_t count() const { return count_; }

private:
    double from_;
    std::size_t count_ = 0;
};

TEST(Verdict, AttractorsOfTheMapEqualThoseOfSimulation) {
    int periodic = 0;
    for (const double omega : {1.0, 1.5, 2.0, 4.0})
        for (const double depth : {1e-4, 3e-6, 1e-7}) {
            const LinearOscillator one = testing::one_degree(1.2, omega, 0.7);
            const Model model = one.model();
            const CycleMap map = map_of(one, model);
            const double clearance = -depth * one.stop();
            const MapMotion motion = map_motion(map, clearance);
            if (motion.period == 0)
                continue;
            ++periodic;
            std::vector<double> parameters = map.contact.touch.parameters;
            parameters[model.independent_parameter("force").place()] += clearance / *map.clearance_rate;
            // Start like the map, from the orbit without contact, which is proportional to the force: several
            // attractors may coexist.
            std::vector<double> start = one.orbit(model).starts[0];
            for (double& component : start)
                component *= parameters[model.independent_parameter("force").place()];
            const Simulation simulation(System(model), {}, {}, SimulationOptions{.tolerance = 1e-15});
            // Cycles are counted from the phase of the start, not of the touch.
            constexpr std::size_t transient = 300, rounds = 20;
            Counter counter(transient * one.period());
            Trajectory trajectory(simulation, parameters, borrowed(counter));
            trajectory.start(start, 0, 0, static_cast<double>(transient + rounds * motion.period) * one.period());
            testing::run(trajectory);
            EXPECT_EQ(counter.count(), rounds * motion.contacts)
                << omega << ' ' << depth << ": " << motion.contacts << " in " << motion.period;
        }
    EXPECT_GE(periodic, 8);
}

} // namespace graze::verdict_test
