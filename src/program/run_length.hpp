#pragma once

#include "graze/model/model.hpp"
#include "graze/trajectory/probe.hpp"
#include "graze/trajectory/run_control.hpp"
#include "program/arguments.hpp"

#include <optional>

namespace graze {

/// How long to run: first a leg of which nothing is shown (it may be empty), then one that is.
struct RunLength {
    LegEnd transient, shown;
    std::optional<Probe> period; ///< its passages are counted: the phase with which the run begins
};

/// @throws InputError for lengths that are not positive, contradict each other, or cannot be known
RunLength run_length(const Model& model, const SimulateArguments& arguments);

} // namespace graze
