#include "instrument/function_generator.hpp"

#include "graze/base/input_error.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace graze::function_generator_test {

FunctionGenerator remote(const GeneratorSettings& settings = {}) {
    FunctionGenerator generator(settings);
    EXPECT_EQ(generator.execute("SYST:REM"), "");
    return generator;
}

std::string error(FunctionGenerator& generator) {
    return generator.execute("SYST:ERR?");
}

TEST(FunctionGenerator, ExecutesTheCommandsOfAnExperiment) {
    FunctionGenerator generator;
    for (const char* line : {"SYST:REM", "*CLS", "APPL:SIN 6.1, 5.5, 0", "VOLT 5.51"})
        EXPECT_EQ(generator.execute(line), "") << line;
    EXPECT_EQ(generator.output(), (GeneratorOutput{6.1, 5.51, 0}));
    EXPECT_EQ(generator.execute("VOLT?"), "+5.510000E+00");
    EXPECT_EQ(generator.execute("FREQ?"), "+6.100000000000E+00");
    EXPECT_EQ(generator.execute("APPL?"), "\"SIN +6.100000000000E+00,+5.510000E+00,+0.000000E+00\"");
    EXPECT_EQ(generator.execute("*IDN?").substr(0, 24), "HEWLETT-PACKARD,33120A,0");
    EXPECT_EQ(error(generator), "+0,\"No error\"");
}

TEST(FunctionGenerator, UnderstandsLongAndShortFormsPathsUnitsAndKeywords) {
    FunctionGenerator generator = remote();
    generator.execute("source:frequency 2.5 kHz;:sour:volt 500 mvpp");
    EXPECT_EQ(generator.output(), (GeneratorOutput{2500, 0.5, 0}));
    generator.execute("VOLTage:OFFSet 0.25;UNIT VRMS"); // the second is relative to VOLT
    EXPECT_EQ(generator.output().offset, 0.25);
    EXPECT_EQ(generator.execute("VOLT:UNIT?;:VOLT?"), "VRMS;+1.767767E-01");
    generator.execute("VOLT 1;:VOLT:UNIT VPP");
    EXPECT_DOUBLE_EQ(generator.output().amplitude, 2 * std::sqrt(2.0));
    generator.execute("APPL:SIN DEF, MAX, DEFault");
    EXPECT_EQ(generator.output(), (GeneratorOutput{1000, 10, 0}));
    generator.execute("APPL:SIN");
    EXPECT_EQ(generator.output(), GeneratorOutput());
    EXPECT_EQ(generator.execute("FREQ? MAX;:VOLT? MIN"), "+1.500000000000E+07;+5.000000E-02");
    generator.execute("FREQ 7;*RST");
    EXPECT_EQ(generator.output(), GeneratorOutput());
    EXPECT_EQ(generator.execute("*OPC?;*TST?;FUNC:SHAP?"), "1;+0;SIN");
    EXPECT_EQ(error(generator), "+0,\"No error\"");
}

TEST(FunctionGenerator, ShowsTwiceTheVoltageAtHighLoadWithTheSameOutput) {
    FunctionGenerator generator = remote();
    generator.execute("APPL:SIN 5, 2, 0.5");
    generator.execute("OUTP:LOAD INF");
    EXPECT_EQ(generator.execute("VOLT?"), "+4.000000E+00");
    EXPECT_EQ(generator.output(), (GeneratorOutput{5, 2, 0.5}));
    generator.execute("VOLT 20");
    EXPECT_EQ(generator.output().amplitude, 10);
    EXPECT_EQ(error(generator), "-221,\"Settings conflict\"") << "no room is left for the offset";
    EXPECT_EQ(generator.output().offset, 0);
}

/// By definition: root mean squares of a sine, a square and a triangle; power at 50 ohm relative to a milliwatt.
TEST(FunctionGenerator, ShowsAmplitudesInTheSelectedUnit) {
    FunctionGenerator generator = remote();
    generator.execute("VOLT 2;:VOLT:UNIT VRMS");
    EXPECT_NEAR(std::stod(generator.execute("VOLT?")), 1 / std::sqrt(2.0), 1e-6);
    generator.execute("FUNC:SHAP SQU");
    EXPECT_NEAR(std::stod(generator.execute("VOLT?")), 1, 1e-6);
    generator.execute("FUNC:SHAP TRI");
    EXPECT_NEAR(std::stod(generator.execute("VOLT?")), 1 / std::sqrt(3.0), 1e-6);
    EXPECT_EQ(generator.output().amplitude, 2);
    generator.execute("FUNC:SHAP SIN;:VOLT:UNIT DBM");
    EXPECT_NEAR(std::stod(generator.execute("VOLT?")), 10, 1e-4); // 0.5 V^2 / 50 ohm
    generator.execute("VOLT 0");
    EXPECT_NEAR(generator.output().amplitude, 2 * std::sqrt(0.1), 1e-12); // a milliwatt
    generator.execute("APPL:SIN 5, 10, 0.25");                            // an offset is in volts
    EXPECT_NEAR(generator.output().amplitude, 2, 1e-12);
    EXPECT_EQ(generator.output().offset, 0.25);
    EXPECT_EQ(error(generator), "+0,\"No error\"");
}

