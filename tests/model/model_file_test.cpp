#include "graze/model/model_file.hpp"

#include "base/message_of.hpp"
#include "base/temporary_folder.hpp"
#include "graze/base/input_error.hpp"
#include "graze/model/check.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/model_file_toml.hpp"
#include "places.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace graze::model_file_test {

/// Uses every feature of the format; states and events are deliberately not in alphabetical order.
const char* const everything = R"toml(name = "everything"
text = """
Two lines, a "quoted" word
and a \\ backslash."""
source = "nowhere"
time_unit = "s"

[parameters]
omega = { value = 5, unit = "rad/s", text = "frequency" }
e = 0.8
a = -0.01
period = { value = "2*pi/omega", text = "dependent" }
half = "period/2"
two = "2"
zero = -0.0

[states]
z = { initial = "a*half", unit = "m", text = "height" }
v = 0.0
theta = { initial = 7, period = "2*pi" }
b = { initial = 1e-300, drifting = true }
phase = { initial = 0, period = 2, unit = "turns" }

[definitions]
gap = "z - table"
table = { value = "a*sin(theta)", text = "of the table" }
seven = 7

[modes.on]
text = "flying"
rates = { v = "-9.81", z = "v", theta = "omega", b = 0, phase = 1 }
watch = ["top", "contact"]

[modes.off]
watch = ["release"]
[modes.off.rates]
z = "v"
v = "-gap"
theta = "omega"
b = "z^2"
phase = 1

[events]
release = "sin(theta)"
[events.contact]
text = "the ball meets the table"
function = "gap"
kind = "barrier"
[events.top]
function = "v"
kind = "section"

[jumps.impact]
text = "reversed"
v = "-e*v + (1 + e)*a*omega*cos(theta)"
[jumps.land]
z = "table"
v = 0

[[transitions]]
mode = "on"
event = "contact"
label = "J1"
jump = "impact"
next = [
    { when = "v > 0 and z >= 0", mode = "on" },
    { when = "v <= 0", mode = "off" },
    { mode = "end" },
]
chatter = { jump = "land", mode = "off" }

[[transitions]]
mode = "off"
event = "release"
next = "on"

[sections.phase0]
text = "start of the period"
state = "theta"
value = "pi/2"
[sections.top]
function = "v"
direction = "falling"
[sections.bottom]
function = "v"
direction = "rising"
[sections.middle]
function = "z"

[symmetries.half]
text = "turn by half"
map = { z = "-z", theta = "theta + pi" }
modes = { on = "off", off = "on" }

[quantities]
energy = { value = "v^2/2", unit = "J/kg", text = "kinetic" }
gap = "gap"

[initial]
mode = "on"
)toml";

/// Returns a valid text of a smooth oscillator with one piece replaced.
std::string smooth_with(const std::string& piece, const std::string& replacement) {
    std::string text = "[parameters]\n"
                       "k = 4.0\n"
                       "[states]\n"
                       "x = 1\n"
                       "v = { initial = 0 }\n"
                       "[modes.free]\n"
                       "rates = { x = \"v\", v = \"-k*x\" }\n";
    const std::size_t at = text.find(piece);
    EXPECT_NE(at, std::string::npos) << piece;
    return text.replace(at, piece.size(), replacement);
}

/// Checks that a text is refused at a place, with a message that contains some words.
void expect_refused(const std::string& text, int line, int column, const std::string& words,
                    const std::string& remedy = "") {
    try {
        parse_model(text, "some.toml");
        FAIL() << "accepted: " << text;
    } catch (const InputError& error) {
        EXPECT_EQ(error.place().file, "some.toml") << error.what();
        EXPECT_EQ(error.place().line, line) << error.what();
        EXPECT_EQ(error.place().column, column) << error.what();
        EXPECT_NE(error.problem().find(words), std::string::npos) << error.what();
        EXPECT_NE(error.remedy().find(remedy), std::string::npos) << error.what();
        EXPECT_FALSE(error.remedy().empty()) << error.what();
    }
}

/// The same for a piece added to the smooth oscillator from line 8 on.
void expect_addition_refused(const std::string& addition, int line, int column, const std::string& words,
                             const std::string& remedy = "") {
    expect_refused(smooth_with("", "") + addition, line, column, words, remedy);
}

std::string bouncing(const std::string& transitions, const std::string& more = "") {
    return "[states]\nx = 1\nv = 0\n"
           "[modes.flight]\nrates = { x = \"v\", v = -9.81 }\nwatch = [\"contact\"]\n"
           "[events]\ncontact = \"x\"\n" +
           more + transitions;
}

