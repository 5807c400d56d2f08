#include "graze/acquire/generator_client.hpp"

#include "acquire/arbitrary_generator.hpp"
#include "acquire/scripted_line.hpp"
#include "graze/base/input_error.hpp"
#include "instrument/function_generator.hpp"

#include <algorithm>
#include <gmock/gmock.h>

namespace graze::testing::generator_client_test {

using ::testing::HasSubstr;

GeneratorOptions options(double largest = 5, double reopen = 0.4) {
    return {.limits = {largest, 1, 0.5, 50}, .timeout = 0.01, .reopen = reopen};
}

/// A client of a faultless generator, of which a test alters some answers.
struct AlteredGenerator {
    explicit AlteredGenerator(const GeneratorOptions& given = options()) : client(borrowed(line), given) {}

    FunctionGenerator generator{};
    std::function<std::string(const std::string& line, std::string answer)> alter;
    ScriptedLine line{[this](const std::string& said) {
        std::string answer = generator.execute(said);
        return alter ? alter(said, answer) : answer;
    }};
    GeneratorClient client;
};

/// Expects that work ends like this, with a problem that says so. @return the problem
std::string expect_ending(AcquisitionEnding ending, const std::string& problem, const std::function<void()>& work) {
    try {
        work();
        EXPECT_EQ(ending, AcquisitionEnding::complete);
    } catch (const InstrumentError& error) {
        EXPECT_EQ(error.ending(), ending) << error.problem();
        EXPECT_THAT(error.problem(), HasSubstr(problem));
        return error.problem();
    }
    return "";
}

constexpr double infinite = std::numeric_limits<double>::infinity();

/// A client of a generator in an arbitrary state, with habits.
struct Arbitrary {
    Arbitrary(unsigned seed, unsigned habits, const GeneratorOptions& given = options())
        : generator(seed, habits, given.load), given_(given), client(borrowed(line), given) {}

    /// Expects that the output never exceeded the limits, except in the generator's initial state.
    void expect_within_limits() const {
        constexpr double roundoff = 1e-3; // rounding of what it reports
        EXPECT_LE(generator.greatest_peaks, std::max(given_.limits.amplitude, generator.first_peaks) * (1 + roundoff));
        EXPECT_LE(generator.greatest_offset, std::max(given_.limits.offset, generator.first_offset) * (1 + roundoff));
    }
    void expect_safe() {
        std::string problem;
        EXPECT_TRUE(client.make_safe(0.1, problem)) << problem;
    }
    std::ptrdiff_t times_said(const std::string& command) const {
        return std::count(line.said.begin(), line.said.end(), command);
    }

    ArbitraryGenerator generator;
    std::function<std::string(const std::string& said)> answer; ///< instead of the generator; empty: itself
    ScriptedLine line{[this](const std::string& said) { return answer ? answer(said) : generator.execute(said); }};
    GeneratorOptions given_;
    GeneratorClient client;
};

TEST(GeneratorClient, SetsValuesAndReadsThemBack) {
    AlteredGenerator altered;
    GeneratorClient& client = altered.client;
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
    altered.client.begin(6, 1, 0);
    altered.line.said.clear();
    for (const double amplitude : {5.01, -1.0, std::numeric_limits<double>::quiet_NaN(), 1e300})
        EXPECT_THROW(altered.client.set_amplitude(amplitude), InputError);
    for (const double frequency : {0.4, 51.0})
        EXPECT_THROW(altered.client.set_frequency(frequency), InputError);
    EXPECT_THROW(altered.client.begin(6, 1, 1.5), InputError);
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
        AlteredGenerator altered(options(5, 0.02));
        altered.client.begin(6, 1, 0);
        altered.alter = [&, bad = text](const std::string& said, std::string answer) {
            return said == "VOLT?" ? bad : answer;
        };
        const std::string what = expect_ending(ending, "", [&] { altered.client.set_amplitude(2.5); });
        EXPECT_LT(what.size(), 300U);
        EXPECT_EQ(what.find('\x1b'), std::string::npos);
        std::string problem;
        EXPECT_FALSE(altered.client.make_safe(0.1, problem)) << "for it cannot be told";
        EXPECT_EQ(altered.generator.output().amplitude, 0.1) << "though it is";
    }
}

