#include "graze/layout/fabrication_rules.hpp"

#include "base/message_of.hpp"
#include "graze/base/input_errors.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace graze::fabrication_rules_test {

using ::testing::HasSubstr;

DeviceFile shipped() {
    return load_device_file("mems-switch-device");
}

std::vector<RuleFinding> found(const DeviceFile& file) {
    return rule_findings(file, draw_device_layout(file));
}

const RuleFinding& of(const std::vector<RuleFinding>& findings, const std::string& rule) {
    return *std::find_if(findings.begin(), findings.end(), [&](const auto& one) { return one.rule == rule; });
}

/// The message about broken rules; empty if all hold.
std::string message(const DeviceFile& file) {
    return testing::message_of([&] { require_rules(file, found(file)); });
}

TEST(FabricationRules, MeasureTheShippedDevice) {
    const DeviceFile file = shipped();
    const std::vector<RuleFinding> findings = found(file);
    const std::size_t given = rule_fields().size();
    ASSERT_EQ(findings.size(), given + 2);
    for (std::size_t i = 0; i < findings.size(); ++i) {
        EXPECT_EQ(findings[i].rule, i < given ? rule_fields()[i].name : "free_way");
        EXPECT_TRUE(findings[i].holds()) << findings[i].text();
    }
    EXPECT_EQ(of(findings, "smallest_line").value, 7);
    EXPECT_EQ(of(findings, "smallest_line").part, "a beam");
    EXPECT_EQ(of(findings, "smallest_gap").value, 8.4);
    EXPECT_EQ(of(findings, "smallest_gap").part, "the trench between the mass and a stop");
    EXPECT_NEAR(of(findings, "largest_aspect").value, 250 / 8.4, 1e-12);
    EXPECT_EQ(of(findings, "undercut").value, 40);
    // The chamber extends 50 um beyond the etched area, and that 40 um beyond the mass; the base is 14.185 + 40 um
    // away.
    EXPECT_NEAR(of(findings, "chamber_overlap").value, 54.185, 1e-9);
    EXPECT_NEAR(of(findings, "largest_stop_share").value, 9 / 14.785, 1e-12);
    EXPECT_EQ(message(file), "");
}

TEST(FabricationRules, AreBrokenByDimensions) {
    const auto broken = [](auto change) {
        DeviceFile file = shipped();
        change(file);
        return message(file);
    };
    EXPECT_THAT(broken([](DeviceFile& f) { f.device.flexure_width = 4.9; }),
                HasSubstr("rule smallest_line is 4.9 um for a beam, at ("));
    EXPECT_THAT(broken([](DeviceFile& f) { f.device.stop_gap = 5.5; }),
                HasSubstr("smallest_gap is 5.5 um for the trench between the mass and a stop, at ("));
    EXPECT_THAT(broken([](DeviceFile& f) { f.rules.largest_aspect = 20; }), HasSubstr("at most 20 is allowed"));
    EXPECT_THAT(broken([](DeviceFile& f) { f.device.base_inset = 28; }), HasSubstr("undercut is 28 um"));
    EXPECT_THAT(broken([](DeviceFile& f) { f.device.stop_gap = 14; }), HasSubstr("largest_stop_share is"));
    EXPECT_THAT(broken([](DeviceFile& f) { f.rules.largest_stress = 15; }),
                HasSubstr("largest_stress is 18.1085 MPa for a beam, when the electrodes touch"));
    EXPECT_THAT(broken([](DeviceFile& f) { f.rules.largest_squeeze = 0.05; }), HasSubstr("largest_squeeze is"));
    // Without a margin the chamber ends at the trench around the mass.
    EXPECT_THAT(broken([](DeviceFile& f) {
                    f.device.chamber_margin = 0;
                    f.rules.chamber_overlap = 45;
                }),
                HasSubstr("chamber_overlap is 40 um for the mass"));
}

