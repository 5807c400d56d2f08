// Orbits that touch a surface on which motions stick: grazing-sliding of an oscillator on a moving belt.

#include "base/special_numbers.hpp"
#include "belt.hpp"
#include "cycle_error.hpp"
#include "follow.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <iostream>
#include <map>
#include <numbers>
#include <random>
#include <string>

namespace graze::sliding_test {

using namespace graze::testing;
using ::testing::HasSubstr;

/// Both orbits continue, neither is stable beyond: immediate chaos.
TEST(Sliding, GrazingOnABeltStartsChaos) {
    Model model = belt();
    model.set_parameter("nu", 1.711);
    const BranchSettings settings = in_parameter(model, "nu", 1.65, 1.72, -1);
    const Branch branch = follow_branch(System(model), settled(model, "phase0").orbit, settings);
    const auto touches = of_type(branch, PointType::grazing);
    ASSERT_FALSE(touches.empty());
    const Judged one(model, touches[0], settings.parameter);
    ASSERT_EQ(one.map.contact.order, MapOrder::linear) << one.map.reason << one.map.contact.reason;
    EXPECT_EQ(one.verdict.outcome, GrazingOutcome::persists) << one.verdict.reason;
    EXPECT_EQ(one.verdict.border, BorderCollision::persistence);
    EXPECT_TRUE(one.verdict.doubles);
    EXPECT_EQ(one.verdict.attractor, AttractorKind::chaotic);
    EXPECT_EQ(one.verdict.side, -1);
    EXPECT_EQ(one.trial.outcome, TrialOutcome::agreed) << one.trial.reason;
    // The slope of the tent map beyond its top is below -1/(the other slope): orbits of twice the period are unstable
    // too.
    EXPECT_LT(-*one.verdict.leading * std::abs(one.map.multipliers[0]), -1);
    expect_rates(model, map_at(model, touches[0]), 1e-4);
}

/// With constant friction the coefficient that bends the motion off the belt is zero, and its computed value is noise.
TEST(Sliding, VerdictIsRightWhereTheBendingCoefficientIsNoise) {
    const Model model =
        model_from(R"toml(
name = "rubbing"
[parameters]
zeta = 0.05
omega = 0.6
amplitude = 0.26
friction = 0.2
belt = 0.5
[states]
x = 0
v = 0
theta = { initial = 0, period = "2*pi" }
[definitions]
force = "amplitude*cos(theta) - 2*zeta*v - x"
[initial]
mode = "below"
[modes.below]
watch = ["reach"]
rates = { x = "v", v = "force + friction", theta = "omega" }
[modes.above]
watch = ["fall"]
rates = { x = "v", v = "force - friction", theta = "omega" }
[modes.stick]
watch = ["up", "down"]
rates = { x = "v", v = 0, theta = "omega" }
[events]
reach = "belt - v"
fall = "v - belt"
up = "friction - force"
down = "friction + force"
[jumps.stop]
v = "belt"
[sections.phase0]
state = "theta"
value = 0
)toml" +
                   transition("below", "reach",
                              "[{ when = 'friction - force >= 0', mode = 'stick' }, { mode = 'above' }]", "stop") +
                   transition("above", "fall",
                              "[{ when = 'friction + force >= 0', mode = 'stick' }, { mode = 'below' }]", "stop") +
                   transition("stick", "up", "above") + transition("stick", "down", "below"));
    const BranchSettings settings = in_parameter(model, "amplitude", 0.1, 1.6, 1);
    const auto touches =
        of_type(follow_branch(System(model), settled(model, "phase0").orbit, settings), PointType::grazing);
    ASSERT_FALSE(touches.empty());
    const double zeta = 0.05, omega = 0.6, turn = 2 * std::numbers::pi / omega, own = std::sqrt(1 - zeta * zeta);
    const double amplitude = touches[0].solution.orbit.parameters[settings.parameter.place()];
    // The largest speed of the linear response equals that of the belt.
    EXPECT_NEAR(amplitude, 0.5 / omega * std::hypot(1 - omega * omega, 2 * zeta * omega), 1e-10);
    const Judged one(model, touches[0], settings.parameter);
    ASSERT_EQ(one.map.contact.order, MapOrder::linear) << one.map.reason << one.map.contact.reason;
    // After sticking only the displacement and its evolution over a period matter.
    EXPECT_NEAR(std::abs(*one.verdict.leading),
                std::exp(-zeta * turn) * std::abs(std::cos(own * turn) + zeta / own * std::sin(own * turn)), 1e-9);
    EXPECT_EQ(one.verdict.outcome, GrazingOutcome::persists) << one.verdict.reason;
    EXPECT_EQ(one.trial.outcome, TrialOutcome::agreed) << one.trial.reason;
}

