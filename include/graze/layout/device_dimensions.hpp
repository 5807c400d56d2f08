#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace graze {

/// What is drawn of one device: a plate of the shape of an H, which hangs on two folded flexures in its notches between
/// a fixed electrode to its left and two stops to its right, with a channel for a laser beam between them. All lengths
/// in micrometres, as they are drawn; x is the direction of motion. docs/layout.md shows where each is measured. The
/// drawing is symmetric about y = 0, where the centre of the H is.
struct DeviceDimensions {
    // The capacitor.
    double electrode_length = 2000; ///< along y, of the fixed electrode's face
    double electrode_width = 300;   ///< along x, from its face to the pad
    double gap = 15;                ///< between the fixed electrode and the mass
    double pad_length = 1000;       ///< along x, of the fixed electrode's contact pad
    double pad_width = 1000;        ///< along y
    double moat = 60;               ///< between the fixed electrode and the frame
    double base_inset = 40;         ///< from the fixed electrode's outline to that of its bonded base

    // The mass.
    double bar_width = 100;    ///< along x, of each of the two upright bars of the H
    double bridge_width = 200; ///< along y, of the bar that joins them
    double clearance = 40;     ///< between the mass, or a truss of a flexure, and what it moves along

    // The flexures, one in each notch of the H: a row of beams along y to each side of the notch's middle, joined one
    // after the other by trusses at alternate ends: from the frame to the first and from the last to the bar.
    double flexure_width = 6;     ///< along x, of a beam
    double flexure_length = 1150; ///< along y, of a beam between trusses
    double flexure_spacing = 30;  ///< along x, between two neighbouring beams, and from the last to the bar
    double flexure_middle = 60;   ///< along x, between the first beams to both sides of the middle
    double truss_width = 40;      ///< along y, of what joins two beams
    std::size_t folds = 1;        ///< each of two beams to either side; in one flexure 4 folds beams

    // The stops.
    double stop_gap = 9;        ///< between a stop and the mass
    double stop_width = 150;    ///< along y
    double channel_width = 200; ///< along y, between the stops, and on to the edge of the die

    // Around them.
    double chamber_margin = 50; ///< by which the chamber on the back reaches beyond all that is etched from the front
    double die_length = 6000;   ///< along x
    double die_width = 6000;    ///< along y
    double frame_width = 500;   ///< at least, from the chamber to the die's edge
    double mark_size = 300;     ///< of an alignment mark; 0: none
    double label_height = 140;  ///< of the letters on the die; 0: none

    /// From the centre of the H to its upper end.
    double mass_half_length() const { return bridge_width / 2 + clearance + 2 * truss_width + flexure_length; }
    /// From the middle of a notch to a bar.
    double notch_half_width() const {
        return flexure_middle / 2 + 2 * static_cast<double>(folds) * (flexure_width + flexure_spacing);
    }
    friend bool operator==(const DeviceDimensions&, const DeviceDimensions&) = default;
};

/// What else a device is made by. The lengths are in micrometres.
struct ProcessData {
    double wafer_thickness = 300; ///< of the wafer with the devices
    double chamber_depth = 50;    ///< etched into its back

    /// Of all that moves, of the electrodes and of the beams.
    double layer_thickness() const { return wafer_thickness - chamber_depth; }
};

/// A length that a design file may give.
template <class Section>
struct LengthField {
    const char* name;
    double Section::*member;
    const char* text; ///< for people
    bool may_be_zero = false;
};

/// In the order of docs/layout.md. `folds`, a whole number, is none of them.
std::span<const LengthField<DeviceDimensions>> device_fields();
std::span<const LengthField<ProcessData>> process_fields();

constexpr double grid_per_micrometre = 1000; ///< all coordinates are multiples of a nanometre
constexpr double greatest_length = 1e6;      ///< micrometres: beyond a metre nothing is drawn
constexpr std::size_t most_folds = 100;

/// Rounds to the grid. @param what for the message, as in "device.gap"
/// @throws InputError (without a place) for what is not finite, not positive (or below zero) or beyond
/// `greatest_length`
double length_on_grid(double value, const std::string& what, bool may_be_zero);

} // namespace graze
