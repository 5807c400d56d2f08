#include "graze/acquire/generator_client.hpp"

#include "acquire/arbitrary_generator.hpp"
#include "acquire/scripted_line.hpp"
#include "graze/base/input_error.hpp"
#include "instrument/function_generator.hpp"

#include <algorithm>
#include <gmock/gmock.h>

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

/// A faultless generator, of which a test alters some answers.
struct AlteredGenerator {
    FunctionGenerator generator{};
    std::function<std::string(const std::string& line, std::string answer)> alter;
    ScriptedLine line{[this](const std::string& said) {
        std::string answer = generator.execute(said);
        return alter ? alter(said, answer) : answer;
    }};
};

AcquisitionEnding ending_of(const std::function<void()>& work, std::string& what) {
    try {
        work();
    } catch (const InstrumentError& error) {
        what = error.problem();
        return error.ending();
    }
    return AcquisitionEnding::complete;
}

using testing::ArbitraryGenerator;

constexpr double infinite = std::numeric_limits<double>::infinity();

struct Arbitrary {
    ArbitraryGenerator generator;
    ScriptedLine line{[this](const std::string& said) { return generator.execute(said); }};
};

/// Expects that the output never exceeded the limits, except in the generator's initial state.
void expect_within(const ArbitraryGenerator& generator, const GeneratorOptions& options, const std::string& what) {
    constexpr double roundoff = 1e-3; // rounding of what it reports
    EXPECT_LE(generator.greatest_peaks, std::max(options.limits.amplitude, generator.first_peaks) * (1 + roundoff))
        << what;
    EXPECT_LE(generator.greatest_offset, std::max(options.limits.offset, generator.first_offset) * (1 + roundoff))
        << what;
}

} // namespace

TEST(GeneratorClient, SetsValuesAndReadsThemBack) {
    AlteredGenerator altered;
    GeneratorClient client(borrowed(altered.line), options());
    client.begin(6.1, 0.1, 0.2);
    EXPECT_EQ(altered.generator.output(), (GeneratorOutput{6.1, 0.1, 0.2}));
    EXPECT_EQ(client.set_amplitude(3.25), 3.25);
    EXPECT_EQ(client.set_frequency(7), 7);
    EXPECT_EQ(client.amplitude(), 3.25);
    std::string problem;
    EXPECT_TRUE(client.make_safe(0.1, problem));
    EXPECT_EQ(altered.generator.output(), (GeneratorOutput{7, 0.1, 0}));
}

TEST(GeneratorClient, SendsNothingBeyondItsLimits) {
    AlteredGenerator altered;
    GeneratorClient client(borrowed(altered.line), options());
    client.begin(6, 1, 0);
    altered.line.said.clear();
    for (const double amplitude : {5.01, -1.0, std::numeric_limits<double>::quiet_NaN(), 1e300})
        EXPECT_THROW(client.set_amplitude(amplitude), InputError);
    for (const double frequency : {0.4, 51.0})
        EXPECT_THROW(client.set_frequency(frequency), InputError);
    EXPECT_THROW(client.begin(6, 1, 1.5), InputError);
    EXPECT_TRUE(altered.line.said.empty());
}

TEST(GeneratorClient, NamesTheFaultOfAnAnswer) {
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
        AlteredGenerator altered;
        GeneratorOptions hasty = options();
        hasty.reopen = 0.02;
        GeneratorClient client(borrowed(altered.line), hasty);
        client.begin(6, 1, 0);
        altered.alter = [&, bad = text](const std::string& said, std::string answer) {
            return said == "VOLT?" ? bad : answer;
        };
        std::string what;
        EXPECT_EQ(ending_of([&] { client.set_amplitude(2.5); }, what), ending) << what;
        EXPECT_LT(what.size(), 300U);
        EXPECT_EQ(what.find('\x1b'), std::string::npos);
        std::string problem;
        EXPECT_FALSE(client.make_safe(0.1, problem)) << "for it cannot be told";
        EXPECT_EQ(altered.generator.output().amplitude, 0.1) << "though it is";
    }
}