/// The branch of the orbit with one more sticking phase begins on the predicted side, with the predicted multiplier.
TEST(Sliding, BranchContinuesWithDryFriction) {
    Model model = shipped_with("dry-friction-oscillator", {{"friction_static", 0.3}, {"omega", 0.2}});
    const BranchSettings settings = in_parameter(model, "omega", 0.15, 0.22, 1);
    const auto touches =
        of_type(follow_branch(System(model), settled(model, "phase0").orbit, settings), PointType::grazing);
    ASSERT_EQ(touches.size(), 1U);
    const Judged one(model, touches[0], settings.parameter);
    EXPECT_EQ(one.verdict.outcome, GrazingOutcome::persists) << one.verdict.reason;
    EXPECT_EQ(one.verdict.border, BorderCollision::persistence);
    EXPECT_EQ(one.verdict.attractor, AttractorKind::periodic);
    EXPECT_EQ(one.verdict.in, 1U);
    EXPECT_EQ(one.verdict.side, 1);
    EXPECT_EQ(one.trial.outcome, TrialOutcome::agreed) << one.trial.reason;
    const Branch beyond = follow(model, branches_at(System(model), touches[0], settings).at(0), settings);
    ASSERT_GE(beyond.points.size(), 3U);
    EXPECT_GT(beyond.points[1].parameter, touches[0].parameter);
    const OrbitSolution& near = beyond.points[0].solution;
    EXPECT_EQ(near.orbit.segments(), touches[0].solution.orbit.segments() + 2);
    // It begins at a thousandth of the typical speed, and multipliers change linearly with the speed.
    EXPECT_NEAR(std::abs(near.half_multipliers.at(0)), *one.verdict.leading, 2e-3 * *one.verdict.leading);
    // From the other side, where the additional sticking phase disappears.
    model.set_parameter("omega", 0.215);
    const BranchSettings down = in_parameter(model, "omega", 0.15, 0.22, -1);
    const auto ends = of_type(follow_branch(System(model), settled(model, "phase0").orbit, down), PointType::grazing);
    ASSERT_FALSE(ends.empty());
    EXPECT_TRUE(ends[0].at_end);
    EXPECT_NEAR(ends[0].parameter, touches[0].parameter, 1e-10);
    const Judged other(model, ends[0], settings.parameter);
    ASSERT_EQ(other.map.contact.order, MapOrder::linear) << other.map.reason << other.map.contact.reason;
    EXPECT_NEAR(*other.verdict.leading, *one.verdict.leading, 1e-8);
    EXPECT_NEAR(other.map.projections(1)[0], one.map.projections(1)[0], 1e-8);
    EXPECT_NEAR(*other.map.clearance_rate, *one.map.clearance_rate, 1e-8);
}

