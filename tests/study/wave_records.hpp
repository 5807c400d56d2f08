#pragma once

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

namespace graze::testing {

constexpr double wave_frequency = 5;

/// V = amplitude sin, q = 3 cos + 1, rows at 1 kHz for `seconds`.
inline std::string waves(double amplitude, double seconds, double phase = 0) {
    std::string text = "t [s], V [V], q [mm]\n";
    for (int i = 0; i <= static_cast<int>(1000 * seconds); ++i) {
        const double t = i / 1000.0, angle = 2 * std::numbers::pi * wave_frequency * t + phase;
        text += fmt::format("{:.17g}, {:.17g}, {:.17g}\n", t, amplitude * std::sin(angle), 3 * std::cos(angle) + 1);
    }
    return text;
}

/// What a study with one run of records begins with.
constexpr const char* record_head = "name = \"s\"\n[runs.r]\nkind = \"record\"\n";

} // namespace graze::testing