TEST(FunctionGenerator, StartsInTheStateThatItWasLeftIn) {
    FunctionGenerator generator({.left_as = "VOLT:UNIT VRMS;:FUNC:SHAP SQU;:VOLT 1.5;:SWE:STAT ON"});
    EXPECT_FALSE(generator.is_remote());
    EXPECT_EQ(generator.output().shape, WaveShape::square);
    EXPECT_DOUBLE_EQ(generator.output().amplitude, 3);
    EXPECT_DOUBLE_EQ(generator.output().fundamental(), 12 / std::acos(-1.0));
    EXPECT_EQ(generator.execute("SWE:STAT?;:AM:STAT?;:FUNC:SHAP?"), "1;0;SQU");
    EXPECT_THROW(FunctionGenerator({.left_as = "VOLT 300"}), InputError);
}

TEST(FunctionGenerator, ReportsErrorsInTheirOrder) {
    FunctionGenerator generator = remote();
    const GeneratorOutput before = generator.output();
    for (const char* line : {"VOLTS 3", "VOLT 11", "VOLT", "VOLT 1, 2", "VOLT x", "FREQ 5 VPP", "FUNC:SHAP SAW",
                             "OUTP?", "FREQ 2e7", "VOLT 1\x01", "VOLT nan", "VOLT 1e999"})
        EXPECT_EQ(generator.execute(line), "") << line;
    EXPECT_EQ(generator.output(), before);
    for (const int number : {-113, -222, -109, -108, -104, -131, -224, -113, -222, -101, -104, -222})
        EXPECT_EQ(std::stoi(error(generator)), number);
    EXPECT_EQ(generator.execute("*ESR?"), "+48"); // command and execution errors
    EXPECT_EQ(generator.execute("*ESR?"), "+0");
    EXPECT_EQ(error(generator), "+0,\"No error\"");
}

TEST(FunctionGenerator, RefusesSettingsBeforeItIsRemote) {
    FunctionGenerator generator;
    generator.execute("VOLT 3");
    EXPECT_EQ(generator.output(), GeneratorOutput());
    EXPECT_EQ(error(generator), "+550,\"Command not allowed in local\"");
    generator.execute("SYST:REM;LOC");
    EXPECT_FALSE(generator.is_remote());
}

TEST(FunctionGenerator, KeepsTheOldestErrorsAndReportsOverflow) {
    FunctionGenerator generator = remote();
    for (int i = 0; i < 1000; ++i)
        generator.execute("WRONG");
    ASSERT_EQ(generator.errors().size(), 20U);
    for (int i = 0; i < 19; ++i)
        EXPECT_EQ(error(generator), "-113,\"Undefined header\"");
    EXPECT_EQ(error(generator), "-350,\"Too many errors\"");
    EXPECT_EQ(error(generator), "+0,\"No error\"");
    generator.execute("WRONG");
    generator.execute("*CLS");
    EXPECT_EQ(error(generator), "+0,\"No error\"");
}

TEST(FunctionGenerator, ClipsSilentlyIfConfiguredTo) {
    FunctionGenerator generator = remote({.takes_offset = false, .clip = 4});
    generator.execute("VOLT 6");
    EXPECT_EQ(error(generator), "+0,\"No error\"");
    EXPECT_EQ(generator.execute("VOLT?"), "+4.000000E+00");
    generator.execute("VOLT:OFFS 0.1");
    EXPECT_EQ(error(generator), "-221,\"Settings conflict\"");
    EXPECT_EQ(generator.output().offset, 0);
}

TEST(FunctionGenerator, StaysWithinItsLimitsForAnyCommand) {
    FunctionGenerator generator = remote();
    std::mt19937 random(7);
    const std::string letters = "VOLTFREQAPPLSIN:;,?* 0123456789.E+-MAXmin\"\t\x80\n";
    for (int i = 0; i < 20000; ++i) {
        std::string line = i % 3 == 0 ? "VOLT " : i % 3 == 1 ? "APPL:SIN " : "";
        for (auto length = random() % 40; length > 0; --length)
            line += letters[random() % letters.size()];
        generator.execute(line);
        const GeneratorOutput& now = generator.output();
        ASSERT_TRUE(now.amplitude >= 0.05 - 1e-9 && now.amplitude <= 10 + 1e-9) << line;
        ASSERT_TRUE(std::abs(now.offset) + now.amplitude / 2 <= 5 + 1e-9) << line;
        ASSERT_TRUE(now.frequency >= 1e-4 && now.frequency <= 15e6) << line;
        ASSERT_LE(generator.errors().size(), 20U);
    }
    generator.execute("*CLS;*RST");
    generator.execute(std::string(1000, 'V'));
    EXPECT_EQ(error(generator), "+521,\"Input buffer overflow\"");
}

} // namespace graze::function_generator_test
