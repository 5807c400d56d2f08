#pragma once

#include <cstddef>
#include <functional>
#include <span>

namespace peers {

/// A hand-written hybrid motion, as a careful user of an integrator would write it: rates, variational rates, surfaces
/// that the motion reaches from positive values, and the maps there. In double precision for CVODES, in long double for
/// the reference.
template <class Real>
class Motion {
public:
    virtual ~Motion() = default;
    virtual std::size_t states() const = 0;
    virtual void rates(std::size_t mode, const Real* x, Real* rates) const = 0;
    /// Rates of the derivatives: the Jacobian times each column, plus, for the last column, the derivative of the rates
    /// with respect to the parameter.
    virtual void derivative_rates(std::size_t mode, const Real* x, std::span<const Real* const> columns,
                                  std::span<Real* const> rates) const = 0;
    /// Bandwidths of the Jacobian.
    virtual std::size_t lower_bandwidth() const { return states() - 1; }
    virtual std::size_t upper_bandwidth() const { return states() - 1; }
    using Entry = std::function<void(std::size_t row, std::size_t column, Real value)>;
    virtual void jacobian(std::size_t mode, const Real* x, const Entry& entry) const = 0;

    virtual std::size_t surfaces(std::size_t mode) const = 0;
    /// Values of the mode's surface functions, positive before the surface is reached.
    virtual void distances(std::size_t mode, const Real* x, Real* values) const = 0;
    /// The gradient of a surface function times a column.
    virtual Real gradient_times(std::size_t mode, std::size_t surface, const Real* column) const = 0;
    /// Applies the map at a surface to the state. @return the next mode
    virtual std::size_t cross(std::size_t mode, std::size_t surface, Real* x) const = 0;
    /// Multiplies a column by the derivative of that map.
    virtual void cross_derivative(std::size_t mode, std::size_t surface, Real* column) const = 0;
};

/// Applies the map at a surface to a state and its derivatives, with the saltation correction for the changed event
/// time (M. A. Aizerman and F. R. Gantmakher, 1958). @param work array of three times the number of states
template <class Real>
std::size_t cross_with_derivatives(const Motion<Real>& motion, std::size_t mode, std::size_t surface, Real* x,
                                   std::span<Real* const> columns, Real* work) {
    const std::size_t n = motion.states();
    Real *before = work, *after = work + n, *carried = work + 2 * n;
    motion.rates(mode, x, before);
    const Real approach = motion.gradient_times(mode, surface, before);
    const std::size_t next = motion.cross(mode, surface, x);
    motion.rates(next, x, after);
    for (std::size_t i = 0; i < n; ++i)
        carried[i] = before[i];
    motion.cross_derivative(mode, surface, carried);
    for (Real* column : columns) {
        const Real later = -motion.gradient_times(mode, surface, column) / approach;
        motion.cross_derivative(mode, surface, column);
        for (std::size_t i = 0; i < n; ++i)
            column[i] += (carried[i] - after[i]) * later;
    }
    return next;
}

} // namespace peers
