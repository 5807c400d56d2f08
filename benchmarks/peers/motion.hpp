#pragma once

#include <cstddef>
#include <functional>
#include <span>

namespace peers {

/// A hybrid motion written by hand, as a careful user of an integrator would: rates, how derivatives of the state
/// change along it, surfaces that it meets from above, and what happens there. In double precision for CVODES, in long
/// double for a reference.
template <class Real>
class Motion {
public:
    virtual ~Motion() = default;
    virtual std::size_t states() const = 0;
    virtual void rates(std::size_t mode, const Real* x, Real* rates) const = 0;
    /// Rates of derivatives: the Jacobian times each column, plus, for the last one, how the rates depend on the
    /// parameter by which that one is.
    virtual void derivative_rates(std::size_t mode, const Real* x, std::span<const Real* const> columns,
                                  std::span<Real* const> rates) const = 0;
    /// How far from the diagonal the Jacobian has entries.
    virtual std::size_t lower_bandwidth() const { return states() - 1; }
    virtual std::size_t upper_bandwidth() const { return states() - 1; }
    using Entry = std::function<void(std::size_t row, std::size_t column, Real value)>;
    virtual void jacobian(std::size_t mode, const Real* x, const Entry& entry) const = 0;

    virtual std::size_t surfaces(std::size_t mode) const = 0;
    /// Of each surface of the mode: positive before it is met.
    virtual void distances(std::size_t mode, const Real* x, Real* values) const = 0;
    /// The gradient of that function times a column.
    virtual Real gradient_times(std::size_t mode, std::size_t surface, const Real* column) const = 0;
    /// What happens at a surface. @return the mode after
    virtual std::size_t cross(std::size_t mode, std::size_t surface, Real* x) const = 0;
    /// The derivatives of that map of states times a column.
    virtual void cross_derivative(std::size_t mode, std::size_t surface, Real* column) const = 0;
};

/// Carries a state over a surface, and derivatives with it, which also know that neighbours meet it earlier or later
/// (M. A. Aizerman and F. R. Gantmakher, 1958). @param work of three times as many numbers as there are states
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
