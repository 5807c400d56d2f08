#pragma once

#include "sweep/field_map.hpp"

#include <Eigen/Core>

#include <optional>

namespace graze {

/// A state at which everything except clocks and drifting states is at rest, and the linearised field there.
struct Equilibrium {
    std::vector<double> state;
    std::size_t mode = 0;
    std::vector<std::size_t> active;   ///< states that take part: neither clocks, drifting nor conserved
    Eigen::VectorXd scale;             ///< scales of the active states
    Eigen::MatrixXd field;             ///< linear part, in these scales
    Eigen::VectorXcd values;           ///< its eigenvalues, largest real part first
    Eigen::MatrixXcd basis, inverse;   ///< basis in which the linear part is diagonal or nearly so, and its inverse
    Eigen::VectorXd leading_direction; ///< real, in these scales
    /// True if clocks change the linear part: then stability is decided by multipliers of the return map, not by
    /// eigenvalues.
    bool driven = false;

    /// Returns the index of the active state number i.
    std::size_t place(Eigen::Index i) const { return active[static_cast<std::size_t>(i)]; }
    /// Returns the largest real part of an eigenvalue; zero if nothing moves.
    double growth() const { return values.size() > 0 ? values[0].real() : 0; }
    double largest_rate() const { return values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0; }
    bool is_stable() const;
    bool is_unstable() const;
};

/// Finds equilibria from the vector field; this is much cheaper than following the motion to them.
class EquilibriumFinder {
public:
    explicit EquilibriumFinder(const FieldMap& field) : field_(&field) {}

    void begin(std::span<const double> parameters, std::span<const double> periods);
    /// Finds an equilibrium by Newton's method.
    /// @param extents range through which each state has moved; may be zero
    std::optional<Equilibrium> find(std::span<const double> state, std::size_t mode, std::span<const double> extents);
    /// Returns the rates at a state.
    std::span<const double> rates(std::span<const double> state, std::size_t mode);
    /// Returns the size of a deviation in a norm that decreases along every motion of a stable linear part.
    double distance(const Equilibrium& equilibrium, std::span<const double> state) const;
    /// Returns whether the field within this distance is so nearly linear that all motions approach the equilibrium or
    /// (if not `strict`) that they differ little from the linear ones during one turn; and no event is within this
    /// distance.
    bool is_linear_within(const Equilibrium& equilibrium, double distance, bool strict);
    /// Returns the equilibrium displaced in the direction that grows fastest.
    /// @param share of the length over which the field remains linear
    /// @param motion states that keep their signs are displaced to its side; from zero to a positive value
    std::vector<double> displaced(const Equilibrium& equilibrium, double share, std::span<const double> motion);
    /// Returns whether a state is a clock here: cyclic, with a rate that is independent of all states.
    bool is_clock(std::size_t index, std::span<const double> state, std::size_t mode);

    /// For a state whose rate vanishes with it, returns the value up to which the rate is proportional to it, to within
    /// a tenth; 0: up to the largest numbers.
    /// @param from a small value
    double linear_length(std::span<const double> state, std::size_t mode, std::size_t index, double from);

private:
    void balance(Equilibrium& equilibrium, const std::vector<bool>& has_size) const;
    Eigen::VectorXd linearise(const Equilibrium& equilibrium, std::span<const double> state, Eigen::MatrixXd& field);
    double phase_of(std::size_t k, std::size_t clock) const;
    bool solve(Equilibrium& equilibrium, std::span<const double> extents);
    bool classify(Equilibrium& equilibrium);
    bool rests_at_all_phases(Equilibrium& equilibrium);
    bool find_basis(Equilibrium& equilibrium) const;
    bool events_are_away(const Equilibrium& equilibrium, double distance);
    double remainder(const Equilibrium& equilibrium, const Eigen::VectorXd& deviation);

    const FieldMap* field_;
    FieldMap::Workspace workspace_;
    std::vector<double> periods_;
    std::vector<std::size_t> clocks_;
};

} // namespace graze
