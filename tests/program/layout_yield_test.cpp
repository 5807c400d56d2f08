#include "program/layout_outputs.hpp"

#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

namespace graze::testing::layout_yield_test {

using ::testing::HasSubstr;

TEST(LayoutModel, WritesParametersThatOtherCommandsTake) {
    const Folder folder;
    const std::string file = folder / "etched.toml";
    done({"layout", "mems-switch-device", "--set", "bias=0.31", "--parameters", file});
    EXPECT_THAT(contents(file), HasSubstr("model = \"mems-switch-device\""));
    done({"simulate", "mems-switch-device", "--set", "@" + file, "--set", "f=f0", "--time", "1", "--format", "csv"});
    const std::string again = folder / "again.toml";
    done({"layout", "mems-switch-device", "--set", "bias=310 nm", "--parameters", again});
    EXPECT_EQ(contents(again), contents(file));
}

TEST(LayoutModel, WritesNothingIfARuleIsBrokenUnlessAsked) {
    const Folder folder;
    const std::string file = folder / "device.gds";
    const Printed broken = run_graze({"layout", "mems-switch-device", "--set", "flexure_width=4.5", "--output", file});
    EXPECT_EQ(broken.code, 2);
    EXPECT_THAT(broken.err, HasSubstr("rule smallest_line is 4.5 um for a beam, at ("));
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
    EXPECT_EQ(despite.code, 2);
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
    expect_refusal({"layout", "mems-switch-device", "--output", "x.txt"},
                   "what kind of file to write; let the name end in .gds");
    const Printed unknown = run_graze({"layout", std::string(3000, 'n')});
    EXPECT_EQ(unknown.code, 2);
    EXPECT_LT(unknown.err.size(), 1000U);
}

TEST(LayoutModel, WritesTheRecipe) {
    const Folder folder;
    done({"layout", "mems-switch-device", "--recipe", folder / "recipe.md"});
    EXPECT_THAT(contents(folder / "recipe.md"), HasSubstr("Etch 50 um deep"));
    done({"layout", "mems-switch-device", "--recipe", folder / "recipe.svg"});
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
    const std::string printed = done(words);
    EXPECT_EQ(header(printed), "quantity,value,unit,meaning");
    EXPECT_THAT(printed, HasSubstr("\ndevices,16,,"));
    EXPECT_THAT(printed, HasSubstr("\nclass_trips,16,,"));
    EXPECT_THAT(printed, HasSubstr("\ntrip_time_median,"));
    const std::string devices = contents(place + "/devices.csv");
    EXPECT_THAT(
        header(devices),
        ::testing::StartsWith("wafer,site,x,y,more_bias,more_thickness,more_taper,more_stop_gap,m,f0,zeta,area,d,stop,"
                              "V,class,trip_time,drawn_electrode_length"));
    EXPECT_EQ(std::count(devices.begin(), devices.end(), '\n'), 17);
    EXPECT_TRUE(JsonCheck(contents(place + "/report.json")).valid());
    const Printed again = run_graze(words);
    EXPECT_EQ(again.out, printed) << "the same devices";
    EXPECT_EQ(contents(place + "/devices.csv"), devices);
}

TEST(LayoutYield, RefusesDesignsWithoutADevice) {
    const Folder folder;
    expect_refusal({"layout", "mems-switch", "--yield", "2", "--folder", folder / "none"}, "no device to be drawn");
    EXPECT_EQ(run_graze({"layout", "mems-switch-device", "--yield", "0"}).code, 2);
    EXPECT_EQ(run_graze({"layout", "mems-switch-device", "--yield", "-3"}).code, 2);
}

} // namespace graze::testing::layout_yield_test