TEST(GeneratorClient, RepeatsGarbledSettingsButNotRefusedOnes) {
    AlteredGenerator altered;
    GeneratorClient client(borrowed(altered.line), options());
    client.begin(6, 1, 0);
    int times = 0;
    altered.alter = [&](const std::string& said, std::string answer) {
        return said == "SYST:ERR?" && ++times < 3 ? "-113,\"Undefined header\"" : answer;
    };
    EXPECT_EQ(client.set_amplitude(2.5), 2.5);
    EXPECT_EQ(times, 3);
    altered.alter = [&](const std::string& said, std::string answer) {
        times += said == "SYST:ERR?" ? 1 : 0;
        return said == "SYST:ERR?" ? "-222,\"Data out of range\"" : answer;
    };
    times = 0;
    std::string what;
    EXPECT_EQ(ending_of([&] { client.set_amplitude(2.6); }, what), AcquisitionEnding::refused);
    EXPECT_EQ(times, 1);
    EXPECT_THAT(what, HasSubstr("refuses an amplitude 2.6 V: -222,\"Data out of range\""));
}

TEST(GeneratorClient, IdentifiesTheInstrumentBeforeItSetsAnything) {
    AlteredGenerator altered;
    GeneratorOptions other = options();
    other.identity = "AGILENT";
    GeneratorClient client(borrowed(altered.line), other);
    std::string what;
    EXPECT_EQ(ending_of([&] { client.begin(6, 1, 0); }, what), AcquisitionEnding::foreign);
    EXPECT_THAT(what, HasSubstr("the instrument on the line is 'HEWLETT-PACKARD,33120A"));
    EXPECT_EQ(altered.generator.output(), GeneratorOutput());
    // also when another process, which has not identified it yet, makes it safe
    EXPECT_FALSE(client.make_safe(0.1, what));
    EXPECT_THAT(what, HasSubstr("the instrument on the line is 'HEWLETT-PACKARD,33120A"));
    for (const std::string& said : altered.line.said)
        EXPECT_TRUE(said == "*IDN?" || said == "SYST:REM") << said;
    EXPECT_EQ(altered.line.said.front(), "*IDN?");
}

TEST(GeneratorClient, IdentifiesTheInstrumentAgainAfterReopeningTheLine) {
    AlteredGenerator altered;
    GeneratorOptions hasty = options();
    hasty.identity = "33120A";
    GeneratorClient client(borrowed(altered.line), hasty);
    client.begin(6, 1, 0);
    altered.alter = [](const std::string& said, std::string answer) { return said == "*IDN?" ? "SUPPLY" : answer; };
    altered.line.said.clear();
    altered.line.lost = true;
    std::string problem;
    EXPECT_FALSE(client.make_safe(0.1, problem));
    for (const std::string& said : altered.line.said)
        EXPECT_TRUE(said == "*IDN?" || said == "SYST:REM") << said;
}

TEST(GeneratorClient, RequiresAnAnswerToTheIdentityQuery) {
    AlteredGenerator altered;
    altered.alter = [](const std::string& said, std::string answer) { return said == "*IDN?" ? " \n" : answer; };
    GeneratorClient client(borrowed(altered.line), options());
    std::string what;
    EXPECT_EQ(ending_of([&] { client.begin(6, 1, 0); }, what), AcquisitionEnding::foreign);
}

TEST(GeneratorClient, CanBeInterruptedExceptWhileMakingSafe) {
    AlteredGenerator altered;
    GeneratorOptions interrupted = options();
    bool now = false;
    interrupted.interrupted = [&] { return now; };
    GeneratorClient client(borrowed(altered.line), interrupted);
    client.begin(6, 1, 0);
    now = true;
    std::string what, problem;
    EXPECT_EQ(ending_of([&] { client.set_amplitude(2); }, what), AcquisitionEnding::interrupted);
    EXPECT_TRUE(client.make_safe(0.1, problem)) << problem;
    EXPECT_EQ(altered.generator.output().amplitude, 0.1);
}

