#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace graze::testing {

/// Balls above one another, on a floor, without size.
struct Stack {
    std::vector<double> mass, restitution, gap, velocity;
    double gravity = 9.81;

    std::size_t size() const { return mass.size(); }

    std::string model() const {
        std::string states, rates, velocities, masses, contacts;
        double height = 0;
        for (std::size_t i = 0; i < size(); ++i) {
            height += gap[i];
            states += fmt::format("y{0} = {1}, v{0} = {2}, ", i, height, velocity[i]);
            rates += fmt::format("y{0} = \"v{0}\", v{0} = \"-g\", ", i);
            velocities += fmt::format("\"v{}\", ", i);
            masses += fmt::format("{}, ", mass[i]);
            contacts += fmt::format("contacts.c{} = {{ gap = \"{}\", restitution = {} }}\n", i,
                                    i == 0 ? "y0" : fmt::format("y{} - y{}", i, i - 1), restitution[i]);
        }
        return fmt::format(
            "parameters.g = {}\nstates = {{ {} }}\nmodes.free.rates = {{ {} }}\ncontacts.law = \"sequence\"\n"
            "contacts.velocities = [{}]\ncontacts.mass = [{}]\n{}initial.mode = \"free\"\n",
            gravity, states.substr(0, states.size() - 2), rates.substr(0, rates.size() - 2), velocities, masses,
            contacts);
    }
};

/// The time at which a stack rests, by the impacts of pairs one after another. Unknowns are gaps and their rates, so
/// that all is known relative to its size.
class StackReference {
public:
    using Real = long double;

    explicit StackReference(const Stack& stack)
        : n_(stack.size()), g_(stack.gravity), mass_(stack.mass.begin(), stack.mass.end()),
          restitution_(stack.restitution.begin(), stack.restitution.end()), gap_(stack.gap.begin(), stack.gap.end()),
          rate_(n_), struck_(n_, 0) {
        for (std::size_t i = 0; i < n_; ++i)
            rate_[i] = static_cast<Real>(stack.velocity[i]) - (i > 0 ? stack.velocity[i - 1] : 0);
    }

    /// Returns the time; negative after too many impacts.
    Real rest() {
        const Real first = scale();
        Real time = 0;
        long in_vain = 0; // impacts between which no time has passed
        Real fastest = 0; // of these
        for (long impacts = 1; impacts < 3'000'000; ++impacts) {
            for (std::size_t i = 0; i < n_; ++i)
                if (g_ > 0 && gap_[i] == 0 && std::abs(rate_[i]) < 1e-25L * first)
                    rate_[i] = 0;
            if (const Real speed = strike(impacts); speed > 0) {
                fastest = in_vain++ == 0 ? speed : std::max(fastest, speed);
                slow_ = speed < 1e-18L * fastest ? slow_ + 1 : 0;
                if (slow_ > 30) { // these have come to rest at one another
                    for (std::size_t i = 0; i < n_; ++i)
                        if (impacts - struck_[i] < 30)
                            gap_[i] = rate_[i] = 0;
                    in_vain = slow_ = 0;
                }
                continue;
            }
            std::vector<Real> acceleration(n_, -g_);
            std::size_t supported = 0;
            while (supported < n_ && gap_[supported] == 0 && rate_[supported] == 0)
                acceleration[supported++] = 0;
            if (supported == n_ || (g_ > 0 && scale() < 1e-20L * first))
                return time;
            for (std::size_t i = n_; i-- > 1;)
                acceleration[i] -= acceleration[i - 1];
            Real flight = -1;
            std::size_t next = 0;
            for (std::size_t i = 0; i < n_; ++i)
                if (const Real t = fall(i, acceleration[i]); t >= 0 && (flight < 0 || t < flight)) {
                    flight = t;
                    next = i;
                }
            if (flight < 0)
                return -1;
            for (std::size_t i = 0; i < n_; ++i) {
                gap_[i] =
                    i == next ? 0 : std::max<Real>(0, gap_[i] + flight * (rate_[i] + acceleration[i] * flight / 2));
                rate_[i] += acceleration[i] * flight;
            }
            time += flight;
            in_vain = flight > 1e-22L * time ? 0 : in_vain;
        }
        return -1;
    }

private:
    Real scale() const {
        Real result = 0;
        for (std::size_t i = 0; i < n_; ++i)
            result = std::max({result, std::abs(rate_[i]), std::sqrt(2 * std::abs(g_) * gap_[i])});
        return result;
    }

    /// Makes the first impact that is due. @return its speed; 0 if there is none
    Real strike(long number) {
        for (std::size_t i = 0; i < n_; ++i) {
            if (gap_[i] != 0 || !(rate_[i] < 0))
                continue;
            struck_[i] = number;
            const Real speed = -rate_[i];
            const Real mass = i == 0 ? mass_[0] : mass_[i - 1] * mass_[i] / (mass_[i - 1] + mass_[i]);
            const Real impulse = -(1 + restitution_[i]) * rate_[i] * mass;
            rate_[i] *= -restitution_[i];
            if (i > 0)
                rate_[i - 1] -= impulse / mass_[i - 1];
            if (i + 1 < n_)
                rate_[i + 1] -= impulse / mass_[i];
            return speed;
        }
        return 0;
    }

    Real fall(std::size_t i, Real a) const {
        const Real u = rate_[i], g = gap_[i];
        if (g == 0 && u == 0)
            return -1;
        const Real root = std::sqrt(std::max<Real>(0, u * u - 2 * a * g));
        if (a < 0)
            return u > 0 ? (u + root) / -a : 2 * g / (root - u);
        return u < 0 && u * u - 2 * a * g >= 0 ? 2 * g / (root - u) : -1;
    }

    std::size_t n_;
    Real g_;
    std::vector<Real> mass_, restitution_, gap_, rate_;
    std::vector<long> struck_; ///< the last impact of each contact
    int slow_ = 0;
};

/// Returns the time at which a stack rests; negative if it is not known to 1e-11, because the order of impacts depends
/// on the last digits of the initial state, or after too many impacts.
inline double known_rest(const Stack& stack) {
    Stack beside = stack;
    beside.gap.back() *= 1 + 1e-14;
    beside.restitution.front() *= 1 + 1e-14;
    const StackReference::Real time = StackReference(stack).rest(), other = StackReference(beside).rest();
    return time >= 0 && std::abs(other - time) <= 1e-11L * time ? static_cast<double>(time) : -1;
}

} // namespace graze::testing
