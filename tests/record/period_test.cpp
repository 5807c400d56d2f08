#include "graze/record/period.hpp"

#include "base/message_of.hpp"
#include "graze/base/input_error.hpp"
#include "graze/record/section.hpp"
#include "record/recorded_model.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <numbers>

namespace graze::testing::period_test {

using ::testing::HasSubstr;

constexpr double turn = 2 * std::numbers::pi;

std::vector<Period> periods_of(SampleSource& source, const PeriodSettings& settings) {
    PeriodSplitter splitter(borrowed(source), settings);
    std::vector<Period> all;
    for (Period period; splitter.next(period);)
        all.push_back(period);
    return all;
}

std::vector<double> crossings_of(const std::vector<Period>& periods) {
    std::vector<double> times;
    for (const Period& period : periods)
        times.push_back(period.begin);
    times.push_back(periods.back().end);
    return times;
}

TEST(Period, FindsTheCrossingsOfASine) {
    const double f = 6.1, start = 0.0137;
    const auto sine = [&](double t) { return 5 * std::sin(turn * f * (t - start)); };
    for (const std::size_t part : {1U, 7U, 64U, 65536U}) { // the size of parts changes nothing
        StoredSamples source(named({"V"}), sampled(1000, 10'000, {sine}), part);
        const std::vector<Period> periods = periods_of(source, {});
        ASSERT_EQ(periods.size(), 60U);
        for (std::size_t k = 0; k < periods.size(); ++k) {
            EXPECT_EQ(periods[k].number, k);
            // The error of a cubic through a sine within 0.25 rad is some 1e-6 rad.
            EXPECT_NEAR(periods[k].begin, start + static_cast<double>(k) / f, 1e-6 / (turn * f));
            EXPECT_LE(periods[k].samples.times.front(), periods[k].begin);
            EXPECT_GE(periods[k].samples.times.back(), periods[k].end);
        }
        const PeriodFit fit = fit_period(crossings_of(periods));
        EXPECT_EQ(fit.crossings, 61U);
        EXPECT_NEAR(fit.period, 1 / f, 1e-8 / f);
        EXPECT_NEAR(fit.begin, start, 1e-8);
    }
}

TEST(Period, FindsCrossingsAtSamplesAndOfAnyLevel) {
    // Each crossing is a sample that is exactly 0, where a test for a change of sign between two samples would fail.
    StoredSamples triangle(named({"V"}), sampled(1, 200, {[](double t) {
                                                     const int k = static_cast<int>(t) % 8;
                                                     return static_cast<double>(k < 4 ? k - 2 : 6 - k);
                                                 }}));
    const std::vector<Period> periods = periods_of(triangle, {0, 0, 0.5});
    ASSERT_EQ(periods.size(), 24U);
    for (std::size_t k = 0; k < periods.size(); ++k)
        EXPECT_NEAR(periods[k].begin, 2 + 8 * static_cast<double>(k), 1e-12);
    StoredSamples shifted(named({"V"}), sampled(500, 5000, {[](double t) { return 3 + std::sin(turn * 2 * t - 1); }}));
    const std::vector<Period> found = periods_of(shifted, {0, 3, 0});
    ASSERT_EQ(found.size(), 19U);
    EXPECT_NEAR(found[0].begin, 1 / (2 * turn), 1e-7);
}

TEST(Period, NoiseMakesNoCrossingsAndTheErrorsOfTheFitCoverTheTruth) {
    const double f = 6.1, sigma = 0.05;
    std::size_t within = 0;
    constexpr std::size_t trials = 200;
    for (std::size_t seed = 0; seed < trials; ++seed) {
        Noise noise(seed);
        StoredSamples source(named({"V"}), sampled(1000, 3000, {[&](double t) {
                                                       return std::sin(turn * f * t + 1) + sigma * noise.normal();
                                                   }}));
        const std::vector<Period> periods = periods_of(source, {});
        ASSERT_EQ(periods.size(), 17U);
        const PeriodFit fit = fit_period(crossings_of(periods));
        // Student's 97.5 % point for 16 degrees of freedom.
        within += std::abs(fit.period - 1 / f) < 2.1199 * fit.period_error ? 1 : 0;
        EXPECT_LT(fit.jitter, sigma / (turn * f)) << "less than one sample would have";
    }
    EXPECT_GE(within, 180U); // 190 are expected: three standard deviations less
    EXPECT_LE(within, 199U);
}

TEST(Period, AReferenceWithoutCrossingsHasNoPeriods) {
    StoredSamples source(named({"V"}), sampled(10, 100, {[](double) { return 1.0; }}));
    EXPECT_TRUE(periods_of(source, {}).empty());
    EXPECT_THROW(PeriodSplitter(borrowed(source), {1, 0, 0}), InputError);
    EXPECT_THROW(PeriodSplitter(borrowed(source), {0, 0, -1}), InputError);
    EXPECT_THROW(PeriodSplitter(borrowed(source), {0, std::nan(""), 0}), InputError);
    EXPECT_THROW(fit_period(std::vector<double>{1}), InputError);
    EXPECT_EQ(fit_period(std::vector<double>{1, 3}).period, 2);
}

TEST(RecordPeriods, CountPeriodsAndAverageTheAmplitude) {
    StoredSamples source(
        named({"V"}), sampled(100, 1050, {[](double t) { return 3 * std::sin(2 * std::numbers::pi * (t - 0.105)); }}));
    std::vector<std::size_t> numbers;
    const RecordPeriods found =
        each_period(source, {}, [&](const Period& period) { numbers.push_back(period.number); });
    ASSERT_EQ(found.count, 10U);
    EXPECT_EQ(numbers.front(), 0U);
    EXPECT_EQ(numbers.back(), 9U);
    // crossings are found by a cubic; the amplitude depends on the square of their error
    EXPECT_NEAR(found.amplitude, 3, 1e-9);
}

TEST(RecordPeriods, NameTheReferenceThatHasNoWholePeriod) {
    PeriodSettings settings;
    settings.level = 5;
    StoredSamples source(named({"V"}), sampled(100, 1050, {[](double t) { return std::sin(t); }}));
    EXPECT_THAT(message_of([&] { each_period(source, settings, [](const Period&) {}); }),
                HasSubstr("'V' does not rise through 5 twice; choose another reference or level"));
}

TEST(Section, AgreesWithSectionsOfTheSimulation) {
    Model model = load_model("electromagnetic-testbed");
    model.set_parameter("f", 7.0); // chaotic: all points differ
    model.set_parameter("V0", 4.5);
    const RecordedModel recorded(model, "theta", 2.0, 5000, 20'000, {section_probe(model, "phase0")});
    StoredSamples source(recorded.header, recorded.samples);
    const std::size_t v = recorded.header.channel("v", "test"), current = recorded.header.channel("I", "test"),
                      q = recorded.header.channel("q", "test");
    const std::vector<Period> periods = periods_of(source, {recorded.header.channel("drive", "test"), 0, 0});
    ASSERT_GE(periods.size(), 26U);
    std::size_t compared = 0;
    for (const auto& [passage, state] : recorded.truth.passages())
        for (const Period& period : periods) {
            if (std::abs(period.begin - passage.time) > 1e-3)
                continue;
            const SectionPoint point = section(period, 0);
            ++compared;
            // Third order in steps of 0.2 ms; the fastest motion has 96 rad/s.
            EXPECT_NEAR(point.time, passage.time, 1e-8);
            EXPECT_NEAR(point.values[q], state[0], 1e-9);
            EXPECT_NEAR(point.values[v], state[1], 1e-6);
            EXPECT_NEAR(point.values[current], state[2], 1e-6);
        }
    EXPECT_GE(compared, 26U);
}

TEST(Section, ImagesOfASymmetricMotionLieOnTheMotion) {
    Model model = load_model("electromagnetic-testbed"); // without impacts: symmetric under (5.11)
    model.set_parameter("V0", 4.0);
    const RecordedModel recorded(model, "theta", 10.0, 5000, 10'000);
    StoredSamples source(recorded.header, recorded.samples);
    const RecordSymmetry symmetry{{recorded.header.channel("I", "test")}, 0.5};
    for (const Period& period : periods_of(source, {recorded.header.channel("drive", "test"), 0, 0})) {
        const SectionPoint point = section(period, 0), image = image_of(section(period, 0.5), symmetry);
        EXPECT_TRUE(image.image);
        EXPECT_EQ(image.phase, 0);
        for (std::size_t c = 0; c < 3; ++c) // the transient has decayed by exp(-1.56 t)
            EXPECT_NEAR(image.values[c], point.values[c], 3e-6 * std::abs(point.values[c])) << c;
    }
    EXPECT_THROW(section(Period{}, 1.5), InputError);
    EXPECT_THROW(image_of({0, 0, 0, {1}, false}, {{1}, 0.5}), InputError);
}

} // namespace graze::testing::period_test
