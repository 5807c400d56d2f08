#include "run_graze.hpp"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gmock/gmock.h>
#include <tuple>
#include <utility>

namespace graze::testing::fit_command_test {

using ::testing::HasSubstr;

constexpr double decay = 0.3, frequency = 2, displacement = 1.5;

/// Records of x'' = -2 c x' - k x from x(0) = 1.5, v(0) = 0, computed by the closed form to all digits.
class FitCommand : public ::testing::Test {
protected:
    FitCommand() {
        folder.write("swing.toml", R"(
name = "swing"
time_unit = "s"
[parameters]
c = { value = 0.2, unit = "1/s" }
k = { value = 3.5, unit = "1/s^2" }
spare = 1
[states]
x = { initial = 1.2, unit = "m" }
v = { initial = 0, unit = "m/s" }
[modes.swing]
rates = { x = "v", v = "-2*c*v - k*x" }
[quantities]
force = { value = "-k*x", unit = "m/s^2" }
)");
    }
    std::string record(const std::string& name, double factor, const std::string& unit, int rows = 80) const {
        std::string text = fmt::format("t [s], x [{}], other [V]\n", unit);
        for (int i = 0; i < rows; ++i) {
            const double t = 0.1 * i;
            text += fmt::format("{},{},{}\n", t,
                                factor * displacement * std::exp(-decay * t) *
                                    (std::cos(frequency * t) + decay / frequency * std::sin(frequency * t)),
                                i);
        }
        return folder.write(name, text);
    }
    std::string fit(const std::string& options) const {
        return "identify fit " + (folder / "swing.toml") + " " + options;
    }
    const Folder folder;
    const double stiffness = frequency * frequency + decay * decay;
};

TEST_F(FitCommand, FindsParametersThatOtherCommandsTake) {
    const std::string found = folder / "found.toml";
    const Csv table(done(fit(record("a.csv", 1, "m") + " --free c,k=3:1:10 --format csv --save " + found)));
    EXPECT_EQ(table.text(0, "name"), "c");
    EXPECT_EQ(table.text(1, "unit"), "1/s^2");
    EXPECT_NEAR(table.number(0, "value"), decay, 1e-9 * decay);
    EXPECT_NEAR(table.number(1, "value"), stiffness, 1e-9 * stiffness);
    EXPECT_EQ(table.text(2, "name"), "x(0)");
    EXPECT_NEAR(table.number(2, "value"), displacement, 1e-9 * displacement);
    EXPECT_LE(table.number(0, "low"), table.number(0, "value"));
    const Csv states(done(fmt::format("simulate {} --set @{} --from @{} --time 5 --samples 2 --format csv",
                                      folder / "swing.toml", found, found)));
    EXPECT_NEAR(states.number(states.rows.size() - 1, "x"),
                displacement * std::exp(-decay * 5) *
                    (std::cos(frequency * 5) + decay / frequency * std::sin(frequency * 5)),
                1e-8);
}

TEST_F(FitCommand, EqualsTheFitOfAStudyBitForBit) {
    const std::string a = record("a.csv", 1, "m"), b = record("b.csv", 1, "m", 60);
    folder.write("s.toml", R"(name = "s"
model = "./swing.toml"
[runs.swings]
kind = "record"
files = ["a.csv", "b.csv"]
[runs.fit]
kind = "identify"
what = "fit"
records = "swings"
unknowns = { c = 0.25, k = { guess = 3, bounds = [1, 10] } }
readings = { x = { value = "x", offset = true } }
known = ["v"]
)");
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder / ".");
    const Printed printed = run_graze("identify s.toml --format csv");
    std::filesystem::current_path(before);
    ASSERT_EQ(printed.code, 0) << printed.err;
    const Csv study(printed.out);
    const Csv table(run_graze(fit(a + " " + b + " --free c=0.25,k=3:1:10 --offset x --known v --format csv")).out);
    ASSERT_EQ(table.rows.size(), 5U);
    ASSERT_EQ(study.rows.size(), 5U);
    for (std::size_t row = 0; row < 5; ++row)
        for (const char* column : {"name", "unit", "value", "error"})
            EXPECT_EQ(table.text(row, column), study.text(row, column));
}

TEST_F(FitCommand, LaterAssignmentsReplaceThoseOfAFile) {
    const std::string model = folder / "swing.toml", found = folder / "found.toml", more = folder / "more.toml";
    std::ofstream(found) << "model = \"swing\"\n[set]\nc = 0.25\nk = 5\n[from]\nx = 2\n";
    std::ofstream(more) << "[set]\nk = 7\n";
    const auto said = [&](const std::string& options) {
        return run_graze("simulate " + model + " --time 1 --samples 2 --format csv --quantity c k " + options);
    };
    const auto values = [&](const std::string& options) {
        const Csv table(done(said(options)));
        return std::pair(table.number(0, "c"), table.number(0, "k"));
    };
    EXPECT_EQ(values("--set @" + found), std::pair(0.25, 5.0));
    EXPECT_EQ(values("--set @" + found + ",k=6"), std::pair(0.25, 6.0));
    EXPECT_EQ(values("--set @" + found + " --set c=2*k"), std::pair(10.0, 5.0));
    EXPECT_EQ(values("--set @" + found + ",@" + more), std::pair(0.25, 7.0));
    for (const auto& [options, message] :
         {std::pair("--set k=6,@" + found, std::string("--set: 'k' is given twice; name the file first")),
          std::pair("--set @" + found + ",k=6,k=7", std::string("--set: 'k' is given twice; leave one"))}) {
        expect_refusal(said(options), message);
    }
}

