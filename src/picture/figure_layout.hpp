#pragma once

#include "picture/label_places.hpp"
#include "picture/legend.hpp"
#include "picture/panel_axis.hpp"

#include <vector>

namespace graze {

/// A line of text on the page.
struct PlacedText {
    enum class Align { left, centre, right };
    RichText text;
    PlanePoint at{}; ///< centre of its height; horizontally its left end, centre or right end (see align)
    double size = 0; ///< font size in points
    Align align = Align::centre;
    bool upright = false; ///< rotated by 90 degrees, read upwards
    Box box{};
};

struct PanelLayout {
    Box frame; ///< between the axes
    PanelAxis x, y;
    std::vector<PlacedText> texts; ///< title, axis labels, tic labels and notes
    std::vector<LegendEntry> legend;
    LabelPlaces labels;
};

/// Positions of everything on the page. Lengths are in points (1/72 inch) from the lower left corner.
struct FigureLayout {
    double width = 0, height = 0, font = 0;
    std::vector<PlacedText> title;
    std::vector<LegendEntry> legend; ///< common legend of all panels; empty if they have their own
    std::vector<PanelLayout> panels;
};

/// Computes the layout of a figure. Texts and symbols outside the frames do not overlap anything else.
FigureLayout layout_of(const Figure& figure);

} // namespace graze