TEST(ModelFile, ReadsEverythingInTheOrderOfTheFile) {
    const Model model = parse_model(everything, "everything.toml");
    EXPECT_EQ(model.name, "everything");
    EXPECT_EQ(model.text, "Two lines, a \"quoted\" word\nand a \\ backslash.");
    EXPECT_EQ(model.source, "nowhere");
    EXPECT_EQ(model.time_unit, "s");

    ASSERT_EQ(model.parameters.size(), 7U);
    EXPECT_EQ(model.parameters[0].name, "omega");
    EXPECT_EQ(model.parameters[0].unit, "rad/s");
    EXPECT_EQ(model.parameters[0].text, "frequency");
    EXPECT_EQ(model.parameters[0].value, 5.0);
    EXPECT_EQ(model.parameters[2].name, "a");
    ASSERT_TRUE(model.parameters[3].expression);
    EXPECT_FALSE(model.parameters[3].value);
    EXPECT_EQ(to_string(*model.parameters[4].expression), "period/2");
    EXPECT_EQ(model.parameters[5].value, 2.0); // an expression without parameters

    ASSERT_EQ(model.states.size(), 5U);
    EXPECT_EQ(model.states[0].name, "z");
    EXPECT_EQ(model.states[1].name, "v");
    EXPECT_EQ(model.states[2].name, "theta");
    EXPECT_TRUE(model.states[2].period);
    EXPECT_EQ(model.states[3].name, "b");
    EXPECT_TRUE(model.states[3].drifting);
    EXPECT_EQ(model.states[4].unit, "turns");

    ASSERT_EQ(model.modes.size(), 2U);
    EXPECT_EQ(model.modes[0].name, "on");
    EXPECT_EQ(model.modes[0].text, "flying");
    EXPECT_EQ(model.modes[0].rates[0], model.symbol("v"));
    EXPECT_TRUE(model.modes[0].rates[1].is_number(-9.81));
    EXPECT_TRUE(model.modes[0].rates[3].is_number(0));
    ASSERT_EQ(model.modes[0].watched.size(), 2U);
    EXPECT_EQ(model.events[model.modes[0].watched[0]].name, "top");
    EXPECT_EQ(model.events[model.modes[0].watched[1]].name, "contact");

    ASSERT_EQ(model.events.size(), 3U);
    EXPECT_EQ(model.events[0].name, "release");
    EXPECT_EQ(model.events[0].kind, EventKind::barrier);
    EXPECT_EQ(model.events[1].kind, EventKind::barrier);
    EXPECT_EQ(model.events[2].kind, EventKind::section);

    ASSERT_EQ(model.jumps.size(), 3U);
    EXPECT_EQ(model.jumps[0].name, "identity");
    EXPECT_EQ(model.jumps[0].map, model.state_symbols());
    EXPECT_EQ(model.jumps[1].text, "reversed");
    EXPECT_EQ(model.jumps[1].map[0], model.symbol("z"));
    EXPECT_TRUE(model.jumps[2].map[1].is_number(0));

    ASSERT_EQ(model.transitions.size(), 2U);
    const Transition& impact = model.transitions[0];
    EXPECT_EQ(impact.label, "J1");
    EXPECT_EQ(impact.jump, 1U);
    ASSERT_EQ(impact.next.size(), 3U);
    EXPECT_EQ(impact.next[0].when_text, "v > 0 and z >= 0");
    ASSERT_EQ(impact.next[0].when.size(), 2U);
    EXPECT_TRUE(impact.next[0].when[0].strict);
    EXPECT_FALSE(impact.next[0].when[1].strict);
    EXPECT_EQ(impact.next[1].mode, 1U);
    EXPECT_TRUE(impact.next[2].when.empty());
    EXPECT_FALSE(impact.next[2].mode);
    ASSERT_TRUE(impact.chatter);
    EXPECT_EQ(impact.chatter->jump, 2U);
    EXPECT_EQ(impact.chatter->mode, 1U);
    EXPECT_EQ(model.transitions[1].label, "off:release");
    EXPECT_EQ(model.transitions[1].jump, 0U);
    EXPECT_FALSE(model.transitions[1].chatter);

    ASSERT_EQ(model.sections.size(), 4U);
    EXPECT_EQ(model.sections[0].state, 2U);
    EXPECT_EQ(model.sections[0].text, "start of the period");
    EXPECT_EQ(model.sections[1].direction, Direction::falling);
    EXPECT_EQ(model.sections[2].direction, Direction::rising);
    EXPECT_EQ(model.sections[3].direction, Direction::both);

    ASSERT_EQ(model.symmetries.size(), 1U);
    EXPECT_EQ(to_string(model.symmetries[0].map[0]), "-z");
    EXPECT_EQ(model.symmetries[0].map[1], model.symbol("v"));
    EXPECT_EQ(model.symmetries[0].modes, (std::vector<std::size_t>{1, 0}));

    ASSERT_EQ(model.quantities.size(), 2U);
    EXPECT_EQ(model.quantities[0].unit, "J/kg");
    EXPECT_EQ(model.quantities[1].value, model.symbol("gap"));
    EXPECT_EQ(model.initial_mode, 0U);
}

