#include "graze/record/extremes.hpp"

#include "graze/base/input_error.hpp"
#include "graze/record/harmonic.hpp"
#include "graze/record/interpolate.hpp"
#include "record/recorded_model.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace graze::testing::extremes_test {

constexpr double turn = 2 * std::numbers::pi;

TEST(Extremes, OfASineAreFoundBetweenSamples) {
    const auto wave = [](double t) { return 2 + 3 * std::sin(turn * 5 * t); };
    StoredSamples source(named({"V", "q"}),
                         sampled(1000, 3000, {[](double t) { return std::sin(turn * 5 * t + 0.3); }, wave}));
    PeriodSplitter splitter(borrowed(source), {});
    std::size_t count = 0;
    for (Period period; splitter.next(period); ++count) {
        const Extremes found = extremes(period, 1);
        // Error of a parabola through three samples 0.031 rad apart: fourth order, 3 (0.031)^4/24/3.
        EXPECT_NEAR(found.greatest, 5, 1e-7);
        EXPECT_NEAR(found.least, -1, 1e-7);
        EXPECT_NEAR(found.peak_to_peak(), 6, 2e-7);
        EXPECT_NEAR(std::sin(turn * 5 * found.greatest_time), 1, 1e-7);
        EXPECT_NEAR(std::sin(turn * 5 * found.least_time), -1, 1e-7);
        EXPECT_NEAR(amplitude(period, 1), 3, 1e-6) << "at the period that the crossings say";
    }
    EXPECT_EQ(count, 14U);
    EXPECT_THROW(extremes(Period{}, 0), InputError);
}

TEST(Extremes, DoNotOvershootAJump) {
    // Rises by 1 in a period and then drops, as a velocity at an impact.
    const auto saw = [](double t) { return t - std::floor(t); };
    StoredSamples source(named({"V", "v"}), sampled(100, 1000,
                                                    {[](double t) { return std::sin(turn * t - 1); },
                                                     [&](double t) { return saw(t + 0.003); }}));
    PeriodSplitter splitter(borrowed(source), {});
    for (Period period; splitter.next(period);) {
        EXPECT_NEAR(extremes(period, 1).greatest, 0.993, 1e-12); // the last sample before the jump
        EXPECT_NEAR(extremes(period, 1).least, 0.003, 1e-12);
    }
}

TEST(Extremes, AgreeWithTheSimulation) {
    Model model = load_model("electromagnetic-testbed");
    const RecordedModel recorded(model, "theta", 4.0, 5000, 10'000);
    StoredSamples source(recorded.header, recorded.samples);
    const std::size_t q = recorded.header.channel("q", "test"), v = recorded.header.channel("v", "test");
    PeriodSplitter splitter(borrowed(source), {recorded.header.channel("drive", "test"), 0, 0});
    std::size_t impacts = 0;
    for (Period period; splitter.next(period);) {
        double fastest = 0; // largest speed towards the stop
        for (const auto& contact : recorded.truth.contacts())
            if (contact.contact.time > period.begin && contact.contact.time < period.end)
                fastest = std::max(fastest, contact.before[1]);
        if (fastest == 0)
            continue;
        ++impacts;
        // The displacement has a corner at the stop, which lies between two samples.
        EXPECT_NEAR(extremes(period, q).greatest, 0.001106239596, fastest * 2e-4);
        EXPECT_LE(extremes(period, v).least, -0.8 * fastest);
    }
    EXPECT_GE(impacts, 8U);
}

TEST(Interpolate, IsOfThirdOrderNextToAJump) {
    double previous = 0;
    for (const double h : {0.1, 0.05, 0.025}) {
        double worst = 0;
        const Samples wave = sampled(1 / h, 200, {[](double t) { return std::sin(t); }});
        for (double t = 1; t < 4; t += 0.013)
            worst = std::max(worst, std::abs(interpolate(wave.times, wave.values[0], t) - std::sin(t)));
        if (previous > 0) {
            EXPECT_NEAR(previous / worst, 8, 1.5);
        }
        previous = worst;
    }
    const std::vector<double> times{0, 1, 2, 3, 4, 5}, values{0, 1, 2, 13, 14, 15};
    EXPECT_NEAR(interpolate(times, values, 1.5), 1.5, 1e-15);
    EXPECT_NEAR(interpolate(times, values, 3.25), 13.25, 1e-14);
    EXPECT_EQ(interpolate(times, values, 5), 15);
    EXPECT_EQ(interpolate(times, values, 0), 0);
    EXPECT_THROW(interpolate(times, values, 5.1), InputError);
    EXPECT_THROW(interpolate(std::vector<double>{1}, std::vector<double>{1}, 1), InputError);
}

} // namespace graze::testing::extremes_test
