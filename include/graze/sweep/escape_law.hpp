#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace graze {

/// How long one of many motions has stayed where motions are chaotic, or wherever else they leave by chance.
struct Stay {
    std::size_t cycles = 0; ///< returns seen
    bool left = false;      ///< at the end of these; otherwise it was there still
};

/// Motions leave a chaotic transient at a rate that does not depend on how long they have been there: the share that is
/// left decays exponentially (Kantz and Grassberger 1985; Lai and Tel, Transient Chaos, 2011, section 1.2).
struct EscapeLaw {
    double rate = 0;           ///< per return: the share that stays decays like exp(-rate * returns)
    double error = 0;          ///< within which it lies in 19 of 20 cases
    std::size_t from = 0;      ///< returns after which the law holds
    std::size_t left = 0;      ///< motions that left later
    std::size_t remaining = 0; ///< and that had not left when they were given up
};

/// The greatest likelihood estimate from motions of which some have been given up before they left. Those that leave
/// first, before the law holds, are left out: as few as possible.
/// @return nothing where fewer than ten leave by a law, or the times at which they do contradict a constant rate: for
///         one, since some never leave
std::optional<EscapeLaw> escape_law(std::span<const Stay> stays);

} // namespace graze
