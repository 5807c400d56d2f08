#include "graze/model/check.hpp"

#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

namespace graze::check_test {

const char* const ball = R"toml(
name = "ball \"on\" table"
[parameters]
g = 9.81
e = 0.8
[states]
x = 1.0
v = 0
[definitions]
height = "x"
[modes.flight]
rates = { x = "v", v = "-g" }
watch = ["contact"]
[modes.rest]
rates = { x = 0, v = 0 }
[events]
contact = "height"
[jumps.impact]
v = "-e*v"
[jumps.land]
x = 0
v = 0
[[transitions]]
mode = "flight"
event = "contact"
label = "J1"
jump = "impact"
next = [{ when = "v > 0", mode = "flight" }, { mode = "end" }]
chatter = { jump = "land", mode = "rest" }
[initial]
mode = "flight"
)toml";

/// The warnings for the ball with one piece of its text replaced.
std::vector<std::string> warnings(const std::string& piece = "", const std::string& replacement = "") {
    std::string text = ball;
    const std::size_t at = text.find(piece);
    EXPECT_NE(at, std::string::npos) << piece;
    return model_warnings(parse_model(text.replace(at, piece.size(), replacement), "ball.toml"));
}

void expect_warning(const std::vector<std::string>& found, const std::string& words) {
    const bool there = std::any_of(found.begin(), found.end(), [&](const std::string& warning) {
        return warning.find(words) != std::string::npos;
    });
    std::string all;
    for (const std::string& warning : found)
        all += warning + "\n";
    EXPECT_TRUE(there) << "expected: " << words << "\nfound:\n" << all;
}

TEST(Check, DoesNotWarnOfAGoodModel) {
    const std::vector<std::string> found = warnings();
    EXPECT_TRUE(found.empty()) << found.front();
}

TEST(Check, WarnsOfUnusedItems) {
    expect_warning(warnings("e = 0.8", "e = 0.8\nmass = 1"), "nothing uses the parameter 'mass'");
    expect_warning(warnings("height = \"x\"", "height = \"x\"\ndepth = \"-x\""), "nothing uses the definition 'depth'");
    expect_warning(warnings("contact = \"height\"", "contact = \"height\"\ntop = \"v\""),
                   "no mode watches the event 'top'");
    expect_warning(warnings("[jumps.land]", "[jumps.other]\nx = 1\n[jumps.land]"),
                   "no transition uses the jump 'other'");
    expect_warning(warnings("[events]", "[modes.far]\nrates = { x = 0, v = 0 }\n[events]"),
                   "no transition leads from the initial mode 'flight' to the mode 'far'");
    const std::string second =
        "[[transitions]]\nmode = \"rest\"\nevent = \"contact\"\nlabel = \"J1\"\nnext = \"flight\"\n[initial]";
    expect_warning(warnings("[initial]", second), "mode 'rest' does not watch the event 'contact'");
    expect_warning(warnings("[initial]", second), "two transitions have the label 'J1'");
}

TEST(Check, WarnsOfConditionsThatFailOrAreNeverTested) {
    expect_warning(warnings(", { mode = \"end\" }", ""), "the conditions of the transition 'J1' may all fail");
    expect_warning(warnings("{ mode = \"end\" }", "{ mode = \"end\" }, { when = \"x > 1\", mode = \"rest\" }"),
                   "alternative 3 of the transition 'J1' is never taken");
    expect_warning(warnings("{ mode = \"end\" }", "{ when = \"0 < v\", mode = \"end\" }, { mode = \"end\" }"),
                   "alternative 2 of the transition 'J1' is never taken");
}

TEST(Check, WarnsOfSectionsUsedAsBarriers) {
    const std::string section = "contact = { function = \"height\", kind = \"section\" }";
    expect_warning(warnings("contact = \"height\"", section), "'contact' is not a barrier");
    const std::string top = "watch = [\"contact\", \"top\"]\n[events.top]\nfunction = \"v\"\nkind = \"section\"";
    expect_warning(warnings("watch = [\"contact\"]", top), "watches the section 'top' but has no transition");
}

TEST(Check, WarnsOfABadInitialState) {
    expect_warning(warnings("x = 1.0", "x = -0.5"), "the barrier 'contact' is -0.5");
    expect_warning(warnings("v = \"-g\"", "v = \"-g/v\""), "the rate of 'v' is -inf");
    expect_warning(warnings("v = \"-g\"", "v = \"sqrt(-1 - x^2)\""), "the rate of 'v' is nan");
    EXPECT_TRUE(warnings("x = 1.0", "x = 0.0").empty());
}

