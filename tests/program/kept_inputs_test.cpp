#include "program/kept_inputs.hpp"

#include "graze/base/input_error.hpp"
#include "places.hpp"
#include "program/command_line.hpp"
#include "program/output_file.hpp"
#include "run_graze.hpp"

#include <CLI/App.hpp>
#include <gmock/gmock.h>

#include <filesystem>
#include <functional>
#include <map>

namespace graze::testing::kept_inputs_test {

using ::testing::HasSubstr;

/// Calls `work` with every declared option, and the command that it belongs to.
void for_each_option(const std::function<void(const CLI::App&, const CLI::Option&)>& work) {
    const CommandLine line;
    for (const CLI::App* command : line.app.get_subcommands({}))
        for (const CLI::Option* option : command->get_options())
            if (!option->get_positional() && !option->get_lnames().empty())
                work(*command, *option);
}

/// A command line with `input` for all positional arguments and `output` for the option.
std::vector<std::string> command_line(const CLI::App& command, const CLI::Option& option, const std::string& input,
                                      const std::string& output) {
    std::vector<std::string> words{command.get_name()};
    for (const CLI::Option* one : command.get_options())
        if (one->get_positional())
            words.push_back(one->get_name() == "WHAT" ? "fit" : input);
    const std::string name = option.get_lnames().front();
    words.insert(words.end(), {"--" + name, output});
    if (name == "data") // which needs a picture
        for (const CLI::Option* one : command.get_options())
            if (one->check_lname("plot"))
                words.insert(words.end(), {"--plot", input + "-other.svg"});
    return words;
}

TEST(KeptInputs, NoCommandReplacesAFileThatItReads) {
    const Folder folder;
    const std::string input = folder / "input.csv", link = folder / "link.csv", hard = folder / "hard.csv";
    write_file(input, "t [s], x [m]\n0, 1\n1, 2\n");
    std::filesystem::create_symlink("input.csv", link);
    std::filesystem::create_hard_link(input, hard);
    const std::string roundabout = folder / "./input.csv";
    int tried = 0;
    for_each_option([&](const CLI::App& command, const CLI::Option& option) {
        if (option.get_type_name() != "FILE" || command.get_name() == "help")
            return;
        for (const std::string& output : {input, link, hard, roundabout}) {
            const std::vector<std::string> words = command_line(command, option, input, output);
            expect_refusal(words, " is the file of ");
            EXPECT_EQ(contents(input), "t [s], x [m]\n0, 1\n1, 2\n");
            ++tried;
        }
    });
    EXPECT_GE(tried, 4 * 25);
}

/// Exactly the options that write files have the type FILE or FOLDER. A new option that writes must have one too, so
/// that its file is compared with the inputs.
TEST(KeptInputs, OptionsThatWriteAreDeclaredAsFileOrFolder) {
    const std::vector<std::string> writing{"output",  "plot",   "data",    "plot-data",  "write",
                                           "graph",   "save",   "live",    "parameters", "recipe",
                                           "picture", "folder", "markers", "verilog-a"};
    for_each_option([&](const CLI::App& command, const CLI::Option& option) {
        const std::string name = option.get_lnames().front();
        const bool writes = std::find(writing.begin(), writing.end(), name) != writing.end();
        EXPECT_EQ(writes, option.get_type_name() == "FILE" || option.get_type_name() == "FOLDER")
            << command.get_name() << " --" << name;
    });
}

/// An input in the output folder that has the name of an output.
struct InputInFolder {
    std::string name, text;
    std::vector<std::string> after{}; ///< further words of the command line
};

const char* const small_study = "name = \"s\"\nmodel = \"bouncing-ball\"\n[runs.r]\nkind = \"simulate\"\ntime = 1\n"
                                "sample = { a = { maxima = \"x\" } }\n[pictures.p]\nkind = \"history\"\nrun = \"r\"\n"
                                "format = \"svg\"\n[tables.t]\nrun = \"r\"\ncolumns = [\"time\"]\n";

/// Such inputs for each command that writes into a folder; none if the command writes nothing over them.
std::map<std::string, std::vector<InputInFolder>> inputs_in_folders() {
    const std::string source = source_folder;
    const std::string design = contents(source + "/designs/mems-switch-device.toml"),
                      experiment = contents(source + "/fuzz/corpus/fuzz_experiment/sweep.toml");
    return {
        {"run", {{"p.svg", small_study, {"--quiet"}}, {"t.csv", small_study, {"--quiet"}}}},
        {"design", {{"device.toml", design}, {"report.json", design}, {"page.svg", design}}},
        {"layout", {{"wafers.csv", design, {"--yield", "1"}}, {"report.json", design, {"--yield", "1"}}}},
        {"acquire",
         {{"manifest.txt", experiment, {"--port", "nowhere", "--device", "tcp:127.0.0.1:1"}},
          {"settings.txt", experiment, {"--port", "nowhere", "--device", "tcp:127.0.0.1:1"}}}},
        {"atlas",
         {{"atlas.csv",
           contents(source + "/tests/atlas/truth/cubic-map.toml"),
           {"--along", "a=0.5:1:3", "--quiet", "--draws", "0", "--multiple", "1"}}}},
        {"merge", {}}, // its inputs are databases, which no output replaces
        {"view", {}},  // it writes a result file only, when it is asked to compute
        {"help", {}},
    };
}

/// A new command that writes into a folder must be added to inputs_in_folders.
TEST(KeptInputs, NoOutputInAFolderReplacesAnInput) {
    const auto listed = inputs_in_folders();
    for_each_option([&](const CLI::App& command, const CLI::Option& option) {
        if (option.get_type_name() != "FOLDER")
            return;
        const auto found = listed.find(command.get_name());
        ASSERT_NE(found, listed.end()) << command.get_name();
        for (const InputInFolder& input : found->second) {
            const Folder folder;
            const std::string path = folder.write(input.name, input.text);
            std::vector<std::string> words{command.get_name(), path};
            words.insert(words.end(), input.after.begin(), input.after.end());
            words.insert(words.end(), {"--" + option.get_lnames().front(), folder.path()});
            const Printed printed = run_graze(words);
            EXPECT_EQ(contents(path), input.text) << ::testing::PrintToString(words);
            EXPECT_NE(printed.code, 0) << ::testing::PrintToString(words);
            EXPECT_NE(printed.err, "") << ::testing::PrintToString(words);
        }
    });
}

/// `graze export --output` may name a folder.
TEST(KeptInputs, ExportsOfRunsReplaceNoResults) {
    const Folder folder;
    const std::string study = folder.write("s.toml", small_study), results = folder / "r.csv";
    done({"run", study, "--output", folder / "out", "--quiet", "--no-pictures"});
    std::filesystem::copy_file(folder / "out/results.sqlite", results);
    const std::string before = contents(results);
    EXPECT_EQ(run_graze({"export", results, "--format", "csv", "--output", folder.path()}).code, 2);
    EXPECT_EQ(contents(results), before);
}

TEST(KeptInputs, TwoOutputsMustBeDifferentFiles) {
    const Folder folder;
    const std::string path = folder / "one.svg";
    expect_refusal({"simulate", "bouncing-ball", "--time", "1", "--plot", path, "--data", path}, "is the file of --");
    EXPECT_EQ(folder.files(), 0U);
}

TEST(KeptInputs, FilesInOptionValuesAreInputs) {
    const Folder folder;
    const std::string values = folder / "values.toml";
    write_file(values, "[set]\ne = 0.5\n");
    for (const char* option : {"--set", "--from"})
        expect_refusal({"simulate", "bouncing-ball", option, "@" + values, "--time", "1", "--output", values},
                       "is the file of " + std::string(option) + " too");
    EXPECT_EQ(contents(values), "[set]\ne = 0.5\n");
}

TEST(KeptInputs, PicturesForLatexHaveASecondFile) {
    const Folder folder;
    const std::string input = folder / "picture.pdf";
    write_file(input, "x");
    EXPECT_THAT(run_graze({"simulate", input, "--time", "1", "--plot", folder / "picture.tex"}).err,
                HasSubstr("is the file of the model too"));
}

TEST(KeptInputs, ProtectionEndsWithTheList) {
    const Folder folder;
    const std::string path = folder / "input.csv";
    write_file(path, "1");
    {
        const KeptInputs kept;
        KeptInputs::add("the record", path);
        EXPECT_THROW(write_file(path, "2"), InputError);
        EXPECT_THROW(require_writable(path), InputError);
        EXPECT_NO_THROW(write_file(folder / "other.csv", "2"));
        EXPECT_THROW(KeptInputs::expect_output("--output", path), InputError);
        KeptInputs::expect_output("--plot", folder / "other.csv");
        EXPECT_THROW(KeptInputs::add("the model", folder / "other.csv"), InputError);
    }
    EXPECT_EQ(contents(path), "1");
    write_file(path, "2");
    EXPECT_EQ(contents(path), "2");
}

} // namespace graze::testing::kept_inputs_test
