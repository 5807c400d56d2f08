// Malicious contents of models, studies and result files, and malicious links in output folders.

#include "branch_results.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/printable.hpp"
#include "picture/gnuplot_text.hpp"
#include "picture/rich_text.hpp"
#include "program/output_file.hpp"
#include "run_graze.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <chrono>
#include <cstdlib>
#include <random>

namespace graze::hostile_test {

using namespace graze::testing;
using ::testing::AnyOf;
using ::testing::HasSubstr;

constexpr const char* oscillator = R"(
name = "oscillator"
[states]
x = 1
v = 0
[modes.only]
rates = { x = "v", v = "-x" }
)";

class Hostile : public ::testing::Test {
protected:
    Hostile() {
        std::ofstream(folder / "model.toml") << oscillator;
        study("\"study\"");
    }
    /// Writes a study with one short run. The arguments are names and a title as TOML, which may be malicious.
    std::string study(const std::string& name, const std::string& run = "\"r\"", const std::string& picture = "\"p\"",
                      const std::string& title = "\"t\"") const {
        std::ofstream(folder / "study.toml")
            << "name = " << name << "\nmodel = \"model.toml\"\n[runs." << run
            << "]\nkind = \"simulate\"\ntime = 3\nsample = { a = { maxima = \"x\" } }\n[pictures." << picture
            << "]\nkind = \"history\"\nformat = \"svg\"\nrun = " << run << "\ntitle = " << title << '\n';
        return folder / "study.toml";
    }
    static std::string quoted(const std::string& text) {
        std::string result = "\"";
        for (const char c : text)
            if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
                result += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
            else
                result += (c == '"' || c == '\\' ? "\\" : "") + std::string(1, c);
        return result + '"';
    }

    Folder folder;
};

/// A random text of pieces that would leave quotes, run commands or control a terminal.
/// @param trace file that an executed command would make
std::string nasty(std::mt19937& random, const std::string& trace) {
    const std::vector<std::string> parts{"\n",
                                         "\nsystem 'touch " + trace + "'\n",
                                         "`touch " + trace + "`",
                                         "$(touch " + trace + ")",
                                         "'",
                                         "\"",
                                         "\\",
                                         "@",
                                         "%",
                                         "{",
                                         "}",
                                         "^",
                                         "_",
                                         "~",
                                         "&",
                                         "#",
                                         "\x1b[2J",
                                         "../",
                                         "/",
                                         "|touch " + trace,
                                         ";",
                                         "\r",
                                         "\t",
                                         "a",
                                         "é",
                                         "\\n",
                                         "\\140",
                                         "\x7f",
                                         "!touch " + trace + "\n"};
    std::string text = "x";
    for (int i = std::uniform_int_distribution<>(1, 6)(random); i > 0; --i)
        text += parts[std::uniform_int_distribution<std::size_t>(0, parts.size() - 1)(random)];
    return text;
}

TEST_F(Hostile, NamesNeitherLeaveTheFolderNorRunCommands) {
    const std::string trace = folder / "trace";
    std::mt19937 random(1);
    for (int i = 0; i < 150; ++i) {
        const std::string wrong = quoted(nasty(random, trace));
        study(i % 3 == 0 ? wrong : "\"s\"", i % 3 == 1 ? wrong : "\"r\"", i % 3 == 2 ? wrong : "\"p\"");
        const Printed printed =
            run_graze(std::vector<std::string>{"run", folder / "study.toml", "--output", folder / "out"});
        if (printed.code == 0)
            continue; // the random text was a valid name
        EXPECT_EQ(printed.code, 2) << wrong;
        EXPECT_THAT(printed.err, AnyOf(HasSubstr("cannot be the name of a"), HasSubstr("control a terminal"),
                                       HasSubstr("in the middle of a word"))) // for a key outside ASCII
            << wrong;
        EXPECT_TRUE(is_plain_text(printed.err));
        // One line for each place of the name: the run, and the picture that refers to it.
        const std::vector<std::string> lines = split(printed.err, '\n');
        EXPECT_LE(lines.size(), i % 3 == 1 ? 2u : 1u) << printed.err;
        for (const std::string& line : lines)
            EXPECT_TRUE(line.starts_with("graze: ")) << printed.err;
    }
    EXPECT_FALSE(std::filesystem::exists(trace));
    EXPECT_LE(folder.files(), 3u); // the model, the study, perhaps the folder
}

