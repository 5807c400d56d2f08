#include "graze/record/low_pass.hpp"

#include "graze/base/input_error.hpp"
#include "graze/record/harmonic.hpp"
#include "record/waves.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace graze::testing::low_pass_test {

constexpr double turn = 2 * std::numbers::pi;

Samples filtered(const LowPassSettings& settings, const std::function<double(double)>& wave, std::size_t part = 1000) {
    StoredSamples source(named({"q"}), sampled(1000, 20'000, {wave}), part);
    LowPass filter(borrowed(source), settings);
    return read_all(filter, 1'000'000);
}

TEST(LowPass, PassesThePassBandAndStopsTheStopBand) {
    for (const double attenuation : {40.0, 80.0, 120.0}) {
        const LowPassSettings settings{50, 70, attenuation, 1};
        const double most = std::pow(10, -attenuation / 20);
        for (const double f : {1.0, 30.0, 50.0, 70.0, 120.0, 499.0}) {
            const Samples rest = filtered(settings, [&](double t) { return std::sin(turn * f * t + 1); });
            ASSERT_GT(rest.rows(), 19'000U);
            const Harmonic fit = fit_harmonic(rest.times, rest.values[0], turn * f);
            // Kaiser's formula for the length bounds the ripple; half as much again for rounding the length.
            EXPECT_NEAR(fit.amplitude(), f < 60 ? 1 : 0, 1.5 * most) << attenuation << ' ' << f;
            if (f < 60) {
                EXPECT_NEAR(fit.phase(), 1, 1e-9) << "without delay";
            }
        }
    }
}

TEST(LowPass, KeepsConstantsAndDropsSamples) {
    LowPassSettings settings;
    settings.every = 10;
    const Samples constant = filtered(settings, [](double) { return 3.25; });
    for (const double value : constant.values[0])
        EXPECT_NEAR(value, 3.25, 1e-13);
    // 130 Hz would be aliased to 30 Hz at 100 samples a second.
    const Samples alias = filtered(settings, [](double t) { return std::sin(turn * 130 * t); });
    for (const double value : alias.values[0])
        EXPECT_NEAR(value, 0, 1.5e-4);
    const Samples wave = filtered(settings, [](double t) { return std::sin(turn * 20 * t); });
    EXPECT_NEAR(wave.times[1] - wave.times[0], 0.01, 1e-12);
    for (std::size_t i = 0; i < wave.rows(); ++i)
        EXPECT_NEAR(wave.values[0][i], std::sin(turn * 20 * wave.times[i]), 1.5e-4);
    for (const std::size_t part : {97U, 5000U}) {
        const Samples other = filtered(
            settings, [](double t) { return std::sin(turn * 20 * t); }, part);
        EXPECT_EQ(other.times, wave.times) << "whatever comes at a time";
        EXPECT_EQ(other.values, wave.values);
    }
}

/// The bands are relative to the sampling frequency, which must be constant over the filter's length.
TEST(LowPass, RefusesUnevenClocks) {
    const auto filter_clock = [](double later, double jitter) {
        Samples samples;
        samples.clear(1);
        for (int i = 0; i < 4000; ++i) {
            samples.times.push_back(1e-3 * (i + (i > 2000 ? (later - 1) * (i - 2000) : 0) + jitter * std::sin(i * i)));
            samples.values[0].push_back(std::sin(turn * 20 * samples.times.back()));
        }
        StoredSamples source(named({"q"}), samples);
        LowPass filter(borrowed(source), {22, 33, 80, 1});
        return read_all(filter, 10'000);
    };
    EXPECT_THROW(filter_clock(1.1, 0), InputError);
    EXPECT_THROW(filter_clock(1.02, 0), InputError);
    for (const double later : {1.0, 1.0001}) {
        const Samples rest = filter_clock(later, 0.01);
        for (std::size_t i = 0; i < rest.rows(); ++i)
            EXPECT_NEAR(rest.values[0][i], std::sin(turn * 20 * rest.times[i]), 3e-3) << later;
    }
}

TEST(LowPass, RefusesInvalidSettings) {
    const auto wave = [](double t) { return t; };
    EXPECT_THROW(filtered({0, 0, 80, 1}, wave), InputError);
    EXPECT_THROW(filtered({50, 40, 80, 1}, wave), InputError);
    EXPECT_THROW(filtered({0, 40, 80, 1}, wave), InputError);
    EXPECT_THROW(filtered({50, 70, 10, 1}, wave), InputError);
    EXPECT_THROW(filtered({50, 70, 80, 0}, wave), InputError);
    EXPECT_THROW(filtered({600, 700, 80, 1}, wave), InputError) << "faster than the samples";
    EXPECT_THROW(filtered({50, 60, 80, 10}, wave), InputError) << "faster than those that are kept";
    EXPECT_THROW(filtered({50, 50.01, 80, 1}, wave), InputError) << "longer than the record";
}

} // namespace graze::testing::low_pass_test
