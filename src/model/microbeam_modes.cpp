#include "graze/model/microbeam.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

namespace graze {
namespace {

/// Modes 1, 3, 5, ... are symmetric about mid-span, the others antisymmetric.
bool is_symmetric(int i) {
    return i % 2 == 1;
}

/// Returns root number i of cos k cosh k = 1. With k = (i + 1/2) pi + s the equation reads sin(s) = +-1/cosh(k):
/// nothing overflows, and s, which decays like exp(-k), keeps its relative accuracy.
double wave_number(int i) {
    const double base = (i + 0.5) * std::numbers::pi;
    const double sign = is_symmetric(i) ? 1 : -1;
    double shift = 0;
    constexpr int enough = 50; // Newton needs five for the first mode, and fewer for the others
    for (int step = 0; step < enough; ++step) {
        const double decay = std::exp(-(base + shift));
        const double inverse_cosh = 2 * decay / (1 + decay * decay);
        const double tanh = (1 - decay * decay) / (1 + decay * decay);
        const double residual = sign * std::sin(shift) - inverse_cosh;
        const double change = residual / (sign * std::cos(shift) + inverse_cosh * tanh);
        shift -= change;
        if (std::abs(change) <= 1e-17 * base)
            break;
    }
    return base + shift;
}

/// Returns the coefficient of sinh and sin in the mode shape: tanh(k/2) for symmetric modes, 1/tanh(k/2) for the
/// others.
double sine_weight(int i, double k) {
    const double tanh = std::tanh(k / 2);
    return is_symmetric(i) ? tanh : 1 / tanh;
}

void require_place(double x) {
    if (!(x >= 0 && x <= 1))
        throw InputError(fmt::format("the place {} is not on the beam", x), "give one from 0 to 1");
}

void require_mode(int i, int count) {
    if (i < 1 || i > count)
        throw InputError("mode number " + std::to_string(i) + " is not between 1 and " + std::to_string(count), "");
}

} // namespace

ClampedBeamModes::ClampedBeamModes(int count) {
    if (count < 1)
        throw InputError("a beam cannot have " + std::to_string(count) + " modes", "ask for at least 1");
    wave_numbers_.reserve(static_cast<std::size_t>(count));
    for (int i = 1; i <= count; ++i)
        wave_numbers_.push_back(wave_number(i));
}

double ClampedBeamModes::frequency(int i) const {
    require_mode(i, count());
    const double k = wave_numbers_[static_cast<std::size_t>(i - 1)];
    return k * k;
}

// cosh kx - cos kx - s (sinh kx - sin kx), with the hyperbolic functions written as boundary layers that decay from
// either end: a direct evaluation subtracts terms of order exp(kx), which loses all digits for higher modes.
double ClampedBeamModes::shape(int i, double x) const {
    require_mode(i, count());
    require_place(x);
    const double parity = is_symmetric(i) ? 1 : -1;
    if (x > 0.5) {
        return parity * shape(i, 1 - x); // so that the symmetry is exact
    }
    if (x == 0.5 && parity < 0)
        return 0;
    const double k = wave_numbers_[static_cast<std::size_t>(i - 1)];
    const double layers = (std::exp(-k * x) + parity * std::exp(-k * (1 - x))) / (1 + parity * std::exp(-k));
    return layers - std::cos(k * x) + sine_weight(i, k) * std::sin(k * x);
}

double ClampedBeamModes::slope(int i, double x) const {
    require_mode(i, count());
    require_place(x);
    const double parity = is_symmetric(i) ? 1 : -1;
    if (x > 0.5)
        return -parity * slope(i, 1 - x);
    if (x == 0.5 && parity > 0)
        return 0;
    const double k = wave_numbers_[static_cast<std::size_t>(i - 1)];
    const double layers = (parity * std::exp(-k * (1 - x)) - std::exp(-k * x)) / (1 + parity * std::exp(-k));
    return k * (layers + std::sin(k * x) + sine_weight(i, k) * std::cos(k * x));
}

double ClampedBeamModes::slope_product(int i, int j) const {
    require_mode(i, count());
    require_mode(j, count());
    if (is_symmetric(i) != is_symmetric(j))
        return 0;
    const double ki = wave_numbers_[static_cast<std::size_t>(i - 1)];
    const double kj = wave_numbers_[static_cast<std::size_t>(j - 1)];
    const double si = sine_weight(i, ki) * ki;
    const double sj = sine_weight(j, kj) * kj;
    if (i == j)
        return si * (si - 2);
    const double product = ki * kj;
    return -8 * product * product * (si - sj) / ((ki - kj) * (ki + kj) * (ki * ki + kj * kj));
}

namespace {

constexpr double mean_square = 128.0 / 315; // mean square of 16 x^2 (x - 1)^2

} // namespace

double ClampedBeamPolynomial::frequency() const {
    return std::sqrt(1024.0 / 5 / mean_square);
}

double ClampedBeamPolynomial::shape(double x) const {
    require_place(x);
    const double root = x * (1 - x);
    return 16 * root * root / std::sqrt(mean_square);
}

double ClampedBeamPolynomial::slope(double x) const {
    require_place(x);
    return 32 * x * (1 - x) * (1 - 2 * x) / std::sqrt(mean_square);
}

double ClampedBeamPolynomial::slope_product() const {
    return 512.0 / 105 / mean_square;
}

} // namespace graze
