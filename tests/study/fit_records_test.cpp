#include "graze/study/fit_records.hpp"

#include "graze/model/model_file.hpp"

#include "study_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace graze::fit_records_test {

using ::testing::HasSubstr;

/// x'' = -k x from x(0) = 1 at rest, with k = 4.
StudyRun swing() {
    StudyRun run(RunKind::identify);
    run.model = parse_model("name = \"swing\"\ntime_unit = \"s\"\n[parameters]\nk = 3.9\n"
                            "[states]\nx = { initial = 1, unit = \"m\" }\nv = 0\n"
                            "[modes.swing]\nrates = { x = \"v\", v = \"-k*x\" }\n",
                            "swing");
    run.place = {"s.toml", 7, 1};
    run.identify().what = IdentifyRequest::What::fit;
    run.identify().unknowns = {{"k", "", "", "", {}}};
    for (const char* name : {"x", "v"}) {
        IdentifyRequest::Reading& reading = run.identify().readings.emplace_back();
        reading.channel = reading.value = name;
        reading.may_lack = true;
    }
    run.identify().all_known = true;
    return run;
}

KeptRecord record(const std::string& channel, const std::string& unit, double factor = 1, int rows = 60) {
    KeptRecord kept;
    kept.name = channel + ".csv";
    kept.header = {{"t", "s"}, {{channel, unit}}};
    kept.samples.clear(1);
    for (int i = 0; i < rows; ++i) {
        kept.samples.times.push_back(0.1 * i);
        kept.samples.values[0].push_back(factor * (channel == "x" ? std::cos(0.2 * i) : -2 * std::sin(0.2 * i)));
    }
    return kept;
}

std::string refusal(const StudyRun& run, const std::vector<KeptRecord>& records) {
    return testing::message_of([&] { fit_records(run, records); });
}

TEST(FitRecords, RecordsNeedNotHaveTheSameChannels) {
    const FitOfRecords found = fit_records(swing(), {record("x", "m"), record("v", "m/s")});
    ASSERT_EQ(found.fit.numbers.size(), 1U);
    EXPECT_NEAR(found.fit.numbers[0].estimate.value, 4, 1e-9); // the records are exact
    EXPECT_EQ(found.channels[1].unit, "m/s");
    EXPECT_EQ(found.task.records[1].readings.front().output, 1U);
    StudyRun strict = swing();
    strict.identify().readings.back().may_lack = false;
    EXPECT_THAT(refusal(strict, {record("x", "m")}), HasSubstr("the record has no channel 'v'"));
}

TEST(FitRecords, MotionsAreIntegratedWithTheToleranceOfTheRun) {
    const auto k_at = [](double tolerance) {
        StudyRun run = swing();
        run.identify().simulation.tolerance = tolerance;
        return fit_records(run, {record("x", "m")}).fit.numbers[0].estimate.value;
    };
    const double fine = std::abs(k_at(1e-13) - 4), coarse = std::abs(k_at(1e-4) - 4);
    EXPECT_LT(fine, 1e-11);
    EXPECT_GT(coarse, 10 * fine);
    EXPECT_LT(coarse, 1e-3);
}

TEST(FitRecords, RefusesUnitsThatDoNotAgree) {
    StudyRun run = swing();
    const std::vector<KeptRecord> millimetres{record("x", "mm", 1000)};
    EXPECT_EQ(refusal(run, millimetres),
              "s.toml:7:1: x.csv: channel 'x' is in mm, and what it measures in m; convert it in the run that has the "
              "record: scale = { x = { factor = 0.001, unit = \"m\" } }");
    run.place = {};
    EXPECT_THAT(refusal(run, {record("x", "m"), millimetres.front()}), HasSubstr("that of another record in m"));
    run.identify().readings.front().gain_unknown = true; // which converts
    EXPECT_EQ(refusal(run, millimetres), "");
    KeptRecord ticks = record("x", "m");
    ticks.header.time.unit = "ticks";
    EXPECT_THAT(refusal(run, {ticks}), HasSubstr("the unit of its time, 'ticks', is not known"));
}

TEST(FitRecords, RefusesWhatIsNoRecord) {
    EXPECT_THAT(refusal(swing(), {record("x", "m", 1, 1)}), HasSubstr("it has fewer than two rows"));
    KeptRecord hollow = record("x", "m");
    hollow.samples.values.clear();
    EXPECT_THAT(refusal(swing(), {hollow}), HasSubstr("x.csv: "));
}

} // namespace graze::fit_records_test