TEST_F(Hostile, TextsOfPicturesAreDrawnOrRefused) {
    const std::string trace = folder / "trace";
    std::mt19937 random(2);
    for (int i = 0; i < 12; ++i) {
        study("\"s\"", "\"r\"", "\"p\"", quoted(nasty(random, trace)));
        const Printed printed =
            run_graze(std::vector<std::string>{"run", folder / "study.toml", "--output", folder / "out"});
        EXPECT_TRUE(printed.code == 0 || printed.code == 2);
        if (printed.code == 0) {
            EXPECT_THAT(contents(folder / "out/p.svg"), HasSubstr("</svg>"));
        }
        EXPECT_FALSE(std::filesystem::exists(trace));
    }
}

/// gnuplot itself does not escape "]]>".
TEST_F(Hostile, PicturesAreWellFormed) {
    const std::string title = "a ]]> b < & > \xef\xbf\xbe c";
    study("\"s\"", "\"r\"", "\"p\"", quoted(title));
    done(std::vector<std::string>{"run", folder / "study.toml", "--output", folder / "out"});
    const std::string drawn = contents(folder / "out/p.svg");
    EXPECT_THAT(drawn, HasSubstr("]]&gt; b &lt; &amp;"));
    EXPECT_EQ(drawn.find("]]>"), std::string::npos);
    EXPECT_EQ(drawn.find("\xef\xbf\xbe"), std::string::npos);
}

TEST_F(Hostile, TextForGnuplotStaysText) {
    std::mt19937 random(3);
    for (int i = 0; i < 5000; ++i) {
        const std::string text = nasty(random, "x");
        const bool controls =
            std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
        if (controls) {
            EXPECT_THROW(plain(text), InputError);
            EXPECT_THROW(quoted_path(text), InputError);
            EXPECT_THROW(gnuplot_markup(rich_name(text)), InputError);
            EXPECT_THROW(gnuplot_markup(rich_unit(text)), InputError);
            continue;
        }
        for (const std::string& escaped :
             {plain(text), gnuplot_markup(rich_name(text)), firm_blanks(gnuplot_markup(rich_unit(text)))}) {
            EXPECT_EQ(escaped.find_first_of("`@\n\r"), std::string::npos) << escaped;
            for (std::size_t at = 0; at < escaped.size(); ++at) // as gnuplot reads a text in double quotes
                if (escaped[at] == '\\')
                    ++at;
                else
                    EXPECT_NE(escaped[at], '"') << escaped;
        }
    }
}

TEST_F(Hostile, DatabasesAreNeverOverwritten) {
    const std::string results = folder / "out/results.sqlite";
    study("\"s\"");
    done("run " + (folder / "study.toml") + " --no-pictures --output " + (folder / "out"));
    const std::string before = contents(results);
    ASSERT_FALSE(before.empty());
    const std::string soft = folder / "soft.csv", hard = folder / "hard.svg";
    std::filesystem::create_symlink(results, soft);
    std::filesystem::create_hard_link(results, hard);
    const std::string roundabout = folder / "out/../out/./results.sqlite";
    for (const std::string& target : {results, soft, hard, roundabout, results + "-wal", results + ".lock"})
        for (const std::string& command :
             {"export " + results + " --output ", "export " + results + " --format csv --output ",
              "export " + results + " --format hdf5 --output ",
              "export " + results + " --what runs --format json --output ",
              "simulate " + (folder / "model.toml") + " --time 1 --output ",
              "simulate " + (folder / "model.toml") + " --time 1 --plot " + (folder / "p.svg") + " --data ",
              "plot " + results + " --output " + (folder / "p.svg") + " --data ",
              std::string("models impact-oscillator --write "), "check " + (folder / "model.toml") + " --output "}) {
            EXPECT_EQ(run_graze(command + target).code, 2) << command << target;
            EXPECT_EQ(contents(results), before) << command << target;
        }
    EXPECT_EQ(run_graze("plot " + results + " --output " + hard).code, 2);
    EXPECT_EQ(contents(results), before);
    EXPECT_EQ(run_graze("models " + (folder / "model.toml") + " --write " + (folder / "model.toml")).code, 2);
    EXPECT_EQ(contents(folder / "model.toml"), oscillator);
}

TEST_F(Hostile, PicturesStayInTheirFolder) {
    study("\"s\"");
    std::filesystem::create_directory(folder / "out");
    std::ofstream(folder / "precious.svg") << "precious";
    for (const std::string target : {"precious.svg", "new.svg"}) {
        std::filesystem::remove(folder / "out/p.svg");
        std::filesystem::create_symlink(folder / target, folder / "out/p.svg");
        const Printed printed = run_graze("run " + (folder / "study.toml") + " --output " + (folder / "out"));
        EXPECT_EQ(printed.code, 2);
        EXPECT_THAT(printed.err, HasSubstr("leads out of the folder"));
    }
    EXPECT_EQ(contents(folder / "precious.svg"), "precious");
    EXPECT_FALSE(std::filesystem::exists(folder / "new.svg"));
}