TEST(FabricationRules, MeasureWidthsAfterTheEtch) {
    DeviceFile file = shipped();
    const double slope = std::tan(0.05 * M_PI / 180); // slope of the design's walls
    const std::vector<RuleFinding> findings = found(file);
    // Trenches widen with depth: lines are narrowest at the bottom, 250 um deep, and trenches at the top.
    EXPECT_NEAR(of(findings, "smallest_etched_line").value, 7 - 2 * (0.3 + 250 * slope), 1e-9);
    EXPECT_EQ(of(findings, "smallest_etched_line").part, "a beam at its bottom");
    EXPECT_NEAR(of(findings, "smallest_etched_gap").value, 8.4 + 0.6, 1e-9);
    EXPECT_EQ(of(findings, "smallest_etched_gap").part, "the trench between the mass and a stop at its top");
    file.conditions.bias = 3.2;
    EXPECT_THAT(message(file), HasSubstr("rule smallest_etched_line is 0.163"));
    EXPECT_EQ(of(found(file), "smallest_etched_line").key, "process.bias");
    file.conditions.bias = 0;
    file.conditions.taper = -1; // trenches narrow with depth
    EXPECT_THAT(message(file), HasSubstr("rule smallest_etched_gap is -0.32"));
    EXPECT_THAT(message(file), HasSubstr("the trench between the mass and a stop at its bottom"));
}

TEST(FabricationRules, ApplyUnlessSwitchedOff) {
    const auto said = [](const std::string& sections) {
        return message(parse_device_file("name = \"one\"\n[device]\nflexure_width = 3.5\n" + sections, "one.toml"));
    };
    for (const char* none : {"", "[rules]\n", "[rules]\nsmallest_gap = 5\n"})
        EXPECT_THAT(said(none), HasSubstr("rule smallest_line is 3.5 um for a beam, at (")) << none;
    EXPECT_THAT(said(""), HasSubstr("at least 4 um is allowed; change the dimension, or smallest_line in [rules]"));
    EXPECT_EQ(said("[rules]\nsmallest_line = false\n"), "");
    EXPECT_EQ(said("[rules]\nsmallest_line = 3.5\n"), "");
    EXPECT_THROW(said("[rules]\nsmallest_line = true\n"), InputError);
    for (const QuantityField<RuleLimits>& rule : rule_fields()) {
        const DeviceFile file = parse_device_file(
            std::string("name = \"one\"\n[device]\n[rules]\n") + rule.name + " = false\n", "one.toml");
        const std::vector<RuleFinding> findings = found(file);
        EXPECT_EQ(findings.size(), rule_fields().size() + 1) << rule.name;
        EXPECT_TRUE(std::none_of(findings.begin(), findings.end(),
                                 [&](const RuleFinding& one) { return one.rule == rule.name; }));
    }
    EXPECT_THROW(parse_device_file("name = \"one\"\n[device]\n[rules]\nlargest_stress = 0\n", "one.toml"), InputError)
        << "no device has none";
}

TEST(FabricationRules, ReportEachBrokenRuleAtItsPlaceInTheFile) {
    DeviceFile file = shipped();
    file.device.stop_gap = 5;
    file.device.flexure_width = 4;
    try {
        require_rules(file, found(file));
        FAIL();
    } catch (const InputErrors& errors) {
        EXPECT_GT(errors.all().size(), 4U); // every beam, both stops, and their aspect ratios
        for (const InputError& error : errors.all())
            EXPECT_GT(error.place().line, 1U);
    }
}

TEST(FabricationRules, CountFurtherPlaces) {
    DeviceFile file = shipped();
    file.device.flexure_width = 4;
    const std::vector<RuleFinding> findings = found(file);
    std::vector<RuleFinding> lines;
    std::copy_if(findings.begin(), findings.end(), std::back_inserter(lines),
                 [](const RuleFinding& one) { return one.rule == "smallest_line"; });
    ASSERT_EQ(lines.size(), 5U);
    EXPECT_EQ(lines.front().more, 0U);
    EXPECT_EQ(lines.back().more, 3U) << "of eight beams";
    EXPECT_THAT(lines.back().text(), HasSubstr("at least 5 um is allowed (and at 3 more places)"));
}

TEST(FabricationRules, DetectAMassThatExtendsBeyondItsChamber) {
    const DeviceFile file = shipped();
    Layout layout = draw_device_layout(file);
    // The mass is drawn a millimetre off its chamber.
    for (GridPoint& corner : layout.devices[0].drawing.mass)
        corner.y += 1'000'000;
    const std::vector<RuleFinding> findings = rule_findings(file, layout, layout.devices[0]);
    const RuleFinding& overlap = of(findings, "chamber_overlap");
    EXPECT_FALSE(overlap.holds());
    EXPECT_LT(overlap.value, -800);
    EXPECT_THAT(overlap.part, HasSubstr("the mass, which reaches out of it"));
}

} // namespace graze::fabrication_rules_test