/// Returns, as text, everything in a model that can be compared between graphs.
std::string contents(const Model& model) {
    std::string result = model.name + '\n' + model.text + '\n' + model.source + '\n' + model.time_unit + '\n';
    const auto add = [&](const auto&... parts) {
        const auto one = [&](const auto& part) {
            using Part = std::decay_t<decltype(part)>;
            if constexpr (std::is_same_v<Part, Expression>)
                result += part.empty() ? "none" : to_string(part);
            else if constexpr (std::is_same_v<Part, std::optional<Expression>>)
                result += part ? to_string(*part) : "none";
            else if constexpr (std::is_same_v<Part, std::vector<Expression>>)
                for (const Expression& expression : part)
                    result += to_string(expression) + ", ";
            else if constexpr (std::is_same_v<Part, std::vector<std::size_t>>)
                for (const std::size_t index : part)
                    result += std::to_string(index) + ", ";
            else if constexpr (std::is_same_v<Part, std::string>)
                result += part;
            else if constexpr (std::is_same_v<Part, std::optional<std::size_t>>)
                result += part ? std::to_string(*part) : "none";
            else
                result += std::to_string(static_cast<int>(part));
            result += " | ";
        };
        (one(parts), ...);
        result += '\n';
    };
    for (const Parameter& p : model.parameters)
        add(p.name, p.unit, p.text, p.expression, p.value ? to_string(model.graph->number(*p.value)) : "none");
    for (const State& s : model.states)
        add(s.name, s.unit, s.text, s.initial, s.period, s.drifting);
    for (const Definition& d : model.definitions)
        add(d.name, d.text, d.value);
    for (const Mode& m : model.modes)
        add(m.name, m.text, m.rates, m.watched);
    for (const Event& e : model.events)
        add(e.name, e.text, e.function, e.kind);
    for (const Jump& j : model.jumps)
        add(j.name, j.text, std::vector<Expression>(j.map));
    for (const Transition& t : model.transitions) {
        add(t.label, t.mode, t.event, t.jump);
        for (const Alternative& a : t.next) {
            add(a.when_text, a.mode);
            for (const Condition& c : a.when)
                add(c.function, c.strict);
        }
        if (t.chatter)
            add(t.chatter->jump, t.chatter->mode);
    }
    for (const Section& s : model.sections)
        add(s.name, s.text, s.function, s.state, s.value, s.direction);
    for (const Symmetry& s : model.symmetries)
        add(s.name, s.text, s.map, s.modes);
    for (const Quantity& q : model.quantities)
        add(q.name, q.unit, q.text, q.value);
    add(model.initial_mode);
    return result;
}

TEST(ModelFile, WrittenModelReadsBackTheSame) {
    const Model model = parse_model(everything, "everything.toml");
    const std::string written = write_model(model);
    const Model again = parse_model(written, "written.toml");
    EXPECT_EQ(contents(again), contents(model)) << written;
    EXPECT_EQ(write_model(again), written);
    EXPECT_TRUE(std::signbit(*again.parameters[6].value));
}

TEST(ModelFile, WritesAllFunctions) {
    const std::string quantities = "[quantities]\n"
                                   "roots = \"sqrt(x + 2)*exp(x)*log(x + 2)\"\n"
                                   "circular = \"sin(x) + cos(x) - tan(x)/(asin(x) - acos(x) + atan(x))\"\n"
                                   "others = \"sinh(x) + cosh(x)*tanh(x) - 3*erf(-x/2)\"\n";
    const Model model = parse_model(smooth_with("", quantities), "functions.toml");
    ASSERT_EQ(model.quantities.size(), 3U);
    const Model again = parse_model(write_model(model), "written.toml");
    EXPECT_EQ(contents(again), contents(model)) << write_model(model);
}

TEST(ModelFile, WritesConditionsOfModelsBuiltFromCpp) {
    Model model = parse_model(everything, "everything.toml");
    model.transitions[0].next[0].when_text = "when the ball rises";
    const Model again = parse_model(write_model(model), "written.toml");
    const Alternative& alternative = again.transitions[0].next[0];
    ASSERT_EQ(alternative.when.size(), 2U);
    EXPECT_EQ(to_string(alternative.when[0].function), "v");
    EXPECT_TRUE(alternative.when[0].strict);
    EXPECT_FALSE(alternative.when[1].strict);
}

