#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// A wafer with devices on a circle, their channels pointing outwards. Lengths in micrometres.
struct WaferPlan {
    double diameter = 100'000;
    double flat_length = 32'500; ///< of the flat, below; 0: none
    double exclusion = 5'000;    ///< of the ring at the edge into which no die reaches
    double radius = 30'000;      ///< of the circle on which the dies' centres lie
    double mark_radius = 42'000; ///< of the circle on which two alignment marks lie, to the left and right
    double mark_size = 1'000;    ///< of these; 0: none
    double label_height = 1'500; ///< of the letters on the wafer; 0: none
    std::size_t devices = 8;
    std::string label; ///< empty: the design's name

    /// Dimensions of [device] that differ from device to device: name and values (of `folds`, too), which are gone
    /// through from the start again where there are more devices.
    std::vector<std::pair<std::string, std::vector<double>>> vary;
};

constexpr std::size_t most_devices_of_wafer = 10'000;

} // namespace graze
