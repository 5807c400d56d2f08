#include "graze/identify/identification.hpp"

#include "base/message_of.hpp"
#include "identify/models.hpp"
#include "identify/noise.hpp"

#include <cmath>
#include <functional>
#include <gmock/gmock.h>
#include <numbers>
#include <utility>

namespace graze::testing::identification_test {

using namespace magnet;
using ::testing::HasSubstr;

constexpr double turn = 2 * std::numbers::pi;

struct NamedRecord {
    std::string name;
    RecordHeader header;
    Samples samples;
};

/// @param functions of time, one for each channel
NamedRecord record(const std::string& name, std::vector<Channel> channels, double rate, std::size_t count,
                   const std::vector<Wave>& functions) {
    return {name, {{"t", "s"}, std::move(channels)}, sampled(rate, count, functions)};
}

EachRecord each(std::vector<NamedRecord> records) {
    return [records = std::move(records)](const std::function<void(const std::string&, SampleSource&)>& work) {
        for (const NamedRecord& one : records) {
            StoredSamples source(one.header, one.samples);
            work(one.name, source);
        }
    };
}

Identification::Value value_of(const Identification& found, const std::string& name) {
    for (const Identification::Value& value : found.values)
        if (value.name == name)
            return value;
    ADD_FAILURE() << name << " is not found";
    return {};
}

void expect_value(const Identification& found, const std::string& name, double value, double tolerance,
                  const std::string& unit) {
    EXPECT_NEAR(value_of(found, name).estimate.value, value, tolerance) << name;
    EXPECT_EQ(value_of(found, name).unit, unit) << name;
}

/// Velocity of a release by natural frequency and damping ratio, with a rest position.
NamedRecord release(double height) {
    constexpr double natural = 95.94, damping = 0.01626;
    const double damped = natural * std::sqrt(1 - damping * damping);
    return record("release", {{"v", "m/s"}}, 5000, 5000,
                  {[=](double t) { return 0.25 + height * std::exp(-damping * natural * t) * std::sin(damped * t); }});
}

/// A ball that falls from 1 m and bounces with a coefficient of restitution: its velocity is linear between impacts.
NamedRecord drops(const std::string& name, double restitution) {
    constexpr double g = 9.81;
    const double first = std::sqrt(2 / g);
    return record(name, {{"v", "m/s"}}, 1000, 3000, {[=](double t) {
                      double begin = first, speed = std::sqrt(2 * g) * restitution;
                      if (t < first)
                          return -g * t;
                      while (t >= begin + 2 * speed / g) {
                          begin += 2 * speed / g;
                          speed *= restitution;
                      }
                      return speed - g * (t - begin);
                  }});
}

/// The current through a coil of this resistance and inductance, on a sinusoidal voltage.
NamedRecord coil_record(double resistance, double inductance, double voltage, double frequency, std::size_t count,
                        double sign = 1) {
    const double w = turn * frequency, size = std::hypot(resistance, w * inductance),
                 late = std::atan2(w * inductance, resistance);
    return record("coil", {{"V", "V"}, {"I", "A"}}, 1000, count,
                  {[=](double t) { return voltage * std::sin(w * t); },
                   [=](double t) { return sign * voltage / size * std::sin(w * t - late); }});
}

TEST(Identification, DecrementHasUnitsAndCurves) {
    const Identification found = identify_decrement(each({release(0.1), release(0.2)}), {});
    // Parabolas through the samples around peaks are accurate to some 1e-6 of a period.
    expect_value(found, "natural_frequency", 95.94, 1e-5 * 95.94, "rad/s");
    expect_value(found, "damping_ratio", 0.01626, 1e-5, "");
    expect_value(found, "rest_position", 0.25, 1e-5, "m/s");
    ASSERT_EQ(found.shown.size(), 2U) << "a curve for each release";
    for (const Identification::Shown& shown : found.shown) {
        ASSERT_EQ(shown.measured.x.size(), 10U);
        for (std::size_t k = 0; k < shown.measured.x.size(); ++k)
            EXPECT_NEAR(shown.left.y[k], shown.measured.y[k] - shown.fitted.y[k], 1e-15);
    }
    const std::size_t count = found.values.size();
    ASSERT_EQ(found.covariance.size(), count * count);
    for (std::size_t i = 0; i < count; ++i)
        EXPECT_EQ(found.covariance[i * count + i], found.values[i].estimate.error * found.values[i].estimate.error);
}

TEST(Identification, RestitutionsOfSeveralRecordsAreCombined) {
    const IdentificationSettings settings{.impacts = {.least_jump = 1}};
    const Identification one = identify_restitution(each({drops("a", 0.8)}), settings);
    // Between two samples the time of an impact is uncertain by half a millisecond: 9.81 m/s^2 makes 0.005 m/s of that,
    // before and after, of speeds of 1.8 m/s and more.
    constexpr double known = 0.005;
    EXPECT_NEAR(value_of(one, "restitution").estimate.value, 0.8, known);
    EXPECT_EQ(one.values.size(), 1U) << "a single record has no spread";
    const Identification both = identify_restitution(each({drops("a", 0.8), drops("b", 0.82)}), settings);
    EXPECT_NEAR(value_of(both, "restitution of a").estimate.value, 0.8, known);
    EXPECT_NEAR(value_of(both, "restitution of b").estimate.value, 0.82, known);
    EXPECT_GT(value_of(both, "restitution").estimate.value, value_of(both, "restitution of a").estimate.value);
    EXPECT_LT(value_of(both, "restitution").estimate.value, value_of(both, "restitution of b").estimate.value);
    EXPECT_GT(value_of(both, "spread_between_records").estimate.value, 0);
    EXPECT_EQ(both.x.name, "v before");
    EXPECT_EQ(both.x.unit, "m/s");
    // The line of the mean, through the origin.
    const Identification::Curve& line = both.shown.front().fitted;
    EXPECT_NEAR(line.y[0], -value_of(both, "restitution").estimate.value * line.x[0], 1e-12);
}

/// An offset that is small relative to the velocities is detected by their errors; the scatter about the line would
/// hide it, since the offset enlarges it.
TEST(Identification, WarnsOfAnOffsetOfTheVelocity) {
    const IdentificationSettings settings{.impacts = {.least_jump = 1}};
    NamedRecord ball = drops("a", 0.85);
    Noise noise(3);
    for (double& v : ball.samples.values[0])
        v += 0.01 * noise.normal();
    EXPECT_THAT(identify_restitution(each({ball}), settings).warnings, ::testing::IsEmpty());
    for (double& v : ball.samples.values[0])
        v += 0.2;
    EXPECT_THAT(identify_restitution(each({ball}), settings).warnings,
                ::testing::Contains(::testing::HasSubstr("may have an offset")));
}

/// Four impacts with an offset that makes all ratios larger than one: by the scatter about the line the interval
/// reaches below one, by the velocities' own errors it does not. For an elastic impact, errors alone may give more than
/// one.
TEST(Identification, WarnsOfARestitutionAboveOne) {
    const IdentificationSettings settings{.impacts = {.least_jump = 1}};
    for (const double offset : {0.0, 0.1}) {
        std::size_t told = 0;
        for (int seed = 1; seed <= 20; ++seed) {
            Noise noise(static_cast<unsigned>(seed));
            NamedRecord one{"a", {{"t", "s"}, {{"v", "m/s"}}}, {{}, {{}}}};
            double first = 2.3;
            for (int k = 0; k < 5; ++k, first *= offset == 0 ? 1 : 0.93)
                for (int i = 0; i < 100; ++i) {
                    one.samples.times.push_back(0.001 * (100 * k + i));
                    one.samples.values[0].push_back(first * (1 - 2 * i / 99.0) + offset + 0.01 * noise.normal());
                }
            const Identification found = identify_restitution(each({one}), settings);
            for (const std::string& warning : found.warnings)
                told += warning.find("the restitution is above one by") != std::string::npos ? 1 : 0;
        }
        if (offset == 0) {
            EXPECT_EQ(told, 0U);
        } else {
            EXPECT_GE(told, 18U);
        }
    }
}

/// Between impacts the velocity changes linearly, so that each value is known to its noise.
TEST(Identification, WarnsOfARestitutionThatChangesFromImpactToImpact) {
    for (const double other : {0.8, 0.6}) {
        Noise noise(7);
        NamedRecord one{"a", {{"t", "s"}, {{"v", "m/s"}}}, {{}, {{}}}};
        double first = 0.8, last = 0.9;
        for (int k = 0; k < 20; ++k) {
            for (int i = 0; i < 50; ++i) {
                one.samples.times.push_back(0.01 * (50 * k + i));
                one.samples.values[0].push_back(first - (first + last) * i / 49 + 0.001 * noise.normal());
            }
            first = (k % 2 == 0 ? 0.8 : other) * last;
            last = 0.7 + 0.3 * noise.uniform();
        }
        const Identification found = identify_restitution(each({one}), {});
        if (other == 0.8) {
            EXPECT_THAT(found.warnings, ::testing::IsEmpty());
            // Within half a sample both velocities change by 0.017, with the same sign: a fifth of that relative to
            // 0.85.
            EXPECT_NEAR(value_of(found, "restitution").estimate.value, 0.8, 5e-3);
        } else {
            EXPECT_THAT(found.warnings, ::testing::Contains(HasSubstr("changes from impact to impact")));
        }
    }
}

/// Exact loads in m: the same loads in mm, or with another gap, are impossible for a magnet.
TEST(Identification, CouplingIsLeftOutWhereNoMagnetHasIt) {
    const auto loads = [&](double unit) {
        return record(
            "loads", {{"q", ""}, {"I", "A"}}, 1, 12,
            {[&](double t) { return unit * 1e-4 * (1 + t); }, [](double t) { return current_at(1e-4 * (1 + t)); }});
    };
    IdentificationSettings settings{.gap = gap, .stiffness = stiffness};
    EXPECT_THAT(message_of([&] { identify_coupling(each({loads(1e3)}), settings); }),
                HasSubstr("a displacement of 0.1 is larger than the gap at rest, 0.004791"));
    settings.gap = 0.05; // beta2 would have to be gap + beta2 less 50 mm
    const Identification found = identify_coupling(each({loads(1)}), settings);
    EXPECT_THAT(found.warnings,
                ::testing::Contains(HasSubstr("beta2 is left out: beta2, the part of the magnetic path")));
    for (const Identification::Value& value : found.values)
        EXPECT_TRUE(value.name != "beta1" && value.name != "beta2");
}

TEST(Identification, CouplingTakesRowsOrRecordsAsEquilibria) {
    IdentificationSettings settings;
    EXPECT_THAT(message_of([&] { identify_coupling(each({}), settings); }), HasSubstr("give gap and stiffness"));
    settings.gap = gap;
    settings.stiffness = stiffness;
    const std::vector<Channel> channels{{"q", "m"}, {"I", "A"}};
    const auto of_time = [](double t) { return 1e-4 * (1 + t); }; // 0.1 to 1.2 mm
    const NamedRecord rows =
        record("loads", channels, 1, 12, {of_time, [&](double t) { return current_at(of_time(t)); }});
    std::vector<NamedRecord> records;
    for (int i = 1; i <= 12; ++i)
        records.push_back(record("load", channels, 1, 5,
                                 {[i](double) { return 1e-4 * i; }, [&, i](double) { return current_at(1e-4 * i); }}));
    for (const bool by_record : {false, true}) {
        settings.one_load_a_record = by_record;
        const Identification found = identify_coupling(each(by_record ? records : std::vector{rows}), settings);
        expect_value(found, "beta1", beta1, 1e-9 * beta1, "H m");
        expect_value(found, "beta2", beta2, 1e-9 * beta2, "m");
        ASSERT_EQ(found.shown.size(), 1U);
        EXPECT_EQ(found.shown[0].measured.x.size(), 12U);
        for (std::size_t i = 0; i < found.shown[0].fitted.x.size(); ++i)
            EXPECT_NEAR(found.shown[0].fitted.x[i], current_at(found.shown[0].fitted.y[i]), 1e-8);
        const std::size_t count = found.values.size();
        EXPECT_EQ(found.covariance[1], found.covariance[count]);
        EXPECT_EQ(found.covariance[2], 0) << "the error of a correlation is unknown";
    }
}

TEST(Identification, ImpedanceWarnsOfSigns) {
    constexpr double resistance = 1.39, inductance = 0.0145, frequency = 6.1;
    const auto coil = [&](double sign) { return coil_record(resistance, inductance, 4, frequency, 4000, sign); };
    const Identification found = identify_impedance(each({coil(1)}), {});
    expect_value(found, "resistance", resistance, 1e-9, "ohm");
    expect_value(found, "inductance", inductance, 1e-9, "H");
    expect_value(found, "frequency", frequency, 1e-9, "Hz");
    EXPECT_TRUE(found.warnings.empty());
    EXPECT_LE(found.shown.front().measured.x.back(), 3 / frequency) << "the first periods tell enough";
    const Identification turned = identify_impedance(each({coil(-1)}), {});
    ASSERT_EQ(turned.warnings.size(), 2U) << "resistance and inductance are both negative";
    EXPECT_THAT(turned.warnings[0], HasSubstr("the resistance comes out below zero"));
    const IdentificationSettings half{.beta1 = Estimate{1.9e-5, 0, 0}};
    EXPECT_THAT(message_of([&] { identify_impedance(each({coil(1)}), half); }),
                HasSubstr("give beta1, beta2 and gap, or none"));
}

/// The same record in other units; `times` and `values` are the factors of the numbers.
NamedRecord in_units(NamedRecord one, const std::string& time, double times, std::size_t channel,
                     const std::string& unit, double values) {
    one.header.time.unit = time;
    for (double& t : one.samples.times)
        t *= times;
    one.header.channels[channel].unit = unit;
    for (double& value : one.samples.values[channel])
        value *= values;
    return one;
}

/// A record in mV, mA or ms gives the same as the one in V, A and s; results are in the units of the first record.
TEST(Identification, RecordsInOtherUnitsAreConverted) {
    constexpr double resistance = 1.4, inductance = 0.0105, frequency = 4;
    const NamedRecord coil = coil_record(resistance, inductance, 5, frequency, 2000);
    for (const NamedRecord& other :
         {in_units(coil, "s", 1, 0, "mV", 1e3), in_units(coil, "s", 1, 1, "mA", 1e3),
          in_units(coil, "ms", 1e3, 0, "V", 1), in_units(coil, "min", 1.0 / 60, 1, "A", 1)}) {
        const Identification found = identify_impedance(each({coil, other}), {});
        expect_value(found, "resistance", resistance, 1e-9, "ohm");
        expect_value(found, "inductance", inductance, 1e-9, "H");
    }
    const Identification turned = identify_impedance(each({in_units(coil, "s", 1, 0, "mV", 1e3), coil}), {});
    expect_value(turned, "resistance", 1e3 * resistance, 1e-6, "mV/A");

    const NamedRecord first = release(0.1);
    const Identification decay = identify_decrement(each({first, in_units(first, "ms", 1e3, 0, "mm/s", 1e3)}), {});
    expect_value(decay, "natural_frequency", 95.94, 1e-6, "rad/s");
    expect_value(decay, "rest_position", 0.25, 1e-6, "m/s");
    EXPECT_THAT(decay.warnings, ::testing::IsEmpty());
    for (const double x : decay.shown[1].measured.x)
        EXPECT_LT(x, 1) << "seconds";
}

TEST(Identification, RecordsWithUnitsOfOtherDimensionsAreRefused) {
    const NamedRecord first = release(0.1);
    const auto refusal = [&](const NamedRecord& other) {
        return message_of([&] { identify_decrement(each({first, other}), {}); });
    };
    EXPECT_THAT(refusal(in_units(first, "s", 1, 0, "V", 1)),
                HasSubstr("channel 'v' is in V, and that of the first record in m/s"));
    EXPECT_THAT(refusal(in_units(first, "s", 1, 0, "", 1)), HasSubstr("channel 'v' is without a unit"));
    EXPECT_THAT(refusal(in_units(first, "ticks", 1, 0, "m/s", 1)),
                HasSubstr("its time is in ticks, and that of the first record in s"));
    EXPECT_THAT(refusal(in_units(first, "mS", 1, 0, "m/s", 1)), HasSubstr("its time is in mS"));
    const NamedRecord ticks = in_units(first, "ticks", 1, 0, "turns", 1);
    EXPECT_NO_THROW(identify_decrement(each({ticks, ticks}), {})) << "the same unit, whatever it is";
}

TEST(Identification, RefusesRecordsWithoutUsableNumbers) {
    NamedRecord none = release(0.1);
    none.samples.clear(1);
    EXPECT_THAT(message_of([&] { identify_decrement(each({none}), {}); }), HasSubstr("the record has no rows"));
    NamedRecord huge = release(0.1);
    for (double& value : huge.samples.values[0])
        value *= 1e150;
    EXPECT_THAT(message_of([&] { identify_decrement(each({huge}), {}); }), HasSubstr("(scale v="));
    const IdentificationSettings other{.channel = "w"};
    EXPECT_THAT(message_of([&] { identify_decrement(each({release(0.1)}), other); }), HasSubstr("channel: "));
}

} // namespace graze::testing::identification_test
