#pragma once

#include "graze/branch/yield.hpp"
#include "graze/design/design.hpp"
#include "graze/design/device_trial.hpp"
#include "graze/design/reset.hpp"
#include "graze/design/trip_point.hpp"
#include "graze/design/trip_times.hpp"
#include "graze/design/value_map.hpp"
#include "graze/design/wishes.hpp"
#include "graze/results/table.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Sensitivity of the trip value to one parameter.
struct Sensitivity {
    std::string name, unit;
    ParameterId parameter;
    double value = 0;
    double derivative = 0; ///< exact derivative of the trip value
    /// Percent of the trip value per percent of the parameter; empty if the trip value is 0.
    std::optional<double> relative;
};

/// The trip value over one dimension.
struct DimensionCurve {
    std::size_t dimension = 0; ///< index of the dimension
    std::vector<MappedValue> points;
};
/// The trip value over two dimensions.
struct DimensionPlane {
    std::size_t across = 0, up = 0; ///< indices of the dimensions
    std::vector<MappedValue> points;
};

/// All results for one device.
struct DesignReport {
    double value = 0; ///< trip value
    std::vector<Sensitivity> sensitivities;
    TripClass found;
    TripTimes times;
    Reset reset;
    DeviceTrial trial;
    std::vector<DimensionCurve> curves;
    std::vector<DimensionPlane> planes;
    std::optional<Tuning> tuning;
    std::string no_tuning; ///< why there is no tuning curve, if one was requested
    std::optional<Yield> yield;
    std::string no_yield; ///< why there is no yield, if tolerances were given
    YieldSettings yield_settings;
    std::optional<MetWishes> wishes; ///< result of the search that led to this device, if the design has requirements
    bool interrupted = false;
};

/// Options of `locate_trip` and `report_of`.
struct DesignReportOptions {
    int jobs = 1;
    DevicesElsewhere elsewhere;                            ///< solves for the devices of yields in place of threads
    std::function<bool()> interrupted;                     ///< returning true interrupts
    std::function<void(const std::string& what)> progress; ///< called with the present task
};

/// Finds the trip point of a device, and stores the branch that leads there in the file. @return nothing when
/// interrupted
std::optional<TripPoint> locate_trip(const Design& design, const std::string& path, const DesignReportOptions& options);

/// Computes the report at a trip point.
/// @throws InputError when the trip value is not determined by the other parameters
DesignReport report_of(const Design& design, const TripPoint& trip, const DesignReportOptions& options = {});

/// A table with the name of its file.
struct NamedTable {
    std::string name;
    Table table;
};
/// Returns the report as tables: facts, derivatives, earlier points, trip times, curves, planes, tuning, devices. Facts
/// have the columns quantity, value, unit and meaning.
Table facts_of(const Design& design, const TripPoint& trip, const DesignReport& report);
std::vector<NamedTable> tables_of(const Design& design, const TripPoint& trip, const DesignReport& report);

/// Returns the report as JSON: all of these tables but the long ones, which have files of their own.
/// @param version of graze
std::string report_json(const Design& design, const std::vector<NamedTable>& tables, const std::string& version);

/// Returns the model of a device at its trip value, with the touching orbit as initial state, for other commands.
Model model_of_device(const TripPoint& trip);

} // namespace graze
