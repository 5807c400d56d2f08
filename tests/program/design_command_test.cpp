// Designs from the command line: the files they write, their output and their error messages.

#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace graze::testing::design_command_test {

using ::testing::HasSubstr;

/// A design with few points, which is computed fast. @param further text at the end of the file
std::string small_design(const std::string& further = "") {
    return R"(name = "small"
model = "mems-switch"
control = "V"
adjustable = "delta"
[approach]
from = { q = 0, v = 0, theta = 0 }
range = [0.05, 0.4]
[trip]
overshoots = [1e-4]
[dimensions.delta]
range = [0.5, 0.7]
tolerance = "1%"
[dimensions.zeta]
range = [0.01, 0.03]
[points]
curve = 3
plane = 3
[yield]
devices = 20
within = [0.19, 0.21]
)" + further;
}

struct DesignCommand : public ::testing::Test {
    std::string design(const std::string& text) const { return folder.write("small.toml", text); }
    Folder folder;
};

TEST_F(DesignCommand, WritesTablesAPageAndTheDevice) {
    const std::string results = folder / "results";
    const std::string printed = done({"design", design(small_design()), "--output", results, "--format", "csv"});
    EXPECT_THAT(printed, HasSubstr("trip_value,0.20136621215412"));
    EXPECT_THAT(printed, HasSubstr("class,trips"));
    for (const char* name :
         {"facts.csv", "sensitivities.csv", "earlier.csv", "trip-times.csv", "curve-delta.csv", "plane-delta-zeta.csv",
          "tuning.csv", "devices.csv", "report.json", "page.svg", "page.pdf", "device.toml", "results.sqlite"})
        EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(results) / name)) << name;
    // Other commands read its files.
    done({"check", results + "/device.toml"});
    EXPECT_THAT(run_graze({"grazing", results, "GR1"}).out, HasSubstr("lost"));
    // A second run prints the same.
    EXPECT_EQ(run_graze({"design", folder / "small.toml", "--output", results, "--format", "csv"}).out, printed);
}

TEST_F(DesignCommand, MeetsWishesOrReportsThemUnmet) {
    const std::string results = folder / "results";
    Printed printed = run_graze({"design", design(small_design("[wanted]\nvalue = 0.21\n")), "--output", results,
                                 "--no-pictures", "--format", "csv"});
    ASSERT_EQ(printed.code, 0) << printed.err;
    EXPECT_THAT(printed.out, HasSubstr("wishes,met"));
    EXPECT_TRUE(std::filesystem::exists(results + "/designed.sqlite"));
    printed = run_graze({"design", design(small_design("[wanted]\nclear = 0.001\n")), "--output", results,
                         "--no-pictures", "--format", "csv"});
    EXPECT_EQ(contents(results + "/report.json").find("inf\""), std::string::npos) << "without a bound it is null";
    printed = run_graze({"design", design(small_design("[wanted]\nvalue = 0.9\n")), "--output", results,
                         "--no-pictures", "--format", "csv"});
    EXPECT_EQ(printed.code, 3);
    EXPECT_THAT(printed.out, HasSubstr("wishes,unmet"));
}

TEST_F(DesignCommand, RemovesTablesOfAnEarlierDesign) {
    const std::string results = folder / "results";
    done({"design", design(small_design()), "--output", results, "--quiet"});
    // Files that graze has not written stay, whatever their names.
    const std::string mine = results + "/curve-mine.csv";
    std::ofstream(mine) << "t,q\n0,1\n";
    const std::string page = (folder / "page.svg"); // in a folder that has not been used before
    std::ofstream(page) << "<svg/>";
    ASSERT_EQ(run_graze({"design", design(small_design()), "--output", folder.path(), "--quiet", "--no-pictures"}).code,
              0);
    EXPECT_EQ(contents(page), "<svg/>");
    std::string other = small_design();
    for (const std::string part :
         {"adjustable = \"delta\"\n", "[dimensions.zeta]\nrange = [0.01, 0.03]\n", "tolerance = \"1%\"\n"})
        other.erase(other.find(part), part.size());
    done({"design", design(other), "--output", results, "--quiet", "--no-pictures"});
    for (const char* name :
         {"curve-zeta.csv", "plane-delta-zeta.csv", "tuning.csv", "devices.csv", "page.svg", "page.pdf"})
        EXPECT_FALSE(std::filesystem::exists(std::filesystem::path(results) / name)) << name;
    for (const char* name : {"curve-delta.csv", "facts.csv", "results.sqlite", "curve-mine.csv"})
        EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(results) / name)) << name;
}

