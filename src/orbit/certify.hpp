#pragma once

#include "graze/orbit/certificate.hpp"
#include "orbit/orbit_equations.hpp"

#include <Eigen/Core>

#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

namespace graze {

/// Whether a transition changes nothing: neither state nor mode. Orbits need not list it.
bool is_harmless(const System& model, std::size_t transition);

/// What an orbit is held to, of which round-off would decide whether it is admissible: that an event is touched within
/// a segment, that a contact has no speed, that a segment takes no time, that the guard after one is about to choose
/// another mode.
struct HeldLimit {
    enum class Kind { touch, stop, vanishing, guard };
    Kind kind = Kind::touch;
    std::size_t segment = 0, event = 0;
    /// Of stop: segments after it that take no time either, as slip does that such a contact would set going.
    std::size_t without_time = 0;

    /// Whether a segment, of so many, is held to take no time.
    bool holds_without_time(std::size_t one, std::size_t segments) const {
        return (kind == Kind::vanishing && one == segment) ||
               (kind == Kind::stop && one != segment && (one + segments - segment) % segments <= without_time);
    }
};

/// Checks every watched event over every arc, by the roots of its Taylor polynomials.
/// @param held zero to within the accuracy of the flow: no contact, no negative duration, no other mode
Certificate certify(OrbitEquations& equations, const OrbitEvaluation& at,
                    const std::optional<HeldLimit>& held = std::nullopt);

/// Whether the model would follow an orbit, all of whose segments take time. @param why not, if it is known
bool is_admissible(const Simulation& simulation, const Orbit& orbit, std::string& why);

/// How many states the orbit brings back to whatever they were although they change along it: each tells one of many
/// orbits side by side. What rests all along the orbit is no more than a parameter of it.
std::size_t moving_neutral_states(const OrbitEquations& equations, const OrbitEvaluation& at);
/// Floquet multipliers of the section map at the start of the first segment, largest first: of the half orbit for one
/// that is given by its half. Without those that drifting or unchanged states, and shifts along the flow, would add.
/// Empty where an event is reached without speed.
std::vector<std::complex<double>> floquet_multipliers(const OrbitEquations& equations, const OrbitEvaluation& at);

} // namespace graze