TEST(GeneratorClient, RepeatsGarbledSettingsButNotRefusedOnes) {
    AlteredGenerator altered;
    altered.client.begin(6, 1, 0);
    int times = 0;
    altered.alter = [&](const std::string& said, std::string answer) {
        return said == "SYST:ERR?" && ++times < 3 ? "-113,\"Undefined header\"" : answer;
    };
    EXPECT_EQ(altered.client.set_amplitude(2.5), 2.5);
    EXPECT_EQ(times, 3);
    altered.alter = [&](const std::string& said, std::string answer) {
        times += said == "SYST:ERR?" ? 1 : 0;
        return said == "SYST:ERR?" ? "-222,\"Data out of range\"" : answer;
    };
    times = 0;
    expect_ending(AcquisitionEnding::refused, "refuses an amplitude 2.6 V: -222,\"Data out of range\"",
                  [&] { altered.client.set_amplitude(2.6); });
    EXPECT_EQ(times, 1);
}

TEST(GeneratorClient, IdentifiesTheInstrumentBeforeItSetsAnything) {
    GeneratorOptions other = options();
    other.identity = "AGILENT";
    AlteredGenerator altered(other);
    expect_ending(AcquisitionEnding::foreign, "the instrument on the line is 'HEWLETT-PACKARD,33120A",
                  [&] { altered.client.begin(6, 1, 0); });
    EXPECT_EQ(altered.generator.output(), GeneratorOutput());
    // also when another process, which has not identified it yet, makes it safe
    std::string what;
    EXPECT_FALSE(altered.client.make_safe(0.1, what));
    EXPECT_THAT(what, HasSubstr("the instrument on the line is 'HEWLETT-PACKARD,33120A"));
    for (const std::string& said : altered.line.said)
        EXPECT_TRUE(said == "*IDN?" || said == "SYST:REM") << said;
    EXPECT_EQ(altered.line.said.front(), "*IDN?");
}

TEST(GeneratorClient, IdentifiesTheInstrumentAgainAfterReopeningTheLine) {
    GeneratorOptions given = options();
    given.identity = "33120A";
    AlteredGenerator altered(given);
    altered.client.begin(6, 1, 0);
    altered.alter = [](const std::string& said, std::string answer) { return said == "*IDN?" ? "SUPPLY" : answer; };
    altered.line.said.clear();
    altered.line.lost = true;
    std::string problem;
    EXPECT_FALSE(altered.client.make_safe(0.1, problem));
    for (const std::string& said : altered.line.said)
        EXPECT_TRUE(said == "*IDN?" || said == "SYST:REM") << said;
}

TEST(GeneratorClient, RequiresAnAnswerToTheIdentityQuery) {
    AlteredGenerator altered;
    altered.alter = [](const std::string& said, std::string answer) { return said == "*IDN?" ? " \n" : answer; };
    expect_ending(AcquisitionEnding::foreign, "", [&] { altered.client.begin(6, 1, 0); });
}

TEST(GeneratorClient, CanBeInterruptedExceptWhileMakingSafe) {
    GeneratorOptions interrupted = options();
    bool now = false;
    interrupted.interrupted = [&] { return now; };
    AlteredGenerator altered(interrupted);
    altered.client.begin(6, 1, 0);
    now = true;
    expect_ending(AcquisitionEnding::interrupted, "", [&] { altered.client.set_amplitude(2); });
    std::string problem;
    EXPECT_TRUE(altered.client.make_safe(0.1, problem)) << problem;
    EXPECT_EQ(altered.generator.output().amplitude, 0.1);
}

TEST(GeneratorClient, ReopensALostLineToBecomeSafe) {
    AlteredGenerator altered;
    altered.client.begin(6, 4, 0);
    altered.line.lost = true;
    expect_ending(AcquisitionEnding::line_lost, "", [&] { altered.client.set_amplitude(2); });
    std::string problem;
    EXPECT_TRUE(altered.client.make_safe(0.1, problem)) << problem;
    EXPECT_EQ(altered.generator.output().amplitude, 0.1);
    altered.line.lost = true;
    altered.line.mended_by_opening = false;
    EXPECT_FALSE(altered.client.make_safe(0.1, problem));
    EXPECT_EQ(problem, "it is cut off");
}

