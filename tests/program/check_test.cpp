#include "program/process.hpp"
#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <random>

namespace graze::testing::check_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(Check, SummarisesEveryShippedModel) {
    const Printed list = run_graze("models --format json");
    EXPECT_TRUE(JsonCheck(list.out).valid());
    for (const std::string name :
         {"ball-and-shaker", "belt-oscillator", "bouncing-ball", "cam-follower", "chua-circuit",
          "dry-friction-oscillator", "electromagnetic-testbed", "impact-microactuator", "impact-oscillator",
          "impact-oscillator-two-stops", "mems-switch", "microbeam", "rocking-block", "spring-walker",
          "welander-convection"}) {
        EXPECT_THAT(list.out, HasSubstr('"' + name + '"'));
        const Printed run = run_graze("check " + name);
        EXPECT_EQ(run.code, 0) << run.err;
        EXPECT_EQ(run.err, "") << "a shipped model has warnings";
        for (const std::string part : {"states", "parameters", "modes", "transitions", "sections"})
            EXPECT_THAT(run.out, HasSubstr(part)) << name;
        const Printed json = run_graze("check --format json " + name);
        EXPECT_TRUE(JsonCheck(json.out).valid()) << name;
        const Printed csv = run_graze("check --format csv " + name);
        EXPECT_EQ(header(csv.out), "item,name,value,unit,text");
    }
}

TEST(Check, WarnsAndReportsPlaces) {
    const Folder folder;
    const std::string file = folder.write(
        "model.toml", "name = \"m\"\n[parameters]\nunused = 1\n[states]\nx = 0\n[modes.a]\nrates = { x = 1 }\n");
    const Printed warned = run_graze("check " + file);
    EXPECT_EQ(warned.code, 0);
    EXPECT_THAT(warned.err, HasSubstr("graze: warning: " + file + ": nothing uses the parameter 'unused'"));
    folder.write("model.toml", "name = \"m\"\n[states]\nx = 0\n[modes.a]\nrates = { x = \"y\" }\n");
    expect_refusal("check " + file, "graze: " + file + ":5:");
}

TEST(Check, ReportsEachMistakeOnItsOwnLine) {
    const Folder folder;
    const std::string file = folder / "wrong.toml";
    std::string text = "[states]\nx = 1\n[modes.m]\nrates = { x = \"-k*x\" }\n[definitions]\n";
    std::ofstream(file) << text << "a = \"2*\"\nb = true\n";
    const Printed few = run_graze("check " + file);
    EXPECT_EQ(few.code, exit_bad_input);
    EXPECT_EQ(few.out, "");
    const std::vector<std::string> said = split(few.err, '\n');
    ASSERT_EQ(said.size(), 3U) << few.err;
    EXPECT_THAT(said[0], HasSubstr("graze: " + file + ":4:17: unknown name 'k'"));
    EXPECT_THAT(said[1], HasSubstr("graze: " + file + ":6:"));
    EXPECT_THAT(said[2], HasSubstr("graze: " + file + ":7:5: definitions.b must be"));
    for (int i = 0; i < 50; ++i)
        text += "d" + std::to_string(i) + " = \"2*\"\n";
    std::ofstream(file) << text;
    const std::vector<std::string> many = split(run_graze("check " + file).err, '\n');
    EXPECT_EQ(many.size(), 21U);
    EXPECT_EQ(many.back(), "graze: and 31 more; mend these first");
    // The search ends after a number of mistakes.
    for (int i = 50; i < 30000; ++i)
        text += "d" + std::to_string(i) + " = \"2*x" + std::to_string(i) + "\"\n";
    std::ofstream(file) << text;
    const std::vector<std::string> most = split(run_graze("check " + file).err, '\n');
    EXPECT_EQ(most.size(), 21U);
    EXPECT_EQ(most.back(), "graze: and at least 80 more; mend these first");
}

