#pragma once

#include "graze/model/model.hpp"
#include "graze/trajectory/probe.hpp"
#include "program/arguments.hpp"

#include <cstddef>
#include <limits>
#include <optional>

namespace graze {

/// What ends one leg of a run: whichever comes first.
struct LegEnd {
    double duration = std::numeric_limits<double>::infinity();
    std::size_t periods = 0;  ///< 0: not counted
    std::size_t contacts = 0; ///< 0: not counted
    /// Time that the leg takes, if it is known beforehand.
    std::optional<double> expected;

    bool empty() const { return duration == std::numeric_limits<double>::infinity() && periods == 0 && contacts == 0; }
};

/// How long to run: first a leg of which nothing is shown (it may be empty), then one that is.
struct RunLength {
    LegEnd transient, shown;
    std::optional<Probe> period; ///< its passages are counted: the phase with which the run begins
};

/// @throws InputError for lengths that are not positive, contradict each other, or cannot be known
RunLength run_length(const Model& model, const SimulateArguments& arguments);

} // namespace graze