/// From any initial state the output is as requested, or off.
TEST(GeneratorClient, GivesTheRequestedOutputFromAnyInitialState) {
    for (unsigned seed = 0; seed < 400; ++seed) {
        SCOPED_TRACE(seed);
        GeneratorOptions given = options(2);
        given.load = seed % 3 == 0 ? infinite : 50;
        Arbitrary arbitrary(seed, seed % 16, given); // none of the habits that are stuck
        const ArbitraryGenerator& generator = arbitrary.generator;
        arbitrary.client.begin(6, 0.1, 0.3);
        EXPECT_NEAR(generator.peaks(), 0.1, 1e-6);
        EXPECT_NEAR(generator.offset(), 0.3, 1e-6);
        EXPECT_TRUE(generator.is_on());
        arbitrary.client.set_amplitude(2);
        EXPECT_NEAR(generator.peaks(), 2, 1e-6);
        EXPECT_NEAR(arbitrary.client.amplitude(), 2, 1e-6);
        arbitrary.expect_within_limits();
        arbitrary.expect_safe();
        EXPECT_NEAR(generator.peaks(), 0.1, 1e-6);
        EXPECT_EQ(generator.offset(), 0);
    }
}

/// If unit, load, shape or modulation cannot be set, no level is sent.
TEST(GeneratorClient, SendsNoLevelIfASettingIsStuck) {
    std::size_t refused = 0;
    for (unsigned seed = 0; seed < 160; ++seed) {
        const unsigned stuck = 16U << (seed % 4), habits = stuck | (seed % 2 == 0 ? 13U : 4U);
        Arbitrary arbitrary(seed, habits, options(2, 0.02));
        std::string what, problem;
        try {
            arbitrary.client.begin(6, 0.1, 0);
            arbitrary.client.set_amplitude(2);
        } catch (const InstrumentError& error) {
            what = error.problem();
            EXPECT_EQ(error.ending(), AcquisitionEnding::clipped) << what;
        }
        const bool safe = arbitrary.client.make_safe(0.1, problem);
        arbitrary.expect_within_limits();
        if (what.empty()) // its initial state was right
            continue;
        ++refused;
        EXPECT_THAT(what, HasSubstr("no level is sent"));
        EXPECT_FALSE(safe);
        EXPECT_TRUE(!arbitrary.generator.is_on() || (habits & ArbitraryGenerator::has_switch) == 0) << what;
    }
    EXPECT_GT(refused, 80U);
}

TEST(GeneratorClient, DetectsAUnitThatWasChangedAtThePanel) {
    for (const unsigned habits : {4U, 13U}) {
        Arbitrary arbitrary(5, habits, options(2));
        arbitrary.client.begin(6, 0.1, 0);
        arbitrary.generator.turn_to_rms(); // 0.1 V rms is more than 0.1 V peak to peak
        arbitrary.line.said.clear();
        expect_ending(AcquisitionEnding::clipped, "has VOLT:UNIT VRMS instead of VPP: no level is sent",
                      [&] { arbitrary.client.set_amplitude(2); });
        for (const std::string& said : arbitrary.line.said)
            EXPECT_TRUE(said.back() == '?' || said == "SYST:REM" || said == "*CLS") << said;
        arbitrary.expect_safe();
        EXPECT_LE(arbitrary.generator.peaks(), 0.1 + 1e-6);
        EXPECT_EQ(arbitrary.generator.is_on(), habits == 4U);
    }
}

/// A level that was lost on the line is not repeated to a generator that was switched off and on meanwhile.
TEST(GeneratorClient, ChecksSettingsBeforeALevelIsSentAgain) {
    for (const bool twice : {false, true}) {
        Arbitrary arbitrary(5, 13U, options(2));
        bool lose = false;
        arbitrary.answer = [&](const std::string& said) {
            if (lose && said == "VOLT 2") {
                lose = twice;
                arbitrary.generator.turn_to_rms();
                return std::string();
            }
            return arbitrary.generator.execute(said);
        };
        arbitrary.client.begin(6, 0.1, 0);
        lose = true;
        expect_ending(AcquisitionEnding::clipped, "has VOLT:UNIT VRMS instead of VPP: no level is sent",
                      [&] { arbitrary.client.set_amplitude(2); });
        arbitrary.expect_within_limits();
        EXPECT_EQ(arbitrary.times_said("VOLT 2"), 1);
    }
}

