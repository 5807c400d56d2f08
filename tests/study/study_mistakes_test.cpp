// All mistakes of a study are told at once, in the order of the file, and none that only follows from another.

#include "graze/base/input_errors.hpp"
#include "graze/results/query_interruption.hpp"
#include "graze/study/study.hpp"

#include "study_fixture.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace graze::study_mistakes_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

/// "line: problem" of each mistake.
std::vector<std::string> mistakes_in(const std::string& text) {
    std::vector<std::string> found;
    const auto add = [&](const InputError& error) {
        EXPECT_EQ(error.place().file, "s.toml") << error.what();
        EXPECT_FALSE(error.remedy().empty()) << error.what();
        found.push_back(std::to_string(error.place().line) + ": " + error.problem());
    };
    try {
        parse_study(text, "s.toml");
    } catch (const InputErrors& errors) {
        for (const InputError& error : errors.all())
            add(error);
    } catch (const InputError& error) {
        add(error);
    }
    return found;
}

const std::string head = "name = \"s\"\nmodel = \"impact-oscillator\"\n";

TEST(StudyMistakes, AreReportedOfEachRunPictureAndTable) {
    EXPECT_THAT(mistakes_in(head + R"(colour = 1
[runs.a]
kind = "simulate"
time = -3
values = ["x", "y", "2*z"]
set = { omga = 2 }
[runs.b]
kind = "sweep"
vary = { omega = { from = 3, to = 2, step = 0.1 } }
cycles = 0
speed = 1
[runs.c]
kind = "continue"
along = { omga = [2, 3] }
start = { run = "d" }
[pictures.p]
kind = "histogram"
run = "a"
size = 4000
[pictures.q]
run = "e"
[tables.t]
run = "a"
columns = ["x", "x"]
)"),
                ElementsAre("3: unknown key 'colour'", "6: runs.a.time is -3, not positive", "7: unknown name 'y'",
                            "7: unknown name 'z'", HasSubstr("8: "), "11: runs.b.vary.omega goes from 3 to 2",
                            "12: runs.b.cycles is 0", "13: unknown key 'speed' in runs.b",
                            "16: the model has no parameter 'omga'", "17: the study has no run 'd'",
                            "19: pictures.p.kind cannot be 'histogram'", HasSubstr("21: a picture with a width"),
                            "22: the study has no run 'e'", "26: there is another column 'x'"));
}

TEST(StudyMistakes, OfARunAreNotRepeatedForRunsThatReferToIt) {
    EXPECT_THAT(mistakes_in(head + R"([runs.a]
kind = "sweep"
vary = { omega = [] }
sample = { s = { section = "turning" } }
[runs.b]
kind = "simulate"
time = 1
start = { run = "a", at = { omega = 2 }, direction = "up" }
[pictures.p]
run = "a"
names = { s = "at rest" }
[tables.t]
run = "a"
columns = ["x"]
samples = ["s"]
)"),
                ElementsAre(HasSubstr("5: runs.a.vary.omega is empty")));
}

TEST(StudyMistakes, OfTheModelOrItsNameAreReportedOnce) {
    const std::string runs = "[runs.a]\nkind = \"simulate\"\ntime = 1\n[runs.b]\nkind = \"simulate\"\ntime = 2\n";
    EXPECT_THAT(mistakes_in("name = \"s\"\nmodel = \"nothing\"\n" + runs), SizeIs(1));
    EXPECT_THAT(mistakes_in("name = \"s\"\nmodle = \"impact-oscillator\"\n" + runs),
                ElementsAre("2: unknown key 'modle'"));
    EXPECT_THAT(mistakes_in(head + "values = \"y\"\nset = { u = 1 }\n" + runs),
                ElementsAre("3: unknown name 'y'", HasSubstr("4: ")));
    EXPECT_THAT(mistakes_in("name = 3\nmodel = 4\n" + runs),
                ElementsAre("1: name must be a string, not a number", "2: model must be a string, not a number"));
}

