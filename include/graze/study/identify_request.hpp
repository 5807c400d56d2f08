#pragma once

#include "graze/base/input_error.hpp"
#include "graze/identify/fit.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// What runs of kind identify ask for. Numbers are texts where they may depend on parameters that other runs find: they
/// are evaluated in the run's model when it is done.
struct IdentifyRequest {
    enum class What { decrement, restitution, coupling, impedance, fit };
    What what = What::decrement;
    std::vector<std::string> records; ///< runs of kind record
    Place records_place;
    std::vector<std::pair<std::string, std::string>> gives; ///< what is found, and the parameter that it is
    std::string channel = "v", displacement, voltage = "V", current = "I";
    std::size_t peaks = 10, window = 12, transition = 0;
    double least_jump = 0;
    std::string gap, stiffness;        ///< of couplings; the gap also of impedances
    std::string beta1, beta2, clamped; ///< of impedances: for the leakage inductance
    /// Standard errors of those numbers, besides what the parameters in them make.
    double gap_error = 0, stiffness_error = 0, beta1_error = 0, beta2_error = 0;
    std::string frequency; ///< about that of the voltage, by unit of time; empty: by itself
    double displacement_noise = 0, current_noise = 0;
    bool each_row = false; ///< couplings: each row is an equilibrium; otherwise, of several records, each record is
    struct Unknown {
        std::string name, guess, least, greatest; ///< empty: the model's value; no bound
        Place place{};
    };
    std::vector<Unknown> unknowns; ///< of fits: parameters
    struct Reading {
        std::string channel, value; ///< of the record, and what it is in terms of the model
        bool gain_unknown = false, offset_unknown = false;
        double gain = 1, offset = 0, noise = 0;
        bool may_lack = false; ///< records need not have the channel
        Place place{};
    };
    std::vector<Reading> readings;
    std::vector<std::string> known; ///< states that begin as the model says
    bool all_known = false;
    FitLoss loss = FitLoss::squares;
    double piece = 0;
    std::string asked_as; ///< what stands before names of settings in messages, such as "--"
};

/// The names of what may be found, in the order of IdentifyRequest::What.
const std::vector<std::string>& kinds_of_estimates();

} // namespace graze
