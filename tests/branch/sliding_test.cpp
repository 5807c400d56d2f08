// Orbits that touch a surface on which motions stick: grazing-sliding of an oscillator on a moving belt.

#include "belt.hpp"
#include "cycle_error.hpp"
#include "follow.hpp"

#include <cmath>
#include <iostream>
#include <map>
#include <numbers>
#include <random>
#include <string>

namespace graze::sliding_test {

using namespace graze::testing;

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

/// x' = -x + A cos(theta) - sign(x): the symmetric orbit crosses x = 0 where the other side just ceases to push back,
/// cos(theta) = -1/A, if sqrt(A^2 - 1) = 1 + 2 tanh(pi/2).
TEST(Sliding, CrossingSlidingHasItsNameAndItsClosedForm) {
    const Model model = model_from(R"toml(name = "first order"
[parameters]
A = 3.6
[states]
x = 1
theta = { initial = 0, period = "2*pi" }
[modes.low]
rates = { x = "-x + A*cos(theta) + 1", theta = 1 }
[modes.high]
rates = { x = "-x + A*cos(theta) - 1", theta = 1 }
[events]
zero = "x"
[slides.still]
surface = "zero"
between = ["low", "high"]
[sections.phase0]
state = "theta"
value = 0
[initial]
mode = "high"
)toml");
    const BranchSettings settings = in_parameter(model, "A", 2.5, 3.6, -1);
    const Branch branch = follow_branch(System(model), settled(model, "phase0").orbit, settings);
    std::size_t found = 0;
    for (const SpecialPoint& point : branch.special) {
        if (point.detail.find("crossing-sliding") == std::string::npos)
            continue;
        ++found;
        EXPECT_NEAR(point.parameter, std::hypot(1, 1 + 2 * std::tanh(std::numbers::pi / 2)), 1e-9) << point.detail;
    }
    EXPECT_GE(found, 1U);
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
