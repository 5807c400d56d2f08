#pragma once

#include "graze/base/input_error.hpp"
#include "graze/branch/orbit_branch.hpp"
#include "graze/branch/torus_branch.hpp"
#include "graze/results/run_kind.hpp"
#include "graze/study/motion_request.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// What runs of the kinds orbit, equilibrium, continue, curve, ladder and torus ask for.
struct BranchRequest {
    std::string signature; ///< of the first orbit; empty: any
    Place signature_place;
    std::string table;      ///< file of a motion that the first orbit is near to; empty: none
    std::string table_text; ///< contents of that file, where they are known and no file is to be read
    BranchSettings settings;
    SweepDirection direction = SweepDirection::up; ///< in which the parameter changes at first
    std::size_t rungs = 8;                         ///< of ladders: number of grazings at most
    TorusResolution torus;                         ///< of tori
    bool touches = false;                          ///< OrbitRecord::touch is computed for orbits that touch
    std::vector<StateBounds> within;               ///< box in which equilibria are searched for; empty: none
    bool every_mode = false;                       ///< search for them in all modes, not only in the initial one
    AttractorOptions attractor;                    ///< how a simulated motion settles on the first orbit
    SimulationOptions simulation;                  ///< of that motion; orbits have the tolerance of `settings`

    bool has_table() const { return !table.empty() || !table_text.empty(); }
    /// Sets the tolerance of all integration: of orbits, and of the motion that leads to the first one. By default
    /// these differ: 1e-13 and 1e-12.
    void set_tolerance(double tolerance) { simulation.tolerance = settings.orbit.tolerance = tolerance; }
    /// Whether a curve holds the condition of its first point, rather than a monitor that is fixed.
    bool keeps_point() const;
    /// How many of the free parameters the conditions of the point need: two for a point of codimension two.
    std::size_t kept_conditions() const;
    /// Of curves as if a point whose condition can be held was known already. @throws InputError as
    /// BranchSettings::validate
    void validate(RunKind kind, const Model& model) const;
};

} // namespace graze
