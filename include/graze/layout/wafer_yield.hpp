#pragma once

#include "graze/branch/device_solver.hpp"
#include "graze/design/trip_point.hpp"
#include "graze/layout/layout.hpp"
#include "graze/layout/lumped_model.hpp"
#include "graze/layout/process_spread.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Options of `wafer_yield_of`.
struct WaferYieldSettings {
    std::size_t wafers = 25;
    std::uint64_t seed = 1;
    int jobs = 1;                      ///< threads; the results do not depend on their number
    DevicesElsewhere elsewhere;        ///< solves for the devices in place of threads, to the same results
    std::function<bool()> interrupted; ///< returning true interrupts
    std::function<void(std::size_t devices)> progress; ///< called with the number of devices done
};

/// One device of one wafer.
struct WaferDevice {
    std::size_t wafer = 0, site = 0; ///< counted from 1
    SitePlace place;
    ProcessDeparture departure;
    std::optional<LumpedModel> lumped; ///< empty: the etch removes a part completely
    DeviceOutcome outcome = DeviceOutcome::not_made;
    double value = 0;                                 ///< trip value, if found
    GrazingOutcome found = GrazingOutcome::undecided; ///< class, if found
    std::optional<double> trip_time;                  ///< in the model's unit, at WaferYield::overshoot
    std::string problem;                              ///< why it cannot be made
};

/// Linear effect of one number of the process on the trip value.
struct SpreadEffect {
    std::string name, unit;
    double deviation = 0;  ///< standard deviation of the number over wafers and devices
    double derivative = 0; ///< derivative of the nominal trip value by the number
    double effect = 0; ///< standard deviation of the trip value that it alone causes, with the sign of the derivative
};

/// Trip values of the devices of all wafers, with statistics.
struct WaferYield {
    Yield yield;                      ///< in the order of `devices`
    std::vector<WaferDevice> devices; ///< wafer by wafer
    std::vector<SpreadEffect> effects;
    double linear_deviation = 0;     ///< standard deviation of all effects together
    std::optional<double> overshoot; ///< overshoot of the trip times; empty: none are computed
    std::vector<std::pair<GrazingOutcome, std::size_t>> classes; ///< number of devices of each class
};

/// Returns the design with the parameters of its drawn and etched device in its model, and with the drive at the
/// nominal ratio to its frequency if that is tuned; without free dimensions.
/// @throws InputError for a model that lacks a parameter
Design design_of_device(const Design& design, const DeviceFile& file);

/// Simulates the fabrication of wafers: deviations of the process change the outlines, these the parameters of the
/// model, these the trip value by Newton's method (yield_of), with the class by the map of the cycle and the trip time
/// by simulation.
/// @param trip of design_of_device; @param wafer drawn by draw_wafer_layout
/// @throws InputError when no number varies, or the trip value is not determined by the device's numbers
WaferYield wafer_yield_of(const Design& design, const DeviceFile& file, const Layout& wafer, const TripPoint& trip,
                          const WaferYieldSettings& settings = {});

/// How devices of a wafer are examined, in any process: for device_solver_of.
DeviceExamination wafer_examination_of(const System& system, const SpecialPoint& point, ParameterId control,
                                       const std::string& request);

} // namespace graze
