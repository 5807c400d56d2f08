#include "graze/record/derivative.hpp"

#include "graze/base/input_error.hpp"
#include "record/recorded_model.hpp"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>
#include <vector>

namespace graze::testing::derivative_test {

constexpr double turn = 2 * std::numbers::pi;

/// Errors of a record's second channel, a derivative, beside those that its third one states.
struct Errors {
    double squares = 0, stated = 0, ratios = 0, within = 0, count = 0; ///< within: those below twice the stated one

    void add(const Samples& rows, const Wave& truth) {
        for (std::size_t i = 0; i < rows.rows(); ++i, ++count) {
            const double off = rows.values[1][i] - truth(rows.times[i]), error = rows.values[2][i];
            squares += off * off;
            stated += error * error;
            ratios += std::pow(off / error, 2);
            within += std::abs(off) < 2 * error ? 1 : 0;
        }
    }
    void expect_stated(double tolerance) const {
        EXPECT_NEAR(std::sqrt(squares / stated), 1, tolerance);
        // 0.95 for normal errors; the truncation error is systematic.
        EXPECT_GT(within / count, 0.85);
    }
};

TEST(Derivative, IsExactForPolynomialsOfFourthDegree) {
    const auto p = [](double t) { return 1e3 + t * (2 + t * (-3 + t * (0.5 - 0.25 * t))); };
    StoredSamples source(named({"q"}), sampled(100, 500, {p}), 123);
    WithDerivative derived(borrowed(source), {0, 6, ""});
    EXPECT_EQ(derived.header().channels[1].name, "q_rate");
    EXPECT_EQ(derived.header().channels[2].name, "q_rate_error");
    const Samples rows = read_all(derived, 1000);
    EXPECT_EQ(rows.rows(), 488U);
    for (std::size_t i = 0; i < rows.rows(); ++i) {
        const double t = rows.times[i];
        // Values of 1e3 are rounded to 1e-13, over a few samples of 0.01.
        EXPECT_NEAR(rows.values[1][i], 2 + t * (-6 + t * (1.5 - t)), 1e-10);
        EXPECT_LT(rows.values[2][i], 1e-10);
    }
}

TEST(Derivative, ErrorsHaveTheStatedSize) {
    const double f = 6.1;
    for (const double sigma : {1e-6, 1e-3, 0.05}) {
        SCOPED_TRACE(sigma);
        Noise noise(11);
        StoredSamples source(named({"q"}), sampled(1000, 20'000, {[&](double t) {
                                                       return std::sin(turn * f * t) +
                                                              0.3 * std::sin(3 * turn * f * t + 1) +
                                                              sigma * noise.normal();
                                                   }}));
        WithDerivative derived(borrowed(source), {0, 0, "v"});
        const Samples rows = read_all(derived, 100'000);
        const Wave v = [&](double t) {
            return turn * f * (std::cos(turn * f * t) + 0.9 * std::cos(3 * turn * f * t + 1));
        };
        Errors errors;
        errors.add(rows, v);
        errors.expect_stated(0.3);
        double plain = 0;
        for (std::size_t i = 1; i + 1 < rows.rows(); ++i)
            plain += std::pow((rows.values[0][i + 1] - rows.values[0][i - 1]) * 500 - v(rows.times[i]), 2);
        EXPECT_LT(std::sqrt(errors.squares), 0.25 * std::sqrt(plain)) << "differences of neighbours";
    }
}

// Over many records the mean of (error/stated error)^2 is 1. At the best width, noise and truncation both contribute.
// The mean truncation error is stated for every sample: up to a tenth too much where it dominates, and nowhere twice as
// large.
TEST(Derivative, StatedErrorsCoverTheTruthOfManyRecords) {
    for (const double f : {6.1, 40.0})
        for (const double sigma : {1e-4, 0.01, 0.1}) {
            Errors errors;
            for (std::uint64_t seed = 1; seed <= 20; ++seed) {
                Noise noise(seed);
                const double phase = turn * noise.uniform();
                const auto q = [&](double t) {
                    return std::sin(turn * f * t + phase) + 0.3 * std::sin(3 * turn * f * t + 1) +
                           sigma * noise.normal();
                };
                StoredSamples source(named({"q"}), sampled(1000, 2000, {q}));
                WithDerivative derived(borrowed(source), {0, 0, "v"});
                errors.add(read_all(derived, 100'000), [&](double t) {
                    return turn * f * (std::cos(turn * f * t + phase) + 0.9 * std::cos(3 * turn * f * t + 1));
                });
            }
            EXPECT_GT(std::sqrt(errors.ratios / errors.count), 0.85) << f << ", " << sigma;
            EXPECT_LT(std::sqrt(errors.ratios / errors.count), 1.1) << f << ", " << sigma;
            EXPECT_GT(errors.within / errors.count, 0.93) << f << ", " << sigma;
        }
}

