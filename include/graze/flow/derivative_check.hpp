#pragma once

#include "graze/flow/system.hpp"

#include <span>
#include <string>
#include <vector>

namespace graze {

/// A derivative that is not what differences make of it, or a value or derivative that is not defined.
struct DerivativeFinding {
    std::string part; ///< of the model, such as "events.wall"
    std::string what; ///< such as "the rate of v by x" (the parameter or state by which)
    double exact = 0, difference = 0;
    double error = 0; ///< by how much the difference may be off, as it tells itself

    /// In words, with the numbers.
    std::string text() const;
};

struct DerivativeCheckOptions {
    double duration = 0;     ///< of the flow; 0: a tenth of the time in which the state changes by its size
    double tolerance = 1e-6; ///< departure that counts, relative to the derivative's own size and to those beside it
};

/// Compares exact derivatives with differences at one state: of rates, watched events and sections, of jumps, and of
/// the flow of each mode over a short time, by states and parameters (as Ceres Solver's GradientChecker does). An event
/// whose function is not defined there cannot be watched, and is told as well. What differences cannot tell, as next to
/// a singularity, is passed over; a corner that is very near is told as a disagreement.
/// @param state, parameters as many as the system has. @return what disagrees; nothing where all is well
/// @throws InputError for numbers that do not fit the system or are not finite
std::vector<DerivativeFinding> check_derivatives(const System& system, std::span<const double> state,
                                                 std::span<const double> parameters,
                                                 const DerivativeCheckOptions& options = {});

} // namespace graze
