#pragma once

#include "graze/branch/yield.hpp"
#include "graze/design/trip_point.hpp"
#include "graze/layout/layout.hpp"
#include "graze/layout/lumped_model.hpp"
#include "graze/layout/process_spread.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace graze {

struct WaferYieldSettings {
    std::size_t wafers = 25;
    std::uint64_t seed = 1;
    int jobs = 1;                                      ///< threads, on which nothing depends
    std::function<bool()> interrupted;
    std::function<void(std::size_t devices)> progress;
};

/// One device of one wafer.
struct WaferDevice {
    std::size_t wafer = 0, site = 0; ///< from 1
    SitePlace place;
    ProcessDeparture departure;
    std::optional<LumpedModel> lumped; ///< none: the etch leaves nothing of a part
    DeviceOutcome outcome = DeviceOutcome::not_made;
    double value = 0;                                 ///< at which it trips, if found
    GrazingOutcome found = GrazingOutcome::undecided; ///< class, if found
    std::optional<double> trip_time; ///< in the model's unit, so far beyond the trip value as is asked for
    std::string problem;             ///< why it cannot be made
};

/// What one number of the process does to the trip value, as far as that is linear in it.
struct SpreadEffect {
    std::string name, unit;
    double deviation = 0;  ///< of the number, over wafers and devices
    double derivative = 0; ///< of the trip value of the nominal device, by the number
    double effect = 0;     ///< standard deviation that it alone causes, with the sign of the derivative
};

struct WaferYield {
    Yield yield;                      ///< in the order of `devices`
    std::vector<WaferDevice> devices; ///< wafer by wafer
    std::vector<SpreadEffect> effects;
    double linear_deviation = 0;                                 ///< of all effects together
    std::optional<double> overshoot;                             ///< for which times are asked; none: nothing is
    std::vector<std::pair<GrazingOutcome, std::size_t>> classes; ///< how many devices have each
};

/// The design with the numbers of its drawn and etched device in its model, and the drive beside its frequency if that
/// is tuned; without dimensions that may be chosen.
/// @throws InputError for a model that lacks a parameter
Design design_of_device(const Design& design, const DeviceFile& file);

/// Makes wafers of devices: departures of the process become outlines that have receded otherwise, these other numbers
/// of the model, these another trip value by Newton's method (yield_of), and that a class by the map of the cycle and a
/// time by simulation.
/// @param trip of design_of_device; @param wafer drawn by draw_wafer_layout
/// @throws InputError where nothing is spread, or the trip value does not follow from the device's numbers
WaferYield wafer_yield_of(const Design& design, const DeviceFile& file, const Layout& wafer, const TripPoint& trip,
                          const WaferYieldSettings& settings = {});

} // namespace graze
