#pragma once

#include "program/box.hpp"
#include "program/panel_axis.hpp"

#include <string>
#include <vector>

namespace graze {

/// A label with its place on the page.
struct PlacedLabel {
    std::string text;
    std::size_t colour = 0;
    PlanePoint point{}; ///< on the page, to which it belongs
    Box box;
    bool led = false; ///< it stands off its point, and a thin line leads from there to it
    PlanePoint leader_start{}, leader_end{};
};

struct LabelPlaces {
    std::vector<PlacedLabel> labels;
    std::vector<Box> marks;  ///< of the points that have symbols
    std::size_t omitted = 0; ///< labels of points in the panel that found no room
};

/// Diameter of a point's symbol, for a size of the font.
double mark_size(double font);
/// Size of the font of labels, for that of the axes.
double label_font(double font);

/// Finds room for a panel's labels: within the frame, clear of one another, of one another's leaders and of all
/// symbols, and of curves as far as there is room. Labels of points that coincide become one. Lower ranks come first,
/// then those that stand first in the list; where there are too many the last ones are left out.
/// @param frame of the panel on the page
LabelPlaces place_labels(const FigurePanel& panel, const Box& frame, const PanelAxis& x, const PanelAxis& y,
                         double font);

} // namespace graze
