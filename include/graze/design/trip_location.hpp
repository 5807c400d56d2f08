#pragma once

#include "graze/design/design_report.hpp"
#include "graze/design/trip_point.hpp"

#include <optional>
#include <string>

namespace graze {

/// Does something with a design; what is wrong with the device that it asks for, and has no place of its own, is said
/// of its file.
template <class Work>
auto said_of(const Design& design, const Work& work) {
    try {
        return work();
    } catch (const InputError& error) {
        if (!error.place().file.empty())
            throw;
        throw InputError(design.approach.place, error.problem(), error.remedy());
    }
}

/// Where a device trips; its way there is kept in the file. @return none when interrupted
std::optional<TripPoint> locate_trip(const Design& design, const std::string& path, const DesignReportOptions& options);

} // namespace graze
