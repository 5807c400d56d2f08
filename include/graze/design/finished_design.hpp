#pragma once

#include "graze/design/design_report.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A design that was carried out: the device, and all that is known about it.
struct FinishedDesign {
    Design written;                ///< the design as it is written
    Design device;                 ///< with the values that were found for what is wanted; otherwise the same
    std::optional<TripPoint> trip; ///< trip point of the device; empty if interrupted before
    DesignReport report;           ///< incomplete if interrupted
    bool interrupted = false;

    /// Whether the device, followed from its start, trips at another point than the one for which it was made.
    bool trips_elsewhere() const;
    /// Whether the class was decided, but not checked by simulation.
    bool is_untried() const;
    /// What the user should look at, in words: a class that is not wanted, or that simulation contradicts or has not
    /// checked, requirements that are not met, devices that trip at no value. Empty: the design is regular.
    std::vector<std::string> warnings() const;
};

/// Where the branches of a device up to its trip point are stored.
struct DesignFiles {
    std::string written;                 ///< of the design as it is written
    std::function<std::string()> device; ///< called for the path of that of the device found, if there is one
};

/// Carries out a design: locates the trip point, finds the device that is wanted, and reports on it.
/// @throws InputError as locate_trip, meet_wishes and report_of do
FinishedDesign finish_design(const Design& design, const DesignFiles& files, const DesignReportOptions& options);

} // namespace graze
