#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace graze::testing::layout_command_test {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class LayoutCommand : public ::testing::Test {
protected:
    std::string design(const std::string& sections) {
        std::ofstream(folder / "mine.toml") << "name = \"mine\"\n" << sections;
        return folder / "mine.toml";
    }

    Folder folder;
};

TEST_F(LayoutCommand, WritesTheSameBytesAndPrintsATable) {
    const std::string first = done({"layout", "mems-switch-device", "--output", folder / "one.gds", "--format", "csv"});
    EXPECT_EQ(header(first), "cell,what,value,unit");
    EXPECT_THAT(first, HasSubstr("\nDEVICE,beams,8,\n"));
    const Printed other =
        run_graze({"layout", "mems-switch-device", "--output", folder / "two.gds", "--format", "csv"});
    EXPECT_EQ(first, other.out);
    EXPECT_EQ(contents(folder / "one.gds"), contents(folder / "two.gds"));
    EXPECT_THAT(contents(folder / "one.gds"), StartsWith(std::string("\0\x06\0\x02\x02\x58", 6)));
    const Printed json = run_graze({"layout", "mems-switch-device", "--wafer", "--format", "json"});
    EXPECT_TRUE(JsonCheck(json.out).valid());
    EXPECT_THAT(json.out, HasSubstr("\"top\":\"WAFER\""));
    EXPECT_EQ(folder.files(), 2U) << "without --output there is only the table";
}

TEST_F(LayoutCommand, SetReplacesDimensions) {
    const std::string file = design("[device]\ngap = 12\nstop_gap = 7\n");
    const std::string printed =
        done({"layout", file, "--set", "stop_gap=8.5", "--set", "folds=2", "--format", "csv", "--digits", "10"});
    EXPECT_THAT(printed, HasSubstr("\nDEVICE,gap,12,um\n"));
    EXPECT_THAT(printed, HasSubstr("\nDEVICE,stop gap,8.5,um\n"));
    EXPECT_THAT(printed, HasSubstr("\nDEVICE,beams,16,\n"));
}

TEST_F(LayoutCommand, WritesOneMaskAlone) {
    for (const std::string mask : {"1", "2"}) {
        const std::string path = folder / ("mask" + mask + ".gds");
        done({"layout", design("[device]\n"), "--mask", mask, "--output", path});
        EXPECT_THAT(contents(path), HasSubstr("MASK_" + mask));
        EXPECT_EQ(contents(path).find("MASK_" + std::string(mask == "1" ? "2" : "1")), std::string::npos);
    }
}

TEST_F(LayoutCommand, WritesParametersOfOneDevice) {
    const std::string file = design("[device]\n[wafer]\nvary = { stop_gap = [8, 9] }\n");
    expect_refusal({"layout", file, "--wafer", "--parameters", folder / "a.toml"},
                   "--parameters: the wafer has 2 devices that differ (wafer.vary)");
    EXPECT_EQ(folder.files(), 1U);
    done({"layout", file, "--set", "stop_gap=8", "--parameters", folder / "a.toml"});
    const std::string alike = design("[device]\n[wafer]\nvary = { stop_gap = [8] }\n");
    done({"layout", alike, "--wafer", "--parameters", folder / "b.toml"});
    EXPECT_EQ(contents(folder / "a.toml"), contents(folder / "b.toml"));
    done({"layout", alike, "--parameters", folder / "c.toml"});
    EXPECT_NE(contents(folder / "a.toml"), contents(folder / "c.toml")) << "which is that of [device]";
}

TEST_F(LayoutCommand, RefusesAMassThatMeetsTheFrameFirst) {
    for (const std::string change : {"flexure_spacing=8", "clearance=13"}) {
        const Printed printed =
            run_graze({"layout", "mems-switch-device", "--set", change, "--output", folder / "a.gds"});
        EXPECT_EQ(printed.code, 2);
        EXPECT_THAT(printed.err, HasSubstr("rule free_way is"));
        EXPECT_EQ(folder.files(), 0U);
    }
    const Printed despite = run_graze(
        {"layout", "mems-switch-device", "--set", "clearance=13", "--output", folder / "a.gds", "--despite-rules"});
    EXPECT_EQ(despite.code, 3);
    EXPECT_THAT(despite.err, HasSubstr("graze: rule free_way is 13.6 um"));
}

