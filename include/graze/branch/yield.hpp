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
    normal,  ///< by a normal distribution
    uniform, ///< evenly
};
/// How much a parameter differs from one device to another.
struct Tolerance {
    ParameterId parameter;
    Spread spread = Spread::normal;
    double size =
        0; ///< standard deviation of a normal one, largest departure of a uniform one; in the parameter's unit

    double deviation() const; ///< standard deviation
};

struct YieldSettings {
    std::vector<Tolerance> tolerances;
    std::size_t devices = 10'000;
    std::uint64_t seed = 1;
    std::optional<double> least, greatest; ///< of the value that is wanted; none: all are
    double confidence = 0.95;              ///< of all limits
    std::vector<double> quantiles{0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99};
    int jobs = 1; ///< threads, on which nothing depends
    LocatedValueOptions solver;
    std::function<bool()> interrupted;
    std::function<void(std::size_t devices)> progress; ///< how many are done
    /// @throws InputError naming what is out of range
    void validate() const;
};

/// With limits of confidence.
struct ConfidenceInterval {
    double value = 0, low = 0, high = 0;
};

struct QuantileEstimate {
    double share = 0; ///< of devices that lie below
    double value = 0;
    std::optional<double> low, high; ///< none where there are too few devices for a limit
};

/// What one parameter contributes, as far as the value is linear in it.
struct Contribution {
    ParameterId parameter;
    double deviation = 0; ///< of the value by it alone, with the sign of the derivative
    double share = 0;     ///< of the variance; 0 if there is none
};

enum class DeviceOutcome {
    found,
    inadmissible, ///< the orbit is none of the model's: something else happens first
    failed,       ///< Newton's method has not found it
    not_made,     ///< the work was interrupted before
};
struct Device {
    DeviceOutcome outcome = DeviceOutcome::not_made;
    double value = 0;  ///< if found
    double linear = 0; ///< what the derivatives alone say
};

/// What becomes of a value over many devices.
struct Yield {
    double nominal = 0;
    std::vector<Device> devices; ///< in their order
    std::size_t made = 0, found = 0, inadmissible = 0, failed = 0;
    std::vector<std::pair<std::string, std::size_t>> problems; ///< of those not found, and how many have each
    bool interrupted = false;

    std::optional<ConfidenceInterval> mean, deviation; ///< of those found; none of fewer than two
    std::vector<QuantileEstimate> quantiles;           ///< of those found
    /// Share of all devices that have the value within what is wanted. One that is not found is not within.
    std::optional<ConfidenceInterval> within;

    double linear_deviation = 0;             ///< by the derivatives alone, exactly
    std::optional<double> linear_within;     ///< share of the same devices, by the derivatives alone
    double largest_departure = 0;            ///< of a device that was found from what the derivatives say
    std::vector<Contribution> contributions; ///< the largest first
};

/// Makes devices whose parameters are drawn independently, and solves for the value of each, by Newton's method from
/// the nominal one. What is drawn depends on the seed, the device's number and the tolerance's place only, so that
/// results are the same bit for bit on any number of threads.
///
/// Limits of shares are those of E. B. Wilson ("Probable inference, the law of succession, and statistical inference",
/// J. Am. Stat. Assoc. 22, 1927); of quantiles the order statistics, whatever the distribution (H. A. David and
/// H. N. Nagaraja, "Order Statistics", 2003); of mean and standard deviation those for many devices.
/// @throws InputError as LocatedValue does, and for settings out of range
Yield yield_of(const System& system, const SpecialPoint& point, ParameterId control, const YieldSettings& settings);

/// Devices whose parameters depend on one another, as those that one process has made.
struct MadeDevices {
    std::vector<ParameterId> parameters;
    std::vector<std::vector<double>> values; ///< of each device, one for each parameter; none: it cannot be made
};

/// The same for given devices: without contributions, and with a deviation that the derivatives give to these devices.
/// @param settings of which tolerances, devices and seed are not used
/// @throws InputError also for devices with another number of values
Yield yield_of(const System& system, const SpecialPoint& point, ParameterId control, const MadeDevices& devices,
               const YieldSettings& settings);

/// Limits of a share, of which `hits` of `trials` are seen. @throws InputError without trials, or for more hits
ConfidenceInterval wilson_interval(std::size_t hits, std::size_t trials, double confidence);

} // namespace graze