TEST(GeneratorClient, ReopensALostLineToBecomeSafe) {
    AlteredGenerator altered;
    GeneratorClient client(borrowed(altered.line), options());
    client.begin(6, 4, 0);
    altered.line.lost = true;
    std::string what, problem;
    EXPECT_EQ(ending_of([&] { client.set_amplitude(2); }, what), AcquisitionEnding::line_lost);
    EXPECT_TRUE(client.make_safe(0.1, problem)) << problem;
    EXPECT_EQ(altered.generator.output().amplitude, 0.1);
    altered.line.lost = true;
    altered.line.mended_by_opening = false;
    EXPECT_FALSE(client.make_safe(0.1, problem));
    EXPECT_EQ(problem, "it is cut off");
}

/// From any initial state the output is as requested, or off.
TEST(GeneratorClient, GivesTheRequestedOutputFromAnyInitialState) {
    for (unsigned seed = 0; seed < 400; ++seed) {
        const double load = seed % 3 == 0 ? infinite : 50;
        const unsigned habits = seed % 16; // none of those that are stuck
        Arbitrary arbitrary{ArbitraryGenerator(seed, habits, load)};
        GeneratorOptions given = options();
        given.limits.amplitude = 2;
        given.load = load;
        GeneratorClient client(borrowed(arbitrary.line), given);
        const std::string what = "seed " + std::to_string(seed);
        client.begin(6, 0.1, 0.3);
        EXPECT_NEAR(arbitrary.generator.peaks(), 0.1, 1e-6) << what;
        EXPECT_NEAR(arbitrary.generator.offset(), 0.3, 1e-6) << what;
        EXPECT_TRUE(arbitrary.generator.is_on()) << what;
        client.set_amplitude(2);
        EXPECT_NEAR(arbitrary.generator.peaks(), 2, 1e-6) << what;
        EXPECT_NEAR(client.amplitude(), 2, 1e-6) << what;
        expect_within(arbitrary.generator, given, what);
        std::string problem;
        EXPECT_TRUE(client.make_safe(0.1, problem)) << what;
        EXPECT_NEAR(arbitrary.generator.peaks(), 0.1, 1e-6) << what;
        EXPECT_EQ(arbitrary.generator.offset(), 0) << what;
    }
}

/// If unit, load, shape or modulation cannot be set, no level is sent.
TEST(GeneratorClient, SendsNoLevelIfASettingIsStuck) {
    std::size_t refused = 0;
    for (unsigned seed = 0; seed < 160; ++seed) {
        const unsigned stuck = 16U << (seed % 4), habits = stuck | (seed % 2 == 0 ? 13U : 4U);
        Arbitrary arbitrary{ArbitraryGenerator(seed, habits, 50)};
        GeneratorOptions given = options();
        given.limits.amplitude = 2;
        given.reopen = 0.02;
        GeneratorClient client(borrowed(arbitrary.line), given);
        std::string what, problem;
        const AcquisitionEnding ending = ending_of(
            [&] {
                client.begin(6, 0.1, 0);
                client.set_amplitude(2);
            },
            what);
        const bool safe = client.make_safe(0.1, problem);
        expect_within(arbitrary.generator, given, what);
        if (ending == AcquisitionEnding::complete) // its initial state was right
            continue;
        ++refused;
        EXPECT_EQ(ending, AcquisitionEnding::clipped) << what;
        EXPECT_THAT(what, HasSubstr("no level is sent"));
        EXPECT_FALSE(safe);
        EXPECT_TRUE(!arbitrary.generator.is_on() || (habits & ArbitraryGenerator::has_switch) == 0) << what;
    }
    EXPECT_GT(refused, 80U);
}

