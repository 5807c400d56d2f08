// Branches of the shipped models against published or independently computed values.

#include "follow.hpp"

#include "graze/model/microbeam.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace graze::published_branches_test {

using namespace graze::testing;
using std::numbers::pi;

struct Microactuator {
    explicit Microactuator(double omega)
        : model(shipped_with("impact-microactuator", {{"V", 0.1}, {"omega", omega}})) {}
    Model model;
    BranchSettings settings = in_parameter(model, "V", 0, 3);
    Branch without_contact() const {
        return follow_branch(System(model), settled(model, "longest", 4000).orbit, settings);
    }
};

TEST(PublishedBranches, MicroactuatorHasItsPublishedPointsUpToTheFirstContact) {
    const Microactuator one(0.9189);
    const Branch branch = one.without_contact();
    ASSERT_EQ(names(branch), "PD PD SN GR");
    EXPECT_EQ(branch.outcome, BranchOutcome::unphysical);
    EXPECT_NEAR(branch.special[0].parameter, 0.316674036113040, 1e-13);
    EXPECT_NEAR(branch.special[1].parameter, 0.451075045332847, 1e-13);
    EXPECT_NEAR(branch.special[2].parameter, 0.587638103140046, 1e-13);
    EXPECT_NEAR(branch.special[3].parameter, 0.5876212422746997, 1e-13);
    expect_flip(branch.special[0]);
    expect_flip(branch.special[1]);
    expect_fold(branch, branch.special[2]);
    expect_touch(one.model, branch.special[3], 0.5);
    // The fold and the touch are 2e-5 apart in V, in this order.
    EXPECT_LT(branch.special[2].arclength, branch.special[3].arclength);
    const SpecialPoint& grazing = branch.special[3];
    const double phase = grazing.solution.orbit.starts[grazing.segment][4] + 0.9189 * grazing.time;
    EXPECT_NEAR(std::remainder(phase - 3.132040065911, pi), 0, 1e-11);
    // The branch ends where orbits become inadmissible.
    EXPECT_NEAR(branch.points.back().parameter, grazing.parameter, 1e-15);
    for (const BranchPoint& point : branch.points) {
        ASSERT_EQ(point.solution.multipliers.size(), 2U);
        EXPECT_NEAR(std::abs(point.solution.multipliers[0] * point.solution.multipliers[1]),
                    std::exp(-0.04 * pi / 0.9189), 1e-9);
    }
}

/// Adds one contact at each grazing and checks the points on each of these branches.
void expect_contacts(double omega, const std::vector<double>& grazings, double tolerance) {
    const Microactuator one(omega);
    Branch branch = one.without_contact();
    for (std::size_t n = 0; n < grazings.size(); ++n) {
        ASSERT_FALSE(branch.special.empty());
        const SpecialPoint grazing = branch.special.back();
        EXPECT_NEAR(grazing.parameter, grazings[n], tolerance) << n;
        expect_touch(one.model, grazing, 0.5);
        const auto starts = branches_at(System(one.model), grazing, one.settings);
        ASSERT_EQ(starts.size(), 1U);
        EXPECT_EQ(to_string(one.model, starts[0].orbit.signature), n == 0 ? "J8 J1" : fmt::format("(J8 J1)^{}", n + 1));
        branch = follow(one.model, starts[0], one.settings);
        for (const SpecialPoint& fold : of_type(branch, PointType::fold))
            expect_fold(branch, fold);
        for (const SpecialPoint& flip : of_type(branch, PointType::flip))
            expect_flip(flip);
        EXPECT_EQ(branch.outcome, BranchOutcome::unphysical);
    }
}

TEST(PublishedBranches, MicroactuatorGainsContactAfterContact) {
    expect_contacts(
        0.9189, {0.5876212422746997, 0.7304755333366196, 0.8095127614194632, 0.8558788675649937, 0.8819580628177297},
        1e-12);
}

TEST(PublishedBranches, MicroactuatorGainsContactAfterContactAtAnotherFrequency) {
    expect_contacts(2.0056,
                    {.52745995765981, .66636423118007, .74940362005310, .79897011651099, .82715666925300,
                     .84240315127881, .85032000894172, .85431167398464},
                    2e-13);
}

