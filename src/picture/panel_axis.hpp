#pragma once

#include "graze/picture/figure.hpp"
#include "picture/rich_text.hpp"

#include <vector>

namespace graze {

/// One axis of a panel: from where to where it goes, and what stands beside it.
struct PanelAxis {
    struct Tic {
        double value = 0;
        RichText text;
    };
    double low = 0, high = 1;
    bool logarithmic = false;
    int power = 0; ///< numbers beside the axis are in units of this power of ten
    std::vector<Tic> tics;
    std::vector<double> minor; ///< tics without numbers

    /// Where a value lies: 0 at the beginning of the axis, 1 at its end; NaN for what has no place.
    double share(double value) const;
    /// The value at a share.
    double value_at(double share) const;
};

/// Whether both numbers have a place on the panel's axes, which may be logarithmic.
bool is_drawn(const PlanePoint& point, const FigurePanel& panel);

/// The axis as asked for, or such that all is seen, with as many tics as go beside one another.
/// @param length of the axis and @param font size of its numbers, both in points
/// @throws InputError for numbers that are too large, too small or too near one another to be drawn
PanelAxis panel_axis(const FigurePanel& panel, bool horizontal, double length, double font);

} // namespace graze