TEST(GeneratorClient, DetectsAUnitThatWasChangedAtThePanel) {
    for (const unsigned habits : {4U, 13U}) {
        Arbitrary arbitrary{ArbitraryGenerator(5, habits, 50)};
        GeneratorOptions given = options();
        given.limits.amplitude = 2;
        GeneratorClient client(borrowed(arbitrary.line), given);
        client.begin(6, 0.1, 0);
        arbitrary.generator.turn_to_rms(); // 0.1 V rms is more than 0.1 V peak to peak
        arbitrary.line.said.clear();
        std::string what;
        EXPECT_EQ(ending_of([&] { client.set_amplitude(2); }, what), AcquisitionEnding::clipped);
        EXPECT_THAT(what, HasSubstr("has VOLT:UNIT VRMS instead of VPP: no level is sent"));
        for (const std::string& said : arbitrary.line.said)
            EXPECT_TRUE(said.back() == '?' || said == "SYST:REM" || said == "*CLS") << said;
        EXPECT_TRUE(client.make_safe(0.1, what)) << what;
        EXPECT_LE(arbitrary.generator.peaks(), 0.1 + 1e-6);
        EXPECT_EQ(arbitrary.generator.is_on(), habits == 4U);
    }
}

/// A level that was lost on the line is not repeated to a generator that was switched off and on meanwhile.
TEST(GeneratorClient, ChecksSettingsBeforeALevelIsSentAgain) {
    for (const bool twice : {false, true}) {
        Arbitrary arbitrary{ArbitraryGenerator(5, 13U, 50)};
        bool lose = false;
        ScriptedLine line{[&](const std::string& said) {
            if (lose && said == "VOLT 2") {
                lose = twice;
                arbitrary.generator.turn_to_rms();
                return std::string();
            }
            return arbitrary.generator.execute(said);
        }};
        GeneratorOptions given = options();
        given.limits.amplitude = 2;
        GeneratorClient client(borrowed(line), given);
        client.begin(6, 0.1, 0);
        lose = true;
        std::string what;
        EXPECT_EQ(ending_of([&] { client.set_amplitude(2); }, what), AcquisitionEnding::clipped);
        EXPECT_THAT(what, HasSubstr("has VOLT:UNIT VRMS instead of VPP: no level is sent"));
        expect_within(arbitrary.generator, given, what);
        EXPECT_EQ(std::count(line.said.begin(), line.said.end(), "VOLT 2"), 1);
    }
}

/// A generator that changes its amplitude when the frequency is set: nothing is output while it is switched off.
TEST(GeneratorClient, ReadsTheAmplitudeAfterSettingTheFrequency) {
    for (const bool has_switch : {true, false}) {
        const unsigned habits = ArbitraryGenerator::frequency_resets | (has_switch ? 13U : 4U);
        Arbitrary arbitrary{ArbitraryGenerator(5, habits, 50)};
        arbitrary.generator.limit = 5.001;
        GeneratorClient client(borrowed(arbitrary.line), options());
        std::string what, problem;
        EXPECT_EQ(ending_of([&] { client.begin(6, 0.1, 0); }, what), AcquisitionEnding::clipped);
        EXPECT_THAT(what, HasSubstr("gives an amplitude of 10 V instead of 0.1 V"));
        const auto& said = arbitrary.line.said;
        EXPECT_EQ(std::count(said.begin(), said.end(), "OUTP ON"), 0);
        const auto set = std::find(said.begin(), said.end(), "FREQ 6");
        ASSERT_LT(set + 2, said.end());
        EXPECT_EQ(*(set + 1), "VOLT?");
        EXPECT_EQ(arbitrary.generator.lines_beyond, has_switch ? 0U : 2U) << "FREQ and the question alone";
        EXPECT_TRUE(client.make_safe(0.1, problem)) << problem;
        EXPECT_LE(arbitrary.generator.peaks(), 0.1 + 1e-6);
    }
}

/// A generator that changes offset or frequency when a level is set: it is detected before a record.
TEST(GeneratorClient, ReadsAllOtherSettingsAfterALevel) {
    for (const bool of_offset : {true, false}) {
        Arbitrary arbitrary{ArbitraryGenerator(5, 13U, 50)};
        ScriptedLine line{[&](const std::string& said) {
            const std::string answer = arbitrary.generator.execute(said);
            if (!of_offset && said == "VOLT 2")
                arbitrary.generator.execute("FREQ 9");
            return answer;
        }};
        GeneratorClient client(borrowed(line), options());
        client.begin(6, 0.1, 0);
        if (of_offset)
            arbitrary.generator.take(ArbitraryGenerator::amplitude_shifts);
        std::string what, problem;
        EXPECT_EQ(ending_of([&] { client.set_amplitude(2); }, what), AcquisitionEnding::clipped);
        EXPECT_THAT(what, HasSubstr(of_offset ? "gives an offset of 1 V instead of 0 V"
                                              : "gives a frequency of 9 Hz instead of 6 Hz"));
        EXPECT_TRUE(client.make_safe(0.1, problem)) << problem;
        EXPECT_EQ(arbitrary.generator.offset(), 0);
        EXPECT_NEAR(arbitrary.generator.peaks(), 0.1, 1e-6);
    }
}

