#include "graze/bench/virtual_bench.hpp"

#include "bench/testbed.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace graze::virtual_bench_test {

BenchSettings testbed() {
    return testing::testbed({"V=voltage:V", "I", "q", "v"});
}

/// A model that is a phase; its sine is measured, so that all values are known in closed form.
BenchSettings wave() {
    BenchSettings settings;
    settings.model = parse_model(R"(name = "wave"
parameters = { a = 1, w = 1 }
states = { phase = { initial = 0, period = "2*pi" } }
modes.only.rates = { phase = "w" }
)",
                                 "wave.toml");
    settings.amplitude = driven_input(settings.model, "a=3", "");
    settings.frequency = driven_input(settings.model, "w=2*pi", "");
    settings.channels.push_back(bench_channel(settings.model, "y=a*sin(phase):V", ""));
    return settings;
}

Samples taken(VirtualBench& bench, std::size_t count) {
    Samples samples;
    bench.sample(count, samples);
    return samples;
}

TEST(VirtualBench, GivesTheWaveOfTheGeneratorWithContinuousPhase) {
    VirtualBench bench(wave());
    bench.drive({5, 2});
    bench.set_rate(200);
    const Samples first = taken(bench, 333);
    for (std::size_t i = 0; i < 333; ++i) {
        EXPECT_NEAR(first.times[i], static_cast<double>(i) / 200, 1e-12);
        EXPECT_NEAR(first.values[0][i], 3 * std::sin(2 * std::numbers::pi * 5 * first.times[i]), 1e-9);
    }
    bench.drive({10, 4});
    const double phase = 2 * std::numbers::pi * 5 * 333 / 200;
    const Samples second = taken(bench, 100);
    for (std::size_t i = 0; i < 100; ++i)
        EXPECT_NEAR(second.values[0][i], 6 * std::sin(phase + 2 * std::numbers::pi * 10 * static_cast<double>(i) / 200),
                    1e-9);
    EXPECT_NEAR(bench.time(), 433.0 / 200, 1e-12);
    EXPECT_EQ(bench.header().channels[0].unit, "V");
}

TEST(VirtualBench, AddsNoiseOffsetAndDrift) {
    BenchSettings settings = wave();
    settings.channels[0].noise = 0.1;
    settings.channels[0].offset = 1;
    settings.channels[0].drift = 0.5;
    VirtualBench noisy(settings);
    settings.channels[0].noise = 0;
    VirtualBench clean(settings);
    const Samples one = taken(noisy, 4000), other = taken(clean, 4000);
    double mean = 0, square = 0;
    for (std::size_t i = 0; i < 4000; ++i) {
        const double noise = one.values[0][i] - other.values[0][i];
        mean += noise / 4000;
        square += noise * noise / 4000;
        EXPECT_NEAR(other.values[0][i] - 1 - 0.5 * other.times[i],
                    0.15 * std::sin(2 * std::numbers::pi * 1000 * other.times[i]), 1e-9);
    }
    EXPECT_NEAR(mean, 0, 5 * 0.1 / std::sqrt(4000.0)); // five standard errors
    EXPECT_NEAR(std::sqrt(square), 0.1, 5 * 0.1 / std::sqrt(8000.0));
}

TEST(VirtualBench, ConvertsToWholeStepsWithinTheRange) {
    BenchSettings settings = wave();
    settings.channels[0].range = 2;
    VirtualBench bench(settings);
    bench.drive({7, 2}); // a sine of amplitude 3
    const Samples samples = taken(bench, 1000);
    double least = 0, most = 0;
    for (const double value : samples.values[0]) {
        EXPECT_EQ(value * 16384, std::nearbyint(value * 16384));
        least = std::min(least, value);
        most = std::max(most, value);
    }
    EXPECT_EQ(least, -2);
    EXPECT_EQ(most, 2 - 1.0 / 16384);
}

