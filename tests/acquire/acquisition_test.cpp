#include "graze/acquire/acquisition.hpp"

#include "acquire/bench_experiment.hpp"
#include "graze/record/record_file.hpp"
#include "instrument/bench_lines.hpp"

#include <chrono>
#include <gmock/gmock.h>
#include <thread>

namespace graze::testing::acquisition_test {

using ::testing::HasSubstr;

AcquisitionReport run_on(ScpiBench& bench, const std::string& text, const std::string& folder,
                         const AcquisitionOptions& options = {}) {
    const Experiment experiment = parse_experiment(text, "sweep.toml");
    BenchGeneratorLine line(bench);
    BenchSampleLine samples(bench);
    TextSampleDevice device(borrowed(samples), 0.1, options.interrupted);
    RecordFolder records(folder, experiment, 0);
    return acquire(experiment, line, device, records, options);
}

TEST(Acquisition, RecordsAllLevelsAndLeavesTheOutputSafe) {
    const TemporaryFolder folder;
    ScpiBench bench(testbed_bench());
    std::size_t told = 0;
    AcquisitionOptions options;
    options.recorded = [&](const RecordEntry& entry) { EXPECT_EQ(entry.level.number, ++told); };
    const AcquisitionReport report = run_on(bench, experiment_text(), folder / "records", options);
    EXPECT_EQ(report.ending, AcquisitionEnding::complete) << report.detail;
    EXPECT_EQ(report.recorded, 6U);
    EXPECT_TRUE(report.safe);
    EXPECT_EQ(told, 6U);
    EXPECT_EQ(bench.generator().output(), (GeneratorOutput{6.1, 0.1, 0}));
    EXPECT_FALSE(bench.generator().is_remote());
    const auto files = files_of(folder / "records");
    EXPECT_EQ(files.size(), 8U);
    EXPECT_THAT(files.at("manifest.txt"), HasSubstr("\n3,0003_f6100mHz_a9600mV_up.csv,6.1,9.6,1,9.6,1,0.5,500,"));
    EXPECT_THAT(files.at("manifest.txt"), HasSubstr("\n6,0006_f6100mHz_a9400mV_down.csv,6.1,9.4,-1,9.4,1,0.5,500,"));
    const auto record = open_record(folder / "records/0003_f6100mHz_a9600mV_up.csv");
    const Samples samples = read_all(*record, 1000);
    EXPECT_EQ(samples.rows(), 500U);
    EXPECT_EQ(record->header().channels[3].unit, "m/s");
    double most = 0;
    for (const double value : samples.values[0])
        most = std::max(most, value);
    EXPECT_NEAR(most, 4.8, 1e-2); // half of the peak-to-peak amplitude
}

TEST(Acquisition, ResumesWithTheSameRecords) {
    const TemporaryFolder folder;
    ScpiBench whole(testbed_bench());
    run_on(whole, experiment_text(), folder / "whole");
    ScpiBench bench(testbed_bench());
    std::size_t runs = 0, asked = 0;
    AcquisitionReport report;
    do { // interrupted at a different point each time
        std::size_t now = 0;
        AcquisitionOptions options;
        options.interrupted = [&] { return ++now > asked; };
        asked += 400;
        try {
            report = run_on(bench, experiment_text(), folder / "parts", options);
        } catch (const InstrumentError& error) { // before anything was sent to the generator
            report.ending = error.ending();
        }
        EXPECT_TRUE(report.safe);
        EXPECT_LE(bench.generator().output().amplitude, 0.1);
    } while (report.ending == AcquisitionEnding::interrupted && ++runs < 100);
    EXPECT_EQ(report.ending, AcquisitionEnding::complete) << report.detail;
    EXPECT_GT(runs, 3U);
    EXPECT_EQ(different_files(folder / "whole", folder / "parts"), std::vector<std::string>());
    const AcquisitionReport again = run_on(bench, experiment_text(), folder / "parts");
    EXPECT_EQ(again.recorded, 0U);
    EXPECT_EQ(again.before, 6U);
}

/// Likewise for HDF5 files, which must not contain the time of writing.
TEST(Acquisition, ResumesWithTheSameRecordsInHdf5) {
    const TemporaryFolder folder;
    const std::string text = experiment_text("format = \"h5\"\n");
    ScpiBench whole(testbed_bench());
    EXPECT_EQ(run_on(whole, text, folder / "whole").ending, AcquisitionEnding::complete);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100)); // HDF5 stores times to the second
    ScpiBench bench(testbed_bench());
    for (int runs = 0; runs < 3; ++runs) {
        std::size_t recorded = 0;
        run_on(bench, text, folder / "parts",
               {.interrupted = [&] { return recorded == 2 && runs < 2; },
                .recorded = [&](const RecordEntry&) { ++recorded; }});
    }
    EXPECT_EQ(files_of(folder / "parts").size(), 8U);
    EXPECT_EQ(different_files(folder / "whole", folder / "parts"), std::vector<std::string>());
}

TEST(Acquisition, SendsNoSettingToAnotherInstrument) {
    const TemporaryFolder folder;
    ScpiBench bench(testbed_bench());
    const GeneratorOutput before = bench.generator().output();
    bool begun = false;
    const AcquisitionReport report = run_on(bench, replaced(experiment_text(), "33120A", "DS345"), folder / "records",
                                            {.begun = [&] { begun = true; }});
    EXPECT_EQ(report.ending, AcquisitionEnding::foreign);
    EXPECT_TRUE(report.safe);
    EXPECT_FALSE(begun);
    EXPECT_EQ(bench.generator().output(), before);
}

