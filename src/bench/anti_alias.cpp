#include "bench/anti_alias.hpp"

#include <cmath>
#include <numbers>

namespace graze {

AntiAlias::AntiAlias(double corner) {
    const double k = std::tan(std::numbers::pi * corner);
    for (std::size_t i = 0; i < sections; ++i) {
        // The poles of a fourth-order filter lie at odd multiples of a sixteenth of a turn.
        const double damping =
            2 * std::cos(std::numbers::pi * (2 * static_cast<double>(i) + 1) / (4.0 * static_cast<double>(sections)));
        const double norm = 1 + damping * k + k * k;
        sections_[i].b = k * k / norm;
        sections_[i].a1 = 2 * (k * k - 1) / norm;
        sections_[i].a2 = (1 - damping * k + k * k) / norm;
    }
}

double AntiAlias::filtered(double sample) {
    for (Section& section : sections_) {
        const double result = section.b * sample + section.first;
        section.first = 2 * section.b * sample - section.a1 * result + section.second;
        section.second = section.b * sample - section.a2 * result;
        sample = result;
    }
    return sample;
}

void AntiAlias::settle(double value) {
    for (Section& section : sections_) { // each section has unit gain at zero frequency
        section.second = (section.b - section.a2) * value;
        section.first = (2 * section.b - section.a1) * value + section.second;
    }
}

} // namespace graze
