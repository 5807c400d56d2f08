#pragma once

#include "../chain.hpp"
#include "motion.hpp"

#include <vector>

namespace peers {

/// The chain of benchmarks/chain.hpp. States are ordered phase, x_1, v_1, x_2, v_2, ..., which keeps the Jacobian's
/// entries near the diagonal.
template <class Real>
class ChainMotion : public Motion<Real> {
public:
    ChainMotion(std::size_t oscillators, double force) : count_(oscillators), force_(force), stiffness_(oscillators) {}

    std::size_t states() const override { return 2 * count_ + 1; }
    void rates(std::size_t, const Real* x, Real* rates) const override {
        using std::cos;
        rates[0] = omega;
        for (std::size_t i = 0; i < count_; ++i) {
            const Real* own = x + 1 + 2 * i;
            Real stretch = 2 * own[0];
            if (i > 0)
                stretch -= own[-2];
            if (i + 1 < count_)
                stretch -= own[2];
            rates[1 + 2 * i] = own[1];
            rates[2 + 2 * i] =
                -spring * own[0] - damping * own[1] - coupling * stretch - cubic * own[0] * own[0] * own[0];
        }
        rates[2] += force_ * cos(x[0]);
    }
    void derivative_rates(std::size_t, const Real* x, std::span<const Real* const> columns,
                          std::span<Real* const> rates) const override {
        using std::cos, std::sin;
        const Real by_phase = -force_ * sin(x[0]);
        find_stiffness(x);
        for (std::size_t j = 0; j < columns.size(); ++j) {
            const Real* s = columns[j];
            Real* rate = rates[j];
            rate[0] = 0;
            for (std::size_t i = 0; i < count_; ++i) {
                const Real* own = s + 1 + 2 * i;
                Real sum = stiffness_[i] * own[0] - damping * own[1];
                if (i > 0)
                    sum += coupling * own[-2];
                if (i + 1 < count_)
                    sum += coupling * own[2];
                rate[1 + 2 * i] = own[1];
                rate[2 + 2 * i] = sum;
            }
            rate[2] += by_phase * s[0];
        }
        rates.back()[2] += cos(x[0]);
    }
    std::size_t lower_bandwidth() const override { return 3; }
    std::size_t upper_bandwidth() const override { return 1; }
    void jacobian(std::size_t, const Real* x, const typename Motion<Real>::Entry& entry) const override {
        using std::sin;
        find_stiffness(x);
        entry(2, 0, -force_ * sin(x[0]));
        for (std::size_t i = 0; i < count_; ++i) {
            const std::size_t own = 1 + 2 * i;
            entry(own, own + 1, 1);
            entry(own + 1, own, stiffness_[i]);
            entry(own + 1, own + 1, -damping);
            if (i > 0)
                entry(own + 1, own - 2, coupling);
            if (i + 1 < count_)
                entry(own + 1, own + 2, coupling);
        }
    }

    std::size_t surfaces(std::size_t) const override { return count_; }
    void distances(std::size_t, const Real* x, Real* values) const override {
        for (std::size_t i = 0; i < count_; ++i)
            values[i] = wall - x[1 + 2 * i];
    }
    Real gradient_times(std::size_t, std::size_t surface, const Real* column) const override {
        return -column[1 + 2 * surface];
    }
    std::size_t cross(std::size_t, std::size_t surface, Real* x) const override {
        x[1 + 2 * surface] = wall;
        x[2 + 2 * surface] *= -restitution;
        return 0;
    }
    void cross_derivative(std::size_t, std::size_t surface, Real* column) const override {
        column[2 + 2 * surface] *= -restitution;
    }

private:
    void find_stiffness(const Real* x) const {
        for (std::size_t i = 0; i < count_; ++i)
            stiffness_[i] = -(spring + 2 * coupling) - 3 * cubic * x[1 + 2 * i] * x[1 + 2 * i];
    }

    static constexpr Real spring = Chain::spring, damping = Chain::damping, coupling = Chain::coupling,
                          cubic = Chain::cubic, omega = Chain::frequency, wall = Chain::wall,
                          restitution = Chain::restitution;
    std::size_t count_;
    Real force_;
    mutable std::vector<Real> stiffness_;
};

} // namespace peers
