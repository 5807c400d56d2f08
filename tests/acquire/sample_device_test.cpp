#include "graze/acquire/sample_device.hpp"

#include "acquire/scripted_line.hpp"

#include <gmock/gmock.h>
#include <thread>

namespace graze::testing::sample_device_test {

using ::testing::HasSubstr;

/// A device of three rows; a test replaces one of its answers.
ScriptedLine device_with(const std::string& question, const std::string& answer) {
    return ScriptedLine([=](const std::string& said) -> std::string {
        if (said == question)
            return answer;
        if (said == "CHANNELS")
            return "t [s], x [V]";
        if (said == "RATE 10")
            return "OK 10";
        if (said == "READ 3")
            return "0,1\n0.1,2\n0.2,-3e-2\nEND 3";
        return "END 0";
    });
}

Samples taken(ScriptedLine& line) {
    TextSampleDevice device(borrowed(line), 0.02, {});
    device.set_rate(10);
    device.begin(3);
    Samples part, all;
    while (device.read(part))
        all.append(part);
    return all;
}

TEST(SampleDevice, ReadsRows) {
    ScriptedLine line = device_with("", "");
    const Samples samples = taken(line);
    EXPECT_EQ(samples.times, (std::vector<double>{0, 0.1, 0.2}));
    EXPECT_EQ(samples.values, (std::vector<std::vector<double>>{{1, 2, -0.03}}));
}

TEST(SampleDevice, RefusesAnswersThatViolateTheProtocol) {
    const std::vector<std::vector<std::string>> cases{
        {"CHANNELS", "", "has not answered for 0.02 s"},
        {"CHANNELS", "t", "instead of the names of its channels"},
        {"CHANNELS", "ERROR no board", "says: no board"},
        {"CHANNELS", "t [s]; x, y [V]", "instead of the names of its channels, separated by commas"},
        {"RATE 10", "OK 11", "takes 11 samples in a second instead of 10"},
        {"RATE 10", "OK ten", "says 'OK ten' instead of 'OK' and its rate"},
        {"RATE 10", "OK nan", "takes nan samples"},
        {"READ 3", "0,1\n0.1,2", "has not answered"},
        {"READ 3", "0,1\n0.1,2\nEND 2", "ends with 'END 2' after 2 of 3 samples"},
        {"READ 3", "0,1\n0.1,2\n0.2,3\n0.3,4\nEND 4", "says '0.3,4' instead of the end"},
        {"READ 3", "0,1\n0.1,2\n0.2,3\nEND 2", "ends with 'END 2' after 3 of 3 samples"},
        {"READ 3", "0,1\n0.1\n0.2,3\nEND 3", "says '0.1' instead of a row"},
        {"READ 3", "0,1\n0.1,2,3\n0.2,3\nEND 3", "a row of as many numbers as it has channels"},
        {"READ 3", "0,1\n0,2\n0.2,3\nEND 3", "gives the time 0 after 0"},
        {"READ 3", "0,1\n0.2,2\n0.4,3\nEND 3", "gives the time 0.2 to its sample at 0.1"},
        {"READ 3", "10,1\n10.1,2\n10.2,3\nEND 3", "gives the time 10 to its sample at 0"},
        {"READ 3", "0,1\n0.1,inf\n0.2,3\nEND 3", "a row of numbers"},
        {"READ 3", "0,1\n0.1,\x1b[2J\n0.2,3\nEND 3", "says '0.1,\\u001b[2J' instead of"},
        {"READ 3", "0,1\nERROR overflow", "says: overflow"},
    };
    for (const std::vector<std::string>& one : cases) {
        ScriptedLine line = device_with(one[0], one[1]);
        try {
            taken(line);
            ADD_FAILURE() << one[1];
        } catch (const InstrumentError& error) {
            EXPECT_THAT(error.what(), HasSubstr(one[2]));
        }
    }
}

/// Each row arrives in time, but all of them never end.
TEST(SampleDevice, RefusesSamplesThatTakeTooLongInAll) {
    ScriptedLine line([&](const std::string& said) {
        if (said == "READ 3")
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        return said == "READ 3" ? "0,1\n0.1,2\n0.2,3\nEND 3" : said == "CHANNELS" ? "t [s], x [V]" : "OK 10";
    });
    TextSampleDevice device(borrowed(line), 0.02, {}, 1e-12); // 20 ms for all rows
    device.set_rate(10);
    device.begin(3);
    try {
        Samples part;
        device.read(part);
        FAIL() << "it was waited for";
    } catch (const InstrumentError& error) {
        EXPECT_THAT(error.what(),
                    HasSubstr("has sent only 1 of 3 samples, which last 0.3 s, in 1e-12 times that time"));
    }
}

TEST(SampleDevice, StopsAnAcquisitionOfAnotherClient) {
    bool stopped = false;
    ScriptedLine line([&](const std::string& said) -> std::string {
        if (said == "STOP" && !stopped) {
            stopped = true;
            return "7.1,3\n7.2,4\nEND 1000\n";
        }
        return said == "CHANNELS" ? "t [s], x [V]" : "";
    });
    const TextSampleDevice device(borrowed(line), 0.02, {});
    EXPECT_EQ(device.header().channels.at(0).name, "x");
}

TEST(SampleDevice, ReportsWhetherItCanReturnToAMark) {
    ScriptedLine simulated = device_with("RETURN 7", "OK"), hardware = device_with("RETURN 7", "ERROR what?");
    EXPECT_TRUE(TextSampleDevice(borrowed(simulated), 0.02, {}).return_to(7));
    EXPECT_FALSE(TextSampleDevice(borrowed(hardware), 0.02, {}).return_to(7));
    EXPECT_FALSE(TextSampleDevice(borrowed(hardware), 0.02, {}).mark(7));
}

} // namespace graze::testing::sample_device_test
