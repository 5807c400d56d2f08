#pragma once

#include "sweep/field_map.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// A state at which all but clocks and drifting states rest, and the field near it.
struct Equilibrium {
    std::vector<double> state;
    std::size_t mode = 0;
    std::vector<std::size_t> active;   ///< states that move near it: neither clocks, drifting nor conserved
    Eigen::VectorXd scale;             ///< of active states
    Eigen::MatrixXd field;             ///< linear part, in these scales
    Eigen::VectorXcd values;           ///< its eigenvalues, largest real part first
    Eigen::MatrixXcd basis, inverse;   ///< in which the linear part is diagonal, or nearly
    Eigen::VectorXd leading_direction; ///< real, in these scales
    /// Whether clocks change the linear part: then eigenvalues say nothing, but multipliers of the return map do.
    bool driven = false;

    /// Largest real part of an eigenvalue; zero if nothing moves.
    double growth() const { return values.size() > 0 ? values[0].real() : 0; }
    double largest_rate() const { return values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0; }
    bool is_stable() const;
    bool is_unstable() const;
};

/// Looks for equilibria in the field itself, which costs next to nothing beside following the motion there.
class EquilibriumFinder {
public:
    explicit EquilibriumFinder(const FieldMap& field) : field_(&field) {}

    void begin(std::span<const double> parameters, std::span<const double> periods);
    /// By Newton's method.
    /// @param extents through which each state has moved; may be zero
    std::optional<Equilibrium> find(std::span<const double> state, std::size_t mode, std::span<const double> extents);
    /// Of a state.
    std::span<const double> rates(std::span<const double> state, std::size_t mode);
    /// Size of a state's deviation in a measure that shrinks along every motion of the linear part of a stable one.
    double distance(const Equilibrium& equilibrium, std::span<const double> state) const;
    /// Whether the field within this distance is so nearly linear that every motion in it comes closer, or (if not
    /// `strict`) that it differs little from the linear one in a single turn; and no event is within reach.
    bool is_linear_within(const Equilibrium& equilibrium, double distance, bool strict);
    /// The equilibrium displaced in the direction that grows most.
    /// @param share of the length over which the field there remains linear
    /// @param motion state, on whose side states that keep their signs are displaced; from zero to above it
    std::vector<double> displaced(const Equilibrium& equilibrium, double share, std::span<const double> motion);
    /// Whether a state is a clock here: cyclic, with a rate that depends on nothing.
    bool is_clock(std::size_t index, std::span<const double> state, std::size_t mode);

    /// Up to what value of a state whose rate vanishes with it that rate is proportional to it, to within a tenth; 0:
    /// up to the end of the range of numbers.
    /// @param from a value that is small
    double linear_length(std::span<const double> state, std::size_t mode, std::size_t index, double from);

private:
    void balance(Equilibrium& equilibrium, const std::vector<bool>& has_size) const;
    bool solve(Equilibrium& equilibrium, std::span<const double> extents);
    bool classify(Equilibrium& equilibrium);
    bool rests_at_all_phases(Equilibrium& equilibrium);
    bool find_basis(Equilibrium& equilibrium) const;
    bool events_are_away(const Equilibrium& equilibrium, double distance);
    double remainder(const Equilibrium& equilibrium, const Eigen::VectorXd& deviation);
    Eigen::VectorXd deviation(const Equilibrium& equilibrium, std::span<const double> state) const;

    const FieldMap* field_;
    FieldMap::Workspace workspace_;
    std::vector<double> periods_;
    std::vector<std::size_t> clocks_;
};

} // namespace graze
