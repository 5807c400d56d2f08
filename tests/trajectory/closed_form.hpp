#pragma once

#include <cmath>
#include <complex>
#include <cstdint>
#include <random>
#include <vector>

namespace graze::testing {

/// Random numbers that are the same on every platform, unlike the distributions of the standard library.
class Random {
public:
    explicit Random(std::uint64_t seed) : bits_(seed) {}
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
    }
    double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
    bool chance(double probability) { return uniform(0, 1) < probability; }
    int integer(int low, int high) { return low + static_cast<int>(uniform(0, 1) * (high - low + 1)); }

private:
    std::mt19937_64 bits_;
};

/// e^(i angle). Reducing the angle, which takes as long as all else, is done once for both parts.
inline std::complex<long double> turned(long double angle) {
    long double sine = 0, cosine = 0;
    ::sincosl(angle, &sine, &cosine);
    return {cosine, sine};
}

/// x'' + 2 zeta n x' + n^2 x = amplitude cos(phase + omega t) in closed form, with more digits than the results under
/// test. Underdamped, and not in undamped resonance.
class LinearOscillator {
public:
    using Real = long double;
    struct Motion {
        Real x, v;
        Real acceleration = 0; ///< of `at`
    };

    LinearOscillator(Real zeta, Real omega, Real amplitude, Real natural = 1)
        : decay_(zeta * natural), natural_(natural), frequency_(natural * std::sqrt(1 - zeta * zeta)), omega_(omega),
          forcing_(amplitude) {
        response_ = amplitude / std::complex<Real>(natural * natural - omega * omega, 2 * zeta * natural * omega);
    }

    void start(Real x, Real v, Real phase) {
        phase_ = phase;
        const std::complex<Real> forced = response_ * turned(phase);
        cosine_ = x - forced.real();
        sine_ = (v + omega_ * forced.imag() + decay_ * cosine_) / frequency_;
    }

    Motion at(Real t) const {
        const std::complex<Real> drive = turned(phase_ + omega_ * t), own = turned(frequency_ * t);
        const Real c = own.real(), s = own.imag(), e = std::exp(-decay_ * t);
        const Real forced = response_.real() * drive.real() - response_.imag() * drive.imag(),
                   forced_rate = -omega_ * (response_.real() * drive.imag() + response_.imag() * drive.real());
        const Real free = e * (cosine_ * c + sine_ * s);
        Motion motion{forced + free, forced_rate - decay_ * free + e * frequency_ * (sine_ * c - cosine_ * s)};
        motion.acceleration = forcing_ * drive.real() - 2 * decay_ * motion.v - natural_ * natural_ * motion.x;
        return motion;
    }
    Real x(Real t) const { return at(t).x; }
    Real v(Real t) const { return at(t).v; }
    Real acceleration(Real t) const { return at(t).acceleration; }
    Real omega() const { return omega_; }
    Real phase() const { return phase_; }

    /// Returns x, v at 0, h, 2h, ... by recurrence.
    std::vector<Motion> sample(Real h, std::size_t count) const {
        std::vector<Motion> motions;
        motions.reserve(count);
        const Real e = std::exp(-decay_ * h);
        const std::complex<Real> turn = e * turned(frequency_ * h), drive = turned(omega_ * h);
        std::complex<Real> free(cosine_, -sine_); // e^-dt (C cos + S sin) = Re[(C - iS) e^(-d + if)t]
        std::complex<Real> forced = response_ * turned(phase_);
        for (std::size_t i = 0; i < count; ++i) {
            motions.push_back({forced.real() + free.real(),
                               -omega_ * forced.imag() - decay_ * free.real() - frequency_ * free.imag()});
            free = {free.real() * turn.real() - free.imag() * turn.imag(),
                    free.real() * turn.imag() + free.imag() * turn.real()};
            forced = {forced.real() * drive.real() - forced.imag() * drive.imag(),
                      forced.real() * drive.imag() + forced.imag() * drive.real()};
        }
        return motions;
    }

private:
    Real decay_, natural_, frequency_, omega_, forcing_, phase_ = 0, cosine_ = 0, sine_ = 0;
    std::complex<Real> response_;
};

/// Returns a root of f, which changes sign from low to high, to the accuracy of long double, by Newton's method inside
/// the bracket. `f` returns value and slope.
template <class Function>
long double root_in(Function f, long double low, long double high) {
    const bool rising = f(high).first > 0;
    long double t = low + (high - low) / 2;
    for (int i = 0; i < 100; ++i) {
        const auto [value, slope] = f(t);
        if (value == 0)
            return t;
        ((value > 0) == rising ? high : low) = t;
        long double next = t - value / slope;
        if (!(next > low && next < high))
            next = low + (high - low) / 2;
        if (!(next > low && next < high) || std::abs(next - t) <= 2e-19L * std::abs(t))
            return next;
        t = next;
    }
    return t;
}

} // namespace graze::testing
