#pragma once

#include "graze/model/model.hpp"

#include <cstddef>
#include <string>
#include <string_view>

namespace graze {

/// A crossing, extremum or phase to be located along a trajectory, without influence on the motion.
struct Probe {
    enum class Kind {
        crossing, ///< `expression` passes zero
        extremum, ///< `expression` has a local maximum (falling rate) or minimum (rising rate)
        phase,    ///< a cyclic state passes a value (modulo its period)
    };
    std::string name;
    Kind kind = Kind::crossing;
    Expression expression;                 ///< for crossing and extremum
    Direction direction = Direction::both; ///< extremum: falling = maxima, rising = minima
    std::size_t state = 0;                 ///< for phase: the cyclic state
    Expression value;                      ///< for phase: its value, in terms of parameters
};

/// Returns the probe of a section declared in the model. @throws InputError for an unknown name, with the nearest one
Probe section_probe(const Model& model, std::string_view section);

} // namespace graze