/// A slide between the two fields makes the same branch and the same grazing-sliding as the model written by hand.
TEST(Sliding, ASlideGivesTheBranchOfTheModelThatIsWrittenByHand) {
    Model written = belt();
    written.set_parameter("nu", 1.711);
    std::string text = write_model(written);
    text = text.substr(0, text.find("[modes.below]")) + R"toml(
[modes.below]
rates = { x = "v", v = "smooth + alpha0", theta = "nu" }
[modes.above]
rates = { x = "v", v = "smooth - alpha0", theta = "nu" }
[events]
reach = "v - 1"
[slides.stick]
surface = "reach"
between = ["below", "above"]
[sections.phase0]
state = "theta"
value = 0
[initial]
mode = "below"
)toml";
    const Model made = model_from(text);
    std::vector<SpecialPoint> points;
    for (const Model& model : {written, made}) {
        const BranchSettings settings = in_parameter(model, "nu", 1.65, 1.72, -1);
        const auto touches =
            of_type(follow_branch(System(model), settled(model, "phase0").orbit, settings), PointType::grazing);
        ASSERT_FALSE(touches.empty());
        points.push_back(touches[0]);
        const Judged one(model, touches[0], settings.parameter);
        EXPECT_EQ(one.map.contact.order, MapOrder::linear) << one.map.reason << one.map.contact.reason;
        EXPECT_EQ(one.verdict.attractor, AttractorKind::chaotic);
        EXPECT_EQ(one.trial.outcome, TrialOutcome::agreed) << one.trial.reason;
    }
    EXPECT_EQ(points[0].detail, "reach");
    EXPECT_EQ(points[1].detail, "reach-rising; grazing-sliding");
    EXPECT_NEAR(points[0].parameter, points[1].parameter, 1e-11);
    EXPECT_EQ(points[0].solution.orbit.segments(), points[1].solution.orbit.segments());
}

/// x' = -k x + A cos(theta) + b below x = 0, and -a instead of b above.
Model first_order(const std::string& parameters, const std::string& mode) {
    return model_from("name = \"first order\"\n[parameters]\n" + parameters + R"toml(
[states]
x = 0
theta = { initial = 0, period = "2*pi" }
[modes.low]
rates = { x = "-k*x + A*cos(theta) + b", theta = 1 }
[modes.high]
rates = { x = "-k*x + A*cos(theta) - a", theta = 1 }
[events]
zero = "x"
[slides.still]
surface = "zero"
between = ["low", "high"]
[sections.phase0]
state = "theta"
value = 0
)toml" + "[initial]\nmode = \"" +
                      mode + "\"\n");
}

/// Returns the values of the parameter at the points of this name.
std::vector<double> named(const Model& model, const std::string& name, const BranchSettings& settings) {
    std::vector<double> found;
    for (const SpecialPoint& point : follow_branch(System(model), settled(model, "phase0").orbit, settings).special)
        if (point.detail.find(name) != std::string::npos)
            found.push_back(point.parameter);
    return found;
}

/// With a = b = k = 1 the symmetric orbit crosses x = 0 where the other side just ceases to push back, cos(theta) =
/// -1/A, if sqrt(A^2 - 1) = 1 + 2 tanh(pi/2).
TEST(Sliding, CrossingSlidingHasItsNameAndItsClosedForm) {
    const Model model = first_order("A = 3.6\nk = 1\na = 1\nb = 1\n", "high");
    const auto found = named(model, "crossing-sliding", in_parameter(model, "A", 2.5, 3.6, -1));
    ASSERT_FALSE(found.empty());
    for (const double amplitude : found)
        EXPECT_NEAR(amplitude, std::hypot(1, 1 + 2 * std::tanh(std::numbers::pi / 2)), 1e-9);
}

/// Where A = a an orbit that rests on the surface comes to the edge of where it slides. It goes on with a short motion
/// off the surface.
TEST(Sliding, AddingSlidingHasItsNameAndItsClosedForm) {
    const Model model = first_order("A = 0.7\nk = 1\na = 1\nb = 1.2\n", "still");
    const auto found = named(model, "adding-sliding", in_parameter(model, "A", 0.5, 1.1, 1));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0], 1, 1e-9);
}

/// Follows the orbit on the belt that slips once in each period, at nu = 1.
Branch slipping(const Model& model, double from, int direction) {
    Model there = model;
    there.set_parameter("amplitude", from);
    BranchSettings settings = in_parameter(there, "amplitude", 1.75, 1.826, direction);
    return follow_branch(System(there), settled(there, "phase0").orbit, settings);
}