/// A generator that changes its amplitude when the frequency is set: nothing is output while it is switched off.
TEST(GeneratorClient, ReadsTheAmplitudeAfterSettingTheFrequency) {
    for (const bool has_switch : {true, false}) {
        Arbitrary arbitrary(5, ArbitraryGenerator::frequency_resets | (has_switch ? 13U : 4U));
        arbitrary.generator.limit = 5.001;
        expect_ending(AcquisitionEnding::clipped, "gives an amplitude of 10 V instead of 0.1 V",
                      [&] { arbitrary.client.begin(6, 0.1, 0); });
        const auto& said = arbitrary.line.said;
        EXPECT_EQ(arbitrary.times_said("OUTP ON"), 0);
        const auto set = std::find(said.begin(), said.end(), "FREQ 6");
        ASSERT_LT(set + 2, said.end());
        EXPECT_EQ(*(set + 1), "VOLT?");
        EXPECT_EQ(arbitrary.generator.lines_beyond, has_switch ? 0U : 2U) << "FREQ and the question alone";
        arbitrary.expect_safe();
        EXPECT_LE(arbitrary.generator.peaks(), 0.1 + 1e-6);
    }
}

/// A generator that changes offset or frequency when a level is set: it is detected before a record.
TEST(GeneratorClient, ReadsAllOtherSettingsAfterALevel) {
    for (const bool of_offset : {true, false}) {
        Arbitrary arbitrary(5, 13U);
        arbitrary.answer = [&](const std::string& said) {
            const std::string answer = arbitrary.generator.execute(said);
            if (!of_offset && said == "VOLT 2")
                arbitrary.generator.execute("FREQ 9");
            return answer;
        };
        arbitrary.client.begin(6, 0.1, 0);
        if (of_offset)
            arbitrary.generator.take(ArbitraryGenerator::amplitude_shifts);
        expect_ending(AcquisitionEnding::clipped,
                      of_offset ? "gives an offset of 1 V instead of 0 V" : "gives a frequency of 9 Hz instead of 6 Hz",
                      [&] { arbitrary.client.set_amplitude(2); });
        arbitrary.expect_safe();
        EXPECT_EQ(arbitrary.generator.offset(), 0);
        EXPECT_NEAR(arbitrary.generator.peaks(), 0.1, 1e-6);
    }
}

/// A generator that recalls another level when it is switched on: a single question separates the two switchings.
TEST(GeneratorClient, SwitchesOffALevelThatTheSwitchHasChanged) {
    Arbitrary arbitrary(5, ArbitraryGenerator::switch_recalls | 13U);
    arbitrary.generator.limit = 5.001;
    expect_ending(AcquisitionEnding::clipped, "gives an amplitude of 7 V instead of 0.1 V; so it was since OUTP ON",
                  [&] { arbitrary.client.begin(6, 0.1, 0); });
    const auto& said = arbitrary.line.said;
    const auto on = std::find(said.begin(), said.end(), "OUTP ON");
    ASSERT_LT(on + 2, said.end());
    EXPECT_EQ(*(on - 1), "VOLT?");
    EXPECT_EQ(*(on + 1), "VOLT?");
    EXPECT_EQ(*(on + 2), "OUTP OFF");
    EXPECT_EQ(arbitrary.times_said("OUTP ON"), 1);
    EXPECT_EQ(arbitrary.generator.lines_beyond, 2U);
    EXPECT_FALSE(arbitrary.generator.is_on());
    arbitrary.expect_safe();
    EXPECT_FALSE(arbitrary.generator.is_on());
}

/// If the unit changes with the switch, 0.1 V is more, though the number is the same.
TEST(GeneratorClient, ReadsTheUnitAfterSwitchingOn) {
    Arbitrary arbitrary(5, 13U);
    arbitrary.answer = [&](const std::string& said) {
        const std::string answer = arbitrary.generator.execute(said);
        if (said == "OUTP ON")
            arbitrary.generator.turn_to_rms();
        return answer;
    };
    expect_ending(AcquisitionEnding::clipped, "has VOLT:UNIT VRMS instead of VPP",
                  [&] { arbitrary.client.begin(6, 0.1, 0); });
    EXPECT_FALSE(arbitrary.generator.is_on());
}

