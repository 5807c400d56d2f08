// Properties of all commands: help, exit codes, and one message for each mistake.

#include "run_graze.hpp"

#include <gmock/gmock.h>

namespace graze::testing::program_test {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Program, HelpHasUsageAndExamples) {
    for (const std::string line :
         {"--help", "check --help", "models --help", "simulate --help", "simulate -h", "run --help", "export --help",
          "plot --help", "points --help", "orbit --help", "info --help", "help --help", "completion --help"}) {
        const Printed run = run_graze(line);
        EXPECT_EQ(run.code, 0) << line;
        EXPECT_EQ(run.err, "") << line;
        EXPECT_THAT(run.out, HasSubstr("Usage: graze")) << line;
        EXPECT_THAT(run.out, HasSubstr("\n  graze ")) << line << ": no example";
        EXPECT_THAT(run.out, ::testing::Not(HasSubstr("contact-table"))) << line;
        for (const std::string& text : split(run.out, '\n'))
            EXPECT_LE(text.size(), 150U) << text;
    }
    EXPECT_THAT(run_graze("--version").out, StartsWith("graze 0."));
}

struct Mistake {
    std::string line, message;
};

TEST(Program, EmptyValuesAreRefused) {
    for (const std::string option : {"--time", "--mode", "--set", "--section", "--output", "--plot", "--every"})
        expect_refusal(std::vector<std::string>{"simulate", "mems-switch", option, ""},
                       option + ": its value is empty");
}

TEST(Program, NoFileIsWrittenTwiceOrReplacesTheModel) {
    const Folder folder;
    const std::string text = "states.x = 1\nmodes.m.rates.x = \"-x\"\n", model = folder.write("model.toml", text);
    const std::string same = folder / "./model.toml", picture = folder / "picture.svg";
    for (const std::string& line :
         {"check " + model + " --output " + same, "check " + model + " --format csv --output " + same,
          "simulate " + model + " --time 1 --output " + same,
          "simulate " + model + " --time 1 --plot-data " + same + " --plot " + picture,
          "simulate " + model + " --time 1 --plot " + picture + " --output " + picture,
          "simulate " + model + " --time 1 --plot " + picture + " --plot-data " + picture})
        expect_refusal(line, "choose another name");
    EXPECT_EQ(contents(model), text);
    EXPECT_FALSE(std::filesystem::exists(picture));
    EXPECT_EQ(
        run_graze("simulate " + model + " --time 1 --output /dev/null --plot-data /dev/null --plot " + picture).code,
        0);
}

class BadInput : public ::testing::TestWithParam<Mistake> {};

