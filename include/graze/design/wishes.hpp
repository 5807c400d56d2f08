#pragma once

#include "graze/design/design.hpp"
#include "graze/design/trip_point.hpp"
#include "graze/design/wish_list.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace graze {

struct WishesOptions {
    std::size_t evaluations = 2000; ///< devices that are tried at most
    int jobs = 1;                   ///< threads for the devices of a yield, on which nothing depends
    std::function<bool()> interrupted;
    std::function<void(std::size_t devices)> progress; ///< how many have been tried
};

/// What was wanted, and what was found.
struct MetWishes {
    WishList list; ///< without callbacks: dimensions, names and limits
    FoundDesign found;
    std::optional<double> trip_value; ///< of the device found, which follows from that of the first

    std::vector<double> values() const; ///< of the dimensions
};

/// Finds the dimensions that a design wants: of each device a Newton solve from the trip point, with the trip value's
/// exact gradient. The trip value, distances from earlier points, a reset value and sensitivities are numbers; of the
/// class it is the least projection of a contact, measured by what the leading multiplier leaves and in units of the
/// largest one, which decides between "trips" (negative) and "persists"; of a trip time the time by the map and
/// simulation. Those of which no gradient is known are followed by differences. A yield is brought to what is wanted by
/// the deviation that derivatives give, as if trip values were normal, and then corrected by devices that are made.
/// @param trip of the first device
/// @throws InputError for wants that the device cannot have at all, such as a reset value of one that does not return
MetWishes meet_wishes(const Design& design, const TripPoint& trip, const WishesOptions& options = {});

/// What a device has of what its design wants, without a search: outcome met or unmet.
/// @param trip of the device, within the ranges of the dimensions or not
/// @throws InputError as meet_wishes does
MetWishes wishes_at(const Design& design, const TripPoint& trip, const WishesOptions& options = {});

/// The design whose first device is another one: its dimensions have these values.
/// @throws InputError unless there is a finite value for each dimension
Design with_values(const Design& design, const std::vector<double>& values);

} // namespace graze