/// `graze layout --from-design` draws only the device of the named design in its present version.
TEST_F(DesignCommand, DevicesOfOtherDesignsAndUnfinishedOnesAreNotDrawn) {
    const std::string results = folder / "results", wanted = "[wanted]\nvalue = 0.21\n", drawn = "[device]\n";
    const std::string unfinished = results + "/design-unfinished.txt";
    const auto design_of = [&](const std::string& text) {
        return run_graze({"design", design(text), "--output", results, "--no-pictures", "--quiet"}).code;
    };
    const auto refusal = [&](const std::string& text) {
        return run_graze({"layout", design(text), "--from-design", results}).err;
    };
    ASSERT_EQ(design_of(small_design(wanted + drawn)), 0);
    EXPECT_FALSE(std::filesystem::exists(unfinished));
    EXPECT_THAT(refusal(small_design("[wanted]\nvalue = 0.2\n" + drawn)),
                HasSubstr("the device of " + results + " is of another design, or of this one before it was changed"));
    // Comments, texts and the table [device] do not change the design.
    for (const std::string& same : {"# a remark\n" + small_design(wanted + drawn),
                                    "text = \"a switch\"\n" + small_design(wanted + "[device]\ngap = \"9 um\"\n")})
        EXPECT_THAT(refusal(same), ::testing::Not(HasSubstr("another design")));
    // A run that fails, here since the range has no grazing.
    std::string failing = small_design(wanted + drawn);
    failing.replace(failing.find("[0.05, 0.4]"), 11, "[0.05, 0.06]");
    failing.replace(failing.find("value = 0.21"), 12, "value = 0.06");
    ASSERT_EQ(design_of(failing), 2);
    EXPECT_TRUE(std::filesystem::exists(unfinished));
    for (const std::string& any : {failing, small_design(wanted + drawn)})
        EXPECT_THAT(refusal(any), HasSubstr("the last run of graze design in " + results + " has not come to its end"));
    ASSERT_EQ(design_of(small_design(wanted + drawn)), 0);
    EXPECT_THAT(refusal(small_design(wanted + drawn)), ::testing::Not(HasSubstr("has not come to its end")));
}

TEST_F(DesignCommand, RemovesResultsOfAnEarlierFinishedDevice) {
    const std::string results = folder / "results", designed = results + "/designed.sqlite";
    const std::vector<std::string> options{"--output", results, "--no-pictures", "--quiet"};
    const auto run = [&](const std::string& wanted) {
        std::vector<std::string> arguments{"design", design(small_design(wanted))};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run_graze(arguments).code;
    };
    ASSERT_EQ(run("[wanted]\nvalue = 0.21\n"), 0);
    ASSERT_TRUE(std::filesystem::exists(designed));
    ASSERT_EQ(run(""), 0);
    for (const char* beside : {"", "-wal", "-shm"})
        EXPECT_FALSE(std::filesystem::exists(designed + beside)) << beside;
    EXPECT_TRUE(std::filesystem::exists(results + "/results.sqlite"));
    // Its lock file stays. Results of a second finished device begin with an empty file.
    ASSERT_EQ(run("[wanted]\nvalue = 0.205\n"), 0);
    ASSERT_TRUE(std::filesystem::exists(designed));
    ASSERT_EQ(run(""), 0);
    // A file of that name that is no result file is kept.
    std::ofstream(designed) << "mine\n";
    ASSERT_EQ(run(""), 0);
    std::string kept;
    std::getline(std::ifstream(designed), kept);
    EXPECT_EQ(kept, "mine");
}

