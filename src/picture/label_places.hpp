#pragma once

#include "picture/box.hpp"
#include "picture/panel_axis.hpp"

#include <string>
#include <vector>

namespace graze {

/// A label with its place on the page.
struct PlacedLabel {
    std::string text;
    std::size_t colour = 0;
    PlanePoint point{}; ///< the labelled point on the page
    Box box;
    bool led = false; ///< the label is away from its point, and a thin leader line joins them
    PlanePoint leader_start{}, leader_end{};
};

/// Result of place_labels.
struct LabelPlaces {
    std::vector<PlacedLabel> labels;
    std::vector<Box> marks;         ///< boxes of the symbols of points
    std::size_t omitted = 0;        ///< number of labels that did not fit
    std::vector<std::string> notes; ///< lists under the panel: names of numbered labels, and omitted labels
};

/// Diameter of a point's symbol for a font size, both in points.
double mark_size(double font);
/// Font size of labels for the font size of the axes.
double label_font(double font);

/// Places a panel's labels within the frame, without overlaps with other labels, leaders and symbols, and if possible
/// not on curves. Each label is nearer to its own symbol than to any other, and no leader crosses another symbol: a
/// label that could be read as that of another point is not drawn. Points whose symbols coincide have one label, in
/// black if their colours differ; more than three texts are replaced by a number and listed under the panel. Labels are
/// placed in the order of rank, then of the list; labels that do not fit are listed too.
/// @param frame of the panel on the page, in points
LabelPlaces place_labels(const FigurePanel& panel, const Box& frame, const PanelAxis& x, const PanelAxis& y,
                         double font);

} // namespace graze
