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
    PlanePoint point{}; ///< on the page, to which it belongs
    Box box;
    bool led = false; ///< it stands off its point, and a thin line leads from there to it
    PlanePoint leader_start{}, leader_end{};
};

struct LabelPlaces {
    std::vector<PlacedLabel> labels;
    std::vector<Box> marks;         ///< of the points that have symbols
    std::size_t omitted = 0;        ///< places of labels in the panel that found no room
    std::vector<std::string> notes; ///< names that stand under the panel: those that a key stands for, and the omitted
};

/// Diameter of a point's symbol, for a size of the font.
double mark_size(double font);
/// Size of the font of labels, for that of the axes.
double label_font(double font);

/// Finds room for a panel's labels: within the frame, clear of one another, of one another's leaders and of all
/// symbols, and of curves as far as there is room. Each stands nearer to its own symbol than to any other, and no
/// leader meets another symbol: a label that can be read as that of another point is not drawn. Labels of points whose
/// symbols lie on one another become one, in black if they have several colours; a number stands for more than three,
/// which are listed. Lower ranks come first, then those that stand first in the list; what finds no room is listed too.
/// @param frame of the panel on the page
LabelPlaces place_labels(const FigurePanel& panel, const Box& frame, const PanelAxis& x, const PanelAxis& y,
                         double font);

} // namespace graze