/// The same from the equations of frame and impactor, the impacts and a law of friction: its modes are derived.
TEST(PublishedBranches, MicroactuatorOfEquationsAndALawGainsContactAfterContact) {
    const std::string shipped = write_model(Microactuator(0.9189).model);
    Model model = model_from(shipped.substr(0, shipped.find("[definitions]")) + R"toml(
[definitions]
F = "alpha*V^2*sin(x5)^2/(d - x3)^2 - c*x4 - k*x3"
[modes.free]
watch = ["front", "back"]
rates = { x1 = "x2", x2 = "-(F + rub)/m1", x3 = "x4", x4 = "F/m2 + (F + rub)/m1", x5 = "omega" }
[friction.rub]
velocity = "x2"
normal = "N"
coefficient = "mu_d"
static = "mu_s"
[events]
front = "delta - x3"
back = "delta + x3"
[jumps.impact]
x2 = "x2 + m2*(1 + e)/(m1 + m2)*x4"
x4 = "-e*x4"
[sections.longest]
function = "x4"
direction = "falling"
[[transitions]]
mode = "free"
event = "front"
jump = "impact"
next = "free"
[[transitions]]
mode = "free"
event = "back"
jump = "impact"
next = "free"
)toml");
    ASSERT_EQ(model.modes.size(), 3U);
    const BranchSettings settings = in_parameter(model, "V", 0, 3);
    Branch branch = follow_branch(System(model), settled(model, "longest", 4000).orbit, settings);
    EXPECT_EQ(names(branch), "PD PD SN GR");
    for (const double grazing : {0.5876212422746997, 0.7304755333366196, 0.8095127614194632}) {
        ASSERT_FALSE(branch.special.empty());
        EXPECT_NEAR(branch.special.back().parameter, grazing, 1e-12);
        const auto starts = branches_at(System(model), branch.special.back(), settings);
        ASSERT_EQ(starts.size(), 1U);
        branch = follow(model, starts[0], settings);
    }
    EXPECT_EQ(to_string(model, branch.points.back().solution.orbit.signature),
              "(free-forward:stops free-stick:front)^3");
}

TEST(PublishedBranches, MicroactuatorWithOneContactHasItsFlip) {
    const Microactuator one(0.9189);
    const Branch before = one.without_contact();
    const Branch branch =
        follow(one.model, branches_at(System(one.model), before.special.back(), one.settings).at(0), one.settings);
    const auto flips = of_type(branch, PointType::flip);
    ASSERT_EQ(flips.size(), 1U);
    EXPECT_NEAR(flips[0].parameter, 0.858230023098903, 1e-12);
    expect_flip(flips[0]);
}

TEST(PublishedBranches, MicroactuatorLosesItsContactWhereItWasGained) {
    const Microactuator one(0.9189);
    const Branch before = one.without_contact();
    Branch branch =
        follow(one.model, branches_at(System(one.model), before.special.back(), one.settings).at(0), one.settings);
    const auto far = std::find_if(branch.points.begin(), branch.points.end(),
                                  [](const BranchPoint& point) { return point.parameter > 0.65; });
    ASSERT_NE(far, branch.points.end());
    // Back from far away, towards vanishing speed.
    BranchSettings back = one.settings;
    back.direction = -1;
    const Branch returned = follow_branch(System(one.model), far->solution.orbit, back);
    ASSERT_EQ(names(returned), "GR");
    const SpecialPoint& lost = returned.special[0];
    EXPECT_TRUE(lost.at_end);
    EXPECT_EQ(returned.outcome, BranchOutcome::unphysical);
    // The contact speed vanishes with the square root of the distance, so the parameter is less accurate.
    EXPECT_NEAR(lost.parameter, 0.5876212422746997, 1e-11);
    const auto starts = branches_at(System(one.model), lost, one.settings);
    ASSERT_EQ(starts.size(), 1U);
    EXPECT_EQ(starts[0].orbit.segments(), 1U);
    const Branch without = follow(one.model, starts[0], one.settings);
    const auto flips = of_type(without, PointType::flip);
    ASSERT_EQ(flips.size(), 2U);
    EXPECT_NEAR(flips[1].parameter, 0.316674036113040, 1e-12);
    EXPECT_NEAR(flips[0].parameter, 0.451075045332847, 1e-12);
    EXPECT_EQ(of_type(without, PointType::fold).size(), 1U);
}

