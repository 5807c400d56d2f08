#pragma once

#include "graze/model/model.hpp"
#include "model/start_values.hpp"

#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace graze {

/// A direction in which a contact acts: normal to the surface or along it.
struct ContactDirection {
    Expression velocity{};              ///< of the bodies relative to each other
    std::vector<Expression> slopes{};   ///< derivatives of this with respect to the velocities of the model
    std::vector<Expression> response{}; ///< change of the velocities of the model by a unit impulse
    Expression acceleration{};          ///< rate of this velocity without contact forces

    /// Returns how much changes of the model's velocities change this one.
    Expression along(const std::vector<Expression>& changes) const;
};

/// A direction that follows from others.
struct DirectionDependence {
    std::vector<Expression> shares{}; ///< of each of the others; the number 0 where it is zero everywhere
    std::vector<double> at_start{};   ///< the values of these at the initial state
    bool everywhere = false;          ///< in all configurations, not only at the initial state
    /// Positive where the difference is round-off; the number 1 if it is everywhere.
    Expression same{};
    /// Velocities of dependent directions may still differ, as slips on belts of different speeds: positive where they
    /// do, but for round-off; the number 0 if they differ nowhere.
    Expression apart{};
};

/// Tries Cholesky's method, which needs pivots above this share of the diagonal. @param matrix symmetric, n x n
bool has_positive_pivots(std::vector<double> matrix, std::size_t n, double share);

/// Directions of all contacts, and how they depend on one another at the initial state: the normal of contact i is
/// number 2i, its slip 2i + 1.
class ContactDirections {
public:
    /// @param model must outlive this
    explicit ContactDirections(const Model& model) : model_(model) {}

    void add_contact(ContactDirection normal, std::optional<ContactDirection> slip);
    /// Computes products of all directions, once all contacts are there.
    /// @param velocities symbols of the states that impulses change
    /// @param gaps of the contacts, expanded
    void note(std::vector<Expression> velocities, std::vector<Expression> gaps);

    const StartValues& start() const { return start_; }
    std::size_t contacts() const { return directions_.size() / 2; }
    bool has(std::size_t direction) const { return directions_[direction].has_value(); }
    const ContactDirection& operator[](std::size_t direction) const { return *directions_[direction]; }

    /// Returns whether directions are independent.
    bool independent(const std::vector<std::size_t>& directions) const;
    /// Returns how a direction follows from others, which are independent; none if it does not.
    std::optional<DirectionDependence> dependence(std::size_t direction, const std::vector<std::size_t>& others) const;

    /// Returns what is positive if a difference is not zero, but for round-off. @param squares sum of those of its
    /// parts
    static Expression apart(const Expression& difference, const Expression& squares) {
        constexpr double at_once = 1e-24;
        return difference * difference - at_once * squares;
    }

private:
    DirectionDependence dependence_of(std::size_t direction, const std::vector<std::size_t>& others) const;
    std::vector<Expression> shares(std::size_t direction, const std::vector<std::size_t>& others) const;
    Expression without_velocities(std::size_t direction) const;

    const Model& model_;
    std::vector<Expression> velocities_, gaps_;
    std::vector<std::optional<ContactDirection>> directions_;
    StartValues start_;
    std::vector<double> products_; ///< of all directions, row by row; none if they are not defined
    /// What has been asked before: the same questions come for each combination of contacts.
    mutable std::map<std::pair<std::size_t, std::vector<std::size_t>>, DirectionDependence> known_;
};

} // namespace graze
