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

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// How the trip value depends on one parameter.
struct Sensitivity {
    std::string name, unit;
    ParameterId parameter;
    double value = 0;
    double derivative = 0;          ///< of the trip value, exactly
    std::optional<double> relative; ///< percents of the trip value for one of the parameter; none where it is zero
};

struct DimensionCurve {
    std::size_t dimension = 0; ///< of the design
    std::vector<MappedValue> points;
};
struct DimensionPlane {
    std::size_t across = 0, up = 0; ///< dimensions of the design
    std::vector<MappedValue> points;
};

/// All that is known of one device.
struct DesignReport {
    double value = 0; ///< at which it trips
    std::vector<Sensitivity> sensitivities;
    TripClass found;
    TripTimes times;
    Reset reset;
    DeviceTrial trial;
    std::vector<DimensionCurve> curves;
    std::vector<DimensionPlane> planes;
    std::optional<Tuning> tuning;
    std::string no_tuning; ///< why there is none, if one was asked for
    std::optional<Yield> yield;
    std::string no_yield; ///< why there is none, if tolerances were given
    YieldSettings yield_settings;
    std::optional<MetWishes> wishes; ///< that led to this device, if the design wants anything
    bool interrupted = false;
};

struct DesignReportOptions {
    int jobs = 1;
    std::function<bool()> interrupted;
    std::function<void(const std::string& what)> progress; ///< what is being done
};

/// Works out everything at a trip point.
/// @throws InputError where the trip value does not follow from the other parameters
DesignReport report_of(const Design& design, const TripPoint& trip, const DesignReportOptions& options = {});

/// A table with the name of the file that it goes to.
struct NamedTable {
    std::string name;
    Table table;
};
/// What the report says in rows: the facts, derivatives, earlier points, trip times, curves, planes, tuning, devices.
/// Facts have the columns quantity, value, unit and meaning.
Table facts_of(const Design& design, const TripPoint& trip, const DesignReport& report);
std::vector<NamedTable> tables_of(const Design& design, const TripPoint& trip, const DesignReport& report);

/// The model of a device at its trip value, beginning on the orbit that touches: for other commands.
Model model_of_device(const TripPoint& trip);

} // namespace graze