TEST_F(Hostile, PipesAndDevicesAreRefusedAtOnce) {
    const std::string pipe = folder / "pipe.toml";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::ofstream(folder / "of_pipe.toml")
        << "name = \"s\"\nmodel = \"pipe.toml\"\n[runs.r]\nkind = \"simulate\"\ntime = 1\n";
    std::ofstream(folder / "of_table.toml")
        << "name = \"s\"\nmodel = \"impact-oscillator\"\n[runs.r]\nkind = \"orbit\"\ntable = "
           "\"pipe.toml\"\n";
    const auto begun = std::chrono::steady_clock::now();
    for (const std::string& command :
         {"simulate " + pipe + " --time 1", "check " + pipe, "run " + pipe, "run " + (folder / "of_pipe.toml"),
          "run " + (folder / "of_table.toml") + " --output " + (folder / "o"), "plot " + pipe, "points " + pipe,
          "orbit " + pipe + " 1", "export " + pipe, std::string("export /dev/zero"), std::string("points /dev/null"),
          std::string("simulate /dev/zero --time 1"), std::string("run /dev/./zero")}) {
        const Printed printed = run_graze(command);
        // A run that cannot read its table fails, and the study's other runs are computed: exit code 3.
        EXPECT_EQ(printed.code, command.find("of_table") == std::string::npos ? 2 : 3) << command << printed.err;
        EXPECT_THAT(printed.err, AnyOf(HasSubstr("pipe"), HasSubstr("device"), HasSubstr("no plain file")));
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(10));
}

TEST_F(Hostile, UnusablePathsAreRefusedInOneLine) {
    const std::string loop = folder / "loop.toml", name(300, 'a'), path(5000, 'b');
    std::filesystem::create_symlink("loop.toml", loop);
    for (const std::string& file : {loop, loop + "/x", folder / name, name, path, folder / (path + "/" + path)})
        for (const std::string command :
             {"check ", "run ", "info ", "export ", "plot ", "points ", "design ", "layout ", "record ", "acquire ",
              "simulate --time 1 ", "identify decrement ", "orbit ", "ladder ", "grazing ", "trip ", "tolerance "}) {
            const bool of_point = command == "orbit " || command == "ladder " || command == "grazing " ||
                                  command == "trip " || command == "tolerance ";
            const Printed printed = run_graze(command + file + (of_point ? " GR1" : ""));
            EXPECT_EQ(printed.code, 2) << command << printed.err;
            EXPECT_EQ(std::count(printed.err.begin(), printed.err.end(), '\n'), 1) << printed.err;
            EXPECT_LT(printed.err.size(), 1500U) << command;
        }
    for (const std::string& file : {loop + "/x", folder / name}) {
        EXPECT_EQ(run_graze("simulate bouncing-ball --time 1 --output " + file).code, 2);
        EXPECT_EQ(run_graze("run " + study("\"s\"") + " --no-pictures --output " + file).code, 2);
    }
}

/// On a full disk gnuplot leaves an empty or incomplete file and returns exit status 0.
TEST_F(Hostile, IncompletePicturesAreReported) {
    const std::string old_path = std::getenv("PATH"), fake = folder / "gnuplot";
    study("\"s\"");
    for (const std::string does :
         {"exit 0",
          "sed -n \"s/set output '\\(.*\\)'/\\1/p\" \"$2\" | while read -r f; do echo '<svg>' > \"$f\"; done"}) {
        std::ofstream(fake) << "#!/bin/sh\n" << does << '\n';
        std::filesystem::permissions(fake, std::filesystem::perms::owner_all);
        setenv("PATH", (std::filesystem::path(fake).parent_path().string() + ':' + old_path).c_str(), 1);
        const Printed simulated =
            run_graze("simulate " + (folder / "model.toml") + " --time 1 --plot " + (folder / "a.svg"));
        const Printed ran = run_graze("run " + (folder / "study.toml") + " --output " + (folder / "out"));
        setenv("PATH", old_path.c_str(), 1);
        EXPECT_EQ(simulated.code, 2);
        EXPECT_EQ(ran.code, 2);
        EXPECT_THAT(simulated.err + ran.err, HasSubstr("not drawn to its end"));
        EXPECT_FALSE(std::filesystem::exists(folder / "a.svg"));
        EXPECT_FALSE(std::filesystem::exists(folder / "out/p.svg"));
    }
}

