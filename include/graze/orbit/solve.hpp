#pragma once

#include "graze/orbit/certificate.hpp"
#include "graze/orbit/orbit.hpp"
#include "graze/sweep/attractor.hpp"
#include "graze/trajectory/simulation.hpp"

#include <complex>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Settings of the solution of orbits.
struct OrbitOptions {
    /// Relative tolerance of the integration, 1e-16 .. 1e-2; raise it only where integration is too slow.
    double tolerance = 1e-13;
    /// Newton's method stops when its last correction, relative to the scale of each unknown, is below this;
    /// 1e-15 .. 1e-2. Raise it for models that are known only to a few digits.
    double accuracy = 1e-10;
    std::size_t iterations = 25; ///< largest number of Newton iterations
    bool error_estimate = true;  ///< estimate the error by one more Newton step at a hundredth of the tolerance
    /// @throws InputError naming the option that is out of range
    void validate() const;
};

/// How the solution of an orbit ended.
enum class OrbitOutcome {
    converged,     ///< an orbit was found
    not_converged, ///< Newton's method did not find an orbit within the iterations
    singular,      ///< the equations do not determine an orbit here, as at a fold
    undefined,     ///< a segment leaves the domain of the model, or its solution becomes singular
};
std::string_view name_of(OrbitOutcome outcome);

/// A periodic orbit with its multipliers, error estimate and certificate.
struct OrbitSolution {
    Orbit orbit; ///< the last iterate when not converged
    OrbitOutcome outcome = OrbitOutcome::not_converged;
    std::string detail; ///< why it has not converged; for a converged orbit, empty or a note that it belongs to a
                        ///< family of orbits
    std::size_t iterations = 0;
    double residual = 0;         ///< largest residual of the equations, relative to the scale of each unknown
    std::optional<double> error; ///< estimated error of the unknowns, relative to their scales
    /// Floquet multipliers of the section map of the whole orbit, largest first; empty where an event is reached with
    /// zero speed. Along branches of models with more than 256 states only those outside a circle, if that suffices:
    /// `other_multipliers` are not computed, but lie within the radius `others_within`, which is below 1.
    std::vector<std::complex<double>> multipliers;
    std::size_t other_multipliers = 0;
    double others_within = 0;
    /// Of an equilibrium, or of the saddle of a homoclinic orbit: the eigenvalues of the linearised field, largest real
    /// part first.
    std::vector<std::complex<double>> eigenvalues;
    std::vector<std::complex<double>> half_multipliers; ///< multipliers of the half map of a symmetric orbit given by
                                                        ///< its half; `multipliers` are their squares
    Certificate certificate;
    /// Number of multipliers that are 1 because the orbit is one of a family on which something is conserved; set along
    /// branches. Where there are any, an orbit is stable if no multiplier lies outside the unit circle.
    std::size_t neutral = 0;
};

/// Returns the number of multipliers, computed or not; 0 where an event is reached with zero speed.
std::size_t number_of_multipliers(const OrbitSolution& solution);
/// True when all multipliers have magnitudes below 1 - 1e-8, the margin of round-off at a bifurcation; of an
/// equilibrium: when the real parts of all eigenvalues are below -1e-10 times the largest magnitude. False where they
/// are not known.
bool is_stable(const OrbitSolution& solution);
/// Returns the number of multipliers outside the unit circle, or of eigenvalues in the right half plane, by the same
/// margin.
std::size_t unstable_directions(const OrbitSolution& solution);

/// Finds a periodic orbit near a candidate by damped Newton's method on multiple shooting with exact derivatives. Where
/// a family of orbits exists at the same parameters, as in conservative models, the nearest member is found. A
/// candidate with the signature of an equilibrium leads to an equilibrium of its mode: an orbit of duration 0.
/// @throws InputError for a homoclinic orbit, which exists at one value of a parameter only, and when the candidate
/// does not fit the model or the options are out of range
OrbitSolution solve_orbit(const System& system, const Orbit& candidate, const OrbitOptions& options = {});

/// Finds the periodic orbit on which simulation settles at the model's parameters and initial state, and refines it by
/// solve_orbit. The result is a half orbit if the orbit is its own image under the model's (first) symmetry.
/// Contacts that accumulate within the orbit are one segment of it, up to the rest that follows.
/// @throws InputError when the motion does not settle on a periodic orbit; the message says what the motion does
/// instead
OrbitSolution find_orbit(const System& system, const AttractorOptions& settle, const OrbitOptions& options = {},
                         const SimulationOptions& simulation = {});
/// The same, but can be interrupted. @param interrupted called after each return to the section; returns true to stop
/// @return none when interrupted
std::optional<OrbitSolution> find_orbit(const System& system, const AttractorOptions& settle,
                                        const OrbitOptions& options, const SimulationOptions& simulation,
                                        const std::function<bool()>& interrupted);

/// Limits of the search for an orbit with a given signature.
struct SignatureSearchOptions {
    std::size_t steps = 1'000'000;     ///< integration steps for which the motion is followed at most
    std::size_t segments = 2000;       ///< segments of the motion that are examined at most
    std::size_t trials = 20;           ///< matching pieces of the motion that are tried as first guesses at most
    bool unphysical = false;           ///< accept an orbit that is not admissible
    std::function<bool()> interrupted; ///< called now and then; returns true to stop
};

/// Finds an orbit with a given signature. The motion from the model's initial state is followed, and each piece of it
/// that has these segments serves as a first guess until one leads to an admissible orbit. Transitions that change
/// neither state nor mode, and sections, count only if the signature names them. The result is a half orbit if the
/// orbit is its own image under a symmetry of the model.
/// @return a solution that is not converged, whose orbit is the first guess, when no piece led to an orbit; empty when
/// interrupted
/// @throws InputError when the motion has no such piece, as for homoclinic orbits, or all orbits found are inadmissible
std::optional<OrbitSolution> orbit_with_signature(const System& system, const Signature& signature,
                                                  const OrbitOptions& options = {},
                                                  const SimulationOptions& simulation = {},
                                                  const SignatureSearchOptions& search = {});

/// Returns the first half of an orbit that is its own image under a symmetry of the model; empty if it is not. @param
/// tolerance largest difference between the halves, relative to the extent of each state
std::optional<Orbit> half_orbit(const System& system, const Orbit& orbit, double tolerance = 1e-6);

/// The segments of a motion, without transitions that change neither state nor mode. The last segment, which the end of
/// the time interrupts, is left out.
struct FollowedMotion {
    Signature segments;
    std::vector<std::vector<double>> starts; ///< of each segment, and of the interrupted one
    std::vector<double> durations;
    std::vector<double> final_state; ///< at the end of the time
    std::size_t final_mode = 0;
    std::string problem; ///< why the motion could not be followed (chatter, singular end); empty otherwise
};
/// What follow_motion does where contacts accumulate: it ends there, with a problem, or makes one segment of the
/// contacts and goes on as the model says.
enum class Accumulations { end, segments };
FollowedMotion follow_motion(const Simulation& simulation, std::span<const double> parameters,
                             std::span<const double> state, std::size_t mode, double time,
                             Accumulations accumulations = Accumulations::end);

} // namespace graze