/// A generator that recalls another level when it is switched on: a single question separates the two switchings.
TEST(GeneratorClient, SwitchesOffALevelThatTheSwitchHasChanged) {
    Arbitrary arbitrary{ArbitraryGenerator(5, ArbitraryGenerator::switch_recalls | 13U, 50)};
    arbitrary.generator.limit = 5.001;
    GeneratorClient client(borrowed(arbitrary.line), options());
    std::string what, problem;
    EXPECT_EQ(ending_of([&] { client.begin(6, 0.1, 0); }, what), AcquisitionEnding::clipped);
    EXPECT_THAT(what, HasSubstr("gives an amplitude of 7 V instead of 0.1 V; so it was since OUTP ON"));
    const auto& said = arbitrary.line.said;
    const auto on = std::find(said.begin(), said.end(), "OUTP ON");
    ASSERT_LT(on + 2, said.end());
    EXPECT_EQ(*(on - 1), "VOLT?");
    EXPECT_EQ(*(on + 1), "VOLT?");
    EXPECT_EQ(*(on + 2), "OUTP OFF");
    EXPECT_EQ(std::count(said.begin(), said.end(), "OUTP ON"), 1);
    EXPECT_EQ(arbitrary.generator.lines_beyond, 2U);
    EXPECT_FALSE(arbitrary.generator.is_on());
    EXPECT_TRUE(client.make_safe(0.1, problem)) << problem;
    EXPECT_FALSE(arbitrary.generator.is_on());
}

/// If the unit changes with the switch, 0.1 V is more, though the number is the same.
TEST(GeneratorClient, ReadsTheUnitAfterSwitchingOn) {
    Arbitrary arbitrary{ArbitraryGenerator(5, 13U, 50)};
    ScriptedLine line{[&](const std::string& said) {
        const std::string answer = arbitrary.generator.execute(said);
        if (said == "OUTP ON")
            arbitrary.generator.turn_to_rms();
        return answer;
    }};
    GeneratorClient client(borrowed(line), options());
    std::string what;
    EXPECT_EQ(ending_of([&] { client.begin(6, 0.1, 0); }, what), AcquisitionEnding::clipped);
    EXPECT_THAT(what, HasSubstr("has VOLT:UNIT VRMS instead of VPP"));
    EXPECT_FALSE(arbitrary.generator.is_on());
}

TEST(GeneratorClient, SilencesAnOutputWhoseAmplitudeChangesWithItsFrequency) {
    for (const bool has_switch : {true, false}) {
        Arbitrary arbitrary{ArbitraryGenerator(5, has_switch ? 13U : 4U, 50)};
        GeneratorClient client(borrowed(arbitrary.line), options());
        client.begin(6, 0.1, 0);
        client.set_amplitude(4);
        client.set_frequency(7);
        arbitrary.generator.take(ArbitraryGenerator::frequency_resets);
        arbitrary.generator.limit = 5.001;
        std::string what;
        EXPECT_EQ(ending_of([&] { client.set_frequency(8); }, what), AcquisitionEnding::clipped);
        EXPECT_THAT(what, HasSubstr("gives an amplitude of 10 V instead of 4 V since its frequency was set"));
        EXPECT_EQ(arbitrary.generator.lines_beyond, 2U);
        EXPECT_LE(arbitrary.generator.peaks(), 0.1 + 1e-6);
        EXPECT_TRUE(client.make_safe(0.1, what)) << what;
        EXPECT_LE(arbitrary.generator.peaks(), 0.1 + 1e-6);
    }
}

