#include "program/command_line.hpp"
#include "run_graze.hpp"

#include <CLI/App.hpp>
#include <gmock/gmock.h>

#include <filesystem>
#include <map>
#include <set>

namespace graze::testing::option_values_test {

using ::testing::HasSubstr;

using Words = std::vector<std::string>;

/// Types of options, as the help shows them, and values that every option of the type refuses.
const std::map<std::string, Words>& refused_values() {
    const Words counts{"nan", "inf", "1.5", "1e3", "x", "", "99999999999999999999999"};
    const Words numbers{"nan", "-nan", "inf", "-inf", "1e999", "x", "1x", "", " "};
    static const std::map<std::string, Words> all{
        {"FORMAT", {"7", "0", "-1", "", "CSV", "csv,json", "nan"}},
        {"N", counts},
        {"[N]", {"nan", "inf", "1.5", "x"}},
        {"PORT", {"nan", "-1", "65536", "x", ""}},
        {"F", numbers},
        {"S", numbers},
        {"HZ", numbers},
        {"FACTOR", numbers},
        {"V", numbers},
        {"P", {"nan", "-0.1", "1.1", "inf", "x", ""}},
        {"PART", {"nan", "-0.1", "1.1", "inf", "x", ""}},
        {"D", numbers},
        {"K", numbers},
        {"Q", numbers},
        {"Q,I", {"nan,1", "1,inf", "1", "1,2,3", "x,1", ""}},
        {"TOL", numbers},
        {"SPEED", numbers},
        {"CYCLES", numbers},
        {"LOSS", {"7", "", "nan"}},
        {"KIND_OF_RUN", {"7", "", "nan", "bifurcation"}},
        {"FLAG", {"7", "1e999", "nan", "x"}},
    };
    return all;
}

/// Types whose values only the command itself can check, since it needs the model or the file.
const std::set<std::string>& judged_by_commands() {
    static const std::set<std::string> all{
        "FILE",     "FOLDER",  "PATH",      "NAME",       "EXPR",      "RUN",          "WAY",
        "LABEL",    "QUERY",   "POINT",     "TYPE",       "FOUND",     "TEXT",         "KIND",
        "AXIS",     "TABLE",   "MODE",      "STATE",      "X,Y",       "NAMES",        "PARTS",
        "RULE",     "VALUE",   "VALUES",    "A:B",        "RATES",     "AMPLITUDES",   "LEVELS",
        "LOW:HIGH", "W[xH]",   "K/N",       "FONT",       "T",         "DT",           "MODES",
        "ADDRESS",  "COMMAND", "NAME=TEXT", "NAME=VALUE", "NAME=SIZE", "NAME=FROM:TO", "STATE=LOW:HIGH"};
    return all;
}

/// Every option whose value is a number or one of a list of words refuses other values before files are read or made.
TEST(OptionValues, NumbersAndWordsAreCheckedBeforeAnyWork) {
    const CommandLine line;
    int tried = 0;
    for (const CLI::App* command : line.app.get_subcommands({}))
        for (const CLI::Option* option : command->get_options()) {
            if (option->get_positional() || option->get_lnames().empty())
                continue;
            const bool is_flag = option->get_items_expected_max() == 0;
            const auto found = refused_values().find(is_flag ? "FLAG" : option->get_type_name());
            if (found == refused_values().end()) {
                EXPECT_TRUE(judged_by_commands().contains(option->get_type_name()) ||
                            option->get_type_name().find_first_of("=:[,") != std::string::npos)
                    << command->get_name() << " " << option->get_name() << " " << option->get_type_name();
                continue;
            }
            for (const std::string& value : found->second) {
                Words words{command->get_name()};
                for (const CLI::Option* one : command->get_options())
                    if (one->get_positional())
                        words.emplace_back("nothing-there");
                words.push_back("--" + option->get_lnames().front() + "=" + value);
                expect_refusal(words, "--" + option->get_lnames().front());
                ++tried;
            }
        }
    EXPECT_GT(tried, 400);
}

/// For all commands.
TEST(OptionValues, ADashIsNoFileName) {
    for (const Words& words : {Words{"models", "impact-oscillator", "--write", "-"},
                               Words{"info", "x", "--output", "-"}, Words{"simulate", "bouncing-ball", "--output=-"},
                               Words{"run", "x", "--output", "-"}, Words{"completion", "bash", "--output", "-"}}) {
        expect_refusal(words, "'-' is no name of a file or folder; with");
        EXPECT_FALSE(std::filesystem::exists("-"));
    }
}

/// Values that a command checks itself.
TEST(OptionValues, CommandsRefuseWrongValues) {
    const std::vector<std::pair<std::string, Words>> cases{
        {"simulate bouncing-ball --time", {"nan", "inf", "0", "-1", "x", "1/0"}},
        {"simulate bouncing-ball --time 1 --after", {"nan", "inf", "0", "-1"}},
        {"simulate bouncing-ball --time 1 --every", {"nan", "inf", "0", "-1"}},
        {"simulate bouncing-ball --time 1 --largest-step", {"nan", "0", "-1"}},
        {"simulate bouncing-ball --time 1 --tolerance", {"0", "-1", "1", "1e-30"}},
        {"simulate bouncing-ball --time 1 --order", {"-1", "1", "1000"}},
        {"simulate bouncing-ball --time 1 --samples", {"0", "-1"}},
        {"simulate bouncing-ball --time 1 --digits", {"0", "-1", "18"}},
        {"simulate bouncing-ball --time 1 --table", {"7", "sample", "nan"}},
        {"simulate bouncing-ball --time 1 --set e=", {"nan", "inf", "x"}},
        {"simulate bouncing-ball --time 1 --plot p.svg --size", {"0", "0x0", "85x0", "x", "85x", "1e3", "99999"}},
        {"simulate impact-oscillator --periods", {"0", "-1"}},
        {"simulate impact-oscillator --skip", {"-1"}},
        {"simulate impact-oscillator --contacts", {"0", "-1"}},
        {"simulate bouncing-ball --time 1 --phase", {"theta", "x", "zzz"}},
        {"models microbeam --beam-modes", {"0", "-1", "1000"}},
        {"models microbeam --quadrature", {"7", "nan", "gaus"}},
        {"models microbeam --points", {"0", "-1", "3"}},
    };
    for (const auto& [start, values] : cases)
        for (const std::string& value : values) {
            const std::string line = start.ends_with('=') ? start + value : start + " " + value;
            const Printed printed = run_graze(line);
            EXPECT_EQ(printed.code, 2) << line;
            EXPECT_EQ(printed.out, "") << line;
            EXPECT_EQ(std::count(printed.err.begin(), printed.err.end(), '\n'), 1) << line << printed.err;
        }
}

} // namespace graze::testing::option_values_test
