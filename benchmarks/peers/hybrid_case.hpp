#pragma once

#include "cvodes_peer.hpp"
#include "motions.hpp"
#include "work_precision.hpp"

#include "graze/model/model.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace peers {

/// A motion with derivatives, given to graze as a model and to its peers as hand-written equations. The peers' units
/// may be others, and their states may have another order.
struct HybridCase {
    std::string name;
    graze::Model model;
    std::size_t parameter = 0; ///< parameter of the derivatives, besides all states
    Motions motions;

    std::vector<std::size_t> order;        ///< the peers' place of each state of the model
    std::vector<double> units;             ///< factors from the peers' units to the model's, for each state
    double time_unit = 1;                  ///< likewise
    double parameter_unit = 1;             ///< likewise
    std::vector<double> scales;            ///< sizes of the model's states
    double parameter_scale = 1;            ///< likewise
    std::vector<double> start;             ///< of the model
    std::size_t mode = 0;                  ///< there
    double duration = 0, longest_step = 0; ///< in the model's time; the step is for the reference
    int periods = 0;                       ///< of the force
};

/// Returns the chain in settled motion, without or with contacts.
HybridCase chain_case(std::size_t oscillators, double force, int periods);
HybridCase beam_case(int modes, int periods);
HybridCase testbed_case(int periods);

/// A result in the model's order, states measured by their scales and derivatives by those of both.
struct Outcome {
    std::vector<double> state;                    ///< without the phase, which comes last
    std::vector<std::vector<double>> derivatives; ///< for each input
    std::vector<double> meetings;                 ///< times of all contacts, in the model's time
};

/// The largest error of the states, or of a direction against that direction's size, whichever is larger.
double error_of(const Outcome& outcome, const Outcome& reference);
/// Returns the largest difference of contact times; infinite if their numbers differ.
double distance_of_meetings(const Outcome& one, const Outcome& other);

Outcome reference_of(const HybridCase& one);
/// @param budget seconds for which the run is repeated to find the smallest time
Effort graze_effort(const HybridCase& one, double tolerance, double budget, const Outcome& reference, Outcome& outcome);
Effort cvodes_effort(const HybridCase& one, CvodesMethod method, double tolerance, double budget,
                     const Outcome& reference, Outcome& outcome);

} // namespace peers
