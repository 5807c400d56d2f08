#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// A wafer with devices on a circle, with channels pointing outwards. Lengths in micrometres.
struct WaferPlan {
    double diameter = 100'000;
    double flat_length = 32'500; ///< length of the flat, at the bottom; 0: none
    double exclusion = 5'000;    ///< width of the ring at the edge that dies must not enter
    double radius = 30'000;      ///< radius of the circle of the dies' centres
    double mark_radius = 42'000; ///< radius at which two alignment marks lie, to the left and right
    double mark_size = 1'000;    ///< size of these marks; 0: none
    double label_height = 1'500; ///< height of the letters on the wafer; 0: none
    std::size_t devices = 8;
    std::string label; ///< empty: the design's name

    /// Dimensions of [device] that vary from device to device: name and values (also of `folds`), which are repeated
    /// cyclically.
    std::vector<std::pair<std::string, std::vector<double>>> vary;
};

constexpr std::size_t most_devices_of_wafer = 10'000;

} // namespace graze