TEST_F(LayoutCommand, DrawsPictures) {
    if (std::system("command -v gnuplot > /dev/null") != 0)
        GTEST_SKIP() << "no gnuplot";
    const std::string file = design("[device]\n");
    const Printed device = run_graze({"layout", file, "--picture", folder / "device.svg"});
    ASSERT_EQ(device.code, 0) << device.err;
    const std::string picture = contents(folder / "device.svg");
    for (const char* part :
         {"fixed electrode", "folded flexure", "truss", "stop, gap 9", "channel", "mask 1", "mask 2"})
        EXPECT_THAT(picture, HasSubstr(part));
    done({"layout", file, "--wafer", "--output", folder / "wafer.png"});
    EXPECT_THAT(contents(folder / "wafer.png"), StartsWith("\x89PNG"));
    EXPECT_EQ(folder.files(), 3U) << "and nothing besides";
}

TEST_F(LayoutCommand, WritesTheDeviceAsVerilogA) {
    const std::string path = folder / "device.va";
    done({"layout", "mems-switch-device", "--verilog-a", path});
    EXPECT_THAT(contents(path), HasSubstr("module mems_switch_device_va(fixed, moving);"));
    expect_refusal({"layout", design("[device]\n[wafer]\nvary = { stop_gap = [8, 9] }\n"), "--wafer", "--verilog-a",
                    folder / "wafer.va"},
                   "--verilog-a: the wafer has 2 devices that differ");
    EXPECT_THAT(run_graze({"layout", "mems-switch-device", "--verilog-a", folder / "device.v"}).err,
                HasSubstr("let the name end in .va"));
    expect_refusal({"layout", design("model = \"mems-switch\"\n[device]\n"), "--verilog-a", path},
                   "has no parameter 'm'");
}

/// The shipped design with few points and devices: designs a device, draws it, and computes where the drawn device
/// trips.
class LayoutCommandSlow : public LayoutCommand {};

TEST_F(LayoutCommandSlow, DrawsADesignedDeviceAndComparesIt) {
    std::string text = run_graze("design mems-switch-device --show").out;
    const auto change = [&](const std::string& from, const std::string& to) {
        ASSERT_NE(text.find(from), std::string::npos) << from;
        text.replace(text.find(from), from.size(), to);
    };
    change("curve = 31", "curve = 2");
    change("plane = 15", "plane = 2");
    change("devices = 2000", "devices = 20");
    std::ofstream(folder / "mine.toml") << text;
    const std::string mine = folder / "mine.toml", found = folder / "found";
    EXPECT_THAT(run_graze({"layout", mine, "--from-design", found}).err,
                HasSubstr("has no device.toml; make it by: graze design " + mine + " --output " + found));
    done({"design", mine, "--output", found, "--no-pictures", "--quiet"});
    EXPECT_TRUE(std::filesystem::exists(found + "/device.va"));
    const Printed drawn = run_graze(
        {"layout", mine, "--from-design", found, "--output", folder / "a.gds", "--format", "csv", "--digits", "12"});
    EXPECT_EQ(drawn.code, 0) << drawn.err;
    const auto cell = [&](const std::string& row, int column) {
        std::istringstream lines(drawn.out);
        for (std::string line; std::getline(lines, line);)
            if (line.starts_with(row + ",")) {
                std::istringstream cells(line);
                std::string one;
                for (int i = 0; i <= column; ++i)
                    std::getline(cells, one, ',');
                return std::stod(one);
            }
        ADD_FAILURE() << "no " << row << " in\n" << drawn.out;
        return 0.0;
    };
    EXPECT_NEAR(cell("trip_value", 1), 28, 28e-8); // the wanted value
    // The grid of 1 nm changes gaps by up to 5e-5 of their size, and each of them the voltage by up to twice as much;
    // relative errors of 5e-7 of the frequency count 23 times.
    EXPECT_NEAR(cell("trip_value", 2), 28, 28 * 3e-4);
    for (const char* quantity : {"d", "stop", "f0", "zeta", "m", "area"})
        EXPECT_NEAR(cell(quantity, 2), cell(quantity, 1), 1e-4 * cell(quantity, 1)) << quantity;
    // Further commands find the same device in the folder.
    const Printed again = run_graze({"layout", mine, "--set", "@" + found + "/drawing.toml", "--parameters",
                                     folder / "again.toml", "--output", folder / "b.gds"});
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(contents(folder / "a.gds"), contents(folder / "b.gds"));
    const auto numbers = [](const std::string& parameters) { return parameters.substr(parameters.find("[set]")); };
    EXPECT_EQ(numbers(contents(folder / "again.toml")), numbers(contents(found + "/drawn.toml")));
    // A given number is kept, and the wish that it prevents is reported.
    const Printed given =
        run_graze({"layout", mine, "--from-design", found, "--set", "pressure=4000", "--format", "csv"});
    EXPECT_EQ(given.code, 3);
    EXPECT_THAT(given.out, HasSubstr("not as designed: pressure is given"));
    EXPECT_EQ(run_graze({"layout", mine, "--from-design", found, "--yield", "2"}).code, 2);
    // A device file without a heading does not tell its design: the wish of another design is missed by far.
    const std::string device = contents(found + "/device.toml");
    std::ofstream(found + "/device.toml") << device.substr(device.find('\n') + 1);
    change("value = 28", "value = 26");
    std::ofstream(mine) << text;
    const Printed missed = run_graze({"layout", mine, "--from-design", found, "--format", "csv"});
    EXPECT_EQ(missed.code, 3) << missed.err;
    EXPECT_THAT(missed.out, HasSubstr("not met: 26 is wanted"));
    EXPECT_THAT(
        run_graze({"layout", "mems-switch-device", "--from-design", found, "--output", found + "/device.toml"}).err,
        HasSubstr("let the name end in"));
}