TEST(ModelFile, SmoothModelNeedsOnlyStatesAndAMode) {
    const Model model = parse_model(smooth_with("", ""), "folder/oscillator.toml");
    EXPECT_EQ(model.name, "oscillator");
    EXPECT_TRUE(model.events.empty());
    EXPECT_EQ(model.jumps.size(), 1U);
    EXPECT_EQ(contents(parse_model(write_model(model), "again.toml")), contents(model));
}

TEST(ModelFile, NumbersWrittenAsExpressionsCanBeSet) {
    Model model = parse_model(R"(parameters.angle = "30*pi/180"
parameters.twice = "2*angle"
states.x = "twice"
modes.m.rates.x = 0)",
                              "test.toml");
    EXPECT_NEAR(model.initial_state()[0], 3.141592653589793 / 3, 1e-15);
    model.set_parameter("angle", 0.25);
    EXPECT_EQ(model.initial_state()[0], 0.5);
    EXPECT_THROW(model.set_parameter("twice", 1), InputError);
}

TEST(ModelFile, ReadsManyStatesInOrder) {
    std::string states = "[states]\n";
    std::string rates = "[modes.all.rates]\n";
    for (int i = 2000; i > 0; --i) {
        states += "x" + std::to_string(i) + " = 0\n";
        rates += "x" + std::to_string(i) + " = \"sin(x" + std::to_string(2001 - i) + ")\"\n";
    }
    const Model model = parse_model(states + rates, "many.toml");
    ASSERT_EQ(model.states.size(), 2000U);
    EXPECT_EQ(model.states.front().name, "x2000");
    EXPECT_EQ(model.states.back().name, "x1");
    EXPECT_EQ(to_string(model.modes[0].rates.back()), "sin(x2000)");
}

TEST(ModelFile, RefusesFilesThatCannotBeRead) {
    const auto message = [](const std::string& path) { return testing::message_of([&] { read_model(path); }); };
    EXPECT_NE(message("/nowhere/at/all.toml").find("/nowhere/at/all.toml: "), std::string::npos);
    EXPECT_NE(message("/nowhere/at/all.toml").find("the model file cannot be read (No such file"), std::string::npos);
    EXPECT_NE(message("/").find("directory"), std::string::npos);
    EXPECT_NE(message("/dev/zero").find("this is a device, not a model file"), std::string::npos);
    const testing::TemporaryFolder folder;
    EXPECT_EQ(read_model(folder.write("m.toml", everything)).states.size(), 5U);
    EXPECT_NE(message(folder.write("m.toml", "")).find("the model is empty"), std::string::npos);
}

TEST(ModelFile, RefusesTextsThatAreNotToml) {
    expect_refused("", 0, 0, "the model is empty");
    expect_refused("# nothing\n", 0, 0, "the model is empty");
    expect_refused("name = \"x\nstates", 1, 10, "not TOML");
    expect_refused("[states]\nx = 1\nx = 2\n", 3, 5, "not TOML");
    expect_refused("name = \"\xff\"\n", 1, 8, "not TOML");
}

TEST(ModelFile, RefusesNestingThatWouldExhaustTheStack) {
    std::string dots = "a";
    for (int i = 0; i < 100000; ++i)
        dots += ".a";
    expect_refused("\n" + dots + " = 1", 2, 32, "a key of more than");
    expect_refused("[" + dots + "]", 1, 33, "a key of more than");
    expect_refused("x = ''' ]\n\n\"'''\n y = \"''\" # '\nz = { " + dots + " = 1}", 5, 38, "a key of more than");
    EXPECT_THROW(parse_model("a = " + std::string(100000, '['), "deep.toml"), InputError);
    // Dots in values, comments and strings do not separate keys.
    EXPECT_NO_THROW(parse_model(smooth_with("k = 4.0", "# " + std::string(99, '.') + "\nk = 4.0"), "dots.toml"));
}

TEST(ModelFile, RefusesCharactersThatTheParserCannotTake) {
    const auto text = [](const std::string& head) { return head + smooth_with("", ""); };
    expect_refused(text("n\u00e9 = 1\n"), 1, 2, "a character outside ASCII");
    expect_refused(text("name = +\"\u00e9\"\n"), 1, 9, "a quote in the middle of a word");
    expect_refused(text("name = \"x\" \u00e9\n"), 1, 12, "a character outside ASCII");
    expect_refused(text("text = \"\"\"x \\\n  \u03b8\"\"\"\n"), 2, 3, "begins with a character outside ASCII");
    expect_refused(text("text = \"\"\"x \\\u00e9\"\"\"\n"), 1, 14, "begins with a character outside ASCII");
    const Model model = parse_model(
        "\xef\xbb\xbf" + text("text = \"\"\"\u03b8 \\\n  x\u03b8\"\"\" # \u03b8\nsource = '\u00e9'\n"), "fine.toml");
    EXPECT_EQ(model.text, "\u03b8 x\u03b8");
    EXPECT_EQ(model.source, "\u00e9");
}

