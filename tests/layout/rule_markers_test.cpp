#include "graze/layout/rule_markers.hpp"

#include <gmock/gmock.h>

namespace graze::testing::rule_markers_test {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(RuleMarkers, HaveTheBrokenRulesWithTheirPlaces) {
    RuleFinding broken;
    broken.rule = "smallest_gap";
    broken.value = 3;
    broken.limit = 5;
    broken.unit = "um";
    broken.part = "the mass & <its> stops";
    broken.at = {1000, -2500};
    broken.device = "DEVICE";
    RuleFinding kept = broken;
    kept.rule = "smallest_line";
    kept.value = 7;
    const std::string text = rule_markers(std::vector{broken, kept}, "DEVICE", "graze 1");
    EXPECT_THAT(text, HasSubstr("<category>'smallest_gap'</category>"));
    EXPECT_THAT(text, HasSubstr("<value>box: (-4,-7.5;6,2.5)</value>"));
    EXPECT_THAT(text, HasSubstr("the mass &amp; &lt;its&gt; stops"));
    EXPECT_THAT(text, Not(HasSubstr("smallest_line")));
    EXPECT_THAT(rule_markers({}, "DEVICE", "graze 1"), HasSubstr(" <items>\n </items>"));
}

} // namespace graze::testing::rule_markers_test
