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

/// What happens at a point of a branch of periodic orbits. Each has an entry, of the same place, in the table of kinds.
enum class PointType {
    fold,         ///< SN: the branch turns; a multiplier is 1
    flip,         ///< PD: a multiplier is -1
    torus,        ///< NS: two multipliers lie on the unit circle
    branch_point, ///< BP: another branch crosses
    asymmetry,    ///< SB: an orbit that is its own image loses that symmetry: its half has a multiplier -1
    grazing,      ///< GR: an event's surface is touched without speed, inside an arc or at the end of one
    vanishing,    ///< DZ: a segment's duration reaches zero
    two_events,   ///< EE: two events happen at once
    guard,        ///< GU: the guard after a jump is about to choose another mode
    cusp,         ///< CP: on a curve of folds, two of them meet: it turns in both parameters
    generalised,  ///< GF: on a curve of flips, or of losses of symmetry: what leaves is neither stable nor unstable yet
    generalised_torus, ///< GT: on a curve of torus points: the torus that leaves is neither stable nor unstable yet
    resonance_1,       ///< R1: on a curve of folds or torus points: two multipliers are 1
    resonance_2,       ///< R2: on a curve of flips or torus points: two multipliers are -1
    resonance_3,       ///< R3: on a curve of torus points: a pair of multipliers are third roots of 1
    resonance_4,       ///< R4: on a curve of torus points: a pair of multipliers is i and -i
    sensitivity,       ///< VS: on a curve of touches: an impact of vanishing speed leaves the next pass as it is
    fold_degenerate,   ///< DF: on a curve of touches: folds of orbits with an impact there end
    flip_degenerate,   ///< DP: on a curve of touches: flips, or losses of symmetry, of orbits with an impact there end
    zero_acceleration, ///< ZA: on a curve of touches: the gap of a contact without speed has no acceleration either
    double_grazing,    ///< DG: on a curve of touches: another event is touched, or the same one elsewhere
    fold_flip,         ///< FP: on a curve of folds or flips: one multiplier is 1, another -1
    fold_torus,        ///< FT: on a curve of folds or torus points: a multiplier is 1, and two lie on the unit circle
    flip_torus,        ///< PT: on a curve of flips or torus points: a multiplier is -1, and two lie on the unit circle
    chatter,           ///< CH: contacts accumulate just where the motion leaves: a ladder of grazings leads there
    hopf,              ///< HB: the orbit shrinks to an equilibrium, as at a Hopf bifurcation
    extremum,          ///< EX: the period, where it is free, is longest or shortest; or a parameter, on a curve
    bound,             ///< BD: a bound that was given is reached
    crossing,          ///< UZ: a monitor takes a value that was asked for
    end,               ///< EP: the first or last point of a branch
    regular,           ///< RG: nothing happens here
};
/// What everybody needs to know of points of one type.
struct PointKind {
    PointType type = PointType::regular;
    std::string_view short_name; ///< the two letters above
    std::string_view name;       ///< in words, such as "fold"
    bool changes = false;        ///< orbits beyond it are of another kind: in stability, number, or contacts
    bool limits = false;         ///< an event is about to happen or to fail: what is admissible ends or begins
    bool leads_on = false;       ///< another branch leaves, which `branches_at` finds
    bool may_stop = false;       ///< a branch may be told to end there
    bool may_be_kept = false;    ///< a curve of such points can be followed: BranchSettings::kept
    int mark = 0;                ///< which of gnuplot's point types shows it in pictures; 0: none
};

/// All kinds, in the order of the types.
std::span<const PointKind> point_kinds();
/// @throws InputError for what is none of the types
const PointKind& kind_of(PointType type);

/// The two letters above.
inline std::string_view short_name(PointType type) {
    return kind_of(type).short_name;
}
/// In words, such as "fold".
inline std::string_view name_of(PointType type) {
    return kind_of(type).name;
}
/// The type with these two letters, if there is one.
std::optional<PointType> point_type(std::string_view short_name);

/// The name of a point, by which others know it: of the third fold "SN3", and of the first 1:1 resonance "R1-1".
std::string point_label(PointType type, std::size_t number);
/// Whether a text may be such a name.
bool is_point_label(std::string_view text);

/// A point of a branch at which something happens, located between two computed ones.
struct SpecialPoint {
    PointType type = PointType::end;
    bool located = true; ///< false: only known to lie within the bracket
    std::string detail;  ///< what exactly, such as the event that is grazed
    OrbitSolution solution;
    double parameter = 0;
    std::pair<double, double> bracket; ///< parameters of the neighbours between which it was found
    double arclength = 0;
    std::size_t step = 0;   ///< of the branch: found between this one and the one before
    OrbitDirection tangent; ///< of the branch
    std::vector<double> monitors;
    // Of grazing, double_grazing, two_events, vanishing and guard:
    std::size_t segment = 0, event = 0;
    double time = 0;     ///< since the segment's start
    bool at_end = false; ///< the segment's own event is met without speed, rather than another touched
};

} // namespace graze
