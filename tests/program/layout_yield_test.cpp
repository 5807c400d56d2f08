#include "program/layout_yield.hpp"

#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

namespace graze::testing {
namespace {

using ::testing::HasSubstr;

TEST(LayoutModel, WritesParametersThatOtherCommandsTake) {
    const Folder folder;
    const std::string file = folder / "etched.toml";
    ASSERT_EQ(run_graze({"layout", "mems-switch-device", "--set", "bias=0.31", "--parameters", file}).code, 0);
    EXPECT_THAT(contents(file), HasSubstr("model = \"mems-switch-device\""));
    const Printed moved = run_graze(
        {"simulate", "mems-switch-device", "--set", "@" + file, "--set", "f=f0", "--time", "1", "--format", "csv"});
    EXPECT_EQ(moved.code, 0) << moved.err;
    const std::string again = folder / "again.toml";
    ASSERT_EQ(run_graze({"layout", "mems-switch-device", "--set", "bias=310 nm", "--parameters", again}).code, 0);
    EXPECT_EQ(contents(again), contents(file));
}

TEST(LayoutModel, WritesNothingIfARuleIsBrokenUnlessAsked) {
    const Folder folder;
    const std::string file = folder / "device.gds";
    const Printed refused = run_graze({"layout", "mems-switch-device", "--set", "flexure_width=4.5", "--output", file});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("rule smallest_line is 4.5 um for a beam, at ("));
    EXPECT_EQ(folder.files(), 0U);
    const Printed written =
        run_graze({"layout", "mems-switch-device", "--set", "flexure_width=4.5", "--output", file, "--despite-rules"});
    EXPECT_EQ(written.code, 3);
    EXPECT_THAT(written.err, HasSubstr("graze: rule smallest_line is 4.5 um"));
    EXPECT_EQ(folder.files(), 1U);
}

TEST(LayoutModel, RefusesADeviceThatTheEtchRemoves) {
    const Printed gone = run_graze({"layout", "mems-switch-device", "--set", "bias=4"});
    EXPECT_EQ(gone.code, 2);
    const Printed despite = run_graze({"layout", "mems-switch-device", "--set", "bias=4", "--despite-rules"});
    EXPECT_EQ(despite.code, 2) << "a device without beams has no model";
    EXPECT_THAT(despite.err, HasSubstr("--set bias: "));
    EXPECT_THAT(gone.err, HasSubstr("--set bias: rule smallest_etched_line is -1.43633 um"));
    for (const char* set : {"taper=1", "wafer_thickness=40", "chamber_depth=300", "gap=1e-6"}) {
        const Printed refused = run_graze({"layout", "mems-switch-device", "--set", set});
        EXPECT_EQ(refused.code, 2);
        const std::string name = set;
        EXPECT_THAT(refused.err, HasSubstr("graze: --set " + name.substr(0, name.find('=')) + ": "));
    }
}

TEST(LayoutModel, RefusesUnknownEndingsAndNames) {
    const Printed text = run_graze({"layout", "mems-switch-device", "--output", "x.txt"});
    EXPECT_EQ(text.code, 2);
    EXPECT_THAT(text.err, HasSubstr("what kind of file to write; let the name end in .gds"));
    const Printed unknown = run_graze({"layout", std::string(3000, 'n')});
    EXPECT_EQ(unknown.code, 2);
    EXPECT_LT(unknown.err.size(), 1000U);
}

TEST(LayoutModel, WritesTheRecipe) {
    const Folder folder;
    ASSERT_EQ(run_graze({"layout", "mems-switch-device", "--recipe", folder / "recipe.md"}).code, 0);
    EXPECT_THAT(contents(folder / "recipe.md"), HasSubstr("Etch 50 um deep"));
    ASSERT_EQ(run_graze({"layout", "mems-switch-device", "--recipe", folder / "recipe.svg"}).code, 0);
    EXPECT_THAT(contents(folder / "recipe.svg"), HasSubstr("9  silicon is etched through, to the epoxy"));
}

TEST(LayoutModel, RecipeHasCommandsThatDrawTheMasks) {
    const Folder folder;
    const std::string design = folder / "z o.toml", recipe = folder / "recipe.md";
    std::ofstream(design) << run_graze({"design", "mems-switch-device", "--show"}).out;
    for (const bool broken : {false, true}) {
        std::vector<std::string> words{"layout", design, "--set", "gap=14.5", "--set", "stop_gap=8.2"};
        if (broken)
            words.insert(words.end(), {"--set", "flexure_width=4.5", "--despite-rules"});
        std::vector<std::string> with_recipe = words;
        with_recipe.insert(with_recipe.end(), {"--recipe", recipe});
        EXPECT_EQ(run_graze(with_recipe).code, broken ? 3 : 0);
        const std::string text = contents(recipe);
        for (const std::string mask : {"1", "2"}) {
            const std::string end = " --wafer --mask " + mask + " --output mems-switch-device-mask" + mask + ".gds\n";
            const std::string options = broken ? " --set flexure_width=4.5 --despite-rules" : "";
            EXPECT_THAT(text, HasSubstr("      graze layout '" + design + "' --set gap=14.5 --set stop_gap=8.2" +
                                        options + end));
            std::vector<std::string> command = words;
            const std::string file = folder / ("mask" + mask + ".gds");
            command.insert(command.end(), {"--wafer", "--mask", mask, "--output", file});
            EXPECT_EQ(run_graze(command).code, broken ? 3 : 0);
        }
    }
}

TEST(LayoutYield, MakesAFolderOfTablesAndMaps) {
    const Folder folder;
    const std::string place = folder / "wafers";
    const std::vector<std::string> words{"layout", "mems-switch-device", "--yield", "2",      "--folder",
                                         place,    "--format",           "csv",     "--seed", "3"};
    const Printed printed = run_graze(words);
    ASSERT_EQ(printed.code, 0) << printed.err;
    EXPECT_EQ(header(printed.out), "quantity,value,unit,meaning");
    EXPECT_THAT(printed.out, HasSubstr("\ndevices,16,,"));
    EXPECT_THAT(printed.out, HasSubstr("\nclass_trips,16,,"));
    EXPECT_THAT(printed.out, HasSubstr("\ntrip_time_median,"));
    const std::string devices = contents(place + "/devices.csv");
    EXPECT_THAT(
        header(devices),
        ::testing::StartsWith("wafer,site,x,y,more_bias,more_thickness,more_taper,more_stop_gap,m,f0,zeta,area,d,stop,"
                              "V,class,trip_time,drawn_electrode_length"));
    EXPECT_EQ(std::count(devices.begin(), devices.end(), '\n'), 17);
    EXPECT_TRUE(JsonCheck(contents(place + "/report.json")).valid());
    const Printed again = run_graze(words);
    EXPECT_EQ(again.out, printed.out) << "the same devices";
    EXPECT_EQ(contents(place + "/devices.csv"), devices);
}

TEST(LayoutYield, RefusesDesignsWithoutADevice) {
    const Folder folder;
    const Printed alike = run_graze({"layout", "mems-switch", "--yield", "2", "--folder", folder / "none"});
    EXPECT_EQ(alike.code, 2);
    EXPECT_THAT(alike.err, HasSubstr("no device to be drawn"));
    EXPECT_EQ(run_graze({"layout", "mems-switch-device", "--yield", "0"}).code, 2);
    EXPECT_EQ(run_graze({"layout", "mems-switch-device", "--yield", "-3"}).code, 2);
}

} // namespace
} // namespace graze::testing