/// The branch goes on through adding-sliding, from both sides.
TEST(Sliding, ABranchGoesOnThroughAddingSliding) {
    const Model model = shipped_with("belt-oscillator", {{"nu", 1}});
    const Branch up = slipping(model, 1.78, 1), down = slipping(model, 1.825, -1);
    const auto touches = of_type(up, PointType::grazing);
    ASSERT_EQ(touches.size(), 1U);
    EXPECT_THAT(touches[0].detail, HasSubstr("adding-sliding; goes on as"));
    const auto vanishing = of_type(down, PointType::vanishing);
    ASSERT_EQ(vanishing.size(), 1U);
    EXPECT_THAT(vanishing[0].detail, HasSubstr("adding-sliding; goes on as"));
    EXPECT_TRUE(of_type(down, PointType::grazing).empty());
    // The equations with the short motion are singular there.
    EXPECT_NEAR(vanishing[0].parameter, touches[0].parameter, 1e-8);
    EXPECT_EQ(up.points.back().solution.orbit.segments(), 4U);
    EXPECT_EQ(down.points.back().solution.orbit.segments(), 2U);
    EXPECT_EQ(up.outcome, BranchOutcome::bound);
    EXPECT_EQ(down.outcome, BranchOutcome::bound);
}

/// Returns by how much a mass on a belt of the speed 1 is ahead of the phase at nu = 1, where it slips from the belt.
double lead_at_slip(const Model& model, const Orbit& orbit) {
    for (std::size_t s = 0; s < orbit.segments(); ++s)
        if (orbit.signature[s].mode == *model.find_mode("slower"))
            return std::remainder(orbit.starts[s][0] - orbit.starts[s][2], 2 * std::numbers::pi);
    return not_a_number;
}

/// Beside adding-sliding the orbit differs from the one without the short motion, which is continued beyond where it is
/// inadmissible, by (1 - P)^-1 P B depth^2.
TEST(Sliding, OrbitsBesideAddingSlidingAreThoseOfTheMap) {
    const Model model = shipped_with("belt-oscillator", {{"nu", 1}});
    const auto touches = of_type(slipping(model, 1.78, 1), PointType::grazing);
    ASSERT_EQ(touches.size(), 1U);
    const Judged one(model, touches[0], model.independent_parameter("amplitude"));
    ASSERT_EQ(one.map.contact.order, MapOrder::quadratic) << one.map.reason << one.map.contact.reason;
    EXPECT_EQ(one.verdict.outcome, GrazingOutcome::persists);
    EXPECT_EQ(one.verdict.attractor, AttractorKind::periodic);
    EXPECT_EQ(one.verdict.side, 1);
    EXPECT_EQ(one.trial.outcome, TrialOutcome::agreed) << one.trial.reason;
    ASSERT_EQ(one.map.active.size(), 3U);
    // Of the motion on the belt only the lead remains, which has one multiplier.
    const double multiplier = one.map.multipliers.front().real();
    std::vector<double> errors;
    for (const double distance : {3e-3, 3e-3 / 16}) {
        Orbit old = touches[0].solution.orbit;
        const std::size_t place = model.independent_parameter("amplitude").place();
        old.parameters[place] += distance;
        const OrbitSolution without = solve_orbit(System(model), old, {});
        ASSERT_EQ(without.outcome, OrbitOutcome::converged);
        EXPECT_FALSE(without.certificate.admissible);
        Model there = model;
        there.set_parameter("amplitude", old.parameters[place]);
        const OrbitSolution with = settled(there, "phase0");
        EXPECT_TRUE(with.certificate.admissible);
        const double depth = -distance * *one.map.clearance_rate,
                     shift = one.map.contact.direction[0] * depth * depth / (1 - multiplier);
        errors.push_back(std::abs((lead_at_slip(model, with.orbit) - lead_at_slip(model, without.orbit)) / shift - 1));
    }
    EXPECT_LT(errors[1], 0.1);
    EXPECT_GT(errors[0] / errors[1], 3); // the next order is smaller by the root of the depth
}

