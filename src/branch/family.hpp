#pragma once

#include "graze/branch/orbit_branch.hpp"
#include "graze/branch/switching.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace graze {

/// A family of orbits at the same parameters, as an ordinary branch of an unfolded model.
///
/// Where a motion conserves a quantity H, the equations of a periodic orbit depend on each other, and orbits form
/// families. The unfolded model has one more parameter for each such quantity, which multiplies the gradient of H in
/// the field: H then grows all along a motion, so that an orbit can only close where the parameter is zero. With this
/// parameter among the unknowns the equations are regular (F. J. Munoz-Almaraz, E. Freire, J. Galan, E. Doedel and A.
/// Vanderbauwhede, Physica D 181, 2003). Where no quantity is declared, the field is unfolded by the distance from the
/// orbit's mean state, with the same effect if the quantity grows with it.
class Family {
public:
    /// Returns the unfolded branch that the settings stand for. Empty where they mean an ordinary branch: of a model
    /// that conserves nothing, or whose parameters `free` end the families.
    /// @throws InputError when the candidate is not an orbit of a family, although settings ask for one
    static std::optional<Family> of(const System& system, const Orbit& candidate, const BranchSettings& settings);

    const System& system() const { return system_; }
    const BranchSettings& settings() const { return settings_; }
    /// Returns the member of the family that is nearest to the candidate, in the unfolded model.
    const Orbit& start() const { return start_; }

    /// Conversions to the unfolded model, whose last parameters are zero, and back.
    Orbit unfolded(Orbit orbit) const;
    SpecialPoint unfolded(SpecialPoint point) const;
    Orbit folded(Orbit orbit) const;
    void fold(BranchPoint& point) const;
    /// @param before, after the last two points of the branch, folded
    void fold(SpecialPoint& point, const BranchPoint& before, const BranchPoint& after) const;

private:
    Family(System system, BranchSettings settings, std::size_t parameters, std::size_t monitors)
        : system_(std::move(system)), settings_(std::move(settings)), parameters_(parameters), monitors_(monitors) {}
    bool is_coordinate() const { return settings_.family && !settings_.kept; }
    double take_coordinate(const Orbit& orbit, std::vector<double>& monitors) const;

    System system_;
    BranchSettings settings_; ///< of the unfolded branch; its last monitor is the coordinate if it follows a family,
                              ///< others follow those asked for
    std::size_t parameters_, monitors_; ///< numbers of those of the model itself, and of the branch that was asked for
    Orbit start_;
};

} // namespace graze