TEST(GeneratorClient, SilencesAnOutputWhoseAmplitudeChangesWithItsFrequency) {
    for (const bool has_switch : {true, false}) {
        Arbitrary arbitrary(5, has_switch ? 13U : 4U);
        arbitrary.client.begin(6, 0.1, 0);
        arbitrary.client.set_amplitude(4);
        arbitrary.client.set_frequency(7);
        arbitrary.generator.take(ArbitraryGenerator::frequency_resets);
        arbitrary.generator.limit = 5.001;
        expect_ending(AcquisitionEnding::clipped,
                      "gives an amplitude of 10 V instead of 4 V since its frequency was set",
                      [&] { arbitrary.client.set_frequency(8); });
        EXPECT_EQ(arbitrary.generator.lines_beyond, 2U);
        EXPECT_LE(arbitrary.generator.peaks(), 0.1 + 1e-6);
        arbitrary.expect_safe();
        EXPECT_LE(arbitrary.generator.peaks(), 0.1 + 1e-6);
    }
}

TEST(GeneratorClient, SwitchesOnAgainAfterAGarbledAnswer) {
    Arbitrary arbitrary(5, 13U);
    int asked = 0, times = 0;
    arbitrary.answer = [&](const std::string& said) {
        asked = said == "OUTP ON" ? 1 : asked;
        std::string answer = arbitrary.generator.execute(said);
        return said == "VOLT?" && asked == 1 && ++times == 1 ? "1.000000e01" : answer;
    };
    arbitrary.client.begin(6, 0.1, 0);
    EXPECT_TRUE(arbitrary.generator.is_on());
    EXPECT_EQ(arbitrary.client.set_amplitude(2), 2);
    EXPECT_EQ(arbitrary.times_said("OUTP ON"), 2);
}

/// A generator whose unit is stuck cannot be made safe, but its switch works.
TEST(GeneratorClient, SwitchesOffAnOutputThatCannotBeMadeSafe) {
    for (const unsigned seed : {1U, 3U, 8U, 9U})
        for (const bool has_switch : {true, false}) {
            const unsigned habits = ArbitraryGenerator::modulation_is_stuck | ArbitraryGenerator::unit_is_stuck |
                                    ArbitraryGenerator::shape_is_stuck | (has_switch ? 13U : 4U);
            Arbitrary arbitrary(seed, habits, options(5, 0.02));
            std::string problem;
            if (arbitrary.client.make_safe(0.1, problem))
                continue; // its initial state was right
            EXPECT_EQ(arbitrary.client.is_switched_off(), has_switch) << seed;
        }
    Arbitrary unknown(5, 13U);
    EXPECT_FALSE(unknown.client.is_switched_off());
    EXPECT_TRUE(unknown.line.said.empty()) << "nobody knows who is there";
}

TEST(GeneratorClient, NamesTheUnansweredQuestion) {
    AlteredGenerator altered;
    altered.alter = [](const std::string& said, std::string answer) { return said == "FUNC:SHAP?" ? "" : answer; };
    expect_ending(AcquisitionEnding::no_answer, "the generator has not answered FUNC:SHAP? for 0.01 s",
                  [&] { altered.client.begin(6, 1, 0); });
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
    altered.client.begin(6, 1, 0);
    late = true;
    expect_ending(AcquisitionEnding::garbled, "come so late that they are not those to the questions",
                  [&] { altered.client.amplitude(); });
    EXPECT_FALSE(altered.client.is_switched_off());
}

TEST(GeneratorClient, MakesAPlainSineOfTheBenchGenerator) {
    AlteredGenerator altered;
    altered.generator =
        FunctionGenerator({.left_as = "VOLT:UNIT VRMS;:VOLT 1;:FUNC:SHAP SQU;:OUTP:LOAD INF;:AM:STAT ON"});
    altered.client.begin(6, 0.1, 0.2);
    altered.client.set_amplitude(2);
    EXPECT_EQ(altered.generator.output(), (GeneratorOutput{6, 2, 0.2}));
    EXPECT_EQ(altered.generator.execute("VOLT:UNIT?;:FUNC:SHAP?;:AM:STAT?"), "VPP;SIN;0");
}

} // namespace graze::testing::generator_client_test