TEST(StudyMistakes, AreMoreRunsThanAStudyCanHave) {
    std::string text = head;
    for (int run = 0; run <= 10'000; ++run)
        text += fmt::format("[runs.r{}]\nkind = \"simulate\"\ntime = 1\n", run);
    EXPECT_THAT(mistakes_in(text), ElementsAre(HasSubstr("more than 10000 runs")));
}

TEST(StudyMistakes, ReadingEndsWhenItIsAskedTo) {
    int asked = 0;
    const QueryInterruption interruption([&] { return ++asked > 2; });
    std::string text = head;
    for (int run = 0; run < 10; ++run)
        text += fmt::format("[runs.r{}]\nkind = \"simulate\"\ntime = 1\n", run);
    EXPECT_THAT(mistakes_in(text), ElementsAre(HasSubstr("9: the reading of the study was interrupted")));
}

TEST(StudyMistakes, OfTheTextAsSuchTellTheFormatOfStudies) {
    try {
        is_study_text("name = \n", "s.toml");
        ADD_FAILURE();
    } catch (const InputError& error) {
        EXPECT_THAT(error.remedy(), HasSubstr("docs/study-format.md"));
    }
    EXPECT_THAT(mistakes_in(head + std::string("# a\0b\n", 6)), ElementsAre("3: the text has a zero byte"));
}

TEST(StudyMistakes, OfMissingKeysAreNotReportedBesideAMisspeltKey) {
    EXPECT_THAT(mistakes_in(head + "[runs.a]\nknd = \"simulate\"\ntime = 1\n"),
                ElementsAre("4: unknown key 'knd' in runs.a"));
    EXPECT_THAT(mistakes_in(head + "[runs.a]\nkind = \"continue\"\nalogn = { omega = [2, 3] }\n"),
                ElementsAre("5: unknown key 'alogn' in runs.a"));
    EXPECT_THAT(
        mistakes_in(head + "[runs.a]\nkind = \"basin\"\ndraws = \"many\"\nvary = { x = { random = [0, 1] } }\n"),
        ElementsAre(HasSubstr("5: ")));
    EXPECT_THAT(mistakes_in("nme = \"s\"\nmodel = \"impact-oscillator\"\n[rns.a]\n"),
                ElementsAre("1: unknown key 'nme'", "3: unknown key 'rns'"));
}

TEST(StudyMistakes, OfBranchesAreReportedForEachKey) {
    EXPECT_THAT(mistakes_in(head + R"([runs.a]
kind = "continue"
along = { omga = [2, 3] }
steps = 0
stop = ["XX"]
step = { largest = -1, biggest = 2 }
monitors = { m = { maximum = "q" }, n = { minimum = "x", mean = "x" }, o = { largest = "x" } }
)"),
                ElementsAre(HasSubstr("5: the model has no parameter 'omga'"), "6: runs.a.steps is 0",
                            "7: there is no type of point 'XX'", "8: runs.a.step.largest is -1, not positive",
                            "8: unknown key 'biggest' in runs.a.step", "9: unknown name 'q'",
                            "9: runs.a.monitors.n is measured in 2 ways",
                            "9: unknown key 'largest' in runs.a.monitors.o"));
}

TEST(StudyMistakes, OfDrawsAreReportedBesideOthers) {
    EXPECT_THAT(mistakes_in(head + "[runs.a]\nkind = \"basin\"\ncycles = 0\nvary = { x = { random = [0, 1] } }\n"),
                ElementsAre("5: runs.a.cycles is 0", "6: runs.a does not say how many values to draw"));
    EXPECT_THAT(mistakes_in(head + "[runs.a]\nkind = \"basin\"\ndraws = 3\nvary = { q = { random = [0, 1] } }\n"),
                ElementsAre(HasSubstr("6: the model has no parameter or state 'q'")));
}

TEST(StudyMistakes, OfRecordsAreReportedBesideThoseOfFiles) {
    EXPECT_THAT(mistakes_in(head + "[runs.a]\nkind = \"record\"\nfiles = \"none.csv\"\nevery = 0\nkeep = -1\n"),
                ElementsAre(HasSubstr("5: "), "6: runs.a.every is 0", "7: runs.a.keep is -1"));
    EXPECT_THAT(mistakes_in(head + "[runs.a]\nkind = \"record\"\nseed = -1\nkeep = -1\n"
                                   "bench = { rate = 100, time = 1, channels = { x = \"y\" } }\n"),
                ElementsAre("5: runs.a.seed is -1", "6: runs.a.keep is -1"));
}

TEST(StudyMistakes, OfRunsThatStartFromEachOtherAreReported) {
    const std::string run = "kind = \"simulate\"\ntime = 1\n";
    EXPECT_THAT(mistakes_in(head + "[runs.a]\n" + run + "start = { run = \"b\" }\n[runs.b]\n" + run +
                            "start = { run = \"a\" }\n"),
                ElementsAre(HasSubstr("starts from itself, by way of others")));
}

TEST(StudyMistakes, AreLimitedInNumber) {
    std::string text = head;
    for (int i = 0; i < 300; ++i)
        text += "[runs.r" + std::to_string(i) + "]\nkind = \"none\"\n";
    EXPECT_EQ(mistakes_in(text).size(), Mistakes::most);
}

TEST(StudyMistakes, OfNamesThatAPictureDoesNotShowAreReported) {
    const std::string study = head + R"toml([runs.a]
kind = "sweep"
vary = { omega = [2, 3] }
values = ["x", "speed = v^2"]
sample = { lowest = { minima = "x" } }
[runs.b]
kind = "continue"
along = { omega = [2, 3] }
[pictures.p]
)toml";
    EXPECT_THAT(mistakes_in(study +
                            "run = \"a\"\nnames = { a = \"\", omega = \"\", speed = \"\", lowest = \"\", e = \"\", "
                            "impact = \"\", periodic = \"\", \"period 3, symmetric\" = \"\" }\n"),
                ElementsAre());
    EXPECT_THAT(mistakes_in(study + "run = \"b\"\nnames = { max_x = \"\", multiplier = \"\", period = \"\" }\n"),
                ElementsAre());
    EXPECT_THAT(mistakes_in(study + "run = \"b\"\nx = \"2*omega\"\nnames = { \"2*omega\" = \"\" }\n"), ElementsAre());
    EXPECT_THAT(mistakes_in(study + "run = \"a\"\nnames = { lowst = \"\", max_x = \"\", speed = \"\" }\n"),
                ElementsAre("13: pictures.p.names.lowst: the picture shows nothing of that name",
                            "13: pictures.p.names.max_x: the picture shows nothing of that name"));
    const auto refusal = [&](const std::string& names) {
        return testing::message_of([&] { parse_study(study + "run = \"a\"\nnames = " + names, "s.toml"); });
    };
    EXPECT_THAT(refusal("{ lowst = \"\" }\n"), HasSubstr("did you mean 'lowest'?"));
    EXPECT_THAT(refusal("{ zzzzzzzz = \"\" }\n"), HasSubstr("known are: a, lowest, omega, speed, x"));
}

} // namespace graze::study_mistakes_test
