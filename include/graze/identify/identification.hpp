#pragma once

#include "graze/identify/estimate.hpp"
#include "graze/record/impacts.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Options of the estimates below (section 5.3.1 of B. E. Wilcox's dissertation): names of channels, and quantities
/// that are known beforehand, in the units of the records. Each field says which estimates use it.
struct IdentificationSettings {
    std::string channel = "v"; ///< velocity channel (decrement, restitution)
    /// Displacement channel: coupling (empty: q); restitution: optional, for the times of impacts.
    std::string displacement = "";
    std::string voltage = "V", current = "I";  ///< voltage (impedance) and current (impedance, coupling) channels
    std::size_t peaks = 10;                    ///< largest number of peaks of each release (decrement)
    ImpactWindow impacts{};                    ///< restitution, see ImpactSettings
    std::optional<double> gap{}, stiffness{};  ///< coupling, see CouplingSettings; the gap also for leakage inductance
    double gap_error = 0, stiffness_error = 0; ///< standard errors of gap and stiffness
    double displacement_noise = 0, current_noise = 0; ///< coupling, see CouplingSettings
    /// Coupling: true: the means of a record are one equilibrium; false: each row is one.
    bool one_load_a_record = false;
    /// Impedance: initial guess of the voltage's frequency, in cycles per unit of time.
    std::optional<double> frequency{};
    std::optional<Estimate> beta1{}, beta2{}; ///< result of a coupling, for the leakage inductance
    double clamped = 0;                       ///< impedance: displacement at which the mass is clamped
};

/// Estimates from records, with warnings about the records and curves to plot.
struct Identification {
    struct Value {
        std::string name, unit;
        Estimate estimate;
    };
    /// Points of a curve.
    struct Curve {
        std::vector<double> x, y;
        void add(double at, double value) {
            x.push_back(at);
            y.push_back(value);
        }
    };
    struct Shown {
        Curve measured, fitted, left;
    };
    std::vector<Value> values;
    std::vector<double> covariance;    ///< covariance matrix of the values, row by row; 0 where unknown
    std::vector<std::string> warnings; ///< reasons to distrust the estimates
    Channel x, y;                      ///< labels and units of the axes of `shown`
    std::vector<Shown> shown; ///< measured and fitted values and residuals: one entry for each record, or one for all
};

/// Calls a function with the name and the samples of each record in turn. Numbers from several records are combined in
/// the units of the first: the others are converted, or refused if they have another dimension or no unit.
using EachRecord = std::function<void(const std::function<void(const std::string& name, SampleSource& record)>&)>;

/// Estimates natural frequency and damping ratio; each record is a release.
/// @throws InputError here and below for missing channels, and for the reasons of logarithmic_decrement, restitution,
/// coupling and impedance
Identification identify_decrement(const EachRecord& records, const IdentificationSettings& settings);
/// Estimates the coefficient of restitution; each record is a set of conditions.
Identification identify_restitution(const EachRecord& records, const IdentificationSettings& settings);
/// Estimates the constants of an electromagnet from equilibria.
Identification identify_coupling(const EachRecord& records, const IdentificationSettings& settings);
/// Estimates resistance and inductance of a coil whose mass is clamped.
Identification identify_impedance(const EachRecord& records, const IdentificationSettings& settings);

} // namespace graze