TEST(PublishedBranches, TestbedHasItsPublishedGrazing) {
    for (const auto& [frequency, voltage] :
         {std::pair{6.25, 4.833263260865}, {7.0, 3.675357252066}, {8.0, 3.998955699893}}) {
        const Model model = shipped_with("electromagnetic-testbed", {{"f", frequency}, {"V0", 3}});
        const BranchSettings settings = in_parameter(model, "V0");
        const Orbit orbit = settled(model, "phase0", 600).orbit;
        ASSERT_TRUE(orbit.symmetry);
        const Branch branch = follow_branch(System(model), orbit, settings);
        ASSERT_EQ(names(branch), "GR");
        EXPECT_NEAR(branch.special[0].parameter, voltage, 1e-11);
        expect_touch(model, branch.special[0], 1e-3);
        // One impact against the stop in each half: the orbit stays symmetric.
        const auto starts = branches_at(System(model), branch.special[0], settings);
        ASSERT_EQ(starts.size(), 1U);
        EXPECT_TRUE(starts[0].orbit.symmetry);
        EXPECT_EQ(to_string(model, starts[0].orbit.signature), "impact");
    }
}

/// Below 7.69 Hz the touch lies at the other end of the half orbit.
TEST(PublishedBranches, TestbedHasOneCurveOfGrazings) {
    const Model model = shipped_with("electromagnetic-testbed", {{"f", 8}, {"V0", 3}});
    BranchSettings settings = in_parameter(model, "V0");
    const Branch branch = follow_branch(System(model), settled(model, "phase0", 600).orbit, settings);
    ASSERT_EQ(names(branch), "GR");
    settings.kept = branch.special[0];
    settings.free = {settings.parameter};
    settings.parameter = model.independent_parameter("f");
    settings.direction = -1;
    for (const auto& [frequency, voltage] : {std::pair{7.0, 3.675357252066}, {6.25, 4.833263260865}}) {
        settings.least = frequency;
        const Branch curve = follow_branch(System(model), branch.special[0].solution.orbit, settings);
        ASSERT_EQ(curve.outcome, BranchOutcome::bound) << curve.detail;
        EXPECT_NEAR(curve.points.back().solution.orbit.parameters[settings.free[0].place()], voltage, 1e-11);
    }
}

TEST(PublishedBranches, TestbedOrbitOfThreePeriodsHasItsPublishedPoints) {
    const Model model = started(load_model("electromagnetic-testbed"), {{"I", 0.1}});
    const OrbitSolution solution = settled(model, "phase0", 600);
    ASSERT_TRUE(solution.orbit.symmetry);
    BranchSettings settings = in_parameter(model, "V0", {}, {}, -1);
    const Branch down = follow_branch(System(model), solution.orbit, settings);
    const auto folds = of_type(down, PointType::fold);
    ASSERT_EQ(folds.size(), 1U);
    EXPECT_NEAR(folds[0].parameter, 4.789014895054, 1e-11);
    expect_fold(down, folds[0]);

    settings.direction = 1;
    const Branch up = follow_branch(System(model), solution.orbit, settings);
    const auto breaking = of_type(up, PointType::asymmetry);
    ASSERT_GE(breaking.size(), 1U);
    EXPECT_NEAR(breaking[0].parameter, 4.846244144797, 1e-11);
    // Located by the half map, which has the multiplier -1; the whole map has 1.
    const auto& halves = breaking[0].solution.half_multipliers;
    EXPECT_LT(std::abs(halves.at(0) + 1.0), 1e-9);
    EXPECT_LT(nearest_multiplier(breaking[0].solution, 1), 1e-9);

    // Two asymmetric branches, images of each other.
    const auto starts = branches_at(System(model), breaking[0], settings);
    ASSERT_EQ(starts.size(), 2U);
    const Branch one = follow(model, starts[0], settings), other = follow(model, starts[1], settings);
    EXPECT_EQ(names(one), names(other));
    ASSERT_EQ(one.special.size(), other.special.size());
    for (std::size_t i = 0; i < one.special.size(); ++i)
        EXPECT_NEAR(one.special[i].parameter, other.special[i].parameter, 1e-10);
    ASSERT_GT(one.points.size(), 2U);
    const Orbit& whole = one.points[2].solution.orbit;
    EXPECT_FALSE(whole.symmetry);
    EXPECT_FALSE(half_orbit(System(model), whole));
    EXPECT_NEAR(whole.period(), 3 / 6.25, 1e-10);
}

