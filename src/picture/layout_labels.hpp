#pragma once

#include "graze/layout/device_drawing.hpp"

#include <string>
#include <vector>

namespace graze {

/// A text beside a drawing, with a leader line to a part.
struct PartLabel {
    std::string text;
    GridPoint at; ///< end of the leader on the part, in the coordinates of the die
    bool to_left; ///< the text stands to the left of the drawing
};

/// Labels of a device's parts. Each position is computed from the part's own outline.
std::vector<PartLabel> part_labels(const DeviceDrawing& drawing);

/// The greatest length 1, 2 or 5 times a power of ten that is not above `longest`, for a scale bar.
double round_length(double longest);

} // namespace graze
