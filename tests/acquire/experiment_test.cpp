#include "graze/acquire/experiment.hpp"

#include "acquire/bench_experiment.hpp"
#include "graze/base/input_errors.hpp"

#include <gmock/gmock.h>
#include <random>

namespace graze {
namespace {

using testing::experiment_text;
using ::testing::HasSubstr;

/// The error message for a text of which a part is replaced.
std::string message(const std::string& part, const std::string& by) {
    try {
        parse_experiment(testing::replaced(experiment_text(), part, by), "e.toml");
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

} // namespace

TEST(Experiment, HasTheLevelsOfItsSweep) {
    const Experiment experiment = parse_experiment(experiment_text(), "e.toml");
    ASSERT_EQ(experiment.levels.size(), 6U);
    const double amplitudes[] = {9.4, 9.5, 9.6, 9.6, 9.5, 9.4};
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(experiment.levels[i].amplitude, amplitudes[i]) << "without what sums leave";
        EXPECT_EQ(experiment.levels[i].direction, i < 3 ? 1 : -1);
        EXPECT_EQ(experiment.levels[i].number, i + 1);
    }
    EXPECT_EQ(experiment.samples, 500U);
    EXPECT_EQ(experiment.serial.baud, 9600U);
    EXPECT_EQ(experiment.serial.stop_bits, StopBits::two);
    EXPECT_EQ(experiment.serial.flow, FlowControl::software);
    EXPECT_EQ(experiment.serial.parity, Parity::none);
    EXPECT_EQ(experiment.record_name(experiment.levels[4]), "0005_f6100mHz_a9500mV_down.csv");
}

TEST(Experiment, MayStepTheFrequency) {
    const std::string text = testing::replaced(
        testing::replaced(experiment_text(), "{ from = 9.4, to = 9.6, step = 0.1, back = true }", "9"), "= 6.1",
        "= { from = 6, to = 7, step = 0.5, back = true }");
    const Experiment experiment = parse_experiment(text, "e.toml");
    ASSERT_EQ(experiment.levels.size(), 6U);
    EXPECT_EQ(experiment.levels[1].frequency, 6.5);
    EXPECT_EQ(experiment.levels[5].direction, -1);
    EXPECT_EQ(experiment.levels[5].leg, 0U) << "one sweep";
}

TEST(Experiment, ErrorsHavePlaceAndRemedy) {
    EXPECT_THAT(message("name = \"sweep\"", "name = \"../sweep\""), HasSubstr("e.toml:1:8: '../sweep' cannot be"));
    EXPECT_THAT(message("name = \"sweep\"", ""), HasSubstr("e.toml:1:1: the experiment has no name"));
    EXPECT_THAT(message("step = 0.1", "step = 0"), HasSubstr("e.toml:16:44: sweep.amplitude.step makes inf steps"));
    EXPECT_THAT(message("step = 0.1", "step = 0.15"), HasSubstr("do not reach 9.6 with a step of 0.15"));
    EXPECT_THAT(message("to = 9.6", "to = 10.1"),
                HasSubstr("e.toml:16:13: the amplitude 10.1 is beyond the limits, 0 to "
                          "10; nothing has been sent"));
    EXPECT_THAT(message("frequency = 6.1", "frequency = 21"),
                HasSubstr("the frequency 21 is beyond the limits, 1 to 20"));
    EXPECT_THAT(message("safe = 0.1", "safe = 11"), HasSubstr("limits.safe is 11; give from 0 to 10"));
    EXPECT_THAT(message("safe = 0.1\n", ""), HasSubstr("limits has no safe"));
    EXPECT_THAT(message("[limits]", "[limit]"), HasSubstr("the experiment has no limits"));
    EXPECT_THAT(message("[settle]", "[settling]"), HasSubstr("e.toml:17:2: unknown key 'settling'; known: name"));
    EXPECT_THAT(message("tcp:127.0.0.1:1", "tcp:here"),
                HasSubstr("'tcp:here' is not an address of a device that takes samples"));
    EXPECT_THAT(message("rate = 500", "rate = nan"), HasSubstr("samples.rate is nan"));
    EXPECT_THAT(message("rate = 500", "rate = \"fast\""), HasSubstr("samples.rate must be a number, not a string"));
    EXPECT_THAT(message("time = 1", "time = 0"), HasSubstr("a record would have 0 samples"));
    EXPECT_THAT(message("time = 0.5", "most = 3"), HasSubstr("most applies to sections"));
    EXPECT_THAT(message("time = 0.5", "reference = \"V\"\nmost = 3"), HasSubstr("settle has no tolerance"));
    EXPECT_THAT(message("timeout = 0.2", "parity = \"maybe\""), HasSubstr("give one of none, odd, even"));
    EXPECT_THAT(message("rate = 500", "rate = 500\nchannels = [\"V\", \"V\"]"), HasSubstr("'V' occurs twice"));
    EXPECT_THAT(message("step = 0.1", "step = 1e-9"), HasSubstr("give one that makes from 1 to 9999"));
    EXPECT_THAT(message("[sweep]", "[sweep"), HasSubstr("docs/experiment.md shows how an experiment is written"));
    EXPECT_THAT(message("\"33120A\"", "\" \""), HasSubstr("generator.identity is empty; give a text"));
    EXPECT_THAT(message("timeout = 0.2", "attempts = 1.5"),
                HasSubstr("generator.attempts is 1.5; give a whole number from 1 to 100"));
    EXPECT_THAT(message("timeout = 0.2", "attempts = \"a\""), HasSubstr("must be a whole number, not a string"));
    EXPECT_THAT(message("rate = 500", "rate = 500\nchannels = [\"V,I\"]"),
                HasSubstr("'V,I' is not a name of a channel"));
    EXPECT_THAT(message("rate = 500", "rate = 500\npatience = 0.5"), HasSubstr("samples.patience is 0.5"));
    const std::string falling = message("frequency = [1, 20]", "frequency = [20, 1]");
    EXPECT_THAT(falling, HasSubstr("limits.frequency goes from 20 to 1; give the smaller one first"));
    EXPECT_EQ(std::count(falling.begin(), falling.end(), ';'), 1) << falling;
    for (const char* address : {"tcp:host:4711:5", "tcp::1", "tcp:host:0", "tcp:host:70000", "serial:", "tcp:[::1:1"})
        EXPECT_THAT(message("tcp:127.0.0.1:1", address), HasSubstr("is not an address of a device that takes samples"))
            << address;
    EXPECT_THAT(message("\"none\"", "\"TCPIP0::host::INSTR\""), HasSubstr("give the port at which it takes SCPI"));
    EXPECT_THAT(message("timeout = 0.2", "timeout = 0.2\nload = \"high\""), HasSubstr("give one of infinite"));
}

TEST(Experiment, ReportsAllErrorsAtOnce) {
    try {
        parse_experiment("name = \"x\"\n[generator]\nbaud = 1\n[samples]\nrate = 0\n", "e.toml");
        FAIL();
    } catch (const InputErrors& errors) {
        EXPECT_EQ(errors.all().size(), 5U); // limits, sweep and record are missing
    }
}

TEST(Experiment, RefusesUnknownKeys) {
    std::mt19937 random(5);
    const std::string whole = experiment_text();
    for (int i = 0; i < 3000; ++i) {
        std::string text = whole;
        for (int k = 0; k < 3; ++k)
            text[random() % text.size()] = static_cast<char>(random() % 96 + 32);
        try {
            const Experiment experiment = parse_experiment(text, "e.toml");
            for (const Level& level : experiment.levels) {
                ASSERT_LE(level.amplitude, experiment.generator.limits.amplitude);
                ASSERT_LE(level.frequency, experiment.generator.limits.greatest_frequency);
                ASSERT_EQ(experiment.record_name(level).find('/'), std::string::npos);
            }
        } catch (const InputError&) {
        }
    }
}

} // namespace graze
