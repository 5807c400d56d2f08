#pragma once

#include "graze/grazing/cycle_map.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// What becomes of a stable orbit beyond the parameter at which it touches.
enum class GrazingOutcome {
    persists,  ///< an attractor remains next to it, which shrinks to it at the touch
    lost,      ///< none does: contacts grow until the motion is elsewhere (the device trips)
    folds,     ///< a compliant contact: the orbit remains, up to a fold at a distance that is predicted
    undecided, ///< leading order does not tell: `reason` says why
};
/// Stable name for tables and files, such as "persists".
std::string_view name_of(GrazingOutcome outcome);

/// Attractors that remain next to a touch: of a rigid stop as the leading multiplier has them, of sliding as the map.
enum class AttractorKind {
    none,             ///< nothing is known of them
    period_adding,    ///< below 1/4: one contact in ever more cycles, nearer and nearer to the touch
    periodic_windows, ///< below 2/3: the same, with chaos between
    chaotic,          ///< chaos that begins at the touch; of sliding, any motion that does not repeat
    periodic,         ///< of sliding: one that repeats
};
std::string_view name_of(AttractorKind kind);

/// How the orbit that touches a surface on which motions slide meets the one that slides for a moment.
enum class BorderCollision {
    none,        ///< nothing is known of it
    persistence, ///< the one becomes the other: it goes on beyond the touch
    fold,        ///< both are there before the touch, and neither beyond it
};
std::string_view name_of(BorderCollision collision);

/// What follows from the map of a cycle.
///
/// A contact of speed s changes the clearance k cycles later by s times the projection k, against which all else is
/// small beside the touch. If all are positive, the next contact comes when its effect has died away, and an attractor
/// remains (A. B. Nordmark, Phys. Rev. E 55, 1997; M. H. Fredriksson and A. B. Nordmark, Proc. R. Soc. A 453, 1997; of
/// which kind: W. Chin, E. Ott, H. E. Nusse and C. Grebogi, Phys. Rev. E 50, 1994). If one is negative, the first of
/// these leads to a contact of the speed growth s^(1/2), which is far harder: the attractor is lost.
///
/// Of a compliant contact the orbit goes on; with d its depth and C the clearance without contact, C + d + chi d^(3/2)
/// = 0, which for chi < 0 turns at C = -4 / (27 chi^2): the cubic alpha tau^3 + tau^2 + beta of Eq. (3.29) in the work
/// that this project follows, with tau = -d^(1/2), alpha = -chi, beta = C.
///
/// With sliding the map is continuous and linear on both sides: P without, P (1 - B g) with it. An odd number of real
/// multipliers above 1 of both together makes a fold of the two orbits, an even number lets the one become the other,
/// and an odd number below -1 sets off an orbit of twice the period (M. I. Feigin, J. Appl. Math. Mech. 42, 1978; M. di
/// Bernardo, M. I. Feigin, S. J. Hogan and M. E. Homer, Chaos, Solitons & Fractals 10, 1999). Where the orbit that
/// slides is not stable the map is iterated, which needs to be done once: it is the same at all distances.
struct Verdict {
    GrazingOutcome outcome = GrazingOutcome::undecided;
    std::string reason;              ///< why undecided; empty if it is not
    int side = 0;                    ///< of the parameter on which contacts begin: 1 above, -1 below; 0: not known
    std::vector<double> projections; ///< the first ones

    // Of a rigid contact.
    std::size_t next_contact = 0;       ///< cycles after which the next one comes, where it is lost; 0: not
    std::optional<double> growth;       ///< from one approach speed to the next: speed' = growth speed^(1/2)
    std::optional<double> jump_growth;  ///< the same of what contacts change of the rate: jumps are (1 + e) speed
    std::optional<double> reach;        ///< speed at which that growth would end: up to there the map must hold
    std::optional<double> speed_factor; ///< of the first contact: speed = speed_factor |parameter - touch|^(1/2)
    AttractorKind attractor = AttractorKind::none;
    std::optional<double> leading; ///< multiplier that decides

    // Of sliding; speed_factor, attractor and leading, too: here that of the orbit that slides, its largest in modulus.
    BorderCollision border = BorderCollision::none;
    bool doubles = false;           ///< an orbit of twice the period begins at the touch, stable or not
    std::size_t slides = 0, in = 0; ///< times it slides in so many cycles, where an attractor repeats

    // Of a compliant contact.
    std::optional<double> alpha;      ///< of the cubic
    std::optional<double> fold_depth; ///< depth and clearance at which it turns
    std::optional<double> fold_clearance;
    std::optional<double> fold_distance; ///< of the parameter from the touch, with its sign
    std::optional<double>
        unstable_depth; ///< depth at which a multiplier leaves the unit circle otherwise, if that comes first
};

/// @param shown how many projections are listed
Verdict verdict_of(const CycleMap& map, std::size_t shown = 8);

} // namespace graze
