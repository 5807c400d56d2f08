#pragma once

#include "graze/orbit/certificate.hpp"
#include "graze/orbit/orbit.hpp"
#include "graze/sweep/attractor.hpp"
#include "graze/trajectory/simulation.hpp"

#include <complex>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

struct OrbitOptions {
    double tolerance = 1e-13; ///< of the integration; 1e-16 .. 1e-2
    double accuracy = 1e-10;  ///< last correction of Newton's method, relative to the size of each unknown
    std::size_t iterations = 25;
    bool error_estimate = true; ///< by a further correction at a tolerance a hundred times smaller
    /// @throws InputError naming the option that is out of range
    void validate() const;
};

enum class OrbitOutcome {
    converged,
    not_converged, ///< Newton's method did not find an orbit within the iterations
    singular,      ///< the equations do not determine an orbit here, as at a fold
    undefined,     ///< a segment leaves the domain of the model, or its solution ceases to exist
};
std::string_view name_of(OrbitOutcome outcome);

/// A periodic orbit with what is known of it.
struct OrbitSolution {
    Orbit orbit; ///< the last iterate when not converged
    OrbitOutcome outcome = OrbitOutcome::not_converged;
    std::string detail; ///< why not converged; of one that has, that it is one of a family
    std::size_t iterations = 0;
    double residual = 0;         ///< of the equations, relative to the size of each unknown
    std::optional<double> error; ///< estimate, relative in the same sense
    /// Floquet multipliers of the whole orbit's section map, largest first; empty where an event is met without speed.
    std::vector<std::complex<double>> multipliers;
    std::vector<std::complex<double>>
        half_multipliers; ///< of an orbit that is given by its half: their squares are those
    Certificate certificate;
};

/// Whether all multipliers lie within the unit circle, by more than round-off at a bifurcation could decide. Not known,
/// and false, without multipliers.
bool is_stable(const OrbitSolution& solution);
/// How many lie outside, by as much.
std::size_t unstable_directions(const OrbitSolution& solution);

/// A periodic orbit near a candidate, by Newton's method on multiple shooting with exact derivatives, damped where it
/// would overshoot. Of a family of orbits at the same parameters, as conservative models have, the nearest one.
/// @throws InputError when the candidate does not fit the model or the options are out of range
OrbitSolution solve_orbit(const System& system, const Orbit& candidate, const OrbitOptions& options = {});

/// The orbit that simulation settles on at the model's parameters and initial state: its signature, starts and
/// durations, polished. Given by its half if it is its own image under the model's (first) symmetry.
/// @throws InputError when the motion does not settle on a periodic orbit, or contacts accumulate within it: says what
///         it does instead
OrbitSolution find_orbit(const System& system, const AttractorOptions& settle, const OrbitOptions& options = {},
                         const SimulationOptions& simulation = {});
/// The same, unless it is interrupted. @param interrupted asked after each return to the section
/// @return none when interrupted
std::optional<OrbitSolution> find_orbit(const System& system, const AttractorOptions& settle,
                                        const OrbitOptions& options, const SimulationOptions& simulation,
                                        const std::function<bool()>& interrupted);

struct SignatureSearchOptions {
    std::size_t steps = 1'000'000; ///< of the motion that is followed
    std::size_t segments = 2000;   ///< of it that are looked at
    std::size_t trials = 20;       ///< pieces of it from which Newton's method is begun
    bool unphysical = false;       ///< an orbit that is not admissible will do
    std::function<bool()> interrupted;
};

/// An orbit with a signature: the motion from the model's initial state is followed, and each piece of it with these
/// segments is a first guess, until one leads to an admissible orbit. Transitions that change nothing, and sections,
/// count if the signature names them. Given by its half if it is its own image under a symmetry of the model.
/// @return not converged when no piece has led to an orbit: then its orbit is the first guess; none when interrupted
/// @throws InputError when the motion has no such piece, or all that was found is not admissible
std::optional<OrbitSolution> orbit_with_signature(const System& system, const Signature& signature,
                                                  const OrbitOptions& options = {},
                                                  const SimulationOptions& simulation = {},
                                                  const SignatureSearchOptions& search = {});

/// The half of an orbit that is its own image under a symmetry of the model, or none if it is not.
std::optional<Orbit> half_orbit(const System& system, const Orbit& orbit, double tolerance = 1e-6);

/// Follows the model's motion from a state for a time and lists the segments that it has, without transitions that
/// change nothing; the last one, cut off by the end, is left out. What a signature is made of.
struct FollowedMotion {
    Signature segments;
    std::vector<std::vector<double>> starts; ///< of each segment, and of the one that was cut off
    std::vector<double> durations;
    std::vector<double> final_state; ///< at the end of the time
    std::size_t final_mode = 0;
    std::string problem; ///< why the motion could not be followed (chatter, singular end); empty when all is well
};
FollowedMotion follow_motion(const Simulation& simulation, std::span<const double> parameters,
                             std::span<const double> state, std::size_t mode, double time);

} // namespace graze
