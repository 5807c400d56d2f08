#pragma once

#include "graze/orbit/orbit.hpp"

#include <optional>
#include <span>
#include <string>

namespace graze {

/// An orbit without contacts, as segments from passage to passage of one of the model's sections: of a phase section if
/// there is one, since a phase passes it at the same rate however the orbit changes; otherwise of the preferred one, or
/// of whichever is passed first.
/// @param state on the orbit; @param duration after which it (or its image under the symmetry) comes back
/// @param symmetry of a half orbit, which is a single segment
std::optional<Orbit> close_at_section(const System& system, const std::vector<double>& parameters,
                                      std::span<const double> state, std::size_t mode, double duration,
                                      const std::string& preferred, std::optional<std::size_t> symmetry);

/// A smooth orbit in one mode, given by arcs that follow one another from anywhere to anywhere, as segments from
/// passage to passage of a section. It begins with the first arc, and events that are touched on the way do not happen.
Orbit cut_at_section(const System& system, const Orbit& arcs, std::size_t section);

} // namespace graze
