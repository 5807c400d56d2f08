#include "graze/study/identify_records.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace graze::identify_records_test {

constexpr double gap = 4.8e-3, beta1 = 1.9e-5, beta2 = 1.6e-3, stiffness = 6000;

StudyRun coupling_run() {
    StudyRun run(RunKind::identify);
    run.identify().what = IdentifyRequest::What::coupling;
    run.identify().gap = "4.8e-3";
    run.identify().stiffness = "6000";
    return run;
}

/// Two records of six equilibria each, with displacements that are off by an alternating part of themselves.
Identification found_with(const StudyRun& run) {
    const EachRecord records = [](const auto& work) {
        for (int r = 0; r < 2; ++r) {
            Samples samples;
            samples.clear(2);
            for (int i = 1; i <= 6; ++i) {
                const double q = 1e-4 * (6 * r + i);
                samples.times.push_back(i);
                samples.values[0].push_back(q * (1 + (i % 2 == 0 ? 1e-3 : -1e-3)));
                samples.values[1].push_back((gap + beta2 - q) * std::sqrt(2 * stiffness * q / beta1));
            }
            StoredSamples source({{"n", ""}, {{"q", "m"}, {"I", "A"}}}, samples);
            work("record", source);
        }
    };
    return identify_records(run, records, 2);
}

TEST(IdentifyRecords, EachRowOfSeveralRecordsMayBeAnEquilibrium) {
    StudyRun run = coupling_run();
    run.identify().each_row = true;
    const Identification found = found_with(run);
    EXPECT_EQ(found.shown.front().measured.x.size(), 12U);
    EXPECT_NEAR(found.values[0].estimate.value, beta1, 0.02 * beta1); // displacements are off by 1e-3
    run.identify().each_row = false;
    EXPECT_THROW(found_with(run), InputError); // two means are too few
}

TEST(IdentifyRecords, ErrorsOfKnownNumbersWidenTheIntervals) {
    StudyRun run = coupling_run();
    run.identify().each_row = true;
    const Identification exact = found_with(run);
    run.identify().gap_error = 1e-4;
    const Identification uncertain = found_with(run);
    EXPECT_EQ(exact.values[1].estimate.value, uncertain.values[1].estimate.value);
    // The gap and beta2 appear as their sum alone: an error of the one is one of the other.
    EXPECT_NEAR(uncertain.values[1].estimate.error, std::hypot(exact.values[1].estimate.error, 1e-4), 1e-9);
}

TEST(IdentifyRecords, FitsNeedAllRecordsAtOnce) {
    StudyRun run = coupling_run();
    run.identify().what = IdentifyRequest::What::fit;
    EXPECT_THROW(found_with(run), InputError);
}

} // namespace graze::identify_records_test
