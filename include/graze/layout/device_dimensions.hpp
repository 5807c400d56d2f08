#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace graze {

/// Dimensions of the drawing of one device: an H-shaped plate (the mass), which hangs on two folded flexures in its
/// notches, between a fixed electrode to its left and two stops to its right, with a channel for a laser beam between
/// the stops. All lengths are drawn lengths in micrometres; x is the direction of motion. docs/layout.md shows each of
/// them. The drawing is symmetric about y = 0, the centre of the H.
struct DeviceDimensions {
    // The capacitor.
    double electrode_length = 2000; ///< length along y of the fixed electrode's face
    double electrode_width = 300;   ///< width along x from its face to the pad
    double gap = 15;                ///< gap between the fixed electrode and the mass
    double pad_length = 1000;       ///< length along x of the fixed electrode's contact pad
    double pad_width = 1000;        ///< width of the pad along y
    double moat = 60;               ///< trench between the fixed electrode and the frame
    double base_inset = 40;         ///< distance of the bonded base's outline within that of the fixed electrode

    // The mass.
    double bar_width = 100;    ///< width along x of each of the two vertical bars of the H
    double bridge_width = 200; ///< width along y of the bridge that joins them
    double clearance = 40;     ///< clearance between the mass, or a truss of a flexure, and what it moves along

    // The flexures, one in each notch of the H: a row of beams along y on each side of the notch's middle, connected in
    // series by trusses at alternate ends, from the frame to the bar.
    double flexure_width = 6;     ///< width of a beam, along x
    double flexure_length = 1150; ///< length of a beam between trusses, along y
    double flexure_spacing = 30;  ///< clear distance between neighbouring beams, and from the last one to the bar
    double flexure_middle = 60;   ///< clear distance between the first beams on both sides of the middle
    double truss_width = 40;      ///< width of a truss, along y
    std::size_t folds = 1;        ///< folds on either side, of two beams each; a flexure has 4 folds beams

    // The stops.
    double stop_gap = 9;     ///< gap between a stop and the mass
    double stop_width = 150; ///< width of a stop, along y
    /// Width along y of the channel between the stops, which continues to the edge of the die.
    double channel_width = 200;

    // The die.
    double chamber_margin = 50; ///< distance by which the chamber on the back extends beyond the front trenches
    double die_length = 6000;   ///< along x
    double die_width = 6000;    ///< along y
    double frame_width = 500;   ///< smallest distance from the chamber to the die's edge
    double mark_size = 300;     ///< size of an alignment mark; 0: none
    double label_height = 140;  ///< height of the letters on the die; 0: none

    /// Distance from the centre of the H to its upper end.
    double mass_half_length() const { return bridge_width / 2 + clearance + 2 * truss_width + flexure_length; }
    /// Distance from the middle of a notch to a bar.
    double notch_half_width() const {
        return flexure_middle / 2 + 2 * static_cast<double>(folds) * (flexure_width + flexure_spacing);
    }
    friend bool operator==(const DeviceDimensions&, const DeviceDimensions&) = default;
};

/// Thicknesses of the process. Lengths in micrometres.
struct ProcessData {
    double wafer_thickness = 300; ///< thickness of the device wafer
    double chamber_depth = 50;    ///< depth of the chambers etched into its back

    /// Thickness of all moving parts, electrodes and beams.
    double layer_thickness() const { return wafer_thickness - chamber_depth; }
};

/// Descriptor of a length in a design file.
template <class Section>
struct LengthField {
    const char* name;
    double Section::*member;
    const char* text; ///< description
    bool may_be_zero = false;
};

/// Returns the lengths in the order of docs/layout.md. `folds`, an integer, is not included.
std::span<const LengthField<DeviceDimensions>> device_fields();
std::span<const LengthField<ProcessData>> process_fields();

constexpr double grid_per_micrometre = 1000; ///< all coordinates are multiples of a nanometre
constexpr double greatest_length = 1e6;      ///< micrometres: larger drawings are refused
constexpr std::size_t most_folds = 100;

/// Rounds a length to the grid. @param what name for messages, such as "device.gap"
/// @throws InputError (without a place) for a length that is not finite, not positive (or negative, if zero is
/// allowed), or beyond `greatest_length`
double length_on_grid(double value, const std::string& what, bool may_be_zero);

} // namespace graze