TEST_F(FitCommand, MistakesInFilesOfParametersHaveAPlace) {
    const std::string model = folder / "swing.toml", found = folder / "found.toml";
    for (const auto& [text, option, message] :
         {std::tuple("[set]\nc = 0.25\nkk = 5\n", "--set", ":3:1: "),
          std::tuple("[from]\n\nx = 0.25\nq = 5\n", "--from", ":4:1: "),
          std::tuple("[set]\nx = 1\n", "--set", ":2:1: 'x' is a state, not a parameter; write it under [from]"),
          std::tuple("[from]\nk = 1\n", "--from", ":2:1: 'k' is a parameter, not a state; write it under [set]"),
          std::tuple("model = \"sling\"\n[set]\nk = 1\n", "--set",
                     ":1:1: these values were found for the model 'sling', not for 'swing'; "),
          std::tuple("[set\nk = 1\n", "--set", "docs/measure-identify-predict.md"),
          std::tuple("[set]\nk = 1\n", "--from", ": it has nothing for --from")}) {
        std::ofstream(found) << text;
        const Printed printed = run_graze("simulate " + model + " --time 1 " + option + " @" + found);
        EXPECT_EQ(printed.code, 2) << text;
        EXPECT_THAT(printed.err, HasSubstr(message)) << text;
        EXPECT_THAT(printed.err, HasSubstr(found)) << text;
    }
}

TEST_F(FitCommand, ConvertsReadingsAndFindsGains) {
    const std::string a = record("a.csv", 1000, "mm");
    for (const char* options :
         {"--scale x=0.001:m", "--reading x=1000*x", "--reading x=1000*x --gain x=1.2 --known x --start x=1.5"}) {
        const std::string printed = done(fit(a + " --free c,k --format csv " + options));
        EXPECT_NEAR(Csv(printed).number(1, "value"), stiffness, 1e-8 * stiffness) << options;
    }
    for (const char* shown : {"outputs", "correlations", "readings"})
        done(fit(record("b.csv", 1, "m") + " --free c,k --format json --table " + shown));
}

TEST_F(FitCommand, NeverWritesOverItsModel) {
    const std::string model = folder / "swing.toml", before = contents(model), a = record("a.csv", 1, "m");
    std::filesystem::create_symlink(model, folder / "link.toml");
    for (const std::string& name : {model, folder / "link.toml"})
        for (const char* option : {" --save ", " --output "})
            expect_refusal(fit(a + " --free c,k" + option + name), "is the file of an input too");
    EXPECT_EQ(contents(model), before);
}

TEST_F(FitCommand, ReportsReadingsThatAreNotFinite) {
    for (const char* reading : {"x=1/0", "x=log(-1-x^2)"}) {
        const Printed printed = run_graze(fit(record("a.csv", 1, "m") + " --free c,k --reading " + reading));
        EXPECT_EQ(printed.code, 3) << reading;
        EXPECT_THAT(printed.err, HasSubstr("are not finite: check the outputs")) << reading;
        EXPECT_EQ(std::count(printed.err.begin(), printed.err.end(), '\n'), 1) << printed.err;
    }
}

TEST_F(FitCommand, DoesNotSaveUndeterminedParameters) {
    const std::string found = folder / "found.toml";
    const Printed printed = run_graze(fit(record("a.csv", 1, "m") + " --free c,k,spare --save " + found));
    EXPECT_EQ(printed.code, 3);
    EXPECT_THAT(printed.err, HasSubstr("spare (+1 %)"));
    EXPECT_THAT(printed.out, HasSubstr("not determined"));
    EXPECT_FALSE(std::ifstream(found).good());
}

TEST_F(FitCommand, MistakesAreOneLineWithARemedy) {
    const std::string a = record("a.csv", 1, "m"), millimetres = record("mm.csv", 1000, "mm"),
                      brief = record("brief.csv", 1, "m", 3), one = record("one.csv", 1, "m", 1);
    const std::vector<std::pair<std::string, std::string>> mistakes{
        {"--free c", "write graze identify fit MODEL RECORD"},
        {a + " --free cc", "--free: "},
        {a + " --free x", "--free: "},
        {a + " --free k=20:1:10", "not within its bounds"},
        {a + " --free k:1", "write NAME=GUESS:LEAST:GREATEST"},
        {a + " --free c,c", "found twice"},
        {a + " --free c --reading y=x", "--reading: the record has no channel 'y'"},
        {a + " --free c --reading other=y", "--reading other"},
        {a + " --free c --gain v", "--gain: 'v' is no channel that is used"},
        {a + " --free c --known y", "--known: 'y' is not a state"},
        {a + " --free c --deviation x=0", "write CHANNEL=VALUE"},
        {a + " --free c --deviation x=1e300", "is out of proportion"},
        {a + " --free c --deviation x=1e-300", "is out of proportion"},
        {a + " --free c --with b.csv:k=1", "is none of the records"},
        {a + " --free c --channel x", "--channel has no effect beside WHAT fit"},
        {millimetres + " --free c", "--scale x=0.001:m"},
        {brief + " --free c,k", "3 readings cannot determine 4 numbers"},
        {one + " --free c", "fewer than two rows"},
        {(folder / "none.csv") + " --free c", "none.csv: the record cannot be read"},
        {a + " --free c --save " + a, "is the file of an input too"},
    };
    for (const auto& [options, message] : mistakes)
        expect_refusal(fit(options), message);
    EXPECT_EQ(run_graze("identify decrement " + a + " --free c").code, 2);
}

} // namespace graze::testing::fit_command_test
