#include "program/asked_trip.hpp"

#include "program/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace graze {

namespace {

NamedEnd end_of(const LossPoint& point, const TripArguments& arguments) {
    if (arguments.greatest_speed)
        return end_at_speed(point, *arguments.greatest_speed);
    return arguments.until.empty() ? usual_end(point) : read_end(point, arguments.until, "--until");
}

} // namespace

AskedTrip asked_trip(const ResultFile& file, const std::string& point, const TripArguments& arguments,
                     const std::string& option) {
    const Place place{option, 0, 0};
    StoredOrbit stored = find_closed_orbit(file, point, place);
    LossPoint loss = loss_point(stored, arguments.parameter, place, {"--parameter", 0, 0});
    NamedEnd end = end_of(loss, arguments);
    return {std::move(stored), std::move(loss), std::move(end)};
}

void tell_lacks(const std::vector<std::string>& lacks, const Console& console) {
    constexpr std::size_t most = 5;
    for (std::size_t i = 0; i < std::min(most, lacks.size()); ++i)
        console.err << fmt::format("graze: {}\n", lacks[i]);
    if (lacks.size() > most)
        console.err << fmt::format("graze: {} more are like that\n", lacks.size() - most);
}

JsonObject heading_of(const ResultFile& file, const AskedTrip& asked) {
    const LossPoint& point = asked.point;
    JsonObject heading = heading_of_point(file, asked.stored);
    heading.add("parameter", point.name);
    heading.add(point.kind(), point.value);
    heading.add("cycle", point.cycle);
    if (point.fold) {
        heading.add("coefficient", point.fold->coefficient);
        heading.add("rate", point.fold->rate);
    } else {
        heading.add("speed", level_until(point, asked.end.end));
    }
    heading.add("end", asked.end.words);
    return heading;
}

} // namespace graze
