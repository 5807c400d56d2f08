#include "graze/record/processed_record.hpp"

#include "base/message_of.hpp"
#include "graze/base/input_error.hpp"
#include "record/waves.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <numbers>

namespace graze::testing::processed_record_test {

/// x = t^2 and a wave with this many cycles per unit of time, for 10 units.
std::unique_ptr<SampleSource> record(double turns = 1) {
    RecordHeader header = named({"x", "w"});
    header.channels[0].unit = "mm";
    const auto square = [](double t) { return t * t; };
    const auto wave = [turns](double t) { return std::sin(2 * std::numbers::pi * turns * t); };
    return std::make_unique<StoredSamples>(header, sampled(100, 1000, {square, wave}));
}

TEST(ProcessedRecord, WithoutProcessingIsTheRecordItself) {
    ProcessedRecord processed(record(), {});
    EXPECT_EQ(processed.header().channels.size(), 2U);
    const Samples rows = read_all(processed.source(), 2000);
    ASSERT_EQ(rows.rows(), 1000U);
    EXPECT_EQ(rows.values[0][300], 9);
}

/// The derivative is taken of the scaled channel, within the selected part.
TEST(ProcessedRecord, ScalesBeforeItDifferentiates) {
    ProcessedRecord processed(
        record(), {.scales = {{"x", 3, 5, "um"}}, .begin = 2, .end = 4, .derivative = "x", .half_width = 6});
    ASSERT_EQ(processed.header().channels.size(), 4U);
    EXPECT_EQ(processed.header().channels[0].unit, "um");
    EXPECT_EQ(processed.header().channels[1].unit, "");
    EXPECT_EQ(processed.header().channels[2].name, "x_rate");
    const Samples rows = read_all(processed.source(), 2000);
    ASSERT_EQ(rows.rows(), 201U - 12U) << "rows at both ends have no neighbours";
    EXPECT_EQ(rows.times.front(), 2.06);
    EXPECT_EQ(rows.times.back(), 3.94);
    for (std::size_t i = 0; i < rows.rows(); ++i) {
        const double t = rows.times[i];
        // Values up to 53 are rounded to 1e-14, over a few samples of 0.01.
        EXPECT_NEAR(rows.values[0][i], 3 * t * t + 5, 1e-12);
        EXPECT_NEAR(rows.values[2][i], 6 * t, 1e-10);
    }
}

/// A wave of 20 cycles would be aliased to 5 if every fourth sample were kept without a filter.
TEST(ProcessedRecord, FiltersWavesThatDecimationWouldAlias) {
    for (const double turns : {2.0, 20.0}) {
        ProcessedRecord processed(record(turns), {.every = 4});
        const Samples rows = read_all(processed.source(), 2000);
        ASSERT_GT(rows.rows(), 200U);
        EXPECT_NEAR(rows.times[1] - rows.times[0], 0.04, 1e-12);
        double largest = 0;
        for (const double value : rows.values[1])
            largest = std::max(largest, std::abs(value));
        // The pass band changes by -80 dB at most; the stop band is attenuated by 80 dB.
        EXPECT_NEAR(largest, turns < 10 ? 1 : 0, turns < 10 ? 0.01 : 2e-4) << turns;
    }
}

TEST(ProcessedRecord, RefusesARecordWithoutRows) {
    RecordProcessing processing;
    processing.begin = 1e9;
    try {
        ProcessedRecord processed(record(), processing);
        Samples samples;
        processed.source().read(samples);
        ADD_FAILURE() << "it was accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.problem(), "the record has no rows");
        EXPECT_THAT(error.remedy(), ::testing::HasSubstr("let `part` leave some"));
    }
}

TEST(ProcessedRecord, RefusesUnknownChannels) {
    const auto message = [](const RecordProcessing& processing) {
        return message_of([&] { ProcessedRecord(record(), processing); });
    };
    EXPECT_THAT(message({.scales = {{"y", 2, 0, {}}}}), ::testing::HasSubstr("scale: "));
    const std::string of_derivative = message({.derivative = "y"});
    EXPECT_THAT(of_derivative, ::testing::HasSubstr("derivative: "));
    EXPECT_THAT(of_derivative, ::testing::HasSubstr("'y'"));
}

} // namespace graze::testing::processed_record_test
