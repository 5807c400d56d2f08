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
    PlanePoint at{}; ///< middle of its height, and of its width or one of its ends
    double size = 0; ///< of its font
    Align align = Align::centre;
    bool upright = false; ///< written upwards
    Box box{};
};

struct PanelLayout {
    Box frame; ///< between the axes
    PanelAxis x, y;
    std::vector<PlacedText> texts; ///< title, labels of the axes, numbers at their tics
    std::vector<LegendEntry> legend;
    LabelPlaces labels;
};

/// Where everything stands on the page. Lengths are points (1/72 inch), from the lower left corner.
struct FigureLayout {
    double width = 0, height = 0, font = 0;
    std::vector<PlacedText> title;
    std::vector<LegendEntry> legend; ///< that all panels share
    std::vector<PanelLayout> panels;
};

/// Gives everything its place: nothing that is written or drawn outside of the frames meets anything else.
FigureLayout layout_of(const Figure& figure);

} // namespace graze
