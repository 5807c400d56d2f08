#include "graze/branch/torus.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace graze {

namespace {

/// Value, rate and second rate, by the turns, of the series of one state.
struct SeriesValue {
    double value = 0, rate = 0, second = 0;
};

SeriesValue series_at(const Torus& torus, std::size_t state, double turns) {
    SeriesValue result{torus.terms[0][state], 0, 0};
    for (std::size_t k = 1; k <= torus.harmonics(); ++k) {
        const double factor = 2 * std::numbers::pi * static_cast<double>(k), angle = factor * turns;
        const double even = torus.terms[2 * k - 1][state], odd = torus.terms[2 * k][state];
        const double value = even * std::cos(angle) + odd * std::sin(angle);
        result.value += value;
        result.rate += factor * (odd * std::cos(angle) - even * std::sin(angle));
        result.second -= factor * factor * value;
    }
    return result;
}

} // namespace

std::vector<double> Torus::state_at(double turns) const {
    std::vector<double> state(terms[0].size());
    for (std::size_t i = 0; i < state.size(); ++i)
        state[i] = series_at(*this, i, turns).value;
    return state;
}

std::pair<double, double> Torus::extremes(std::size_t state) const {
    const std::size_t samples = 16 * harmonics() + 16;
    const double spacing = 1 / static_cast<double>(samples);
    double least = terms[0][state], greatest = least;
    const auto note = [&](double value) {
        least = std::min(least, value);
        greatest = std::max(greatest, value);
    };
    for (std::size_t j = 0; j < samples; ++j) {
        const double turns = spacing * static_cast<double>(j);
        SeriesValue at = series_at(*this, state, turns);
        note(at.value);
        // From a sample beside an extremum, Newton's method leads to it.
        double moved = 0;
        for (int iteration = 0; iteration < 4 && at.second != 0; ++iteration) {
            moved -= at.rate / at.second;
            if (!(std::abs(moved) <= spacing))
                break;
            at = series_at(*this, state, turns + moved);
            note(at.value);
        }
    }
    return {least, greatest};
}

} // namespace graze
