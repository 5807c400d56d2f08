#pragma once

#include "graze/record/samples.hpp"

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace graze::testing {

using Wave = std::function<double(double)>;

/// A record of functions of time, sampled at the times of a clock.
inline Samples sampled_at(const std::function<double(std::size_t)>& clock, std::size_t count,
                          const std::vector<Wave>& waves) {
    Samples samples;
    samples.clear(waves.size());
    for (std::size_t i = 0; i < count; ++i) {
        samples.times.push_back(clock(i));
        for (std::size_t c = 0; c < waves.size(); ++c)
            samples.values[c].push_back(waves[c](samples.times.back()));
    }
    return samples;
}
/// The same at a given frequency.
inline Samples sampled(double frequency, std::size_t count, const std::vector<Wave>& waves) {
    return sampled_at([&](std::size_t i) { return static_cast<double>(i) / frequency; }, count, waves);
}

inline RecordHeader named(const std::vector<std::string>& names) {
    RecordHeader header{{"t", "s"}, {}};
    for (const std::string& name : names)
        header.channels.push_back({name, ""});
    return header;
}

/// Noise that is the same with every standard library (their normal distributions differ).
class Noise {
public:
    explicit Noise(std::uint64_t seed) : engine_(seed) {}
    double uniform() { return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53; }
    /// Standard normal (Box and Muller).
    double normal() {
        const double radius = std::sqrt(-2 * std::log(uniform()));
        return radius * std::cos(2 * std::acos(-1.0) * uniform());
    }

private:
    std::mt19937_64 engine_;
};

} // namespace graze::testing
