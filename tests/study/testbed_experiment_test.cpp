// The loop is closed: a bench whose parameters nobody knows but by what is measured, and the model with what was found.

#include "graze/results/result_file.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/study_catalogue.hpp"

#include "study_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace graze::testbed_experiment_test {

/// Of the benches of the study: each run of kind record has those that matter to it.
std::map<std::string, double> hidden_of(const Study& study) {
    std::map<std::string, double> hidden;
    const Model& bench = study.find_run("sweep")->record().bench->model;
    for (const char* name : {"w0", "zeta", "e", "beta1", "beta2", "R", "Ll"})
        hidden[name] = bench.parameter_values()[bench.independent_parameter(name).place()];
    return hidden;
}

/// The parameters that runs of kind identify have found.
std::map<std::string, Estimate> found_in(const ResultFile& file, const std::map<std::string, double>& hidden) {
    std::map<std::string, Estimate> found;
    for (const RunRecord& run : file.runs())
        for (const EstimateRecord& number : file.estimates(run.name).numbers)
            if (hidden.contains(number.name))
                found[number.name] = number.estimate;
    return found;
}

TEST(TestbedExperimentSlow, HiddenParametersAreFoundAndPredictMeasurements) {
    const Study study = load_study("testbed-experiment");
    const auto hidden = hidden_of(study);
    testing::TemporaryFolder folder;
    ResultFile file(folder / "r.sqlite", ResultFile::Access::write);
    testing::expect_complete(run_study(study, file, {.jobs = 2}));
    const auto found = found_in(file, hidden);
    ASSERT_EQ(found.size(), hidden.size());
    for (const auto& [name, estimate] : found) {
        EXPECT_NE(hidden.at(name), study.find_run("decay")->model.parameter_values()[0]);
        EXPECT_LE(std::abs(estimate.value - hidden.at(name)), estimate.half_width()) << name;
        EXPECT_LT(estimate.error, 0.01 * estimate.value) << name; // and says something
    }
    // Measured and predicted sections, where neither has impacts: the mean over records of some 30 periods.
    const auto mean = [&](const std::string& run, const std::string& sampling, double level) {
        const auto point = file.nearest_point(run, "V0", level, std::nullopt);
        const auto stored = file.find_run(run);
        const SampleSet& samples = point->result.samples;
        std::size_t v = 0;
        while (stored->values[v].name != "v")
            ++v;
        double sum = 0, count = 0;
        for (std::size_t s = 0; s < samples.size(); ++s)
            if (stored->samplings[samples.samplings[s]] == sampling) {
                sum += samples.values[s * samples.width + v];
                ++count;
            }
        EXPECT_GT(count, 0);
        return sum / count;
    };
    // Noise is 5e-4 a reading, so 1e-4 of a mean; the velocity is 0.04, of which parameters tell one in a hundred.
    for (const double level : {4.9, 4.94, 5.0, 5.06})
        EXPECT_NEAR(mean("sweep", "rising", level), mean("predicted", "rising", level), 5e-4) << level;
}

TEST(TestbedExperimentSlow, IntervalsHoldTheHiddenValuesWhateverTheNoise) {
    Study study = load_study("testbed-experiment");
    const auto hidden = hidden_of(study);
    testing::TemporaryFolder folder;
    int inside = 0, all = 0;
    constexpr int trials = 20;
    for (std::uint64_t trial = 0; trial < trials; ++trial) {
        for (StudyRun& run : study.runs)
            if (run.kind == RunKind::record && run.record().bench)
                run.record().bench->seed += 1000;
        ResultFile file(folder / "r" + std::to_string(trial), ResultFile::Access::write);
        run_study(study, file, {.jobs = 2, .only = {"decay", "impacts", "coupling", "coil"}});
        for (const auto& [name, estimate] : found_in(file, hidden)) {
            inside += std::abs(estimate.value - hidden.at(name)) <= estimate.half_width() ? 1 : 0;
            ++all;
        }
    }
    ASSERT_EQ(all, 7 * trials);
    // 95 % of 140, less and more three standard deviations of a count: constants of one experiment are correlated, so
    // that it scatters more than a binomial one, by about the root of two.
    EXPECT_GE(inside, 133 - 11);
    EXPECT_LE(inside, 140);
}

} // namespace graze::testbed_experiment_test
