#pragma once

#include "graze/base/input_error.hpp"
#include "graze/identify/fit.hpp"
#include "graze/record/impacts.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// What runs of kind identify ask for. Numbers that may depend on parameters which other runs find are texts:
/// expressions that are evaluated in the run's model when the run is carried out.
struct IdentifyRequest {
    enum class What { decrement, restitution, coupling, impedance, fit };
    What what = What::decrement;
    std::vector<std::string> records; ///< runs of kind record
    Place records_place;
    std::vector<std::pair<std::string, std::string>> gives; ///< name of an estimate, and the parameter that it becomes
    std::string channel = "v", displacement, voltage = "V", current = "I";
    std::size_t peaks = 10;
    ImpactWindow impacts;              ///< of restitutions
    std::string gap, stiffness;        ///< of couplings; the gap also of impedances
    std::string beta1, beta2, clamped; ///< of impedances: for the leakage inductance
    /// Standard errors of these numbers, in addition to those that follow from the parameters in them.
    double gap_error = 0, stiffness_error = 0, beta1_error = 0, beta2_error = 0;
    std::string frequency; ///< of the voltage, roughly, per unit of time; empty: it is found from the record
    double displacement_noise = 0, current_noise = 0;
    bool each_row = false; ///< couplings: each row is an equilibrium; otherwise the mean of each of several records is
    struct Unknown {
        std::string name, guess, least, greatest; ///< guess empty: the model's value; bounds empty: none
        Place place{};
    };
    std::vector<Unknown> unknowns; ///< of fits: parameters
    struct Reading {
        std::string channel, value; ///< channel of the record, and the expression of the model that it measures
        bool gain_unknown = false, offset_unknown = false; ///< they are found by the fit
        double gain = 1, offset = 0, noise = 0;            ///< noise: standard deviation; 0: found by the fit
        bool may_lack = false;                             ///< records without the channel are accepted
        Place place{};
    };
    std::vector<Reading> readings;
    std::vector<std::string> known; ///< states whose initial values are those of the model; others are found
    bool all_known = false;         ///< all initial values are those of the model
    FitLoss loss = FitLoss::squares;
    double piece = 0; ///< length of the pieces that records are cut into; 0: chosen by the number of readings
    SimulationOptions simulation = FitSettings().simulation; ///< of fits
};

/// The names of the estimates, in the order of IdentifyRequest::What.
const std::vector<std::string>& kinds_of_estimates();

} // namespace graze
