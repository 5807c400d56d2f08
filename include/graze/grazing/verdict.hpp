#pragma once

#include "graze/grazing/cycle_map.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// The fate of a stable orbit beyond the parameter at which it touches a surface.
enum class GrazingOutcome {
    persists,  ///< an attractor persists near the orbit and shrinks to it at the touch
    lost,      ///< no attractor remains nearby: contacts grow until the motion leaves (the device trips)
    folds,     ///< compliant contact: the orbit persists up to a fold at a predicted distance
    undecided, ///< the leading order does not decide: `reason` says why
};
/// Returns the stable name for tables and files, such as "persists".
std::string_view name_of(GrazingOutcome outcome);

/// Attractors that persist near a touch: for a rigid stop classified by the leading multiplier, for sliding by
/// iterating the map.
enum class AttractorKind {
    none,             ///< unknown
    period_adding,    ///< multiplier below 1/4: one contact per period; the period increases towards the touch
    periodic_windows, ///< multiplier below 2/3: the same, with chaos between the periodic windows
    chaotic,          ///< chaos that begins at the touch; for sliding, any motion that does not repeat
    periodic,         ///< sliding, or a slide that is left, only: a periodic attractor
};
std::string_view name_of(AttractorKind kind);

/// How an orbit that touches a sliding surface is related to the orbit with a short sliding segment.
enum class BorderCollision {
    none,        ///< unknown
    persistence, ///< one becomes the other: the orbit continues beyond the touch
    fold,        ///< both exist before the touch, neither beyond it
};
std::string_view name_of(BorderCollision collision);

/// The prediction that follows from the map of a cycle.
///
/// A contact of speed s changes the clearance k cycles later by s times the k-th projection, which dominates near the
/// touch. If all projections are positive, the next contact occurs only when the effect has decayed, and an attractor
/// persists (A. B. Nordmark, Phys. Rev. E 55, 1997; M. H. Fredriksson and A. B. Nordmark, Proc. R. Soc. A 453, 1997;
/// for its kind: W. Chin, E. Ott, H. E. Nusse and C. Grebogi, Phys. Rev. E 50, 1994). If one is negative, the first
/// negative one leads to a contact of speed growth s^(1/2), which is much harder: the attractor is lost.
///
/// With a compliant contact the orbit continues. Its depth d and the clearance C without contact satisfy C + d + chi
/// d^(3/2) = 0, which for chi < 0 has a fold at C = -4 / (27 chi^2): the cubic alpha tau^3 + tau^2 + beta = 0 with tau
/// = -d^(1/2), alpha = -chi, beta = C (Eq. (3.29) of the work that this project follows).
///
/// With sliding the map is continuous and piecewise linear: P without sliding, P (1 - B g) with it. An odd number of
/// real multipliers above 1 of both together gives a fold of the two orbits, an even number persistence; an odd number
/// below -1 gives rise to an orbit of twice the period (M. I. Feigin, J. Appl. Math. Mech. 42, 1978; M. di Bernardo, M.
/// I. Feigin, S. J. Hogan and M. E. Homer, Chaos, Solitons & Fractals 10, 1999). Where the sliding orbit is not stable
/// the map is iterated, at one distance only because the map is the same at all.
///
/// Where a slide is left for a short time the map is differentiable: the orbit continues, with the same multipliers.
struct Verdict {
    GrazingOutcome outcome = GrazingOutcome::undecided;
    std::string reason; ///< why the outcome is undecided; empty otherwise
    int side = 0;       ///< side of the touch, in the parameter, on which contacts occur: 1 above, -1 below; 0: unknown
    std::vector<double> projections; ///< the first projections

    // For a rigid contact:
    std::size_t next_contact = 0; ///< cycles until the next contact, where the attractor is lost; 0 otherwise
    /// Growth of approach speeds from contact to contact: next speed = growth speed^(1/2).
    std::optional<double> growth;
    std::optional<double> jump_growth;  ///< the same for the jumps of the rate, (1 + e) speed
    std::optional<double> reach;        ///< speed at which the growth would end; the map must be valid up to it
    std::optional<double> speed_factor; ///< first contact: speed = speed_factor |parameter - touch|^(1/2)
    AttractorKind attractor = AttractorKind::none;
    std::optional<double> leading; ///< the multiplier that decides

    // For sliding; speed_factor, attractor and leading apply too, where leading is the largest modulus of the
    // multipliers of the sliding orbit:
    BorderCollision border = BorderCollision::none;
    bool doubles = false;           ///< an orbit of twice the period, stable or not, begins at the touch
    std::size_t slides = 0, in = 0; ///< a periodic attractor slides `slides` times in `in` cycles

    // For a compliant contact:
    std::optional<double> alpha;          ///< coefficient of the cubic
    std::optional<double> fold_depth;     ///< depth at the fold
    std::optional<double> fold_clearance; ///< clearance at the fold
    std::optional<double> fold_distance;  ///< signed distance of the fold from the touch in the parameter
    /// Depth at which a multiplier leaves the unit circle, if that happens before the fold.
    std::optional<double> unstable_depth;
};

/// @param shown number of projections that are listed
Verdict verdict_of(const CycleMap& map, std::size_t shown = 8);

} // namespace graze