/// Random walls with the initial state on either side. A wall beyond which the initial state or a jump lies probably
/// has the wrong sign.
TEST(Check, WarnsOfAProbablyWrongSign) {
    const Folder folder;
    const std::string file = folder / "model.toml";
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-1, 1);
    for (int draw = 0; draw < 40; ++draw) {
        const double wall = number(random), start = number(random);
        const bool rising = number(random) > 0; // which side is admissible
        const bool in_table = number(random) > 0;
        const std::string function = rising ? "x - w" : "w - x";
        std::ofstream(file) << "name = \"m\"\n[parameters]\nw = " << wall << "\n[states]\nx = " << start
                            << "\nv = 0\n[modes.a]\nrates = { x = \"v\", v = \"-(x - " << start
                            << ")\" }\nwatch = [\"wall\"]\n"
                            << (in_table ? "[events.wall]\nfunction = \"" : "[events]\nwall = \"") << function
                            << "\"\n[[transitions]]\nmode = \"a\"\nevent = \"wall\"\nnext = \"end\"\n";
        const bool beyond = (rising ? start - wall : wall - start) < 0;
        const Printed run = run_graze("check " + file);
        EXPECT_EQ(run.code, 0);
        if (!beyond)
            EXPECT_EQ(run.err, "");
        else
            EXPECT_THAT(run.err, AllOf(HasSubstr("graze: warning: " + file + (in_table ? ":10:1: " : ":11:1: ")),
                                       HasSubstr("wrong side"), HasSubstr("give the function the other sign")));
    }
    // The initial state is admissible, but the jump leads beyond another wall.
    std::ofstream(file) << "name = \"m\"\n[states]\nx = 0\n[modes.a]\nrates = { x = 1 }\nwatch = [\"one\"]\n[modes.b]\n"
                           "rates = { x = 1 }\nwatch = [\"two\"]\n[events]\none = \"1 - x\"\ntwo = \"x - 2\"\n"
                           "[[transitions]]\nmode = \"a\"\nevent = \"one\"\nnext = \"b\"\n"
                           "[[transitions]]\nmode = \"b\"\nevent = \"two\"\nnext = \"end\"\n[initial]\nmode = \"a\"\n";
    EXPECT_THAT(run_graze("check " + file).err,
                AllOf(HasSubstr(file + ":12:1: the motion from the initial state ends at time 1: "),
                      HasSubstr("barrier 'two'"), HasSubstr("perhaps its function has the wrong sign")));
}

TEST(Check, DrawsTheGraphOfModes) {
    const Folder folder;
    done("check mems-switch --graph " + (folder / "modes.dot"));
    EXPECT_THAT(contents(folder / "modes.dot"), HasSubstr("digraph"));
    if (!find_program("dot"))
        GTEST_SKIP() << "no Graphviz";
    for (const std::string ending : {"svg", "png", "pdf"}) {
        const std::string file = folder / ("modes." + ending);
        done("check mems-switch --graph " + file);
        EXPECT_GT(contents(file).size(), 1000U);
    }
    EXPECT_EQ(folder.files(), 4U);
}

TEST(Check, NamesTheProgramToInstall) {
    const std::string path = std::getenv("PATH");
    setenv("PATH", "/nonexistent", 1);
    const Folder folder;
    const Printed run = run_graze("check mems-switch --graph " + (folder / "modes.svg"));
    const Printed dot = run_graze("check mems-switch --graph " + (folder / "modes.dot"));
    const Printed plot = run_graze("simulate mems-switch --plot " + (folder / "plot.svg"));
    setenv("PATH", path.c_str(), 1);
    EXPECT_EQ(run.code, exit_bad_input);
    EXPECT_THAT(run.err, HasSubstr("install Graphviz"));
    EXPECT_EQ(dot.code, 0);
    EXPECT_EQ(plot.code, exit_bad_input);
    EXPECT_THAT(plot.err, HasSubstr("install gnuplot"));
    EXPECT_EQ(folder.files(), 1U);
}

} // namespace graze::testing::check_test
