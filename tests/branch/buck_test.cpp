// A DC/DC buck converter (J. H. B. Deane and D. C. Hamill, IEEE Trans. Power Electron. 5, 1990): the switching function
// is zero at the start of each arc by construction.

#include "follow.hpp"

#include <gtest/gtest.h>

namespace graze {
namespace {

using namespace graze::testing;

const char* const converter = R"toml(
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
[events.cross_on]
function = "-h"
kind = "section"
[events.cross_off]
function = "h"
kind = "section"
[events.reset]
function = "T - p"
[jumps.ramp]
p = 0
[[transitions]]
mode = "on"
event = "cross_on"
label = "off"
next = "off"
[[transitions]]
mode = "off"
event = "cross_off"
label = "on"
next = "on"
[[transitions]]
mode = "on"
event = "reset"
label = "R1"
jump = "ramp"
next = [{when = "h < 0", mode = "on"}, {mode = "off"}]
[[transitions]]
mode = "off"
event = "reset"
label = "R0"
jump = "ramp"
next = [{when = "h < 0", mode = "on"}, {mode = "off"}]
[sections.ramp]
function = "T/2 - p"
direction = "falling"
[initial]
mode = "on"
)toml";

TEST(BuckConverter, StartOnTheSwitchingSurfaceIsNotAGrazing) {
    const Model model = model_from(converter);
    BranchSettings settings;
    settings.parameter = model.independent_parameter("E");
    settings.least = 15;
    settings.greatest = 40;
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

} // namespace
} // namespace graze
