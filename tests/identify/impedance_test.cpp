#include "graze/identify/impedance.hpp"

#include "graze/base/input_error.hpp"
#include "identify/noise.hpp"

#include <algorithm>
#include <vector>

namespace graze::testing::impedance_test {

constexpr double resistance = 1.39, leakage = 10.55e-3, beta1 = 1.902e-5, beta2 = 1.631e-3, gap = 4.79e-3, q = 1.27e-3;
constexpr double omega = 25.1, size = 1.66;

struct Recorded {
    std::vector<double> times, voltage, current;
};

/// A record by Eqs. (5.17) to (5.19), under the conditions of Fig. 5.9.
Recorded recorded(Noise& noise, double noise_v, double noise_i) {
    const double inductance = leakage + beta1 / (beta2 + gap - q), lag = std::atan2(omega * inductance, resistance);
    const double flow = size / std::hypot(resistance, omega * inductance);
    Recorded record;
    for (int i = 0; i < 2000; ++i) {
        const double t = 3 + i * 1e-3;
        record.times.push_back(t);
        record.voltage.push_back(size * std::sin(omega * t + 0.7) + noise_v * noise.normal());
        record.current.push_back(0.01 + flow * std::sin(omega * t + 0.7 - lag) + noise_i * noise.normal());
    }
    return record;
}

TEST(Impedance, IsExactForExactSines) {
    Noise noise(1);
    const Recorded record = recorded(noise, 0, 0);
    for (const double guess : {0.0, 25.0}) {
        const Impedance found = impedance(record.times, record.voltage, record.current, guess);
        EXPECT_NEAR(found.frequency, omega, 1e-9 * omega);
        EXPECT_NEAR(found.resistance.value, resistance, 1e-9 * resistance);
        const Estimate leak = leakage_inductance(found.inductance, {beta1, 0, 0}, {beta2, 0, 0}, gap, q);
        EXPECT_NEAR(leak.value, leakage, 1e-9 * leakage);
    }
}

/// The number of periods within a gap is unknown: the part without gaps gives the first guess of the frequency.
TEST(Impedance, IsFoundInARecordWithGaps) {
    Noise noise(4);
    const Recorded whole = recorded(noise, 0.01, 0.01);
    for (const std::vector<std::size_t>& gaps : {std::vector<std::size_t>{500}, {300, 1500}}) {
        Recorded record;
        for (std::size_t i = 0; i < whole.times.size(); ++i) {
            if (std::any_of(gaps.begin(), gaps.end(), [&](std::size_t first) { return i >= first && i < first + 300; }))
                continue;
            record.times.push_back(whole.times[i]);
            record.voltage.push_back(whole.voltage[i]);
            record.current.push_back(whole.current[i]);
        }
        const Impedance found = impedance(record.times, record.voltage, record.current);
        EXPECT_NEAR(found.frequency, omega, 1e-3 * omega);
        EXPECT_TRUE(found.voltage_test.is_noise()) << found.voltage_test.text();
        EXPECT_NEAR(found.resistance.value, resistance, 4 * found.resistance.error);
    }
}

TEST(Impedance, IntervalsCoverTheTruth) {
    std::size_t resistances = 0, leakages = 0;
    for (std::size_t seed = 0; seed < experiments; ++seed) {
        Noise noise(seed);
        const Recorded record = recorded(noise, 0.02, 0.05);
        const Impedance found = impedance(record.times, record.voltage, record.current);
        resistances += covers(found.resistance, resistance) ? 1 : 0;
        const Estimate leak = leakage_inductance(found.inductance, {beta1, 0, 0}, {beta2, 0, 0}, gap, q);
        leakages += covers(leak, leakage) ? 1 : 0;
    }
    expect_coverage(resistances, "resistance");
    expect_coverage(leakages, "leakage inductance");
}

// With noise of half the amplitude the voltage crosses its mean many times a period.
TEST(Impedance, IsFoundInNoiseThatCrossesTheMeanOften) {
    std::size_t covered = 0;
    for (std::size_t seed = 0; seed < experiments; ++seed) {
        Noise noise(seed);
        const Recorded record = recorded(noise, 0.5 * size, 0.5);
        const Impedance found = impedance(record.times, record.voltage, record.current);
        EXPECT_NEAR(found.frequency, omega, 0.02 * omega) << seed;
        covered += covers(found.resistance, resistance) ? 1 : 0;
    }
    expect_coverage(covered, "resistance");
}

TEST(Impedance, ErrorsOfTheConstantsPropagate) {
    const Estimate all{0.014, 0, 100};
    EXPECT_NEAR(leakage_inductance(all, {beta1, 1e-3 * beta1, 9}, {beta2, 0, 9}, gap, q).error,
                1e-3 * beta1 / (beta2 + gap - q), 1e-18);
    EXPECT_NEAR(leakage_inductance(all, {beta1, 0, 9}, {beta2, 1e-5, 9}, gap, q).error,
                1e-5 * beta1 / std::pow(beta2 + gap - q, 2), 1e-18);
    EXPECT_THROW(leakage_inductance(all, {beta1, 0, 9}, {beta2, 0, 9}, 0, 1), InputError);
}

TEST(Impedance, RefusesChannelsWithoutASignal) {
    Noise noise(1);
    const Recorded record = recorded(noise, 0, 0);
    const std::vector<double> none(record.times.size(), 0.0);
    EXPECT_THROW(impedance(record.times, none, record.current), InputError);
    EXPECT_THROW(impedance(record.times, record.voltage, none), InputError);
    EXPECT_THROW(impedance({}, {}, {}), InputError);
}

} // namespace graze::testing::impedance_test
