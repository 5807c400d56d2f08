#pragma once

#include "graze/design/trip_point.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace graze {

/// A device that differs from the nominal one in one or two dimensions.
struct MappedValue {
    double x = 0, y = 0; ///< of the dimensions
    bool found = false;
    double value = 0;        ///< trip value, if found
    bool admissible = false; ///< whether the model would come there: nothing else is touched before
    GrazingOutcome outcome = GrazingOutcome::undecided; ///< class, if found and admissible
    std::string problem;                                ///< why not found or not admissible
};

struct MapSettings {
    std::size_t points = 41; ///< in each direction
    int jobs = 1;            ///< threads, on which nothing depends
    LocatedValueOptions solver;
    std::function<bool()> interrupted;
    std::function<void(std::size_t done)> progress; ///< pieces of work
    /// @throws InputError naming what is out of range
    void validate() const;
};

/// The trip value and the class against one dimension, each a Newton solve from the trip point.
/// @return in rising order of the dimension; fewer when interrupted
std::vector<MappedValue> value_curve(const TripPoint& trip, const DesignDimension& dimension,
                                     const MapSettings& settings);

/// The same in the plane of two dimensions, row by row: y is the same along a row.
std::vector<MappedValue> value_plane(const TripPoint& trip, const DesignDimension& across, const DesignDimension& up,
                                     const MapSettings& settings);

/// Where an adjustable stop must be for a trip value.
struct TuningPoint {
    double value = 0;    ///< trip value that is wanted
    double position = 0; ///< of the stop, if found
    bool found = false, admissible = false;
    std::string problem;
};
struct Tuning {
    std::vector<TuningPoint> points; ///< in rising order of the value
    /// Trip values that can be had with the stop within its range, and what ends them on either side.
    double least = 0, greatest = 0;
    std::string ends_below, ends_above;
};

/// The tuning curve of one dimension: its value as a function of the trip value, as far as the range goes and the
/// device would trip there.
/// @throws InputError where the stop does not follow from the trip value
Tuning tuning_curve(const TripPoint& trip, const DesignDimension& stop, const MapSettings& settings);

} // namespace graze
