#include "graze/acquire/generator_client.hpp"

#include "acquire/scripted_line.hpp"
#include "graze/bench/function_generator.hpp"
#include "graze/symbolic/input_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

namespace graze {
namespace {

using ::testing::HasSubstr;
using testing::ScriptedLine;

GeneratorOptions options() {
    GeneratorOptions result;
    result.limits = {5, 1, 0.5, 50};
    result.timeout = 0.01;
    result.reopen = 0.4;
    return result;
}

/// A generator that answers as it should, but for some answers that a test has a hand in.
struct Bent {
    FunctionGenerator generator{};
    std::function<std::string(const std::string& line, std::string answer)> bend;
    ScriptedLine line{[this](const std::string& said) {
        std::string answer = generator.execute(said);
        return bend ? bend(said, answer) : answer;
    }};
};

AcquisitionEnding ending_of(const std::function<void()>& work, std::string& what) {
    try {
        work();
    } catch (const InstrumentError& error) {
        what = error.what();
        return error.ending();
    }
    return AcquisitionEnding::complete;
}

} // namespace

TEST(GeneratorClient, SetsAndAsks) {
    Bent bent;
    GeneratorClient client(bent.line, options());
    client.begin(6.1, 0.1, 0.2);
    EXPECT_EQ(bent.generator.output(), (GeneratorOutput{6.1, 0.1, 0.2}));
    EXPECT_EQ(client.set_amplitude(3.25), 3.25);
    EXPECT_EQ(client.set_frequency(7), 7);
    EXPECT_EQ(client.amplitude(), 3.25);
    std::string problem;
    EXPECT_TRUE(client.make_safe(0.1, problem));
    EXPECT_EQ(bent.generator.output(), (GeneratorOutput{7, 0.1, 0}));
}

TEST(GeneratorClient, SendsNothingBeyondItsLimits) {
    Bent bent;
    GeneratorClient client(bent.line, options());
    client.begin(6, 1, 0);
    bent.line.said.clear();
    for (const double amplitude : {5.01, -1.0, std::numeric_limits<double>::quiet_NaN(), 1e300})
        EXPECT_THROW(client.set_amplitude(amplitude), InputError);
    for (const double frequency : {0.4, 51.0})
        EXPECT_THROW(client.set_frequency(frequency), InputError);
    EXPECT_THROW(client.begin(6, 1, 1.5), InputError);
    EXPECT_TRUE(bent.line.said.empty());
}

TEST(GeneratorClient, TellsWhatIsWrongWithAnswers) {
    const std::vector<std::pair<std::string, AcquisitionEnding>> answers{
        {"", AcquisitionEnding::no_answer},
        {"rubbish", AcquisitionEnding::garbled},
        {"\x1b[31m" + std::string(60000, 'x'), AcquisitionEnding::garbled},
        {"nan", AcquisitionEnding::garbled},
        {"+1E999", AcquisitionEnding::garbled},
        {"+2.5,1", AcquisitionEnding::garbled},
        {"+4.000000E+00", AcquisitionEnding::clipped},
        {"-2.500000E+00", AcquisitionEnding::clipped},
    };
    for (const auto& [text, ending] : answers) {
        Bent bent;
        GeneratorOptions hasty = options();
        hasty.reopen = 0.02;
        GeneratorClient client(bent.line, hasty);
        client.begin(6, 1, 0);
        bent.bend = [&, bad = text](const std::string& said, std::string answer) {
            return said == "VOLT?" ? bad : answer;
        };
        std::string what;
        EXPECT_EQ(ending_of([&] { client.set_amplitude(2.5); }, what), ending) << what;
        EXPECT_LT(what.size(), 300U);
        EXPECT_EQ(what.find('\x1b'), std::string::npos);
        std::string problem;
        EXPECT_FALSE(client.make_safe(0.1, problem)) << "for it cannot be told";
        EXPECT_EQ(bent.generator.output().amplitude, 0.1) << "though it is";
    }
}

TEST(GeneratorClient, TriesAgainWhatIsGarbledAndNotWhatIsRefused) {
    Bent bent;
    GeneratorClient client(bent.line, options());
    client.begin(6, 1, 0);
    int times = 0;
    bent.bend = [&](const std::string& said, std::string answer) {
        return said == "SYST:ERR?" && ++times < 3 ? "-113,\"Undefined header\"" : answer;
    };
    EXPECT_EQ(client.set_amplitude(2.5), 2.5);
    EXPECT_EQ(times, 3);
    bent.bend = [&](const std::string& said, std::string answer) {
        times += said == "SYST:ERR?" ? 1 : 0;
        return said == "SYST:ERR?" ? "-222,\"Data out of range\"" : answer;
    };
    times = 0;
    std::string what;
    EXPECT_EQ(ending_of([&] { client.set_amplitude(2.6); }, what), AcquisitionEnding::refused);
    EXPECT_EQ(times, 1);
    EXPECT_THAT(what, HasSubstr("refuses an amplitude 2.6 V: -222,\"Data out of range\""));
}

TEST(GeneratorClient, LooksWhoIsThereBeforeItSetsAnything) {
    Bent bent;
    GeneratorOptions other = options();
    other.identity = "AGILENT";
    GeneratorClient client(bent.line, other);
    std::string what;
    EXPECT_EQ(ending_of([&] { client.begin(6, 1, 0); }, what), AcquisitionEnding::foreign);
    EXPECT_THAT(what, HasSubstr("there is 'HEWLETT-PACKARD,33120A"));
    EXPECT_EQ(bent.generator.output(), GeneratorOutput());
    EXPECT_FALSE(client.make_safe(0.1, what)); // which another process is asked for, too, that has not looked yet
    EXPECT_THAT(what, HasSubstr("there is 'HEWLETT-PACKARD,33120A"));
    for (const std::string& said : bent.line.said)
        EXPECT_TRUE(said == "*IDN?" || said == "SYST:REM") << said;
    EXPECT_EQ(bent.line.said.front(), "*IDN?");
}

TEST(GeneratorClient, LooksAgainWhoIsThereAfterALineWasOpenedAgain) {
    Bent bent;
    GeneratorOptions hasty = options();
    hasty.identity = "33120A";
    GeneratorClient client(bent.line, hasty);
    client.begin(6, 1, 0);
    bent.bend = [](const std::string& said, std::string answer) { return said == "*IDN?" ? "SUPPLY" : answer; };
    bent.line.said.clear();
    bent.line.lost = true;
    std::string problem;
    EXPECT_FALSE(client.make_safe(0.1, problem));
    for (const std::string& said : bent.line.said)
        EXPECT_TRUE(said == "*IDN?" || said == "SYST:REM") << said;
}

TEST(GeneratorClient, WantsAnAnswerWhoeverItIs) {
    Bent bent;
    bent.bend = [](const std::string& said, std::string answer) { return said == "*IDN?" ? " \n" : answer; };
    GeneratorClient client(bent.line, options());
    std::string what;
    EXPECT_EQ(ending_of([&] { client.begin(6, 1, 0); }, what), AcquisitionEnding::foreign);
}

TEST(GeneratorClient, IsInterruptedButForWhatMakesItSafe) {
    Bent bent;
    GeneratorOptions interrupted = options();
    bool now = false;
    interrupted.interrupted = [&] { return now; };
    GeneratorClient client(bent.line, interrupted);
    client.begin(6, 1, 0);
    now = true;
    std::string what, problem;
    EXPECT_EQ(ending_of([&] { client.set_amplitude(2); }, what), AcquisitionEnding::interrupted);
    EXPECT_TRUE(client.make_safe(0.1, problem)) << problem;
    EXPECT_EQ(bent.generator.output().amplitude, 0.1);
}

TEST(GeneratorClient, OpensALostLineAgainToBecomeSafe) {
    Bent bent;
    GeneratorClient client(bent.line, options());
    client.begin(6, 4, 0);
    bent.line.lost = true;
    std::string what, problem;
    EXPECT_EQ(ending_of([&] { client.set_amplitude(2); }, what), AcquisitionEnding::line_lost);
    EXPECT_TRUE(client.make_safe(0.1, problem)) << problem;
    EXPECT_EQ(bent.generator.output().amplitude, 0.1);
    bent.line.lost = true;
    bent.line.mended_by_opening = false;
    EXPECT_FALSE(client.make_safe(0.1, problem));
    EXPECT_EQ(problem, "it is cut off");
}

} // namespace graze
