#pragma once

#include "graze/design/trip_point.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace graze {

/// Trip value of a device that differs from the nominal one in one or two dimensions.
struct MappedValue {
    double x = 0, y = 0; ///< values of the dimensions
    bool found = false;
    double value = 0;        ///< trip value, if found
    bool admissible = false; ///< whether the model reaches it: nothing else is touched before
    GrazingOutcome outcome = GrazingOutcome::undecided; ///< class, if found and admissible
    std::string problem;                                ///< why it was not found or is not admissible
};

/// Options of the curves and planes below.
struct MapSettings {
    std::size_t points = 41; ///< points in each direction
    int jobs = 1;            ///< threads; the results do not depend on their number
    LocatedValueOptions solver;
    std::function<bool()> interrupted; ///< returning true interrupts
    /// Called with the number of points or tiles done.
    std::function<void(std::size_t done)> progress;
    /// @throws InputError naming what is out of range
    void validate() const;
};

/// Computes trip value and class over one dimension, each by a Newton solve from the trip point.
/// @return in increasing order of the dimension; empty when interrupted
std::vector<MappedValue> value_curve(const TripPoint& trip, const DesignDimension& dimension,
                                     const MapSettings& settings);

/// Computes trip value and class over two dimensions, row by row: y is constant along a row.
std::vector<MappedValue> value_plane(const TripPoint& trip, const DesignDimension& across, const DesignDimension& up,
                                     const MapSettings& settings);

/// Position of an adjustable stop for a trip value.
struct TuningPoint {
    double value = 0;    ///< requested trip value
    double position = 0; ///< position of the stop, if found
    bool found = false, admissible = false;
    std::string problem;
};
/// A tuning curve.
struct Tuning {
    std::vector<TuningPoint> points; ///< in increasing order of the trip value
    /// Range of trip values that the stop can reach within its range, and what limits it on either side.
    double least = 0, greatest = 0;
    std::string ends_below, ends_above;
};

/// Computes the tuning curve: the position of one dimension as a function of the trip value, within its range and where
/// the device trips at that point.
/// @throws InputError when the stop is not determined by the trip value
Tuning tuning_curve(const TripPoint& trip, const DesignDimension& stop, const MapSettings& settings);

} // namespace graze
