#pragma once

#include "graze/identify/estimate.hpp"
#include "graze/record/impacts.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// What the estimates of section 5.3.1 of B. E. Wilcox's dissertation are made with: names of channels, and what is
/// known beforehand, in the units of the records.
struct IdentificationSettings {
    std::string channel = "v";                        ///< velocity, of decrements and restitutions
    std::string displacement = "";                    ///< of couplings (q if it is empty); of restitutions: for times
    std::string voltage = "V", current = "I";         ///< of impedances; of couplings the current
    std::size_t peaks = 10;                           ///< of each release
    ImpactWindow impacts{};                           ///< of restitutions
    std::optional<double> gap{}, stiffness{};         ///< of couplings; the gap also of leakage inductances
    double gap_error = 0, stiffness_error = 0;        ///< standard errors
    double displacement_noise = 0, current_noise = 0; ///< of couplings, see CouplingSettings
    bool one_load_a_record = false;                   ///< couplings: a record is an equilibrium, otherwise each row is
    std::optional<double> frequency{};                ///< about that of the voltage, in cycles by unit of time
    std::optional<Estimate> beta1{}, beta2{};         ///< of couplings found before: for the leakage inductance
    double clamped = 0;                               ///< displacement at which the mass is held
    std::string asked_as{}; ///< what stands before names of settings in messages, such as "--"
};

/// What has been found from records, and how well it says what was measured.
struct Identification {
    struct Value {
        std::string name, unit;
        Estimate estimate;
    };
    /// Of one record: what was measured, what should have been, and the difference.
    struct Curve {
        std::vector<double> x, y;
    };
    struct Shown {
        Curve measured, fitted, left;
    };
    std::vector<Value> values;
    std::vector<double> covariance;    ///< of the values, row by row; 0 where nothing is known
    std::vector<std::string> warnings; ///< what calls for a look at the record
    Channel x, y;                      ///< what is shown over what
    std::vector<Shown> shown;          ///< a curve for each record, or one for all
};

/// Hands out records one after the other, with what they are called. Numbers of several records are put together in the
/// units of the first: others are converted, and refused where they measure something else or one of them says none.
using EachRecord = std::function<void(const std::function<void(const std::string& name, SampleSource& record)>&)>;

/// Natural frequency and damping ratio: a record for each release.
/// @throws InputError here and below for channels that are not there, and as logarithmic_decrement, ... do
Identification identify_decrement(const EachRecord& records, const IdentificationSettings& settings);
/// Coefficient of restitution: a record for each set of conditions.
Identification identify_restitution(const EachRecord& records, const IdentificationSettings& settings);
/// Constants of an electromagnet, from equilibria.
Identification identify_coupling(const EachRecord& records, const IdentificationSettings& settings);
/// Resistance and inductance of a coil whose mass is held.
Identification identify_impedance(const EachRecord& records, const IdentificationSettings& settings);

} // namespace graze