TEST(ModelFile, RefusesHeadersAndBracketsThatTheParserCannotTake) {
    expect_refused("[=", 1, 2, "a table without a name");
    expect_refused("\xef\xbb\xbf[.]", 1, 2, "a table without a name");
    expect_refused("name = \"x\"\r\n [ \x01]\n", 2, 4, "a table without a name");
    expect_refused("[[ \t+a]]\n", 1, 5, "a table without a name");
    expect_refused("[\n]", 1, 2, "a table without a name");
    expect_refused("a = [}", 1, 6, "a '}' that closes nothing");
    expect_refused("a = [[1, 2], }]", 1, 14, "a '}' that closes nothing");
    expect_refused("a = { b = 1 ]", 1, 13, "a ']' that closes nothing");
    expect_refused("a = 1 ]", 1, 7, "a ']' that closes nothing");
    for (const std::string unfinished : {"[", "[[", "[ ", "[[ ", "[]", "[[]]", "[ [a]]", "[a", "a = [", "a = [{"})
        EXPECT_THROW(parse_model(unfinished, "unfinished.toml"), InputError) << unfinished;
    // Lists may continue on another line with a value; brackets in strings and comments are text.
    EXPECT_NO_THROW(parse_toml("[ 'a' ] # [.\nb = [\n[+1,\n-2], # }\n[ 5 ]]\n[[ \"c\" ]]\nd = '}]'\n", "fine.toml"));
}

TEST(ModelFile, RefusesUnknownKeys) {
    expect_refused(smooth_with("[parameters]", "[paramters]"), 1, 2, "unknown key 'paramters'", "'parameters'");
    expect_refused(smooth_with("{ initial = 0 }", "{ inital = 0 }"), 5, 7, "unknown key 'inital' in states.v",
                   "'initial'");
    expect_refused(smooth_with("rates = {", "rate = {"), 7, 1, "unknown key 'rate' in modes.free", "'rates'");
    expect_refused(smooth_with("k = 4.0", "k = { value = 4, units = \"N\" }"), 2, 18, "unknown key 'units'", "'unit'");
    expect_addition_refused("[initial]\nmod = \"free\"\n", 9, 1, "unknown key 'mod'", "'mode'");
    expect_addition_refused("[sections.s]\nfunction = \"x\"\ndirectoin = \"both\"\n", 10, 1, "unknown key 'directoin'");
    expect_addition_refused("[quantities]\nq = { value = \"x\", txt = \"\" }\n", 9, 20, "unknown key 'txt'");
    expect_addition_refused("[events]\ne = { function = \"x\", sort = \"\" }\n", 9, 23, "unknown key 'sort'", "kind");
    expect_addition_refused("[symmetries.s]\nmaps = {}\n", 9, 1, "unknown key 'maps'", "'map'");
    expect_addition_refused("[definitions]\nd = { value = 1, unit = \"m\" }\n", 9, 18, "unknown key 'unit'");
    expect_refused(bouncing("[[transitions]]\nmode = \"flight\"\nevent = \"contact\"\nnxt = \"flight\"\n"), 12, 1,
                   "unknown key 'nxt'", "'next'");
    expect_refused(bouncing("[[transitions]]\nmode = \"flight\"\nevent = \"contact\"\nnext = [{ wen = \"x > 0\" }]\n"),
                   12, 11, "unknown key 'wen'", "'when'");
}

