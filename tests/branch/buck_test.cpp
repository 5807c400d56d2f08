// A DC/DC buck converter (J. H. B. Deane and D. C. Hamill, IEEE Trans. Power Electron. 5, 1990): the switching function
// is zero at the start of each arc by construction.

#include "follow.hpp"

#include <gtest/gtest.h>

namespace graze::buck_test {

using namespace graze::testing;

Model converter() {
    const std::string after_reset = "[{ when = 'h < 0', mode = 'on' }, { mode = 'off' }]";
    return model_from(R"toml(
[parameters]
E = 22
R = 22
C = 47e-6
L = 20e-3
T = 400e-6
[states]
V = 12
I = 0.55
p = 0
[definitions]
h = "8.4*(V - 11.3) - 3.8 - 4.4*p/T"
[modes.on]
rates = { V = "(I - V/R)/C", I = "(E - V)/L", p = 1 }
watch = ["cross_on", "reset"]
[modes.off]
rates = { V = "(I - V/R)/C", I = "-V/L", p = 1 }
watch = ["cross_off", "reset"]
[events]
cross_on = { function = "-h", kind = "section" }
cross_off = { function = "h", kind = "section" }
reset = "T - p"
[jumps.ramp]
p = 0
[initial]
mode = "on"
)toml" + transition("on", "cross_on", "off", "", "off") +
                      transition("off", "cross_off", "on", "", "on") +
                      transition("on", "reset", after_reset, "ramp", "R1") +
                      transition("off", "reset", after_reset, "ramp", "R0") + section("ramp", "T/2 - p", "falling"));
}

TEST(BuckConverter, StartOnTheSwitchingSurfaceIsNotAGrazing) {
    const Model model = converter();
    const BranchSettings settings = in_parameter(model, "E", 15, 40);
    const Branch one = follow_branch(System(model), settled(model, "ramp").orbit, settings);
    ASSERT_EQ(names(one), "PD BD");
    EXPECT_NEAR(one.special[0].parameter, 24.516, 1e-3); // M. di Bernardo et al., IEEE Trans. Circuits Syst. I 45, 1998
    for (const BranchPoint& point : one.points)
        EXPECT_TRUE(point.solution.certificate.admissible) << point.solution.certificate.reason;
    const Branch two = follow(model, branches_at(System(model), one.special[0], settings).at(0), settings);
    const auto flips = of_type(two, PointType::flip);
    ASSERT_EQ(flips.size(), 1U) << names(two);
    EXPECT_NEAR(flips[0].parameter, 31.118, 1e-3);
    EXPECT_TRUE(of_type(two, PointType::grazing).empty()) << names(two);
}

} // namespace graze::buck_test