TEST(PublishedBranches, MemsSwitchHasItsPublishedGrazing) {
    const Model model = started(shipped_with("mems-switch", {{"V", 0.15}}), {{"q", 0}});
    const BranchSettings settings = in_parameter(model, "V");
    const Branch branch = follow_branch(System(model), settled(model, "phase0").orbit, settings);
    ASSERT_EQ(names(branch), "GR");
    const SpecialPoint& grazing = branch.special[0];
    EXPECT_NEAR(grazing.parameter, 0.2013662121541341, 1e-13);
    EXPECT_NEAR(grazing.solution.orbit.starts[grazing.segment][2] + grazing.time, 0.7306205700512591, 1e-12);
    ASSERT_EQ(grazing.solution.multipliers.size(), 2U);
    EXPECT_LT(nearest_multiplier(grazing.solution, 0), 1);
    EXPECT_NEAR(grazing.solution.multipliers[0].real(), 0.8765517138529, 1e-11);
    EXPECT_NEAR(std::abs(grazing.solution.multipliers[0].imag()), 0.0970812655112, 1e-11);
    expect_touch(model, grazing, 0.6);
    // The orbit with an impact exists, but is unstable from the start: beyond grazing only snap-through remains.
    const auto starts = branches_at(System(model), grazing, settings);
    ASSERT_EQ(starts.size(), 1U);
    const Branch impacting = follow(model, starts[0], settings);
    ASSERT_GT(impacting.points.size(), 3U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_TRUE(impacting.points[i].solution.certificate.admissible);
        EXPECT_FALSE(impacting.points[i].stable);
        EXPECT_LT(impacting.points[i].parameter, grazing.parameter);
    }
}

TEST(PublishedBranches, MicrobeamHasItsPublishedGrazing) {
    const Model model = shipped_with("microbeam", {{"V", 0.01}});
    BranchSettings settings = in_parameter(model, "V", 0.005, 0.06);
    const Branch branch = follow_branch(System(model), settled(model, "phase0").orbit, settings);
    ASSERT_EQ(names(branch), "GR");
    EXPECT_NEAR(branch.special[0].parameter, 0.030040810557599, 1e-13);
    expect_touch(model, branch.special[0], 0.01);
    const auto starts = branches_at(System(model), branch.special[0], settings);
    ASSERT_EQ(starts.size(), 1U);
    settings.steps = 60;
    const Branch deeper = follow(model, starts[0], settings);
    const auto folds = of_type(deeper, PointType::fold);
    ASSERT_EQ(folds.size(), 2U);
    EXPECT_NEAR(folds[0].parameter, 0.032825650930776, 1e-13);
    expect_fold(deeper, folds[0]);
    // Where contact lasts beyond the end of the pulse, the branch continues with another order of events; its next fold
    // is where the high-penetration orbits begin.
    EXPECT_EQ(of_type(deeper, PointType::vanishing).size(), 1U);
    EXPECT_NEAR(folds[1].parameter, 0.022532683475758, 1e-13);
    expect_fold(deeper, folds[1]);
}

TEST(PublishedBranches, MicrobeamHasItsPublishedFoldsWithAndWithoutStop) {
    Model model = shipped_with("microbeam", {{"V", 0.034}});
    BranchSettings settings = in_parameter(model, "V", 0.01, {}, -1);
    settings.stop_at = {PointType::fold};
    const Branch high = follow_branch(System(model), settled(model, "phase0").orbit, settings);
    EXPECT_EQ(high.outcome, BranchOutcome::stopped) << high.detail;
    const auto folds = of_type(high, PointType::fold);
    ASSERT_EQ(folds.size(), 1U);
    EXPECT_NEAR(folds[0].parameter, 0.022532683475758, 1e-13);

    model = microbeam({.stop_distance = -0.02, .stop_stiffness = 0, .voltage = 0.01});
    settings.direction = 1;
    const Branch soft = follow_branch(System(model), settled(model, "phase0").orbit, settings);
    EXPECT_EQ(names(soft), "SN");
    EXPECT_NEAR(soft.special.back().parameter, 0.036662363851355, 1e-13);
}

} // namespace graze::published_branches_test