TEST_F(DesignCommand, ReportsTooFewCyclesForTheSimulationCheck) {
    std::string text = small_design();
    text.replace(text.find("overshoots"), 0, "cycles = 2\n");
    const Printed printed =
        run_graze({"design", design(text), "--output", folder / "results", "--no-pictures", "--format", "csv"});
    EXPECT_EQ(printed.code, 3);
    EXPECT_THAT(printed.out, HasSubstr("trial,undecided"));
    EXPECT_THAT(printed.err, HasSubstr("not checked by simulation"));
    EXPECT_THAT(printed.err, HasSubstr("give more trip.cycles than 2"));
}

TEST_F(DesignCommand, RefusesARangeThatBeginsBeyondATouch) {
    const auto refusal = [&](const std::string& model, const std::string& control, const std::string& range) {
        const Printed printed =
            run_graze({"design",
                       design("name = \"small\"\nmodel = \"" + model + "\"\ncontrol = \"" + control + "\"\nset = { " +
                              (model == "mems-switch" ? "zeta = 0.02" : "zeta = 0.1, omega = 0.5") +
                              " }\n[approach]\nrange = " + range + "\n[dimensions.zeta]\nrange = [0.01, 0.3]\n"),
                       "--output", folder / "refused", "--no-pictures"});
        EXPECT_EQ(printed.code, 2) << printed.out;
        return printed.err;
    };
    const std::string beyond = refusal("impact-oscillator", "amplitude", "[-1, 1]");
    EXPECT_THAT(beyond,
                HasSubstr("small.toml:6:1: at amplitude = -1, where the range begins, the motion has contacts"));
    const std::string lost = refusal("mems-switch", "V", "[0.6, 0.9]");
    EXPECT_THAT(lost,
                HasSubstr("small.toml:6:1: at V = 0.6, where the range begins, there is no orbit: the motion does"));
}

TEST_F(DesignCommand, ListsAndShowsShippedDesigns) {
    EXPECT_THAT(run_graze("design --list").out, HasSubstr("mems-switch"));
    EXPECT_THAT(run_graze("design mems-switch --show").out, HasSubstr("[dimensions.delta]"));
}

TEST_F(DesignCommand, ReportsThePlacesOfMistakes) {
    EXPECT_EQ(run_graze("design").code, 2);
    EXPECT_THAT(run_graze("design mems-swich").err, HasSubstr("mems-switch"));
    const Printed printed = run_graze(
        {"design", design(small_design("[wanted]\nclass = \"x\"\nvalue = \"y\"\n")), "--output", folder / "none"});
    EXPECT_EQ(printed.code, 2);
    EXPECT_THAT(printed.err, HasSubstr("small.toml:22:9"));
    EXPECT_THAT(printed.err, HasSubstr("small.toml:23:"));
    EXPECT_FALSE(std::filesystem::exists(folder / "none"));
    const auto refusal = [&](const std::string& from, const std::string& to) {
        std::string text = small_design();
        text.replace(text.find(from), from.size(), to);
        const Printed refused = run_graze({"design", design(text), "--output", folder / "none"});
        EXPECT_EQ(refused.code, 2);
        return refused.err;
    };
    // A dimension with a mistake is not also reported as missing.
    const std::string turned = refusal("[0.5, 0.7]", "[0.7, 0.5]");
    EXPECT_THAT(turned, HasSubstr("small.toml:11:9: dimensions.delta.range goes from 0.7 to 0.5"));
    EXPECT_EQ(std::count(turned.begin(), turned.end(), '\n'), 1) << turned;
    EXPECT_THAT(refusal("\"1%\"", "\"1% gaussian\""), HasSubstr("12:13: 'gaussian' is no way in which devices differ"));
    EXPECT_THAT(refusal("[0.5, 0.7]", "[0.5, \"0,7\"]"), HasSubstr("decimals are written with a point"));
    EXPECT_THAT(refusal("control = \"V\"", "control ="), HasSubstr("docs/design.md shows how a design is written"));
    EXPECT_THAT(refusal("adjustable = \"delta\"", "adjustable = \"omega\""), HasSubstr("no dimension 'omega'"));
}

} // namespace graze::testing::design_command_test