TEST(Check, NamesTheDefinitionThatIsNotFinite) {
    std::string text = ball;
    text.replace(text.find("v = \"-g\""), 8, "v = \"-outer\"");
    text.replace(text.find("height = \"x\""), 12,
                 "height = \"x\"\nouter = \"2*inner + height\"\ninner = \"log(v - 1)\"");
    const std::vector<std::string> found = model_warnings(parse_model(text, "ball.toml"));
    expect_warning(found, "the rate of 'v' is");
    expect_warning(found, "because 'inner' is");
}

TEST(Check, WarnsOfASymmetryThatDoesNotHold) {
    const auto oscillator = [](const std::string& map, const std::string& modes) {
        return model_warnings(
            parse_model("[parameters]\nk = 2e6\n[states]\nx = 1e-3\nv = 0\n"
                        "theta = { initial = 0, period = \"2*pi\" }\n"
                        "[modes.a]\nrates = { x = \"v\", v = \"cos(theta) - k*x - x^3\", theta = 1 }\n"
                        "[modes.b]\nrates = { x = \"v\", v = \"cos(theta) - k*x + 1\", theta = 1 }\n"
                        "[initial]\nmode = \"a\"\n[symmetries.half]\nmap = " +
                            map + "\nmodes = " + modes + "\n",
                        "oscillator.toml"));
    };
    const std::string right = "{ x = \"-x\", v = \"-v\", theta = \"theta + pi\" }";
    const std::vector<std::string> found = oscillator(right, "{}");
    expect_warning(found, "the symmetry 'half' does not hold: it does not take the rate of 'v' in mode 'b' to that in "
                          "mode 'b'");
    EXPECT_EQ(found.size(), 2U) << "the second warning says that nothing leads to mode b";
    expect_warning(oscillator("{ x = \"-x\", theta = \"theta + pi\" }", "{}"), "the rate of 'x' in mode 'a'");
    expect_warning(oscillator("{ x = \"-x\", v = \"-v\" }", "{}"), "the rate of 'v' in mode 'a'");
    expect_warning(oscillator(right, "{ a = \"b\", b = \"a\" }"), "in mode 'a' to that in mode 'b'");
}

TEST(Check, DrawsTheConnectivityGraph) {
    const std::string graph = connectivity_graph(parse_model(ball, "ball.toml"));
    const auto expect_line = [&](const std::string& line) {
        EXPECT_NE(graph.find(line), std::string::npos) << line << "\n" << graph;
    };
    expect_line("digraph \"ball \\\"on\\\" table\" {");
    expect_line("mode0 [label = \"flight\"];");
    expect_line("mode1 [label = \"rest\"];");
    expect_line("start -> mode0;");
    expect_line("mode0 -> mode0 [label = \"J1: contact / impact [v > 0]\"];");
    expect_line("mode0 -> end [label = \"J1: contact / impact\"];");
    expect_line("mode0 -> mode1 [label = \"J1: contact / land [chatter]\", style = dashed];");
    expect_line("end [shape = doublecircle");
}

TEST(Check, DrawsOneArrowForAllTransitionsBetweenTwoModes) {
    const std::string graph = connectivity_graph(load_model("impact-microactuator"));
    std::set<std::string> arrows;
    std::istringstream lines(graph);
    for (std::string line; std::getline(lines, line);)
        if (line.find(" -> ") != std::string::npos) {
            const bool dashed = line.find("style = dashed") != std::string::npos;
            EXPECT_TRUE(arrows.insert(line.substr(0, line.find(" [")) + (dashed ? " dashed" : "")).second) << line;
        }
    EXPECT_GT(arrows.size(), 8U);
    for (const char* name : {"J1", "J2", "J3", "J4", "J5", "J6", "J7", "J8", "J9", "J10", "J11", "J12", "J13"})
        EXPECT_NE(graph.find(std::string(name) + ": "), std::string::npos) << name;
    EXPECT_NE(graph.find("J1: front / impact [x2 > 0]\\nJ1: front / impact [F < 0]"), std::string::npos) << graph;
}

} // namespace graze::check_test
