#pragma once

#include "graze/model/model.hpp"

#include <cstddef>
#include <string>
#include <string_view>

namespace graze {

/// Something to be located along a trajectory without disturbing it.
struct Probe {
    enum class Kind {
        crossing, ///< `expression` passes zero
        extremum, ///< `expression` has a local maximum (falling rate) or minimum (rising rate)
        phase,    ///< a cyclic state passes a value (modulo its period)
    };
    std::string name;
    Kind kind = Kind::crossing;
    Expression expression;                 ///< of crossing and extremum
    Direction direction = Direction::both; ///< extremum: falling = maxima, rising = minima
    std::size_t state = 0;                 ///< of phase
    Expression value;                      ///< of phase, in terms of parameters
};

/// The probe of a section declared in the model. @throws InputError for an unknown name, with the nearest one
Probe section_probe(const Model& model, std::string_view section);

} // namespace graze