TEST(ModelFile, RefusesUnknownNames) {
    expect_refused(smooth_with("\"-k*x\"", "\"-k*X1\""), 7, 28, "X1");
    expect_refused(smooth_with("v = \"-k*x\"", "w = \"-k*x\""), 7, 20, "there is no state 'w'");
    expect_addition_refused("[jumps.j]\nxx = 1\n", 9, 1, "there is no state 'xx'", "'x'");
    expect_addition_refused("[sections.s]\nstate = \"y\"\nvalue = 0\n", 9, 9, "there is no state 'y'");
    expect_addition_refused("[symmetries.s]\nmap = { y = \"x\" }\n", 9, 9, "there is no state 'y'");
    expect_addition_refused("[symmetries.s]\nmodes = { fre = \"free\" }\n", 9, 11, "there is no mode 'fre'", "'free'");
    expect_addition_refused("[symmetries.s]\nmodes = { free = \"fre\" }\n", 9, 18, "there is no mode 'fre'", "'free'");
    expect_addition_refused("[initial]\nmode = \"fee\"\n", 9, 8, "there is no mode 'fee'", "'free'");
    expect_refused(smooth_with("rates =", "watch = [\"contact\"]\nrates ="), 7, 10, "there is no event 'contact'");
    const std::string start = "[[transitions]]\nmode = \"flight\"\nevent = \"contact\"\n";
    expect_refused(bouncing("[[transitions]]\nmode = \"fligt\"\n"), 10, 8, "there is no mode 'fligt'", "'flight'");
    expect_refused(bouncing("[[transitions]]\nevent = \"contct\"\n"), 10, 9, "there is no event 'contct'", "'contact'");
    expect_refused(bouncing(start + "jump = \"impact\"\n"), 12, 8, "there is no jump 'impact'");
    expect_refused(bouncing(start + "next = \"fight\"\n"), 12, 8, "there is no mode 'fight'", "'flight'");
    expect_refused(bouncing(start + "next = [{ mode = \"fight\" }]\n"), 12, 18, "there is no mode 'fight'");
    expect_refused(bouncing(start + "next = [{ when = \"v > w\", mode = \"flight\" }]\n"), 12, 23, "w");
    expect_refused(bouncing(start + "next = \"flight\"\nchatter = { mode = \"rest\" }\n"), 13, 20,
                   "there is no mode 'rest'");
}

TEST(ModelFile, RefusesMissingParts) {
    expect_refused("[modes.m]\nrates = {}\n", 0, 0, "the model has no states");
    expect_refused("[states]\nx = 1\n", 0, 0, "the model has no modes");
    expect_refused("[states]\n[modes.m]\nrates = {}\n", 1, 2, "the model has no states");
    expect_refused(smooth_with(", v = \"-k*x\"", ""), 7, 1, "mode 'free' has no rate for the state 'v'", "add v = ");
    expect_refused(smooth_with("rates = { x = \"v\", v = \"-k*x\" }", ""), 6, 8,
                   "mode 'free' has no rate for the state 'x'");
    expect_refused(smooth_with("{ initial = 0 }", "{}"), 5, 1, "states.v has no initial value");
    expect_refused(smooth_with("k = 4.0", "k = { unit = \"N/m\" }"), 2, 1, "parameters.k has no value");
    expect_addition_refused("[definitions]\nd = { text = \"\" }\n", 9, 1, "definitions.d has no value");
    expect_addition_refused("[events.e]\nkind = \"section\"\n", 8, 9, "events.e has no function");
    expect_addition_refused("[quantities]\nq = { unit = \"m\" }\n", 9, 1, "quantities.q has no value");
    expect_addition_refused("[modes.other]\nrates = { x = 0, v = 0 }\n", 0, 0, "does not say which one is first");
    expect_addition_refused("[modes.other]\nrates = { x = 0, v = 0 }\n[initial]\n", 10, 2, "initial has no mode");
    expect_addition_refused("[sections.s]\ndirection = \"both\"\n", 8, 11, "needs either a function or a state");
    expect_addition_refused("[sections.s]\nstate = \"x\"\n", 8, 11, "state and value belong together");
    expect_addition_refused("[sections.s]\nfunction = \"x\"\nvalue = 1\n", 8, 11, "state and value belong together");
    const std::string start = "[[transitions]]\nmode = \"flight\"\nevent = \"contact\"\n";
    expect_refused(bouncing(""), 6, 10, "mode 'flight' watches the barrier 'contact' but has no transition");
    expect_refused(bouncing(start), 9, 1, "transitions.1 has no next mode");
    expect_refused(bouncing("[[transitions]]\nevent = \"contact\"\nnext = \"end\"\n"), 9, 1,
                   "transitions.1 has no mode");
    expect_refused(bouncing("[[transitions]]\nmode = \"flight\"\nnext = \"end\"\n"), 9, 1,
                   "transitions.1 has no event");
    expect_refused(bouncing(start + "next = []\n"), 9, 1, "transitions.1 has no next mode");
    expect_refused(bouncing(start + "next = [{ when = \"v > 0\" }]\n"), 12, 9, "transitions.1.next.1 has no mode");
    expect_refused(bouncing(start + "next = \"end\"\nchatter = {}\n"), 13, 1, "transitions.1.chatter has no mode");
}