/// With k = 0 and A = 1 the orbit leaves the surface at cos(theta) = a and returns where sin(theta) - a theta is as
/// before, at an angle above pi: it meets the edge of where it slides if b = -cos of that angle.
TEST(Sliding, SwitchingSlidingHasItsNameAndItsClosedForm) {
    const double a = 0.1, leaves = -std::acos(a);
    double met = 4.5;
    for (int i = 0; i < 50; ++i)
        met -= (std::sin(met) - std::sin(leaves) - a * (met - leaves)) / (std::cos(met) - a);
    const double edge = -std::cos(met);
    ASSERT_GT(met, std::numbers::pi);
    for (const double start : {edge + 0.1, edge - 0.1}) {
        const Model model = first_order(fmt::format("A = 1\nk = 0\na = 0.1\nb = {}\n", start), "high");
        const auto found =
            named(model, "switching-sliding", in_parameter(model, "b", edge - 0.2, edge + 0.2, start > edge ? -1 : 1));
        ASSERT_FALSE(found.empty()) << start;
        for (const double b : found)
            EXPECT_NEAR(b, edge, 1e-8);
    }
}

/// The sliding orbit exists before the touch, and neither exists beyond it.
TEST(Sliding, GrazingOnABeltMayBeAFold) {
    Model model = belt();
    model.set_parameter("nu", 2.2);
    const BranchSettings settings = in_parameter(model, "nu", 2, 2.4, -1);
    const Branch branch = follow_branch(System(model), settled(model, "phase0").orbit, settings);
    std::size_t folds = 0;
    for (const SpecialPoint& point : of_type(branch, PointType::grazing)) {
        const Judged one(model, point, settings.parameter);
        if (one.verdict.outcome == GrazingOutcome::undecided)
            continue;
        ++folds;
        EXPECT_EQ(one.verdict.outcome, GrazingOutcome::lost);
        EXPECT_EQ(one.verdict.border, BorderCollision::fold);
        EXPECT_EQ(one.trial.outcome, TrialOutcome::agreed) << one.trial.reason;
        expect_rates(model, map_at(model, point), 1e-4);
    }
    EXPECT_GE(folds, 1U);
}

/// Counts outcomes of verdicts and trials at touches along branches of random belts.
std::map<std::string, int> try_random(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::map<std::string, int> counts;
    for (int trial = 0; trial < count; ++trial) {
        Model model = belt();
        model.set_parameter("alpha0", 0.5 + 1.5 * uniform(random));
        model.set_parameter("alpha1", 2 * uniform(random));
        model.set_parameter("alpha2", 0.8 * uniform(random));
        model.set_parameter("amplitude", 0.05 + uniform(random));
        model.set_parameter("nu", 0.4 + 2.5 * uniform(random));
        const AttractorOptions settle{.section = "phase0", .cycles = 400};
        OrbitSolution start;
        try {
            start = find_orbit(System(model), settle);
        } catch (const InputError&) { // chaotic, or on a torus
            ++counts["start without orbit"];
            continue;
        }
        const double amplitude = model.parameter_values()[model.independent_parameter("amplitude").place()];
        for (const int direction : {-1, 1}) {
            BranchSettings settings = in_parameter(model, "amplitude", 0.2 * amplitude, 3 * amplitude, direction);
            settings.steps = 100;
            for (const SpecialPoint& point :
                 of_type(follow_branch(System(model), start.orbit, settings), PointType::grazing)) {
                const Judged one(model, point, settings.parameter);
                if (one.map.contact.order != MapOrder::linear) {
                    ++counts["not grazing-sliding"];
                    continue;
                }
                if (one.verdict.outcome == GrazingOutcome::undecided) {
                    ++counts["undecided: " + one.verdict.reason];
                    continue;
                }
                ++counts[fmt::format("{} ({}), {}", name_of(one.verdict.outcome), name_of(one.verdict.border),
                                     name_of(one.trial.outcome))];
                ++counts[std::string(name_of(one.trial.outcome))];
                EXPECT_NE(one.trial.outcome, TrialOutcome::contradicted)
                    << trial << ": " << name_of(one.verdict.outcome) << ", " << one.trial.reason;
            }
        }
    }
    for (const auto& [what, number] : counts)
        std::cout << what << ": " << number << '\n';
    return counts;
}

TEST(Sliding, VerdictsAgreeWithSimulationOnRandomBelts) {
    auto counts = try_random(12, 1);
    EXPECT_GE(counts["agreed"], 3);
}

TEST(SlidingSlow, VerdictsAgreeWithSimulationOnManyRandomBelts) {
    auto counts = try_random(400, 2);
    EXPECT_GE(counts["agreed"], 90);
}

} // namespace graze::sliding_test