TEST_F(LayoutCommand, WritesNoFilesOfAWrongDesign) {
    const std::vector<std::pair<std::string, std::string>> mistakes{
        {"[device]\ngap = -1\n", "mine.toml:3:7: device.gap is -1 um, not positive; give a positive length"},
        {"[device]\nflexure_length = 6000\n", "mine.toml:3:18: flexures of 6000 um make a mass"},
        {"[device]\nchannel_width = 3000\n", "mine.toml:3:17: channel and stops take"},
        {"[device]\ngap = nan\n", "mine.toml:3:7: device.gap is not a finite number"},
        {"[device]\ngap = 1e300\n", "mine.toml:3:7: device.gap is 1e+300 um, more than a metre"},
        {"[device]\n[wafer]\ndevices = 60\n", "mine.toml:4:11: device 1 and device 2 overlap"},
        {"", "the design has no device to be drawn"},
    };
    for (const auto& [sections, said] : mistakes) {
        const std::string file = design(sections);
        expect_refusal({"layout", file, "--wafer", "--output", folder / "a.gds", "--picture", folder / "a.svg"}, said);
        EXPECT_EQ(folder.files(), 1U);
    }
    const std::string file = design("[device]\n");
    EXPECT_THAT(run_graze({"layout", file, "--output", folder / "a.dxf"}).err, HasSubstr("let the name end in .gds"));
    EXPECT_THAT(run_graze({"layout", file, "--markers", folder / "a.txt"}).err,
                HasSubstr("a.txt' does not say what kind of file to write; let the name end in .lyrdb"));
    EXPECT_THAT(run_graze({"layout", file, "--mask", "1"}).err,
                HasSubstr("--mask has no effect without --picture or --output; add --output or leave it out"));
    for (const std::string option : {"--seed", "--jobs", "--folder"})
        EXPECT_THAT(run_graze({"layout", file, option, "1"}).err, HasSubstr(option + " has no effect without --yield"));
    EXPECT_THAT(run_graze({"layout", file, "--output", folder / "a.gds", "--picture", file + "/a.svg"}).err,
                HasSubstr("cannot be made"));
    EXPECT_THAT(run_graze({"layout", file, "--output", file + "/a.gds"}).err, HasSubstr("cannot be made"));
    EXPECT_THAT(run_graze({"layout", file, "--set", "gab=1"}).err, HasSubstr("did you mean 'gap'?"));
    EXPECT_THAT(run_graze({"layout", file, "--mask", "3"}).err, HasSubstr("--mask"));
    EXPECT_THAT(run_graze("layout mems-swich").err, HasSubstr("did you mean"));
    EXPECT_EQ(run_graze("layout").code, 2);
    EXPECT_EQ(folder.files(), 1U);
}

} // namespace graze::testing::layout_command_test