TEST(ModelFile, RefusesWrongTypes) {
    expect_refused("name = 1\n" + smooth_with("", ""), 1, 8, "name must be a string, not a number");
    expect_refused("parameters = 1\n", 1, 14, "parameters must be a table, not a number");
    expect_refused(smooth_with("k = 4.0", "k = true"), 2, 5, "must be a number, an expression or a table, not true");
    expect_refused(smooth_with("k = 4.0", "k = { value = [] }"), 2, 15,
                   "must be a number or an expression, not a list");
    expect_refused(smooth_with("k = 4.0", "k = 1979-05-27"), 2, 5, "not a date");
    expect_refused(smooth_with("x = 1", "x = { initial = 1, period = 2, drifting = true }"), 4, 1,
                   "the state 'x' is both cyclic and drifting",
                   "leave out `drifting` if it comes back after its period, or else the period");
    expect_refused(smooth_with("x = 1", "x = { initial = 1, drifting = 1 }"), 4, 31,
                   "must be true or false, not a number");
    expect_refused(smooth_with("[modes.free]", "[[modes.free]]"), 6, 1, "modes.free must be a table, not a list");
    expect_refused(smooth_with("rates =", "watch = \"contact\"\nrates ="), 7, 9, "must be a list, not a string");
    expect_refused(smooth_with("rates =", "watch = [1]\nrates ="), 7, 10, "modes.free.watch.1 must be a string");
    expect_refused(smooth_with("\"v\"", "{ v = 1 }"), 7, 15, "must be a number or an expression, not a table");
    expect_addition_refused("[transitions]\nmode = 1\n", 8, 1, "transitions must be a list, not a table");
    expect_addition_refused("[events]\ne = { function = \"x\", kind = \"wall\" }\n", 9, 30,
                            "events.e.kind cannot be 'wall'", "barrier, section");
    expect_addition_refused("[sections.s]\nfunction = \"x\"\ndirection = \"up\"\n", 10, 13, "cannot be 'up'",
                            "falling");
    expect_refused(bouncing("[[transitions]]\nmode = \"flight\"\nevent = \"contact\"\nnext = 1\n"), 12, 8,
                   "must be the name of a mode or a list of alternatives");
}

TEST(ModelFile, RefusesBadValues) {
    expect_refused(smooth_with("4.0", "nan"), 2, 5, "parameters.k.value is nan");
    expect_refused(smooth_with("4.0", "-inf"), 2, 5, "parameters.k.value is -inf");
    expect_refused(smooth_with("x = 1", "x = inf"), 4, 5, "states.x.initial is inf");
    expect_refused(smooth_with("4.0", "4.0\nd = \"1/(k - 4)\""), 3, 5, "parameters.d.value is inf");
    expect_refused(smooth_with("4.0", "4.0\nd = \"log(-k)\""), 3, 5, "parameters.d.value is");
    expect_refused(smooth_with("x = 1", "x = { initial = 1, period = 0 }"), 4, 29, "the period of 'x' is 0");
    expect_refused(smooth_with("x = 1", "x = { initial = 1, period = \"-k\" }"), 4, 29, "the period of 'x' is -4");
    expect_refused(smooth_with("x = 1", "x = \"sqrt(-k)\""), 4, 5, "states.x.initial is");
}

TEST(ModelFile, RefusesNamesThatClash) {
    expect_refused(smooth_with("k = 4.0", "k = 4.0\nv = 1"), 6, 1,
                   "the name 'v' is used twice, for a parameter and for a state");
    expect_addition_refused("[definitions]\nk = \"x\"\n", 9, 1,
                            "the name 'k' is used twice, for a parameter and for a definition");
    expect_refused(smooth_with("k = 4.0", "exp = 4.0"), 2, 1, "'exp' is a reserved name");
    expect_refused(smooth_with("k = 4.0", "t = 4.0"), 2, 1, "'t' is a reserved name");
    expect_refused(smooth_with("k = 4.0", "k = 4\npi = 3"), 3, 1, "'pi' is a reserved name");
    expect_refused(smooth_with("k = 4.0", "k = 4\n\"a b\" = 4.0"), 3, 1, "'a b' cannot be the name of a parameter");
    expect_addition_refused("[quantities]\nx = \"x\"\n", 9, 1, "the name 'x' of a quantity is used twice");
    expect_addition_refused("[quantities]\na-b = \"x\"\n", 9, 1, "'a-b' cannot be the name of a quantity");
    expect_addition_refused("[jumps.identity]\nx = 1\n", 8, 8, "the jump 'identity' exists always");
    expect_refused(smooth_with("[modes.free]", "[modes.end]"), 6, 8, "a mode cannot be named 'end'");
    expect_addition_refused("[sections.'a b']\nfunction = \"x\"\n", 8, 11, "'a b' cannot be the name of a section");
}

