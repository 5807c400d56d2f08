#pragma once

#include "graze/branch/special_point.hpp"
#include "graze/flow/system.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Where a ladder of grazings leads: the orbit whose contacts accumulate just where the motion leaves the surface
/// again. There the event's function h is zero together with its first two rates, and its third rate j is positive:
/// until then contacts hold the motion back, from then on none is needed.
///
/// Before that time h'' = j t to leading order, and one sequence of contacts repeats itself on ever smaller scales: its
/// times before the end fall by a factor rho, its speeds by rho^2. A flight from -t to -rho t begins with the speed
/// j t^2 (1 - rho) (2 + rho) / 6 and ends with j t^2 (1 - rho) (1 + 2 rho) / 6, so that with a restitution e
///
///     e (1 + 2 rho) = rho^2 (2 + rho).
///
/// As a contact takes areas v dv dt to e^2 of them, what departs from that sequence grows by e^2 / rho^5 each time:
/// the distances of the grazings from the limit fall by the inverse.
struct SelfSimilarContacts {
    double restitution = 0; ///< e, from the speeds just before and after, in (0, 1)
    double times = 0;       ///< rho
    double ratio = 0;       ///< rho^5 / e^2
    double speed = 0;       ///< (1 - rho) (2 + rho) / 6: speed times third rate, in units of the square of the second
};
/// @throws InputError for a restitution outside of (0, 1)
SelfSimilarContacts self_similar_contacts(double restitution);

struct ChatterLimit {
    /// From the orbit itself, followed from one accumulation to the next; and its error. None if not found.
    std::optional<std::pair<double, double>> direct;
    /// From the grazings alone, by Richardson's extrapolation with the ratios above; and its error.
    std::optional<std::pair<double, double>> extrapolated;
    SelfSimilarContacts contacts;
    /// The orbit up to contacts so close to the end that the rest is below the resolution of pictures: its last segment
    /// stands for all that are to come, so that its period is the whole one. Empty if not found.
    Orbit orbit;
    double gap = 0;      ///< between the end of that orbit and its start, relative to the sizes of the states
    std::string problem; ///< why there is no direct value
};

/// The limit of a ladder of grazings, each with one contact more at the same event than the one before.
/// @param along the parameter that varies; @param tolerance of the integration
/// @throws InputError for fewer than two grazings, or points that are none
ChatterLimit chatter_limit(const System& system, std::span<const SpecialPoint> grazings, ParameterId along,
                           double tolerance = 1e-13);

/// The same beside a limit that is known, without its grazings: at other values of other parameters, say.
/// @param known ChatterLimit::orbit, whose parameters may have been changed and whose first start may have been moved;
/// @param event at which contacts accumulate
/// @throws InputError for an orbit that does not fit the system, or has no contact at the event
ChatterLimit chatter_limit_near(const System& system, const Orbit& known, std::size_t event, ParameterId along,
                                double tolerance = 1e-13);

} // namespace graze
