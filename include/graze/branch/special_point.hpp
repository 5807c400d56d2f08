#pragma once

#include "graze/orbit/solve.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

/// Types of points on a branch of periodic orbits or equilibria. Each has an entry at the same index in the table of
/// kinds.
enum class PointType {
    fold,              ///< SN: the branch has a fold; a multiplier is 1
    flip,              ///< PD: a multiplier is -1
    torus,             ///< NS: two multipliers lie on the unit circle
    branch_point,      ///< BP: another branch crosses
    asymmetry,         ///< SB: symmetry breaking; the half map of a symmetric orbit has a multiplier -1
    grazing,           ///< GR: the surface of an event is touched with zero speed, inside an arc or at its end
    vanishing,         ///< DZ: a segment's duration reaches zero
    two_events,        ///< EE: two events happen simultaneously
    guard,             ///< GU: the guard after a jump is about to choose another mode
    cusp,              ///< CP: on a curve of folds: two folds meet
    generalised,       ///< GF: on a curve of flips or symmetry breakings: criticality changes (generalised flip)
    generalised_torus, ///< GT: on a curve of torus points: criticality changes
    resonance_1,       ///< R1: on a curve of folds or torus points: two multipliers are 1
    resonance_2,       ///< R2: on a curve of flips or torus points: two multipliers are -1
    resonance_3,       ///< R3: on a curve of torus points: a pair of multipliers are third roots of 1
    resonance_4,       ///< R4: on a curve of torus points: a pair of multipliers is i and -i
    sensitivity,       ///< VS: on a curve of touches: a slow impact has no effect on the next pass
    fold_degenerate,   ///< DF: on a curve of touches: the curve of folds of orbits with an impact ends
    flip_degenerate, ///< DP: on a curve of touches: the curve of flips (or symmetry breakings) of orbits with an impact
                     ///< ends
    zero_acceleration, ///< ZA: on a curve of touches: the contact with zero speed has zero acceleration too
    double_grazing,    ///< DG: on a curve of touches: the orbit has a second touch
    fold_flip,         ///< FP: on a curve of folds or flips: one multiplier is 1, another -1
    fold_torus,        ///< FT: on a curve of folds or torus points: a multiplier is 1, and two lie on the unit circle
    flip_torus,        ///< PT: on a curve of flips or torus points: a multiplier is -1, and two lie on the unit circle
    chatter,           ///< CH: onset of chatter, the limit of a ladder of grazings
    hopf,              ///< HB: the orbit shrinks to an equilibrium, or two eigenvalues of one are imaginary: Hopf
    boundary_equilibrium, ///< BE: an equilibrium meets the surface of an event that ends its mode
    takens_bogdanov,      ///< BT: on a curve of folds or Hopf points of equilibria: two eigenvalues are 0
    zero_hopf,            ///< ZH: on such a curve: one eigenvalue is 0, two are imaginary
    double_hopf,          ///< HH: on a curve of Hopf points: four eigenvalues are imaginary
    generalised_hopf,     ///< GH: on a curve of Hopf points: criticality changes (Bautin)
    homoclinic,           ///< HC: the period grows without bound: the orbit becomes homoclinic to a saddle
    homoclinic_tangency,  ///< HT: of orbits homoclinic to a cycle: its stable and unstable manifold touch, as at a fold
    locking,              ///< PL: phase locking, on a branch of tori: the interval in which they lock begins or ends
    extremum,             ///< EX: extremum of the period, where that is free; or of a parameter, on a curve
    bound,                ///< BD: a given bound is reached
    crossing,             ///< UZ: a monitor takes a requested value
    end,                  ///< EP: the first or last point of a branch
    regular,              ///< RG: no special event
};
/// Properties of a type of points.
struct PointKind {
    PointType type = PointType::regular;
    std::string_view short_name; ///< the two letters above
    std::string_view name;       ///< name in words, such as "fold"
    bool changes = false;        ///< orbits beyond the point differ in stability, number or contacts
    bool limits = false;         ///< an event appears or disappears: the branch may become inadmissible beyond it
    bool has_bifurcating_branch = false; ///< another branch leaves, which `branches_at` computes
    bool may_stop = false;               ///< a branch may be told to end there
    bool may_be_kept = false;            ///< a curve of such points can be followed: BranchSettings::kept
    int mark = 0;                        ///< gnuplot's point type for plots; 0: not plotted
};

/// Returns all kinds, in the order of the types.
std::span<const PointKind> point_kinds();
/// @throws InputError for a value that is not a type
const PointKind& kind_of(PointType type);

/// Returns the two letters of a type.
inline std::string_view short_name(PointType type) {
    return kind_of(type).short_name;
}
/// Returns the name of a type in words, such as "fold".
inline std::string_view name_of(PointType type) {
    return kind_of(type).name;
}
/// Returns the type with these two letters, if one exists.
std::optional<PointType> point_type(std::string_view short_name);

/// Returns the label of a point: "SN3" for the third fold, "R1-1" for the first 1:1 resonance.
std::string point_label(PointType type, std::size_t number);
/// True when a text has the form of a label.
bool is_point_label(std::string_view text);

/// A special point of a branch, located between two computed points.
struct SpecialPoint {
    PointType type = PointType::end;
    bool located = true; ///< false: the point is only known to lie within the bracket
    std::string detail;  ///< details, such as the event that is grazed
    OrbitSolution solution;
    double parameter = 0;
    std::pair<double, double> bracket; ///< parameters of the two computed points around it
    double arclength = 0;
    std::size_t step = 0;   ///< step of the branch that passed the point
    OrbitDirection tangent; ///< tangent of the branch
    std::vector<double> monitors;
    // For grazing, double_grazing, two_events, vanishing and guard:
    std::size_t segment = 0, event = 0;
    double time = 0;     ///< since the start of the segment
    bool at_end = false; ///< the event that ends the segment is reached with zero speed; false: an event is touched
                         ///< inside the segment
};

} // namespace graze
