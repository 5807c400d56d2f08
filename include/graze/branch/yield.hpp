#pragma once

#include "graze/branch/located_value.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

enum class Spread {
    normal,  ///< normal distribution
    uniform, ///< uniform distribution
};
/// The scatter of a parameter between devices.
struct Tolerance {
    ParameterId parameter;
    Spread spread = Spread::normal;
    /// Standard deviation of a normal, half width of a uniform distribution; in the unit of the parameter.
    double size = 0;

    double deviation() const; ///< standard deviation
};

struct AskedDevices;
struct SolvedDevice;
/// Receives what has been found of a device; may move from it.
using DeviceSink = std::function<void(std::size_t device, SolvedDevice& solved)>;
/// Solves for devices in some other way than by threads of this process: see device_solver.hpp.
/// @param interrupted asked now and then; true: it has to end soon
/// @param sink receives each device once; called by one thread at a time
/// @return false when it was interrupted
using DevicesElsewhere =
    std::function<bool(const AskedDevices& devices, const std::function<bool()>& interrupted, const DeviceSink& sink)>;

struct YieldSettings {
    std::vector<Tolerance> tolerances;
    std::size_t devices = 10'000;          ///< number of devices; raise it for narrower confidence intervals
    std::uint64_t seed = 1;                ///< of the random numbers
    std::optional<double> least, greatest; ///< specification limits of the value; empty: no limit
    double confidence = 0.95;              ///< confidence level of all intervals
    std::vector<double> quantiles{0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99};
    int jobs = 1;               ///< number of threads; results do not depend on it
    DevicesElsewhere elsewhere; ///< solves for the devices in place of threads; results do not depend on it
    LocatedValueOptions solver;
    std::function<bool()> interrupted; ///< returns true to stop
    /// Called with the number of finished devices.
    std::function<void(std::size_t devices)> progress;
    /// @throws InputError naming the setting that is out of range
    void validate() const;
};

/// An estimate with its confidence interval.
struct ConfidenceInterval {
    double value = 0, low = 0, high = 0;
};

struct QuantileEstimate {
    double share = 0; ///< share of devices below the value
    double value = 0;
    std::optional<double> low, high; ///< confidence limits; empty where there are too few devices
};

/// Linear contribution of one parameter to the scatter of the value.
struct Contribution {
    ParameterId parameter;
    /// Standard deviation of the value due to this parameter alone, with the sign of the derivative.
    double deviation = 0;
    double share = 0; ///< share of the variance; 0 if the variance is zero
};

enum class DeviceOutcome {
    found,
    inadmissible, ///< the model would not follow the orbit: another event happens first
    failed,       ///< Newton's method did not converge
    not_made,     ///< the computation was interrupted before
};
struct Device {
    DeviceOutcome outcome = DeviceOutcome::not_made;
    double value = 0;  ///< value of the control parameter, if found
    double linear = 0; ///< prediction by the derivatives at the nominal point
};

/// Distribution of a value over many devices.
struct Yield {
    double nominal = 0;
    std::vector<Device> devices; ///< in order of their numbers
    std::size_t made = 0, found = 0, inadmissible = 0, failed = 0;
    /// Reasons why devices were not found, with their counts.
    std::vector<std::pair<std::string, std::size_t>> problems;
    bool interrupted = false;

    std::optional<ConfidenceInterval> mean, deviation; ///< over the devices found; empty for fewer than two
    std::vector<QuantileEstimate> quantiles;           ///< over the devices found
    /// Share of all devices whose value is within the specification limits; devices that were not found count as
    /// outside.
    std::optional<ConfidenceInterval> within;

    double linear_deviation = 0;         ///< standard deviation in the linear approximation, exact
    std::optional<double> linear_within; ///< share of the same devices within the limits, in the linear approximation
    double largest_departure = 0;        ///< largest difference between a found value and its linear prediction
    std::vector<Contribution> contributions; ///< contributions of the parameters, largest first
};

/// Draws devices with independent parameters and solves for the value of each by Newton's method from the nominal one.
/// A random number depends only on the seed, the number of the device and the index of the tolerance, so results are
/// bit for bit the same on any number of threads.
///
/// Confidence limits of shares are those of E. B. Wilson ("Probable inference, the law of succession, and statistical
/// inference", J. Am. Stat. Assoc. 22, 1927); of quantiles the order statistics, whatever the distribution (H. A. David
/// and H. N. Nagaraja, "Order Statistics", 2003); of mean and standard deviation the asymptotic ones for many devices.
/// @throws InputError as LocatedValue does, and for settings out of range
Yield yield_of(const System& system, const SpecialPoint& point, ParameterId control, const YieldSettings& settings);

/// Given devices, whose parameters may be correlated, as those made by one process.
struct MadeDevices {
    std::vector<ParameterId> parameters;
    /// For each device one value per parameter; empty: the device cannot be made.
    std::vector<std::vector<double>> values;
};

/// The same for given devices: without contributions, and with the linear deviation computed from these devices.
/// @param settings tolerances, devices and seed are ignored
/// @throws InputError also for devices with a wrong number of values
Yield yield_of(const System& system, const SpecialPoint& point, ParameterId control, const MadeDevices& devices,
               const YieldSettings& settings);

/// Returns the Wilson confidence interval of a share of which `hits` of `trials` were observed. @throws InputError
/// without trials, or for more hits than trials
ConfidenceInterval wilson_interval(std::size_t hits, std::size_t trials, double confidence);

} // namespace graze
