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

/// Constants of the self-similar sequence of contacts at an onset of chatter, the limit of a ladder of grazings: the
/// orbit whose contacts accumulate exactly where the motion leaves the surface again. There the event function h and
/// its first two time derivatives are zero, and its third one, j, is positive: until then contacts hold the motion
/// back, afterwards none is needed.
///
/// Before that time h'' = j t to leading order, and the sequence of contacts is self-similar: the times before the end
/// decrease by a factor rho, the speeds by rho^2. A flight from -t to -rho t begins with the speed j t^2 (1 - rho) (2 +
/// rho) / 6 and ends with j t^2 (1 - rho) (1 + 2 rho) / 6, so that with a restitution e
///
///     e (1 + 2 rho) = rho^2 (2 + rho).
///
/// A contact multiplies the area element v dv dt by e^2, so deviations from the sequence grow by e^2 / rho^5 per
/// contact; the distances of the grazings from the limit decrease by the inverse factor.
struct SelfSimilarContacts {
    double restitution = 0; ///< e, the ratio of the speeds just after and before a contact, in (0, 1)
    double times = 0;       ///< rho, the ratio of successive times before the end
    double ratio = 0;       ///< rho^5 / e^2, the ratio of successive distances of grazings from the limit
    double speed = 0;       ///< (1 - rho) (2 + rho) / 6: speed times third rate, in units of the square of the second
};
/// Computes these constants. @throws InputError for a restitution outside of (0, 1)
SelfSimilarContacts self_similar_contacts(double restitution);

/// The onset of chatter to which a ladder of grazings leads: its parameter, by two methods, and its orbit.
struct ChatterLimit {
    /// Parameter value from the orbit itself, followed from one accumulation to the next, and its error; empty if not
    /// found.
    std::optional<std::pair<double, double>> direct;
    /// Parameter value from the grazings alone, by Richardson extrapolation with the ratios above, and its error.
    std::optional<std::pair<double, double>> extrapolated;
    SelfSimilarContacts contacts;
    /// The orbit up to contacts so near the end that the remaining ones are below the resolution of plots; its last
    /// segment represents all remaining contacts, so that the period is complete. Empty if not found.
    Orbit orbit;
    double gap = 0;      ///< distance between end and start of that orbit, relative to the scales of the states
    std::string problem; ///< why the direct value was not found
};

/// Computes the limit of a ladder of grazings, each with one contact more at the same event than the previous one.
/// @param along the parameter that varies; @param tolerance relative tolerance of the integration
/// @throws InputError for fewer than two grazings, or points that are not grazings of one event
ChatterLimit chatter_limit(const System& system, std::span<const SpecialPoint> grazings, ParameterId along,
                           double tolerance = 1e-13);

/// Computes the limit near a known one without its grazings, for example at other values of other parameters.
/// @param known ChatterLimit::orbit, with changed parameters and, optionally, a predicted first start;
/// @param event at which contacts accumulate
/// @throws InputError for an orbit that does not fit the system or has no contact at the event
ChatterLimit chatter_limit_near(const System& system, const Orbit& known, std::size_t event, ParameterId along,
                                double tolerance = 1e-13);

} // namespace graze
