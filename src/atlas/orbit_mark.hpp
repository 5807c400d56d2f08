#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// Numbers by which orbits are told apart, wherever on them their description begins and whatever contacts it lists:
/// the parameters of the atlas, the period, and the greatest and least value of each state that neither turns round nor
/// drifts.
struct OrbitMark {
    std::vector<double> at; ///< values of the parameters of the atlas
    double period = 0;
    std::vector<double> extents; ///< greatest and least value of each of these states, in this order
};

/// The sizes by which differences of marks are measured.
struct MarkScales {
    std::vector<double> at;      ///< widths of the box
    std::vector<double> extents; ///< usual magnitudes of each extent; both of a state have the same

    /// Sets usual magnitudes to the medians over orbits: a branch may run to a pole.
    void fit(const std::vector<const OrbitMark*>& marks);
    /// The scale of an extent: the magnitude of its state on both orbits, whose least value may be a wall at zero.
    double extent(std::size_t index, const OrbitMark& one, const OrbitMark& other) const;
};

/// Located points agree to about 1e-10 of the box. Orbits at a fold are known to the square root of that.
inline constexpr double same_place = 1e-7, same_extent = 1e-5;

/// Whether two parameter values are the same, to `same_place` of the box.
bool is_same_place(const OrbitMark& one, const OrbitMark& other, const MarkScales& scales);
/// Whether two orbits at the same place go equally far.
/// @param tolerance of extents, relative to their scales
bool has_same_extents(const OrbitMark& one, const OrbitMark& other, const MarkScales& scales,
                      double tolerance = same_extent);
/// Whether two orbits, at parameters that may differ by round-off, are one orbit: a period that is a multiple of the
/// other one counts as the same where `multiples` is true, since both branches of a flip have its orbit.
bool is_same_orbit(const OrbitMark& one, const OrbitMark& other, const MarkScales& scales, bool multiples = false);

} // namespace graze
