#include "graze/layout/device_file.hpp"

#include "base/message_of.hpp"
#include "graze/base/input_errors.hpp"
#include "graze/design/design.hpp"

#include <gmock/gmock.h>

#include <cstdlib>

namespace graze::testing::device_file_test {

using ::testing::HasSubstr;

std::string message(const std::string& device, const GivenLengths& given = {}) {
    return message_of([&] { parse_device_file("name = \"one\"\n[device]\n" + device, "one.toml", given); });
}

TEST(DeviceFile, ReadsLengthsInAnyUnitOnTheGrid) {
    const DeviceFile file = parse_device_file(R"(name = "one"
[device]
gap = "12 um"
stop_gap = "0.6*12"
flexure_length = "1.2 mm"
flexure_width = "5.5e-6 m"
bar_width = 100.0004
folds = 3
[process]
chamber_depth = "0.05 mm"
[wafer]
diameter = "10 cm"
vary = { stop_gap = [5, "5500 nm"] }
[rules]
smallest_gap = "0.005 mm"
)",
                                              "one.toml");
    EXPECT_EQ(file.device.gap, 12);
    EXPECT_EQ(file.device.stop_gap, 7.2);
    EXPECT_EQ(file.device.flexure_length, 1200);
    EXPECT_EQ(file.device.flexure_width, 5.5);
    EXPECT_EQ(file.device.bar_width, 100);
    EXPECT_EQ(file.device.folds, 3U);
    EXPECT_EQ(file.process.layer_thickness(), 250);
    EXPECT_EQ(file.wafer.diameter, 100'000);
    EXPECT_EQ(file.rules.smallest_gap, 5);
    ASSERT_EQ(file.wafer.vary.size(), 1U);
    EXPECT_EQ(file.wafer.vary[0].second, (std::vector<double>{5, 5.5}));
    EXPECT_EQ(file.place("device.gap").text(), "one.toml:3:7");
    EXPECT_EQ(file.place("device.moat").text(), "one.toml:2:2") << "the section's";
    EXPECT_EQ(file.place("none").text(), "one.toml:1:1");
}

TEST(DeviceFile, ErrorsHavePlaceAndRemedy) {
    const std::vector<std::pair<std::string, std::string>> mistakes{
        {"gap = -3", "one.toml:3:7: device.gap is -3 um, not positive; give a positive length"},
        {"gap = 0", "one.toml:3:7: device.gap is 0 um, not positive; give a positive length"},
        {"gap = nan", "one.toml:3:7: device.gap is not a finite number; give a finite number"},
        {"gap = \"1/0\"", "one.toml:3:8: '1/0' has no finite value"},
        {"gap = 1e9",
         "one.toml:3:7: device.gap is 1e+09 um, more than a metre; give a length in micrometres, at most 1e6"},
        {"gap = \"0.1 nm\"", "one.toml:3:7: device.gap is 0.0001 um, less than the grid of 1 nm"},
        {"gap = \"3 inch\"", "one.toml:3:7: device.gap has the unknown unit 'inch'; give it in nm, um, mm, cm or m"},
        {"gap = \"1 bar\"", "one.toml:3:7: device.gap has the unknown unit 'bar'"},
        {"gap = \"15 V\"", "one.toml:3:7: device.gap is not measured in V; give it in nm, um, mm, cm or m"},
        {"gap = \"2 * x\"", "one.toml:3:"},
        {"gap = true", "one.toml:3:7: device.gap must be a number or an expression"},
        {"folds = 1.5", "one.toml:3:9: device.folds is 1.5; give a whole number from 1 to 100"},
        {"folds = 0", "one.toml:3:9: device.folds is 0; give a whole number from 1 to 100"},
        {"gapp = 3", "one.toml:3:1: unknown key 'gapp' in device; did you mean 'gap'?"},
        {"[wafr]", "unknown key 'wafr'; did you mean 'wafer'?"},
        {"[process]\nchamber_depth = 300", "one.toml:4:17: the chambers, 300 um deep, leave nothing of the wafer"},
        {"[process]\nmodulus = \"169 GHz\"", "one.toml:4:11: process.modulus is not measured in GHz; give it in GPa"},
        {"[process]\ntaper = 90", "one.toml:4:9: process.taper is 90 deg; give a number from -45 to 45"},
        {"[process]\npressure = \"2 barn\"",
         "one.toml:4:12: process.pressure has the unknown unit 'barn'; give it in Pa"},
        {"[process]\npressure = 0", "one.toml:4:12: process.pressure is 0 Pa; give a number from 1e-06 to"},
        {"[process]\ndensity = inf", "one.toml:4:11: process.density is not a finite number"},
        {"[process]\nbais = 1", "one.toml:4:1: unknown key 'bais' in process; did you mean 'bias'?"},
        {"[rules]\nsmallest_gap = -1", "one.toml:4:16: rules.smallest_gap is -1 um; give a number from 0 to"},
        {"[rules]\nlargest_gap = 1", "one.toml:4:1: unknown key 'largest_gap' in rules"},
        {"[wafer]\nvary = { gapp = [1] }", "one.toml:4:10: unknown key 'gapp' in wafer.vary; did you mean 'gap'?"},
    };
    for (const auto& [text, said] : mistakes)
        EXPECT_THAT(message(text), HasSubstr(said));
    EXPECT_THAT(message("gap = \"3inch\""), HasSubstr("one.toml:3:8: "));
    EXPECT_THAT(message("", {{"gap", -1}}), HasSubstr("given gap: gap is -1 um, not positive"));
    EXPECT_THAT(message("", {{"gab", 1}}),
                HasSubstr("given gab: a device has no dimension 'gab'; did you mean 'gap'?"));
    EXPECT_THAT(message("", {{"chamber_depth", 400}}), HasSubstr("given chamber_depth: the chambers, 400 um deep"));
    EXPECT_THAT(message("", {{"folds", 1.5}}), HasSubstr("give a whole number"));
    EXPECT_THROW(parse_device_file("name = \"one\"\n", "one.toml"), InputError) << "nothing to be drawn";
    EXPECT_THROW(parse_device_file("[device]\n", "one.toml"), InputError) << "no name";
}

TEST(DeviceFile, ReadsDimensionsOfTheCommandLineWithUnits) {
    const Place place{"--set", 1, 1};
    const auto value = [&](const std::string& name, const std::string& text) {
        return dimension_of_text(name, text, place);
    };
    EXPECT_DOUBLE_EQ(value("gap", "0.012 mm"), 12);
    EXPECT_DOUBLE_EQ(value("gap", "500nm"), 0.5);
    EXPECT_DOUBLE_EQ(value("gap", "2*6"), 12);
    EXPECT_DOUBLE_EQ(value("chamber_depth", "5e-5 m"), 50);
    EXPECT_DOUBLE_EQ(value("modulus", "169e9 Pa"), 169);
    EXPECT_DOUBLE_EQ(value("pressure", "100 kPa"), 1e5);
    EXPECT_EQ(value("folds", "3"), 3);
    const auto said = [&](const std::string& name, const std::string& text) {
        return message_of([&] { value(name, text); });
    };
    EXPECT_EQ(said("gap", "15 V"), "--set:1:1: gap is not measured in V; give it in nm, um, mm, cm or m");
    EXPECT_EQ(said("modulus", "3 um"), "--set:1:1: modulus is not measured in um; give it in GPa");
    EXPECT_EQ(said("gap", "3 inch"), "--set:1:1: gap has the unknown unit 'inch'; give it in nm, um, mm, cm or m");
}

TEST(DeviceFile, IsAlsoReadAsADesign) {
    const DeviceFile file = load_device_file("mems-switch-device", {{"gap", 20}});
    EXPECT_EQ(file.device.gap, 20);
    EXPECT_EQ(file.place("device.gap").file, "given gap");
    EXPECT_EQ(load_design("mems-switch-device").name, file.name);
}

} // namespace graze::testing::device_file_test