TEST(VirtualBench, FiltersFrequenciesThatWouldBeAliased) {
    BenchSettings settings = wave();
    settings.anti_alias = 40;
    VirtualBench bench(settings);
    bench.drive({990, 2}); // aliased to 10 Hz at 1000 samples per second
    bench.set_rate(1000);
    taken(bench, 500);
    const Samples samples = taken(bench, 500);
    // The remainder is (tan(pi 40/8000)/tan(pi 990/8000))^4 of 3 V: 5e-6 V.
    for (const double value : samples.values[0])
        EXPECT_LT(std::abs(value), 1e-5);
    bench.drive({4, 2});
    taken(bench, 500);
    double most = 0;
    const Samples slow = taken(bench, 500);
    for (const double value : slow.values[0])
        most = std::max(most, std::abs(value));
    EXPECT_NEAR(most, 3, 1e-3);
    EXPECT_THROW(bench.set_rate(80), InputError);
}

TEST(VirtualBench, RepeatsItsSamplesAfterReturningToAMark) {
    BenchSettings settings = testbed();
    settings.anti_alias = 300;
    for (BenchChannel& channel : settings.channels)
        channel.noise = 1e-3;
    VirtualBench bench(settings);
    bench.drive({6.1, 9.6}); // with impacts
    taken(bench, 1500);
    bench.mark(7);
    bench.drive({6.1, 9.7});
    const Samples first = taken(bench, 2000);
    bench.drive({20, 1});
    taken(bench, 321);
    ASSERT_TRUE(bench.return_to(7));
    bench.drive({6.1, 0.1});
    bench.drive({6.1, 9.7});
    const Samples second = taken(bench, 2000);
    EXPECT_EQ(first.times, second.times);
    EXPECT_EQ(first.values, second.values);
    EXPECT_FALSE(bench.return_to(8));
    for (std::uint64_t i = 8; i < 12; ++i)
        bench.mark(i);
    EXPECT_FALSE(bench.return_to(7)) << "only the last four are kept";
    VirtualBench another(settings);
    another.drive({6.1, 9.6});
    taken(another, 1500);
    another.mark(0);
    another.drive({6.1, 9.7});
    EXPECT_EQ(taken(another, 2000).values, first.values) << "the same calls, the same samples";
}

TEST(VirtualBench, SaysWhyTheMotionHasEnded) {
    BenchSettings settings = wave();
    settings.model = parse_model(R"(name = "blow-up"
parameters = { a = 1, w = 1 }
states = { x = 1, phase = { initial = 0, period = "2*pi" } }
modes.only.rates = { x = "a*x^2", phase = "w" }
)",
                                 "blow-up.toml");
    settings.channels = {bench_channel(settings.model, "x", "")};
    VirtualBench bench(settings); // x = 1/(1 - a t) with a = 0.15
    bench.set_rate(100);
    EXPECT_EQ(taken(bench, 600).rows(), 600U);
    EXPECT_EQ(bench.ended(), "");
    const Samples rest = taken(bench, 1000);
    EXPECT_EQ(rest.rows(), 67U) << "to 6.66 s of 6.67 s";
    EXPECT_EQ(bench.ended(), "the model's motion has ended (singular)");
    EXPECT_EQ(taken(bench, 10).rows(), 0U);
    bench.pass(1);
}

TEST(VirtualBench, RefusesInvalidSettings) {
    const Model model = load_model("electromagnetic-testbed");
    EXPECT_THROW(bench_channel(model, "nothing", "--channel"), InputError);
    EXPECT_THROW(bench_channel(model, "../x=q", "--channel"), InputError);
    EXPECT_THROW(bench_channel(model, "x=q:m, v", "--channel"), InputError);
    EXPECT_THROW(driven_input(model, "omega", "--amplitude"), InputError) << "which follows from f";
    EXPECT_THROW(driven_input(model, "V0=1/0", "--amplitude"), InputError);
    BenchSettings settings = testbed();
    settings.channels[1].noise = -1;
    EXPECT_THROW(VirtualBench bench(settings), InputError);
    settings = testbed();
    settings.channels[1].value.name = "V";
    EXPECT_THROW(VirtualBench bench(settings), InputError);
    VirtualBench bench(testbed());
    for (const double rate : {0.0, -1.0, 1e9, std::nan("")})
        EXPECT_THROW(bench.set_rate(rate), InputError);
}

} // namespace graze::virtual_bench_test
