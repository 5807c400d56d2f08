#pragma once

#include "graze/picture/figure.hpp"
#include "picture/rich_text.hpp"

#include <vector>

namespace graze {

/// One axis of a panel: its range, and its tics.
struct PanelAxis {
    struct Tic {
        double value = 0;
        RichText text;
    };
    double low = 0, high = 1;
    bool logarithmic = false;
    int power = 0; ///< tic labels are in units of 10^power
    std::vector<Tic> tics;
    std::vector<double> minor; ///< tics without labels

    /// Position of a value: 0 at the beginning of the axis, 1 at its end; NaN for values <= 0 on logarithmic axes.
    double share(double value) const;
    /// The value at a position.
    double value_at(double share) const;
};

/// True when both coordinates are finite and, on logarithmic axes, positive.
bool is_drawn(const PlanePoint& point, const FigurePanel& panel);

/// The axis with the range of the panel or of its data, and as many tics as fit without overlap.
/// @param length of the axis and @param font size of its labels, both in points
/// @throws InputError for ranges that are too large, too small or too narrow to be drawn
PanelAxis panel_axis(const FigurePanel& panel, bool horizontal, double length, double font);

} // namespace graze
