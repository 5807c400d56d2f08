#include "program/command_line.hpp"
#include "program/completion.hpp"
#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdio>

namespace graze::testing::help_test {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const std::vector<std::string> commands{"check",     "models", "simulate",   "run",     "info",     "export",
                                        "plot",      "points", "orbit",      "grazing", "trip",     "ladder",
                                        "tolerance", "design", "layout",     "record",  "identify", "bench",
                                        "acquire",   "help",   "completion", "view",    "merge",    "atlas"};

/// The output of a shell command.
std::string printed_by(const std::string& command) {
    std::string text;
    FILE* pipe = popen(command.c_str(), "r");
    char buffer[4096];
    while (const std::size_t read = fread(buffer, 1, sizeof buffer, pipe))
        text.append(buffer, read);
    pclose(pipe);
    return text;
}

/// The words that bash offers for the last word of a line.
std::vector<std::string> completed(const std::string& script, const std::string& line) {
    const auto words = static_cast<int>(std::count(line.begin(), line.end(), ' '));
    std::string array;
    for (const std::string& word : split(line + (line.back() == ' ' ? "\"\"" : ""), ' '))
        array += word.empty() ? "" : " " + word;
    const std::vector<std::string> offered =
        split(printed_by("bash -c '. " + script + "; COMP_WORDS=(" + array + "); COMP_CWORD=" + std::to_string(words) +
                         "; _graze; printf \"%s\\n\" \"${COMPREPLY[@]}\"'"),
              '\n');
    return offered == std::vector<std::string>{""} ? std::vector<std::string>() : offered;
}

void expect_among(const std::vector<std::string>& words, const std::vector<std::string>& offered) {
    for (const std::string& word : words)
        EXPECT_NE(std::find(offered.begin(), offered.end(), word), offered.end()) << word;
}

TEST(Help, CommandAndOptionPrintTheSame) {
    EXPECT_EQ(run_graze("help").out, run_graze("--help").out);
    for (const std::string& command : commands) {
        const Printed help = run_graze("help " + command);
        EXPECT_EQ(help.code, 0) << help.err;
        EXPECT_EQ(help.out, run_graze(command + " --help").out);
        EXPECT_THAT(run_graze("help").out, HasSubstr("\n  " + command + " ")) << "all commands are listed";
    }
}

TEST(Help, ManualPagesHaveAllOptions) {
    const CommandLine declared;
    for (const std::string& command : commands) {
        const std::string page = run_graze("help --man " + command).out;
        EXPECT_THAT(page, StartsWith(".TH GRAZE-"));
        EXPECT_THAT(page, HasSubstr("\n.SH EXAMPLES\n"));
        const CLI::App& app = command_named(declared.app, command);
        EXPECT_GT(declared_options(app).size(), 1U);
        for (const DeclaredOption& option : declared_options(app)) {
            std::string name = option.name;
            for (std::size_t at = name.find('-'); at != std::string::npos; at = name.find('-', at + 2))
                name.insert(at, "\\");
            EXPECT_THAT(page, HasSubstr(name)) << command;
        }
        EXPECT_THAT(page, Not(HasSubstr("contact\\-table"))) << "which is not for users";
    }
}

TEST(Help, GroffReadsManualPagesWithoutWarnings) {
    if (printed_by("command -v groff").empty())
        GTEST_SKIP() << "no groff";
    const Folder folder;
    const std::string written = done("help --write " + (folder / "man1"));
    EXPECT_EQ(split(written, '\n').size(), commands.size() + 1);
    for (const std::string& page : split(written, '\n'))
        EXPECT_EQ(printed_by("groff -man -Tutf8 -ww -z " + page + " 2>&1"), "") << page;
    EXPECT_THAT(printed_by("groff -man -Tascii -P-cbu " + (folder / "man1/graze-run.1")),
                HasSubstr("graze run [STUDY]"));
}

TEST(Completion, BashOffersCommandsOptionsAndValues) {
    const Folder folder;
    const std::string script = folder / "graze.bash";
    done("completion bash --output " + script);
    expect_among(commands, completed(script, "graze "));
    EXPECT_EQ(completed(script, "graze exp"), std::vector<std::string>{"export"});
    EXPECT_EQ(completed(script, "graze run --no-p"), std::vector<std::string>{"--no-pictures"});
    EXPECT_EQ(completed(script, "graze export x --format h"), std::vector<std::string>{"hdf5"});
    EXPECT_EQ(completed(script, "graze simulate mems-switch-"), std::vector<std::string>{"mems-switch-device"});
    EXPECT_EQ(completed(script, "graze help compl"), std::vector<std::string>{"completion"});
    expect_among({"GR", "SN", "PD"}, completed(script, "graze points x --type "));
    std::ofstream(folder / "mine.toml") << "";
    EXPECT_EQ(completed(script, "graze check " + (folder / "mi")), std::vector<std::string>{folder / "mine.toml"});
    EXPECT_EQ(completed(script, "graze run --jobs "), std::vector<std::string>{});
}

TEST(Completion, ScriptsOfAllShellsHaveAllOptions) {
    const CommandLine declared;
    for (const std::string shell : {"bash", "zsh", "fish"}) {
        const std::string script = run_graze("completion " + shell).out;
        for (const CLI::App* command : declared_commands(declared.app))
            for (const DeclaredOption& option : declared_options(*command))
                EXPECT_THAT(script, HasSubstr(option.is_argument ? command->get_name()
                                              : shell == "fish"  ? "-l " + option.name.substr(2)
                                                                 : option.name))
                    << shell;
        if (!printed_by("command -v " + shell).empty()) {
            const Folder folder;
            done("completion " + shell + " --output " + (folder / "script"));
            EXPECT_EQ(printed_by(shell + " -n " + (folder / "script") + " 2>&1"), "") << shell;
        }
    }
}

TEST(Completion, OffersOnlyAcceptedValues) {
    const CommandLine declared;
    std::size_t tried = 0;
    for (const CLI::App* command : declared_commands(declared.app))
        for (const DeclaredOption& option : declared_options(*command))
            for (const std::string& word : choices_for(declared.app, *command, option).words)
                if (!option.is_argument) {
                    ++tried;
                    CommandLine fresh;
                    CLI::App& app = const_cast<CLI::App&>(command_named(fresh.app, command->get_name()));
                    for (CLI::Option* other : app.get_options())
                        other->required(false);
                    // CLI11 expects the last word first.
                    EXPECT_NO_THROW(app.parse(std::vector<std::string>{word, option.name})) << option.name << word;
                }
    EXPECT_GT(tried, 40U);
}

TEST(Help, RefusesUnknownCommandsAndShells) {
    const Folder folder;
    std::ofstream(folder / "file") << "";
    const std::vector<std::pair<std::string, std::string>> mistakes{
        {"help simulat", "did you mean 'simulate'?"},
        {"help run export", "one argument too many"},
        {"help --write " + (folder / "file/pages"), "cannot be made"},
        {"help run --write pages", "COMMAND has no effect beside --write"},
        {"help --mann", "did you mean '--man'?"},
        {"completion", "the shell is missing"},
        {"completion bsh", "did you mean 'bash'?"},
        {"completion powershell", "there is no completion for the shell 'powershell'"},
        {"completion bash --output " + (folder / "no/such/file"), "cannot be written"},
        {"completion bash --format csv", "unknown option '--format'"},
    };
    for (const auto& [line, message] : mistakes)
        expect_refusal(line, message);
}

} // namespace graze::testing::help_test
