#pragma once

#include "graze/layout/device_drawing.hpp"

#include <string>
#include <vector>

namespace graze {

/// What is written beside a drawing, and where its line leads.
struct PartLabel {
    std::string text;
    GridPoint at; ///< of the die, on the part
    bool to_left;
};

/// Names of a device's parts. Each place is taken from the part's own outline.
std::vector<PartLabel> part_labels(const DeviceDrawing& drawing);

/// The greatest of 1, 2 and 5 times a power of ten that is no longer than a length: for a scale bar.
double round_length(double longest);

} // namespace graze