TEST_F(Hostile, ExcessiveStudiesAreRefused) {
    const std::string head = "name = \"s\"\nmodel = \"impact-oscillator\"\n";
    std::string keys = head, runs = head;
    for (int i = 0; i < 100'000; ++i)
        keys += "k" + std::to_string(i) + " = 1\n";
    for (int i = 0; i < 30; ++i)
        runs += "[runs.r" + std::to_string(i) +
                "]\nkind = \"sweep\"\nvary = { omega = { from = 1, to = 2, points = 1000000 } }\n";
    const std::string deep(100'000, '('), nested(100'000, '[');
    const std::string point = "[runs.r]\nkind = \"simulate\"\ntime = 1\n";
    for (const std::string& text :
         {keys,
          runs,
          head + "x = " + nested,
          head + "[a." + std::string(100'000, 'b') + "]",
          head + "text = \"\xff\xfe\"",
          head + "[runs.r]\nkind = \"sweep\"\nvary = { omega = { from = 1, to = 2, points = 1000000000000000000 } }",
          head + "[runs.r]\nkind = \"sweep\"\nvary = { omega = { from = 1, to = 2, step = 1e-18 } }",
          head + "[runs.r]\nkind = \"sweep\"\nvary = { omega = { from = 1, to = 2, points = 1000000000 } }",
          head + "[runs.r]\nkind = \"sweep\"\nvary = { omega = [1, 2] }\nkeep = 1000000000",
          head + "[runs.r]\nkind = \"sweep\"\nvary = { omega = [1, 2] }\nlargest_period = 1000000",
          head + "[runs.r]\nkind = \"sweep\"\nvary = { omega = [1, 2] }\nlyapunov_cycles = 1000000000",
          head + "[runs.r]\nkind = \"simulate\"\ntime = 1\norder = 1000000000",
          head + "[runs.r]\nkind = \"continue\"\nalong = { omega = [1, 2] }\nsteps = 1000000000",
          head + "[runs.r]\nkind = \"basin\"\nvary = { x = { random = [0, 1] } }\ndraws = 1000000000",
          head + "[runs.r]\nkind = \"basin\"\nvary = { x = { from = 0, to = 1, points = 100000 }, v = { from = 0, to = "
                 "1, points "
                 "= 100000 } }",
          head + point + "values = [\"" + deep + "x\"]",
          head + point + "values = [\"" + std::string(200'000, '-') + "x\"]",
          head + point + "set = { zeta = " + std::string(100'000, '9') + " }",
          head + point + "set = { zeta = 1e999 }",
          head + "[runs.r]\nkind = \"orbit\"\nsignature = \"((((((impact)^1000)^1000)^1000)^1000)^1000)^1000\"",
          head + "[runs.r]\nkind = \"orbit\"\nsignature = \"impact^1000000000\"",
          std::string("\0", 1),
          std::string("name = \"s\"")}) {
        std::ofstream(folder / "study.toml") << text;
        const Printed printed = run_graze("run " + (folder / "study.toml") + " --output " + (folder / "out"));
        EXPECT_EQ(printed.code, 2) << text.substr(0, 300);
        EXPECT_LT(printed.err.size(), 4000u);
        EXPECT_TRUE(is_plain_text(printed.err));
    }
}

TEST_F(Hostile, CircularDefinitionsAreReportedInOneLine) {
    std::ofstream model(folder / "circle.toml");
    model << oscillator << "[definitions]\n";
    for (int i = 0; i < 3000; ++i)
        model << "d" << i << " = \"d" << (i + 1) % 3000 << "\"\n";
    model.close();
    const Printed printed = run_graze("check " + (folder / "circle.toml"));
    EXPECT_EQ(printed.code, 2);
    EXPECT_THAT(printed.err, HasSubstr("d0 -> d1 -> d2 -> ... (2995 more) ..."));
    EXPECT_LT(printed.err.size(), 400u);
}

class HostileResults : public BranchResults {};

TEST_F(HostileResults, ControlCharactersArePrintedAsCodes) {
    write_branches();
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
    const char* sql =
        "UPDATE branch_first SET detail = char(27) || ']0;x' || char(7) || char(155) || '2J' || char(10) || 'y', "
        "label = iif(label IS NULL, NULL, label || char(27) || '[31m'), reason = char(8238)";
    ASSERT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(database);
    for (const std::string& command :
         {"points " + path, "points " + path + " --format csv", "points " + path + " --format json --all",
          "export " + path + " --run first", "export " + path + " --run first --format csv",
          "export " + path + " --run first --format json", "orbit " + path + " first:2",
          "orbit " + path + " first:nothing", "plot " + path + " --run first --output " + (folder / "p.svg"),
          "export " + path + " --run \x1b[2J"}) {
        const Printed printed = run_graze(command);
        EXPECT_TRUE(is_plain_text(printed.out)) << command;
        EXPECT_TRUE(is_plain_text(printed.err)) << command;
        if (command.find("json") != std::string::npos) {
            EXPECT_TRUE(JsonCheck(printed.out).valid()) << printed.out;
        }
    }
}

} // namespace graze::hostile_test
