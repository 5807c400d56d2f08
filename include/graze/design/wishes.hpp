#pragma once

#include "graze/design/design.hpp"
#include "graze/design/trip_point.hpp"
#include "graze/design/wish_list.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace graze {

/// Options of `meet_wishes`.
struct WishesOptions {
    std::size_t evaluations = 2000; ///< largest number of devices that are evaluated
    int jobs = 1;                   ///< threads for the devices of a yield; the results do not depend on their number
    DevicesElsewhere elsewhere;     ///< solves for these devices in place of threads
    std::function<bool()> interrupted;
    std::function<void(std::size_t devices)> progress; ///< called with the number of evaluated devices
};

/// Requirements of a design, and the device that was found.
struct MetWishes {
    WishList list; ///< dimensions, names and limits; without callbacks
    FoundDesign found;
    std::optional<double> trip_value; ///< trip value of the device found

    std::vector<double> values() const; ///< values of the dimensions
};

/// Finds the dimensions that meet the requirements of a design. Each device is a Newton solve from the trip point, with
/// the exact gradient of the trip value. Trip value, distances from earlier points, reset value and sensitivities are
/// used as they are. The class is replaced by the least projection of a contact, normalised by the decay of the leading
/// multiplier and by the largest projection: "trips" if negative, otherwise "persists". A trip time is computed by the
/// map and simulation. Values without a known gradient are differentiated by differences. A yield is first estimated by
/// derivatives, as if trip values were normally distributed, and then corrected by counting devices that are drawn with
/// the tolerances.
/// @param trip trip point of the first device
/// @throws InputError for requirements that the device cannot have at all, such as a reset value if it does not reset
MetWishes meet_wishes(const Design& design, const TripPoint& trip, const WishesOptions& options = {});

/// Evaluates the requirements at a device, without a search: outcome met or unmet.
/// @param trip trip point of the device, within the ranges of the dimensions or not
/// @throws InputError as meet_wishes does
MetWishes wishes_at(const Design& design, const TripPoint& trip, const WishesOptions& options = {});

/// Returns the design with other values of its dimensions for the first device.
/// @throws InputError unless there is a finite value for each dimension
Design with_values(const Design& design, const std::vector<double>& values);

} // namespace graze