TEST_P(BadInput, GivesOneMessageWithARemedy) {
    expect_refusal(GetParam().line, GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    CommandLine, BadInput,
    ::testing::Values(Mistake{"", "a command is missing"}, Mistake{"simulat mems-switch", "did you mean 'simulate'?"},
                      Mistake{"simulate", "the model is missing"}, Mistake{"simulate mems-swich", "mems-switch"},
                      Mistake{"simulate no/such/file.toml", "no/such/file.toml"},
                      Mistake{"simulate mems-switch --tolerence 1e-8", "did you mean '--tolerance'?"},
                      Mistake{"simulate mems-switch --frobnicate", "unknown option '--frobnicate'"},
                      Mistake{"simulate mems-switch extra", "one argument too many"},
                      Mistake{"simulate mems-switch --format xml",
                              "--format: 'xml' is no value for it; choose table, csv or json"},
                      Mistake{"simulate mems-switch --digits 40", "--digits"}, Mistake{"check", "the model is missing"},
                      Mistake{"check bouncing-bal", "bouncing-ball"},
                      Mistake{"check mems-switch --graph modes.gif", ".svg"}));

INSTANTIATE_TEST_SUITE_P(
    Words, BadInput,
    ::testing::Values(
        Mistake{"plot x --kind portrat", "--kind: 'portrat' is no value for it; did you mean 'portrait'?"},
        Mistake{"export x --format xlsx", "--format: 'xlsx' is no value for it; choose table, csv"},
        Mistake{"run x --jobs 0", "--jobs: '0' is not a whole number from 1 to 1024"},
        Mistake{"run microactator", "there is no study 'microactator'; did you mean 'microactuator'? ("}));

INSTANTIATE_TEST_SUITE_P(
    Numbers, BadInput,
    ::testing::Values(Mistake{"simulate mems-switch --steps -1", "--steps: '-1' is not a whole number from 1"},
                      Mistake{"simulate mems-switch --steps 0", "--steps: '0' is not a whole number from 1"},
                      Mistake{"simulate mems-switch --digits -1", "--digits: '-1' is not a whole number from 1 to 17"},
                      Mistake{"simulate mems-switch --time", "--time: its value is missing; write --time T"}));

INSTANTIATE_TEST_SUITE_P(Values, BadInput,
                         ::testing::Values(Mistake{"simulate mems-switch --set omga=1", "'omega'"},
                                           Mistake{"simulate mems-switch --set V", "V=VALUE"},
                                           Mistake{"simulate mems-switch --set V=nan", "not a finite number"},
                                           Mistake{"simulate mems-switch --set V=-inf", "not a finite number"},
                                           Mistake{"simulate mems-switch --set V=1/0", "no finite value"},
                                           Mistake{"simulate mems-switch --set V=log(-1)", "no finite value"},
                                           Mistake{"simulate mems-switch --set V=2*(3", "--set V=2*(3:1:"},
                                           Mistake{"simulate mems-switch --set V=2*delt", "'delta'"},
                                           Mistake{"simulate mems-switch --set V=", "--set V="},
                                           Mistake{"simulate mems-switch --set q=1", "--from q=1"},
                                           Mistake{"simulate mems-switch --from V=1", "--set V=1"},
                                           Mistake{"simulate mems-switch --from thta=1", "'theta'"},
                                           Mistake{"simulate bouncing-ball --set omega=3", "follows from others"},
                                           Mistake{"simulate mems-switch --mode onn", "'on'"},
                                           Mistake{"simulate mems-switch --section phase", "'phase0'"},
                                           Mistake{"simulate mems-switch --contacts --event stp", "'stop'"},
                                           Mistake{"simulate mems-switch --quantity clearence", "'clearance'"},
                                           Mistake{"simulate mems-switch --quantity abs(q)", "event"},
                                           Mistake{"simulate mems-switch --derivatives omga", "'omega'"},
                                           Mistake{"simulate mems-switch --table smples", "'samples'"},
                                           Mistake{"simulate mems-switch --extrema", "--extrema"}));

INSTANTIATE_TEST_SUITE_P(Lengths, BadInput,
                         ::testing::Values(Mistake{"simulate mems-switch --time=-1", "not positive"},
                                           Mistake{"simulate mems-switch --time 0", "not positive"},
                                           Mistake{"simulate mems-switch --time inf", "finite"},
                                           Mistake{"simulate mems-switch --periods -3", "not a positive"},
                                           Mistake{"simulate mems-switch --periods 0", "not a positive"},
                                           Mistake{"simulate mems-switch --periods 2.5", "--periods"},
                                           Mistake{"simulate mems-switch --contacts 0", "not a positive"},
                                           Mistake{"simulate mems-switch --skip -1", "not a positive"},
                                           Mistake{"simulate mems-switch --time 3 --periods 2", "choose one"},
                                           Mistake{"simulate mems-switch --skip 3 --after 2", "choose one"},
                                           Mistake{"simulate mems-switch --samples 1", "2 or more"},
                                           Mistake{"simulate mems-switch --every 0", "not positive"},
                                           Mistake{"simulate mems-switch --every 1e-300", "10000000 rows"},
                                           Mistake{"simulate mems-switch --samples 9 --every 1", "choose one"},
                                           Mistake{"simulate mems-switch --phase q", "no cyclic state"},
                                           Mistake{"simulate mems-switch --tolerance 1", "tolerance"},
                                           Mistake{"simulate mems-switch --tolerance nan", "tolerance"},
                                           Mistake{"simulate mems-switch --order 99", "order"},
                                           Mistake{"simulate mems-switch --largest-step=-1", "not positive"},
                                           Mistake{"simulate mems-switch --section phase0 --extrema q", "--table"},
                                           Mistake{"simulate mems-switch --table extrema", "--extrema"},
                                           Mistake{"simulate mems-switch --portrait q,v", "--plot"},
                                           Mistake{"simulate mems-switch --plot a.jpg", ".svg"}));

INSTANTIATE_TEST_SUITE_P(Models, BadInput,
                         ::testing::Values(Mistake{"models nonsense", "no shipped model"},
                                           Mistake{"models --show", "name is missing"},
                                           Mistake{"models mems-switch --beam-modes 2", "microbeam"},
                                           Mistake{"models microbeam --beam-modes 0", "number of modes"},
                                           Mistake{"models microbeam --quadrature gaus", "'gauss'"}));

INSTANTIATE_TEST_SUITE_P(
    Contradictions, BadInput,
    ::testing::Values(Mistake{"simulate mems-switch --set V=1 --set V=2", "'V' is given twice"},
                      Mistake{"simulate mems-switch --set V=1,V=1", "'V' is given twice"},
                      Mistake{"simulate mems-switch --from q=0 v=0 q=0", "'q' is given twice"},
                      Mistake{"simulate mems-switch --samples 9 --contacts", "--samples"},
                      Mistake{"simulate mems-switch --samples 9 --table minima", "--samples has no effect"},
                      Mistake{"simulate mems-switch --every 1 --section phase0", "--every"},
                      Mistake{"simulate mems-switch --event stop", "--event has no effect"},
                      Mistake{"simulate mems-switch --event stop --table extrema --extrema q", "--event has no effect"},
                      Mistake{"simulate mems-switch --derivatives V --table samples", "--derivatives has no effect"},
                      Mistake{"export x --sql Q --run r", "--run has no effect beside --sql"},
                      Mistake{"export x --sql Q --what points", "--what has no effect beside --sql"},
                      Mistake{"export x --what runs --label GR", "--label has no effect beside --what runs"},
                      Mistake{"export x --format hdf5 --label GR --output y", "--label has no effect"},
                      Mistake{"run mems-switch --list", "STUDY has no effect beside --list"},
                      Mistake{"run mems-switch --show --only trip", "--only has no effect beside --show"},
                      Mistake{"orbit x GR1 --plot y.svg --samples 7", "--samples has no effect beside --plot"},
                      Mistake{"orbit x GR1 --data y", "--data has no effect without --plot"},
                      Mistake{"plot x --kind branch --fit 1:2", "choose --kind regression"},
                      Mistake{"plot x --kind basin --point GR1", "choose --kind history or portrait"},
                      Mistake{"models mems-switch --show --format json", "--format has no effect"}));

TEST(Program, FullDeviceIsReported) {
    std::ofstream full("/dev/full");
    if (!full)
        GTEST_SKIP() << "no /dev/full";
    std::ostringstream err;
    const std::vector<std::string> arguments{"models"};
    EXPECT_EQ(run_program(arguments, {full, err, false}), exit_bad_input);
    EXPECT_THAT(err.str(), HasSubstr("standard output"));
}

} // namespace graze::testing::program_test
