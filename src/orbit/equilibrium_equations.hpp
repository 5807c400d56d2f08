#pragma once

#include "graze/flow/system.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// Derivatives of expressions that are not identically zero, evaluated into dense matrices.
class SparseDerivatives {
public:
    SparseDerivatives() = default;
    /// @param inputs of the function; @param expressions to differentiate
    /// @param symbols with respect to which; their order is that of the columns
    SparseDerivatives(const SymbolIndex& inputs, std::span<const Expression> expressions,
                      std::span<const Expression> symbols);
    /// Returns one row for each expression, one column for each symbol.
    Eigen::MatrixXd operator()(std::span<const double> inputs) const;

private:
    struct Place {
        Eigen::Index row, column;
    };
    Eigen::Index rows_ = 0, columns_ = 0;
    std::vector<Place> places_;
    Function values_;
};

/// The equations of equilibria in one mode: the rates of the active states are zero. Active are the states whose rate
/// depends on states, except drifting ones. Clocks (cyclic states that advance at a rate of their own), drifting states
/// and states that do not move keep the values that they are given. All derivatives are symbolic.
///
/// In a mode that slides along surfaces the field says nothing of how far a state is from them. There it is completed
/// so that distances decay, each at a rate of its own, which adds an eigenvalue for each surface.
class EquilibriumEquations {
public:
    /// @param free independent parameters with respect to which derivatives are computed
    EquilibriumEquations(const System& system, std::size_t mode, std::vector<ParameterId> free);

    const System& system() const { return system_; }
    std::size_t mode() const { return mode_; }
    const std::vector<ParameterId>& free() const { return free_; }
    /// The active states, rising.
    const std::vector<std::size_t>& active() const { return active_; }
    const std::vector<std::size_t>& clocks() const { return clocks_; }
    /// The eigenvalues that sliding along surfaces adds to those of the motion.
    const std::vector<double>& added_eigenvalues() const { return added_; }
    /// Number of equations, which is that of active states.
    Eigen::Index size() const { return static_cast<Eigen::Index>(active_.size()); }
    /// Number of variables: active states, then free parameters.
    Eigen::Index variables() const { return size() + static_cast<Eigen::Index>(free_.size()); }

    /// Returns why the mode has no equilibria at these parameters: a state that moves steadily; empty if it may have.
    std::string why_none(std::span<const double> parameters) const;
    /// Returns the rates of the active states, then their derivatives with respect to them, row by row, as a function
    /// of the active states, the other states and the independent parameters.
    Function rates_for_search() const;
    /// Rates of the active states.
    Eigen::VectorXd rates(std::span<const double> state, std::span<const double> parameters) const;
    /// Bounds of their round-off.
    Eigen::VectorXd round_off(std::span<const double> state, std::span<const double> parameters) const;
    /// Derivatives of the rates with respect to all variables.
    Eigen::MatrixXd jacobian(std::span<const double> state, std::span<const double> parameters) const;
    /// Derivatives, with respect to all variables, of the derivative of the rates along a direction of the variables.
    /// @param direction may end with the active states; parameters then stay
    Eigen::MatrixXd second(std::span<const double> state, std::span<const double> parameters,
                           const Eigen::VectorXd& direction) const;

private:
    friend class EquilibriumThirdDerivatives;
    void classify();
    void keep_to_surfaces();
    std::vector<double> inputs(std::span<const double> state, std::span<const double> parameters) const;

    System system_;
    std::size_t mode_;
    std::vector<ParameterId> free_;
    std::vector<std::size_t> active_, clocks_, steady_; ///< steady: moves at a rate that depends on parameters only
    std::vector<double> added_;
    Model model_; ///< a copy, whose graph may grow
    std::vector<Expression> rates_of_all_, rates_, variables_, direction_, other_;
    /// States, independent parameters, a direction of the variables and one of the active states.
    SymbolIndex symbols_;
    Function values_, steady_rates_;
    SparseDerivatives first_, second_;
};

/// The third derivatives of the equations, which normal forms need; compiled apart because they are large.
class EquilibriumThirdDerivatives {
public:
    explicit EquilibriumThirdDerivatives(const EquilibriumEquations& equations);
    /// Returns the derivatives, with respect to the active states, of the second derivative along two directions.
    Eigen::MatrixXd operator()(std::span<const double> state, std::span<const double> parameters,
                               const Eigen::VectorXd& one, const Eigen::VectorXd& other) const;

private:
    const EquilibriumEquations* equations_;
    SparseDerivatives derivatives_;
};

} // namespace graze
