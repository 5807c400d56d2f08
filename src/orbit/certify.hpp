#pragma once

#include "graze/orbit/certificate.hpp"
#include "orbit/orbit_equations.hpp"

#include <complex>
#include <optional>

namespace graze {

/// True when a transition changes neither state nor mode. Signatures need not list it.
bool is_identity_transition(const System& model, std::size_t transition);

/// A constraint that places an orbit at the limit of admissibility, so that round-off alone would decide the check: an
/// event is touched within a segment (touch), a contact has zero speed (stop), a segment has zero duration (vanishing),
/// or the guard after a segment is about to choose another mode (guard).
struct HeldLimit {
    enum class Kind { touch, stop, vanishing, guard };
    Kind kind = Kind::touch;
    std::size_t segment = 0, event = 0;
    /// For stop: number of following segments whose duration is zero too, such as a slip that the contact would start.
    std::size_t zero_durations = 0;

    /// True when the constraint makes the duration of segment `one`, of `segments`, zero.
    bool has_zero_duration(std::size_t one, std::size_t segments) const {
        return (kind == Kind::vanishing && one == segment) ||
               (kind == Kind::stop && one != segment && (one + segments - segment) % segments <= zero_durations);
    }
};

/// Checks every watched event along every arc by root isolation on its Taylor polynomials.
/// @param held constraint of the orbit, which is zero only to the accuracy of the flow and must not cause a rejection
Certificate certify(OrbitEquations& equations, const OrbitEvaluation& at,
                    const std::optional<HeldLimit>& held = std::nullopt);

/// True when the model would follow the orbit and all its durations are positive. @param why set to the reason
/// otherwise, if it is known
bool is_admissible(const Simulation& simulation, const Orbit& orbit, std::string& why);

/// Returns the number of neutral states that change along the orbit: the orbit returns them to any value that they
/// start with, so that each parametrises a family of orbits. States that are constant along the orbit do not count;
/// they act as parameters.
std::size_t moving_neutral_states(const OrbitEquations& equations, const OrbitEvaluation& at);
/// Returns the Floquet multipliers of the section map at the start of the first segment, largest first; of the half map
/// for a half orbit. The trivial multipliers of drifting states, constant states and shifts along the flow are left
/// out. Empty where an event is reached with zero speed. Method: product of saltation and flow matrices (Aizerman and
/// Gantmakher 1958).
std::vector<std::complex<double>> floquet_multipliers(const OrbitEquations& equations, const OrbitEvaluation& at);

/// Those multipliers of a model with many states that lie outside a circle, and the number of the others.
struct LeadingMultipliers {
    std::vector<std::complex<double>> values; ///< largest first
    std::size_t others = 0;
    double others_within = 0; ///< radius below 1 of the circle in which the others lie
};
/// @return none where all are needed: of models with up to 256 states, where many lie near the unit circle, or where
/// `floquet_multipliers` finds none
std::optional<LeadingMultipliers> leading_multipliers(const OrbitEquations& equations, const OrbitEvaluation& at);

/// Returns the eigenvalues of a product of square matrices, last factor times ... times first, largest first, without
/// forming the product: orthogonal iteration through the factors (the unshifted form of the periodic QR algorithm: A.
/// Bojanczyk, G. Golub, P. Van Dooren, "The periodic Schur decomposition", Proc. SPIE 1770, 1992) separates eigenvalues
/// of different magnitude. Each is as accurate as the factors allow, however many powers of ten lie between them. Empty
/// where the eigenvalues of a block cannot be computed.
std::vector<std::complex<double>> product_eigenvalues(const std::vector<Eigen::MatrixXd>& factors);

} // namespace graze
