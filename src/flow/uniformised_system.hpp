#pragma once

#include "graze/base/require.hpp"
#include "graze/flow/system.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// A radicand g of a mode that vanishes with an event which the mode watches: the argument of roots and of powers with
/// fractional exponents r/q in its rates. Its root y = g^(1/q) and the time change dt = q y^(q-1) ds turn the rates
/// into functions that are analytic at g = 0:
///
///     x' = q y^(q-1) f(x, y^r),   y' = the rate of g along f,   t' = q y^(q-1).
///
/// (The local uniformisation of an algebraic branch point: x is a Puiseux series in t, and a power series in s.)
///
/// Exponents that are parameters or irrational have no such root. Then the motion is followed in time up to a
/// negligible distance from g = 0.
struct UniformisedRoot {
    int degree = 0;     ///< q; 0: the exponents are no multiples of a common fraction
    Function exponents; ///< as functions of the parameters
    Function radicand;  ///< g, then its derivatives with respect to states and parameters
    Function field;     ///< f, as a function of the states and parameters of `UniformisedSystem::modes`
    std::size_t inside = 0, outside = 0; ///< the modes for g > 0, and for g < 0, where the powers are taken to be 0
    std::size_t output = 0;              ///< index of g among the observed expressions
};

/// The modes of a system in variables in which the motion is analytic where radicands vanish. States: those of the
/// system, then y and t; in modes `outside` the independent variable is t.
class UniformisedSystem {
public:
    explicit UniformisedSystem(const System& system);

    std::span<const UniformisedRoot> roots(std::size_t mode) const { return item_at(roots_, mode, "mode"); }
    /// Requires that a mode has roots.
    const System& modes() const { return *modes_; }

private:
    std::vector<std::vector<UniformisedRoot>> roots_; ///< of each mode
    std::optional<System> modes_;
};

/// Returns rates in which powers of those radicands that vanish with an event of the mode are zero where the radicand
/// is negative; elsewhere they have the same values, bit for bit. @param ends functions of the mode's events
std::vector<Expression> extended_rates(const std::vector<Expression>& rates, std::span<const Expression> ends,
                                       const SymbolIndex& states);

/// Returns the functions that are zero where a mode ends. @param expand reduces expressions to states and parameters
std::vector<Expression> ends_of_mode(Model& model, std::size_t mode);

} // namespace graze
