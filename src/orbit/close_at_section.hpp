#pragma once

#include "graze/orbit/orbit.hpp"

#include <optional>
#include <span>
#include <string>

namespace graze {

/// Divides an orbit without contacts into segments between passages of one of the model's sections: a phase section if
/// there is one, since a phase crosses it at the same rate however the orbit changes; otherwise the preferred section,
/// or else the first that the orbit crosses. Empty if it crosses none.
/// @param state on the orbit; @param duration after which the state (or its image under the symmetry) returns
/// @param symmetry of a half orbit, which becomes a single segment
std::optional<Orbit> close_at_section(const System& system, const std::vector<double>& parameters,
                                      std::span<const double> state, std::size_t mode, double duration,
                                      const std::string& preferred, std::optional<std::size_t> symmetry);

/// Divides a smooth orbit in one mode, given by consecutive arcs with arbitrary ends, into segments between passages of
/// a section. The first segment begins with the first arc. Events that the orbit only touches are ignored.
Orbit cut_at_section(const System& system, const Orbit& arcs, std::size_t section);

} // namespace graze