/// A sine with noise, sampled by a clock whose steps change: the times are used as given.
TEST(Derivative, UsesTheTimesOfAnUnevenClock) {
    constexpr double w = turn * 7;
    constexpr std::size_t count = 1500;
    const std::vector<std::function<double(std::size_t)>> clocks{
        [](std::size_t i) { return i < count / 2 ? 1e-3 : 1.1e-3; },
        [](std::size_t i) { return i < count / 2 ? 1e-3 : 1.02e-3; },
        [](std::size_t i) { return 1e-3 * (1 + 0.3 * static_cast<double>(i) / count); },
        [](std::size_t i) { return 1e-3 * (1 + 0.004 * static_cast<double>(i) / count); },
        [](std::size_t i) { return 1e-3 * (1 + 0.1 * std::sin(static_cast<double>(i * i))); }};
    for (std::size_t c = 0; c < clocks.size(); ++c) {
        SCOPED_TRACE(c);
        Noise noise(5);
        Samples samples;
        samples.clear(1);
        for (std::size_t i = 0; i < count; ++i) {
            samples.times.push_back(i == 0 ? 0 : samples.times.back() + clocks[c](i));
            samples.values[0].push_back(std::sin(w * samples.times.back()) + 1e-4 * noise.normal());
        }
        StoredSamples source(named({"q"}), samples);
        WithDerivative derived(borrowed(source), {0, 0, "v"});
        Errors errors;
        errors.add(read_all(derived, 100'000), [](double t) { return w * std::cos(w * t); });
        errors.expect_stated(0.4);
    }
}

/// Times with few digits belong to an even clock: taken literally, they would add noise to the derivative.
TEST(Derivative, RoundedTimesCountAsEven) {
    constexpr double w = turn * 7;
    Samples exact = sampled(300, 3000, {[](double t) { return std::sin(w * t); }}), rounded = exact;
    for (double& t : rounded.times)
        t = std::round(t * 1e3) / 1e3;
    const auto derivative = [](const Samples& samples) {
        StoredSamples source(named({"q"}), samples);
        WithDerivative derived(borrowed(source), {0, 6, "v"});
        return read_all(derived, 10'000);
    };
    const Samples one = derivative(exact), other = derivative(rounded);
    for (std::size_t i = 0; i < one.rows(); ++i)
        EXPECT_NEAR(other.values[1][i], one.values[1][i], 1e-2)
            << i; // the last time is off by half a ms in ten seconds
}

TEST(Derivative, OfADisplacementIsItsVelocityWithLargeErrorsAtJumps) {
    const Model model = load_model("electromagnetic-testbed");
    RecordedModel recorded(model, "theta", 4.0, 10'000, 20'000);
    Noise noise(5);
    recorded.add_noise("q", 1e-7, noise);
    StoredSamples source(recorded.header, recorded.samples);
    WithDerivative derived(borrowed(source), {recorded.header.channel("q", "test"), 0, "rate"});
    const Samples rows = read_all(derived, 100'000);
    const std::size_t v = recorded.header.channel("v", "test"), rate = derived.header().channel("rate", "test"),
                      error = rate + 1;
    std::size_t outside = 0;
    for (std::size_t i = 0; i < rows.rows(); ++i)
        outside += std::abs(rows.values[rate][i] - rows.values[v][i]) > 3 * rows.values[error][i] ? 1 : 0;
    EXPECT_GT(recorded.truth.contacts().size(), 8U);
    // Next to a corner of the displacement errors are not normal.
    EXPECT_LT(static_cast<double>(outside), 0.03 * static_cast<double>(rows.rows()));
}

TEST(Derivative, RefusesInvalidSettings) {
    StoredSamples source(named({"q", "v"}), sampled(10, 10, {[](double t) { return t; }, [](double t) { return t; }}));
    EXPECT_THROW(WithDerivative(borrowed(source), {2, 0, ""}), InputError);
    EXPECT_THROW(WithDerivative(borrowed(source), {0, 3, ""}), InputError);
    EXPECT_THROW(WithDerivative(borrowed(source), {0, 0, "v"}), InputError);
    WithDerivative derived(borrowed(source), {0, 100, ""});
    Samples rows;
    EXPECT_THROW(derived.read(rows), InputError);
}

} // namespace graze::testing::derivative_test
