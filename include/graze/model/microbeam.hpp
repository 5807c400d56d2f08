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
    /// Modal frequency omega_i, i from 1: the square of the wave number.
    double frequency(int i) const;
    /// phi_i(x) and its derivative, 0 <= x <= 1.
    double shape(int i, double x) const;
    double slope(int i, double x) const;
    /// Lambda'_ij: integral of phi_i' phi_j' (closed form).
    double slope_product(int i, int j) const;

private:
    std::vector<double> wave_numbers_;
};

/// The polynomial x^2 (x - 1)^2 of Eq. (3.20), the shape of the beam under a small steady load, likewise normalised to
/// unit mean square: its amplitude is g0 (128/315)^(1/2) times that of the equation. Of Eq. (3.21) that leaves
/// Lambda'_11 = 12, and the frequency 504^(1/2) for 22.373 of the first eigenmode.
class ClampedBeamPolynomial {
public:
    double frequency() const;
    /// phi(x) and its derivative, 0 <= x <= 1.
    double shape(double x) const;
    double slope(double x) const;
    double slope_product() const; ///< integral of the slope's square
};

enum class TrialFunctions {
    eigenmodes, ///< of the linear beam, any number of them
    polynomial, ///< ClampedBeamPolynomial alone
};
enum class Quadrature { simpson, gauss };

struct MicrobeamOptions {
    int modes = 1;
    TrialFunctions trial = TrialFunctions::eigenmodes;
    bool steady = false; ///< the voltage is always on: orbits are equilibria, and their folds are those of pull-in
    Quadrature quadrature = Quadrature::simpson;
    int points = 20; ///< intervals of Simpson's rule (even), or nodes of Gauss's
    double gamma = 3e4, thickness = 0.02, width = 0.01, gap = 0.04; ///< gamma, h, b, g0 of section 3.2.4
    double stop_position = 0.5, stop_distance = -0.004;             ///< x0, d
    double stop_stiffness = 100, frequency = 28, voltage = 0.03, damping = 0.05;
};

/// The microbeam of chapter 3 with N trial functions: modes of motion (pulse on or off) x (free or in contact).
/// @throws InputError for options that make no sense
Model microbeam(const MicrobeamOptions& options = {});
/// The member of this family that has a name: "microbeam-9" with nine modes, "microbeam-polynomial" with the trial
/// function of Eq. (3.20), "microbeam-steady" under a steady voltage. None for other names, "microbeam" among them.
std::optional<MicrobeamOptions> microbeam_member(std::string_view model_name);

} // namespace graze