TEST(ModelFile, RefusesNamesUsedInTheWrongPlace) {
    expect_refused(smooth_with("{ initial = 0 }", "{ initial = \"k + 2*x\" }"), 5, 24,
                   "states.v.initial uses the state 'x'");
    expect_refused(smooth_with("4.0", "4.0\nd = \"k*v\""), 3, 8, "parameters.d.value uses the state 'v'");
    expect_refused("[definitions]\nd = \"k\"\n" + smooth_with("x = 1", "x = \"d\""), 6, 6,
                   "states.x.initial uses the definition 'd'", "dependent parameter");
    expect_refused(smooth_with("x = 1", "x = { initial = 1, period = \"2 + v\" }"), 4, 34,
                   "states.x.period uses the state 'v'");
    expect_addition_refused("[sections.s]\nstate = \"x\"\nvalue = 0\n", 9, 9, "which is not cyclic");
    expect_addition_refused("[sections.s]\nstate = \"x\"\nvalue = 0\ndirection = \"both\"\n", 11, 1,
                            "cannot have a direction");
    expect_addition_refused("[sections.s]\nstate = \"x\"\nvalue = \"v\"\nfunction = \"v\"\n", 8, 11,
                            "either a function or a state");
}

TEST(ModelFile, RefusesCirclesAndShowsThem) {
    expect_addition_refused("[definitions]\na = \"x + b\"\nb = \"2*c\"\nc = \"sin(a)\"\nd = \"a\"\n", 9, 10,
                            "definitions refer to one another in a circle: a -> b -> c -> a");
    expect_addition_refused("[definitions]\na = \"x + a\"\n", 9, 10, "a -> a");
    expect_refused(smooth_with("4.0", "\"2*m\"\nm = \"k\""), 2, 8,
                   "dependent parameters refer to one another in a circle: k -> m -> k");
}

TEST(ModelFile, RefusesRepetitions) {
    const std::string transition = "[[transitions]]\nmode = \"flight\"\nevent = \"contact\"\nnext = \"flight\"\n";
    EXPECT_NO_THROW(parse_model(bouncing(transition), "right.toml"));
    expect_refused(bouncing(transition + transition), 13, 1,
                   "there is a second transition for event 'contact' in mode 'flight'");
    std::string text = bouncing(transition);
    text.replace(text.find("[\"contact\"]"), 11, "[\"contact\", \"contact\"]");
    expect_refused(text, 6, 21, "mode 'flight' watches event 'contact' twice");
}

TEST(ModelFile, FindsPlacesInsideStrings) {
    // Escapes, characters of several bytes, literal and multi-line strings.
    expect_addition_refused("[definitions]\nd = 'x + y1'\n", 9, 10, "y1");
    expect_addition_refused("[definitions]\nd = \"x\\t+ \\u0078 + y1\"\n", 9, 20, "y1");
    expect_addition_refused("[definitions]\nd = { text = \"\u00e9\u00e8\", value = \"x + y1\" }\n", 9, 33, "y1");
    expect_addition_refused("[definitions]\nd = \"\"\"\nx +\n y1\"\"\"\n", 11, 2, "y1");
    expect_addition_refused("[definitions]\nd = \"\"\"x + \\\n   y1\"\"\"\n", 10, 4, "y1");
    expect_addition_refused("[definitions]\nd = '''x +\r\n y1'''\n", 10, 2, "y1");
    expect_addition_refused("[definitions]\nd = \"\"\"x + 1 \\\n  + (x\"\"\"\n", 10, 5, "(");
    expect_addition_refused("[definitions]\nd = \"\"\n", 9, 6, "");
    expect_addition_refused("[definitions]\nd = \"x +\"\n", 9, 8, "");
}

/// Returns the fenced block of the guide that begins with this line.
std::string block_of_the_guide(const std::string& fence) {
    std::ifstream file(std::string(testing::source_folder) + "/docs/model-format.md");
    std::string result;
    std::string line;
    while (std::getline(file, line) && line != fence) {
    }
    while (std::getline(file, line) && line != "```")
        result += line + "\n";
    return result;
}

TEST(ModelFile, ExamplesOfTheGuideAreValidModels) {
    const Model model = parse_model(block_of_the_guide("```toml file=ball-on-table.toml"), "ball-on-table.toml");
    EXPECT_TRUE(model_warnings(model).empty());
    EXPECT_EQ(contents(parse_model(write_model(model), "again.toml")), contents(model));
    try {
        parse_model(block_of_the_guide("```toml file=wrong.toml"), "wrong.toml");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.what() + std::string("\n"), block_of_the_guide("```text"));
    }
}

} // namespace graze::model_file_test