TEST(Acquisition, RepeatsEarlierLevelsOnANewBench) {
    const TemporaryFolder folder;
    ScpiBench whole(testbed_bench());
    run_on(whole, experiment_text(), folder / "whole");
    std::size_t recorded = 0;
    const AcquisitionOptions options{.interrupted = [&] { return recorded == 4; },
                                     .recorded = [&](const RecordEntry&) { ++recorded; }};
    ScpiBench first(testbed_bench()), second(testbed_bench());
    EXPECT_EQ(run_on(first, experiment_text(), folder / "parts", options).ending, AcquisitionEnding::interrupted);
    const AcquisitionReport report = run_on(second, experiment_text("[resume]\nwalk = \"whole\"\n"), folder / "parts");
    EXPECT_EQ(report.before, 4U);
    EXPECT_EQ(report.recorded, 2U);
    EXPECT_EQ(different_files(folder / "whole", folder / "parts"), std::vector<std::string>());
}

TEST(Acquisition, DetectsAGeneratorThatGivesLess) {
    const TemporaryFolder folder;
    ScpiBench bench(testbed_bench(), {.clip = 9.5});
    const AcquisitionReport report = run_on(bench, experiment_text(), folder / "records");
    EXPECT_EQ(report.ending, AcquisitionEnding::clipped);
    EXPECT_THAT(report.detail, HasSubstr("gives an amplitude of 9.5 V instead of 9.6 V"));
    EXPECT_EQ(report.recorded, 2U);
    EXPECT_TRUE(report.safe);
}

TEST(Acquisition, DetectsAnAmplitudeThatIsChangedAtThePanel) {
    const TemporaryFolder folder;
    ScpiBench bench(testbed_bench());
    AcquisitionOptions options;
    options.progress = [&](const AcquisitionProgress& progress) {
        if (progress.stage == AcquisitionStage::recording && progress.level.number == 2)
            bench.command("VOLT 3");
    };
    const AcquisitionReport report = run_on(bench, experiment_text(), folder / "records", options);
    EXPECT_EQ(report.ending, AcquisitionEnding::clipped);
    EXPECT_THAT(report.detail, HasSubstr("the record is not kept"));
    EXPECT_EQ(report.recorded, 1U);
    EXPECT_EQ(files_of(folder / "records").count("0002_f6100mHz_a9500mV_up.csv"), 0U);
    EXPECT_EQ(run_on(bench, experiment_text(), folder / "records").recorded, 5U);
}

TEST(Acquisition, MakesTheOutputSafeAfterAnException) {
    const TemporaryFolder folder;
    ScpiBench bench(testbed_bench());
    const AcquisitionOptions options{.recorded = [](const RecordEntry&) { throw std::runtime_error("of the caller"); }};
    EXPECT_THROW(run_on(bench, experiment_text(), folder / "records", options), std::runtime_error);
    EXPECT_EQ(bench.generator().output().amplitude, 0.1);
    EXPECT_THROW(run_on(bench, experiment_text("", "none", "tcp:a:1") + "", "/dev/null/x"), InputError);
}

TEST(Acquisition, WaitsUntilSectionsRepeat) {
    const TemporaryFolder folder;
    BenchSettings settings = testbed_bench();
    ScpiBench bench(settings);
    std::string text = experiment_text("", "none");
    text.replace(
        text.find("time = 0.5"), 10,
        "time = 0.2\nmost = 20\nreference = \"V\"\nphase = 0.25\nrepeats = 4\ntolerance = { v = 0.01, q = 2e-6 }");
    text.replace(text.find("amplitude = {"), text.find("}") - text.find("amplitude = {") + 1, "amplitude = [2, 3]");
    const AcquisitionReport report = run_on(bench, text, folder / "records");
    EXPECT_EQ(report.ending, AcquisitionEnding::complete) << report.detail;
    EXPECT_EQ(report.unsettled, 0U);
    const std::string list = contents(folder / "records/manifest.txt");
    EXPECT_THAT(list, HasSubstr("a2000mV_up.csv"));
    ScpiBench chaotic(settings); // whose sections never repeat within the tolerance
    const std::string noisy = replaced(replaced(text, "v = 0.01", "v = 1e-6"), "most = 20", "most = 2");
    const AcquisitionReport given_up = run_on(chaotic, noisy, folder / "noisy");
    EXPECT_EQ(given_up.unsettled, 2U);
    EXPECT_THAT(contents(folder / "noisy/manifest.txt"), HasSubstr(",0,2,500,"));
}

TEST(Acquisition, ChecksTheChannelsOfTheDeviceBeforeAnythingIsSent) {
    const TemporaryFolder folder;
    ScpiBench bench(testbed_bench());
    const std::string text = replaced(experiment_text(), "rate = 500", "rate = 500\nchannels = [\"V\", \"vv\"]");
    EXPECT_THROW(run_on(bench, text, folder / "records"), InputError);
    EXPECT_EQ(bench.generator().output(), GeneratorOutput());
    EXPECT_FALSE(bench.generator().is_remote());
}

} // namespace graze::testing::acquisition_test
