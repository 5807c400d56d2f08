#pragma once

#include "../odeint_peer.hpp"
#include "motion.hpp"

#include <cmath>

namespace peers {

/// The electromagnetic vibro-impactor (models/electromagnetic-testbed.toml), nondimensional: displacement, velocity,
/// current, phase of the voltage. Derivatives by a parameter are those by the voltage.
template <class Real>
class TestbedMotion : public Motion<Real> {
public:
    explicit TestbedMotion(const OdeintPeer::Parameters& groups)
        : voltage_(groups.voltage), frequency_(groups.frequency), damping_(groups.damping),
          restitution_(groups.restitution), gap_(groups.gap), stop_(groups.stop), inductance_(groups.inductance),
          resistance_(groups.resistance) {}

    std::size_t states() const override { return 4; }
    void rates(std::size_t, const Real* x, Real* rates) const override {
        using std::sin;
        const Real r = 1 / (1 + gap_ - x[0]);
        rates[0] = x[1];
        rates[1] = x[2] * x[2] * r * r - x[0] - 2 * damping_ * x[1];
        rates[2] = (voltage_ * sin(x[3]) - (resistance_ + x[1] * r * r) * x[2]) / (inductance_ + r);
        rates[3] = frequency_;
    }
    void derivative_rates(std::size_t, const Real* x, std::span<const Real* const> columns,
                          std::span<Real* const> rates) const override {
        using std::sin;
        const Rows by = rows(x);
        for (std::size_t j = 0; j < columns.size(); ++j) {
            const Real* s = columns[j];
            rates[j][0] = s[1];
            rates[j][1] = by.velocity[0] * s[0] + by.velocity[1] * s[1] + by.velocity[2] * s[2];
            rates[j][2] = by.current[0] * s[0] + by.current[1] * s[1] + by.current[2] * s[2] + by.current[3] * s[3];
            rates[j][3] = 0;
        }
        rates.back()[2] += sin(x[3]) / (inductance_ + 1 / (1 + gap_ - x[0]));
    }
    void jacobian(std::size_t, const Real* x, const typename Motion<Real>::Entry& entry) const override {
        const Rows by = rows(x);
        entry(0, 1, 1);
        for (std::size_t i = 0; i < 3; ++i)
            entry(1, i, by.velocity[i]);
        for (std::size_t i = 0; i < 4; ++i)
            entry(2, i, by.current[i]);
    }

    std::size_t surfaces(std::size_t) const override { return 1; }
    void distances(std::size_t, const Real* x, Real* values) const override { values[0] = stop_ - x[0]; }
    Real gradient_times(std::size_t, std::size_t, const Real* column) const override { return -column[0]; }
    std::size_t cross(std::size_t, std::size_t, Real* x) const override {
        x[0] = stop_;
        x[1] *= -restitution_;
        return 0;
    }
    void cross_derivative(std::size_t, std::size_t, Real* column) const override { column[1] *= -restitution_; }

private:
    struct Rows {
        Real velocity[3], current[4];
    };
    Rows rows(const Real* x) const {
        using std::cos, std::sin;
        const Real r = 1 / (1 + gap_ - x[0]), total = inductance_ + r, resistance = resistance_ + x[1] * r * r;
        const Real rate = (voltage_ * sin(x[3]) - resistance * x[2]) / total;
        return {{2 * x[2] * x[2] * r * r * r - 1, -2 * damping_, 2 * x[2] * r * r},
                {(-2 * x[1] * r * r * r * x[2] - rate * r * r) / total, -r * r * x[2] / total, -resistance / total,
                 voltage_ * cos(x[3]) / total}};
    }
    Real voltage_, frequency_, damping_, restitution_, gap_, stop_, inductance_, resistance_;
};

} // namespace peers
