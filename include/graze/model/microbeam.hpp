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

enum class Quadrature { simpson, gauss };

struct MicrobeamOptions {
    int modes = 1;
    Quadrature quadrature = Quadrature::simpson;
    int points = 20; ///< intervals of Simpson's rule (even), or nodes of Gauss's
    double gamma = 3e4, thickness = 0.02, width = 0.01, gap = 0.04; ///< gamma, h, b, g0 of section 3.2.4
    double stop_position = 0.5, stop_distance = -0.004;             ///< x0, d
    double stop_stiffness = 100, frequency = 28, voltage = 0.03, damping = 0.05;
};

/// The microbeam of chapter 3 with N modes: modes of motion (pulse on or off) x (free or in contact).
/// @throws InputError for options that make no sense
Model microbeam(const MicrobeamOptions& options = {});
/// The number of modes in the name of a member of this family: 9 in "microbeam-9". None in other names, "microbeam"
/// among them.
std::optional<int> microbeam_modes(std::string_view model_name);

} // namespace graze
