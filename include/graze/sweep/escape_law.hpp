#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace graze {

/// The lifetime of motions in a chaotic transient, or in another region that motions leave at random.
struct Stay {
    std::size_t cycles = 0;  ///< number of observed returns
    bool left = false;       ///< true if the motions left after these; false if they were still there
    std::size_t motions = 1; ///< number of motions of which that is so
};

/// The law of escape from a chaotic transient: motions leave at a rate that does not depend on the time they have
/// stayed, so that the remaining share decays exponentially (Kantz and Grassberger 1985; Lai and Tel, Transient Chaos,
/// 2011, section 1.2).
struct EscapeLaw {
    double rate = 0;           ///< per return: the remaining share decays like exp(-rate * returns)
    double error = 0;          ///< half width of the 95 % confidence interval of the rate
    std::size_t from = 0;      ///< number of returns after which the law holds
    std::size_t left = 0;      ///< number of motions that left later
    std::size_t remaining = 0; ///< number of motions that had not left at the end of their observation
};

/// Returns the maximum likelihood estimate from motions some of which were observed only for a limited time (censored).
/// As few as possible of the motions that leave first, before the law holds, are excluded.
/// @return nothing if fewer than ten motions leave by the law, if their times contradict a constant rate, for
/// example because some never leave, or if only the last motions to leave obey a law
std::optional<EscapeLaw> escape_law(std::span<const Stay> stays);

} // namespace graze
