// Reading design files, and their errors.

#include "graze/design/design.hpp"

#include "graze/base/input_errors.hpp"
#include "switches.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace graze::testing::design_test {

using ::testing::HasSubstr;

/// All errors of a text, with their places.
std::vector<std::string> mistakes_of(const std::string& text) {
    std::vector<std::string> result;
    try {
        parse_design(text, "d.toml");
    } catch (const InputErrors& errors) {
        for (const InputError& one : errors.all())
            result.emplace_back(one.what());
    } catch (const InputError& error) {
        result.emplace_back(error.what());
    }
    return result;
}

TEST(Design, IsReadWithTolerancesOfEitherKind) {
    const Design design = oscillator_design();
    EXPECT_EQ(design.name, "oscillator");
    ASSERT_EQ(design.dimensions.size(), 2U);
    const DesignDimension& sigma = design.dimensions[0];
    ASSERT_TRUE(sigma.tolerance);
    EXPECT_DOUBLE_EQ(sigma.tolerance->at(sigma.parameter, 0.2).size, 0.002);
    EXPECT_DOUBLE_EQ(sigma.tolerance->at(sigma.parameter, -0.4).size, 0.004);
    EXPECT_EQ(design.adjustable, 0U);
    EXPECT_TRUE(design.wanted.is_empty());
    EXPECT_EQ(design.planes.size(), 1U); // by default of the first two
    EXPECT_DOUBLE_EQ(design.trip.end.speed, 0.5);
}

TEST(Design, AllShippedDesignsCanBeRead) {
    const std::vector<std::string> names = shipped_designs();
    EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
    EXPECT_TRUE(std::count(names.begin(), names.end(), "mems-switch"));
    for (const std::string& name : names)
        EXPECT_EQ(load_design(name).name, name);
    EXPECT_THROW(load_design("mems-swich"), InputError);
}

TEST(Design, ReportsAllErrorsAtOnceWithTheirPlaces) {
    const std::vector<std::string> found = mistakes_of(R"(name = "bad one"
model = "mems-switch"
control = "W"
nonsense = 1
[approach]
from = { x = 0 }
range = [0.6, 0.5]
event = "stopp"
[trip]
until = "q"
overshoots = [-1]
[dimensions.delta]
range = [0.7, 0.8]
[dimensions.zeta]
range = [0, 1]
tolerance = "-1%"
[dimensions.zetta]
range = [0, 1]
[wanted]
class = "perhaps"
trip_time = { overshoot = 1 }
)");
    const std::vector<std::string> parts{"d.toml:1:8: 'bad one' cannot be",
                                         "d.toml:3:1: there is no parameter 'W'",
                                         "d.toml:4:1: unknown key 'nonsense'",
                                         "d.toml:6:10: ",
                                         "d.toml:7:9: approach.range goes from",
                                         "d.toml:8:9: model 'mems-switch' has no event 'stopp'",
                                         "d.toml:10:9: 'q' names no level",
                                         "d.toml:11:15: trip.overshoots.1 is -1",
                                         "d.toml:12:13: 'delta' is 0.6 at first",
                                         "d.toml:16:13: dimensions.zeta.tolerance is below zero",
                                         "d.toml:17:13: there is no parameter",
                                         "d.toml:20:9: wanted.class cannot be 'perhaps'",
                                         "d.toml:21:13: wanted.trip_time is not complete"};
    ASSERT_EQ(found.size(), parts.size()) << ::testing::PrintToString(found);
    for (std::size_t i = 0; i < parts.size(); ++i)
        EXPECT_THAT(found[i], HasSubstr(parts[i]));
}

TEST(Design, RequiresTolerancesAndLimitsForAYield) {
    const std::string head = "name = \"a\"\nmodel = \"mems-switch\"\ncontrol = \"V\"\n[approach]\nrange = [0.05, 0.6]\n"
                             "[dimensions.delta]\nrange = [0.1, 1]\n";
    EXPECT_THAT(mistakes_of(head + "[wanted]\nyield = 0.9\n").front(), HasSubstr("no dimension has a tolerance"));
    const std::string made = head + "tolerance = \"1%\"\n";
    EXPECT_THAT(mistakes_of(made + "[wanted]\nyield = 0.9\n").front(), HasSubstr("which trip values will do"));
    EXPECT_THAT(mistakes_of(made + "[wanted]\nvalue = [0.2, 0.3]\nyield = 0\n").front(),
                HasSubstr("the yield 0 is not a share of devices above 0"));
    EXPECT_THAT(mistakes_of(made + "[wanted]\nvalue = [0.2, 0.3]\nyield = 95\n").front(),
                HasSubstr("as 0.95 for 95 percent"));
    EXPECT_THAT(mistakes_of(made + "[wanted]\nvalue = 0.2\nimportance = { value = 1000 }\n").front(),
                HasSubstr("give from 0.01 to 100"));
    EXPECT_THAT(mistakes_of(made + "[wanted]\nvalue = 0.2\nimportance = { speed = 2 }\n").front(),
                HasSubstr("unknown key 'speed'"));
    EXPECT_TRUE(mistakes_of(made + "[wanted]\nvalue = [0.2, 0.3]\nyield = 1\nimportance = { yield = 2 }\n").empty());
}

/// The finished device is approached like the first.
TEST(Design, RefusesATripValueBelowTheStartOfItsApproach) {
    const std::string head = "name = \"a\"\nmodel = \"mems-switch\"\ncontrol = \"V\"\n[approach]\nrange = [0.05, 0.6]\n"
                             "[dimensions.delta]\nrange = [0.1, 1]\n[wanted]\n";
    for (const char* value : {"0.04", "[0.01, 0.049]"})
        EXPECT_THAT(mistakes_of(head + "value = " + value + "\n").front(),
                    HasSubstr("d.toml:9:9: wanted.value is below approach.range, from 0.05 to 0.6: a device that trips "
                              "there has tripped where its approach begins"));
    for (const char* value : {"0.05", "0.7", "[0.01, 0.06]", "[0.5, 2]"})
        EXPECT_TRUE(mistakes_of(head + "value = " + value + "\n").empty()) << value;
}

TEST(Design, NamesMissingAndConflictingKeys) {
    EXPECT_EQ(mistakes_of("").size(), 4U); // name, approach, dimensions, model
    EXPECT_THAT(mistakes_of("name = \"a\"\nmodel = \"mems-switch\"\ncontrol = \"V\"\n[approach]\nrun = \"x\"\n"
                            "[dimensions.delta]\nrange = [0.1, 1]")
                    .front(),
                HasSubstr("names a run without a study"));
    EXPECT_THAT(mistakes_of("name = \"a\"\ncontrol = \"V\"\n[approach]\nstudy = \"mems-switch\"\nrun = \"trip\"\n"
                            "point = \"GR1\"\n[dimensions.delta]\nrange = [0.1, 1]")
                    .front(),
                HasSubstr("run 'trip' has no orbits"));
    EXPECT_THAT(mistakes_of("name = \"a\"\nmodel = \"mems-switch\"\ncontrol = \"V\"\n[approach]\nrange = [0, 1]\n"
                            "[dimensions.V]\nrange = [0.1, 1]")
                    .front(),
                HasSubstr("is the control parameter"));
}

} // namespace graze::testing::design_test