TEST(GeneratorClient, SwitchesOnAgainAfterAGarbledAnswer) {
    Arbitrary arbitrary{ArbitraryGenerator(5, 13U, 50)};
    int asked = 0, times = 0;
    ScriptedLine line{[&](const std::string& said) {
        asked = said == "OUTP ON" ? 1 : asked;
        std::string answer = arbitrary.generator.execute(said);
        return said == "VOLT?" && asked == 1 && ++times == 1 ? "1.000000e01" : answer;
    }};
    GeneratorClient client(borrowed(line), options());
    client.begin(6, 0.1, 0);
    EXPECT_TRUE(arbitrary.generator.is_on());
    EXPECT_EQ(client.set_amplitude(2), 2);
    EXPECT_EQ(std::count(line.said.begin(), line.said.end(), "OUTP ON"), 2);
}

/// A generator whose unit is stuck cannot be made safe, but its switch works.
TEST(GeneratorClient, SwitchesOffAnOutputThatCannotBeMadeSafe) {
    for (const unsigned seed : {1U, 3U, 8U, 9U}) {
        for (const bool has_switch : {true, false}) {
            const unsigned habits = ArbitraryGenerator::modulation_is_stuck | ArbitraryGenerator::unit_is_stuck |
                                    ArbitraryGenerator::shape_is_stuck | (has_switch ? 13U : 4U);
            Arbitrary arbitrary{ArbitraryGenerator(seed, habits, 50)};
            GeneratorOptions hasty = options();
            hasty.reopen = 0.02;
            GeneratorClient client(borrowed(arbitrary.line), hasty);
            std::string problem;
            if (client.make_safe(0.1, problem))
                continue; // its initial state was right
            EXPECT_EQ(client.is_switched_off(), has_switch) << seed;
        }
    }
    Arbitrary arbitrary{ArbitraryGenerator(5, 13U, 50)};
    GeneratorClient unknown(borrowed(arbitrary.line), options());
    EXPECT_FALSE(unknown.is_switched_off());
    EXPECT_TRUE(arbitrary.line.said.empty()) << "nobody knows who is there";
}

TEST(GeneratorClient, NamesTheUnansweredQuestion) {
    AlteredGenerator altered;
    altered.alter = [](const std::string& said, std::string answer) { return said == "FUNC:SHAP?" ? "" : answer; };
    GeneratorClient client(borrowed(altered.line), options());
    std::string what;
    EXPECT_EQ(ending_of([&] { client.begin(6, 1, 0); }, what), AcquisitionEnding::no_answer);
    EXPECT_THAT(what, HasSubstr("the generator has not answered FUNC:SHAP? for 0.01 s"));
}

/// Each answer arrives after the next question: none of them shows the present settings.
TEST(GeneratorClient, DoesNotAcceptLateAnswers) {
    AlteredGenerator altered;
    bool late = false;
    std::string held;
    altered.alter = [&](const std::string&, std::string answer) {
        if (late && !answer.empty())
            std::swap(held, answer);
        return answer;
    };
    GeneratorClient client(borrowed(altered.line), options());
    client.begin(6, 1, 0);
    late = true;
    std::string what;
    EXPECT_EQ(ending_of([&] { client.amplitude(); }, what), AcquisitionEnding::garbled);
    EXPECT_THAT(what, HasSubstr("come so late that they are not those to the questions"));
    EXPECT_FALSE(client.is_switched_off());
}

TEST(GeneratorClient, MakesAPlainSineOfTheBenchGenerator) {
    AlteredGenerator altered;
    altered.generator =
        FunctionGenerator({.left_as = "VOLT:UNIT VRMS;:VOLT 1;:FUNC:SHAP SQU;:OUTP:LOAD INF;:AM:STAT ON"});
    GeneratorClient client(borrowed(altered.line), options());
    client.begin(6, 0.1, 0.2);
    client.set_amplitude(2);
    EXPECT_EQ(altered.generator.output(), (GeneratorOutput{6, 2, 0.2}));
    EXPECT_EQ(altered.generator.execute("VOLT:UNIT?;:FUNC:SHAP?;:AM:STAT?"), "VPP;SIN;0");
}

} // namespace graze
