#include "layout/wafer_examination.hpp"

#include "graze/design/trip_times.hpp"
#include "graze/layout/wafer_yield.hpp"
#include "graze/model/named_value.hpp"
#include "graze/symbolic/transform.hpp"
#include "study/point_bytes.hpp"

#include <memory>
#include <utility>

namespace graze {

namespace {

template <class Bytes, class Trip, class Quantity>
void describe_request(Bytes& bytes, Trip& trip, Quantity& quantity) {
    bytes(quantity, trip.end.speed, trip.end.level, trip.overshoots, trip.cycles, trip.place.file, trip.place.line,
          trip.place.column);
}

/// Follows the device's trip from its own trip point.
ExaminedWaferDevice examined(const TripPoint& trip, const TripRequest& request, const LocatedSolution& device,
                             const std::function<bool()>& interrupted) {
    const TripPoint moved = moved_to(trip, device.orbit);
    const TripClass found = class_at(moved);
    ExaminedWaferDevice result{found.outcome, {}};
    if (request.overshoots.empty() || found.outcome == GrazingOutcome::persists)
        return result;
    const TripTimes times = trip_times(moved, device.orbit, found, request, interrupted);
    if (!times.rows.empty())
        if (const TripTime* best = times.rows.front().best())
            result.trip_time = best->time;
    return result;
}

} // namespace

std::string wafer_request(int fold_side, const TripRequest& trip) {
    std::optional<std::string> quantity;
    if (trip.end.quantity)
        quantity = to_string(*trip.end.quantity);
    ByteWriter bytes;
    bytes(fold_side);
    describe_request(bytes, trip, quantity);
    return bytes.take();
}

DeviceExamination wafer_examination_of(const System& system, const SpecialPoint& point, ParameterId control,
                                       const std::string& request) {
    const auto trip = std::make_shared<TripPoint>(TripPoint{system, point, control, {}, {}, {}});
    const auto asked = std::make_shared<TripRequest>();
    std::optional<std::string> quantity;
    ByteReader reader(request);
    reader(trip->fold_side);
    describe_request(reader, *asked, quantity);
    reader.require_end();
    if (quantity)
        asked->end.quantity = named_value(system.model(), *quantity, asked->place).value;
    return {request, [trip, asked](const LocatedSolution& device, const std::function<bool()>& interrupted) {
                const ExaminedWaferDevice found = examined(*trip, *asked, device, interrupted);
                ByteWriter bytes;
                bytes.choice(found.found, GrazingOutcome::undecided);
                bytes(found.trip_time);
                return bytes.take();
            }};
}

ExaminedWaferDevice read_examined(std::string_view bytes) {
    ExaminedWaferDevice device;
    ByteReader reader(bytes);
    reader.choice(device.found, GrazingOutcome::undecided);
    reader(device.trip_time);
    reader.require_end();
    return device;
}

} // namespace graze
