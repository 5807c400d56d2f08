#pragma once

#include "graze/model/model.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Spatial eigenmodes of the doubly clamped Euler-Bernoulli beam of unit length, normalised to unit mean
/// square, by formulas without cancellation for any mode number (dissertation section 3.2.5, Table 3.1).
class ClampedBeamModes {
public:
    /// @param count number of modes, at least 1
    explicit ClampedBeamModes(int count);
    int count() const { return static_cast<int>(wave_numbers_.size()); }
    /// Returns the modal frequency omega_i, i from 1: the square of the wave number.
    double frequency(int i) const;
    /// Return phi_i(x) and its derivative, 0 <= x <= 1. @throws InputError for x outside that range
    double shape(int i, double x) const;
    double slope(int i, double x) const;
    /// Returns Lambda'_ij, the integral of phi_i' phi_j' (closed form).
    double slope_product(int i, int j) const;

private:
    std::vector<double> wave_numbers_;
};

/// The polynomial x^2 (x - 1)^2 of Eq. (3.20), the deflection of the beam under a small uniform static load, normalised
/// to unit mean square too: amplitudes are g0 (128/315)^(1/2) times those of the equation. With this scaling, Eq.
/// (3.21) gives Lambda'_11 = 12 and the frequency 504^(1/2), against 22.373 for the first eigenmode.
class ClampedBeamPolynomial {
public:
    double frequency() const;
    /// Return phi(x) and its derivative, 0 <= x <= 1.
    double shape(double x) const;
    double slope(double x) const;
    double slope_product() const; ///< integral of phi'^2
};

enum class TrialFunctions {
    eigenmodes, ///< eigenmodes of the linear beam, any number
    polynomial, ///< the single function ClampedBeamPolynomial
};
enum class Quadrature { simpson, gauss };

/// Options of `microbeam`. Quantities are nondimensional as in section 3.2.4 of the dissertation: lengths in
/// units of the beam's length l.
struct MicrobeamOptions {
    int modes = 1;                                     ///< number N of trial functions; more resolve the shape better
    TrialFunctions trial = TrialFunctions::eigenmodes; ///< the polynomial allows one mode only
    bool steady = false; ///< constant voltage instead of pulses: orbits are equilibria, their folds are pull-in
    Quadrature quadrature = Quadrature::simpson; ///< rule for the electrostatic force
    int points = 20;         ///< intervals of Simpson's rule (even), or nodes of Gauss's; more for larger deflections
    double gamma = 3e4;      ///< b h l^2/I, stiffening by stretching of the mid-line
    double thickness = 0.02; ///< h
    double width = 0.01;     ///< b
    double gap = 0.04;       ///< g0, distance of the electrode from the undeformed beam
    double stop_position = 0.5;    ///< x0, between 0 and 1
    double stop_distance = -0.004; ///< d, distance of the stop from the undeformed beam, towards the electrode; not 0
    double stop_stiffness = 100;
    double frequency = 28; ///< angular frequency of the pulses
    double voltage = 0.03;
    double damping = 0.05;
};

/// The microbeam of chapter 3 with N trial functions: modes of motion (pulse on or off) x (free or in contact).
/// @throws InputError for invalid options
Model microbeam(const MicrobeamOptions& options = {});
/// Returns the options of a named variant: "microbeam-9" with nine modes, "microbeam-polynomial" with the trial
/// function of Eq. (3.20), "microbeam-steady" under a constant voltage. None for other names, including "microbeam".
std::optional<MicrobeamOptions> microbeam_member(std::string_view model_name);

} // namespace graze
