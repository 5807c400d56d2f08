#include "graze/acquire/experiment.hpp"

#include "acquire/bench_experiment.hpp"
#include "base/message_of.hpp"
#include "graze/base/input_errors.hpp"

#include <array>
#include <gmock/gmock.h>
#include <random>

namespace graze::testing::experiment_test {

using ::testing::HasSubstr;

/// The error message for a text of which a part is replaced.
std::string message(const std::string& part, const std::string& by) {
    return message_of([&] { parse_experiment(replaced(experiment_text(), part, by), "e.toml"); });
}

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
    const std::string text =
        replaced(replaced(experiment_text(), "{ from = 9.4, to = 9.6, step = 0.1, back = true }", "9"), "= 6.1",
                 "= { from = 6, to = 7, step = 0.5, back = true }");
    const Experiment experiment = parse_experiment(text, "e.toml");
    ASSERT_EQ(experiment.levels.size(), 6U);
    EXPECT_EQ(experiment.levels[1].frequency, 6.5);
    EXPECT_EQ(experiment.levels[5].direction, -1);
    EXPECT_EQ(experiment.levels[5].leg, 0U) << "one sweep";
}

TEST(Experiment, ErrorsHavePlaceAndRemedy) {
    const std::vector<std::array<std::string, 3>> mistakes{
        // a part of the text, another one in its place, the message
        {"name = \"sweep\"", "name = \"../sweep\"", "e.toml:1:8: '../sweep' cannot be"},
        {"name = \"sweep\"", "", "e.toml:1:1: the experiment has no name"},
        {"step = 0.1", "step = 0", "e.toml:16:44: sweep.amplitude.step makes inf steps"},
        {"step = 0.1", "step = 0.15", "do not reach 9.6 with a step of 0.15"},
        {"to = 9.6", "to = 10.1",
         "e.toml:16:13: the amplitude 10.1 is beyond the limits, 0 to 10; nothing has been sent"},
        {"frequency = 6.1", "frequency = 21", "the frequency 21 is beyond the limits, 1 to 20"},
        {"safe = 0.1", "safe = 11", "limits.safe is 11; give from 0 to 10"},
        {"safe = 0.1\n", "", "limits has no safe"},
        {"[limits]", "[limit]", "the experiment has no limits"},
        {"[settle]", "[settling]", "e.toml:17:2: unknown key 'settling'; known: name"},
        {"tcp:127.0.0.1:1", "tcp:here", "'tcp:here' is not an address of a device that takes samples"},
        {"rate = 500", "rate = nan", "samples.rate is nan"},
        {"rate = 500", "rate = \"fast\"", "samples.rate must be a number, not a string"},
        {"time = 1", "time = 0", "a record would have 0 samples"},
        {"time = 0.5", "most = 3", "most applies to sections"},
        {"time = 0.5", "reference = \"V\"\nmost = 3", "settle has no tolerance"},
        {"timeout = 0.2", "parity = \"maybe\"", "give one of none, odd, even"},
        {"rate = 500", "rate = 500\nchannels = [\"V\", \"V\"]", "'V' occurs twice"},
        {"step = 0.1", "step = 1e-9", "give one that makes from 1 to 9999"},
        {"[sweep]", "[sweep", "docs/experiment.md shows how an experiment is written"},
        {"\"33120A\"", "\" \"", "generator.identity is empty; give a text"},
        {"timeout = 0.2", "attempts = 1.5", "generator.attempts is 1.5; give a whole number from 1 to 100"},
        {"timeout = 0.2", "attempts = \"a\"", "must be a whole number, not a string"},
        {"rate = 500", "rate = 500\nchannels = [\"V,I\"]", "'V,I' is not a name of a channel"},
        {"rate = 500", "rate = 500\npatience = 0.5", "samples.patience is 0.5"},
        {"\"none\"", "\"TCPIP0::host::INSTR\"", "give the port at which it takes SCPI"},
        {"timeout = 0.2", "timeout = 0.2\nload = \"high\"", "give one of infinite"},
    };
    for (const auto& [part, by, text] : mistakes)
        EXPECT_THAT(message(part, by), HasSubstr(text));
    const std::string falling = message("frequency = [1, 20]", "frequency = [20, 1]");
    EXPECT_THAT(falling, HasSubstr("limits.frequency goes from 20 to 1; give the smaller one first"));
    EXPECT_EQ(std::count(falling.begin(), falling.end(), ';'), 1) << falling;
    for (const char* address : {"tcp:host:4711:5", "tcp::1", "tcp:host:0", "tcp:host:70000", "serial:", "tcp:[::1:1"})
        EXPECT_THAT(message("tcp:127.0.0.1:1", address), HasSubstr("is not an address of a device that takes samples"))
            << address;
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

} // namespace graze::testing::experiment_test
