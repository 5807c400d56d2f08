#pragma once

#include "graze/layout/device_file.hpp"
#include "graze/layout/layout.hpp"

#include <string>
#include <vector>

namespace graze {

enum class ProcessMaterial { silicon, resist, epoxy, aluminium };

/// A rectangle of a cross-section, in micrometres: x as in the drawing, z is 0 at the back of the device wafer.
struct ProcessSlab {
    ProcessMaterial material;
    double left = 0, right = 0, low = 0, high = 0;
};

/// The cross-section of the wafers after a step.
struct ProcessStep {
    std::string text;
    std::vector<ProcessSlab> slabs;
};

/// Returns cross-sections of one device after each of the eleven fabrication steps: B. E. Wilcox, "On the use of
/// impact-induced nonlinearities in limit switch design", section 6.3 and Fig. 6.5. Silicon and chambers are to scale;
/// films of resist, epoxy and metal would be invisible and are drawn thicker. Alignment marks are shown at their x,
/// though they lie at another y.
/// @param layout of one device @param y plane of the section, in micrometres
std::vector<ProcessStep> process_steps(const DeviceFile& file, const Layout& layout, double y);

/// Returns the y, in micrometres, of a plane through the middle of a stop, which also cuts the fixed electrode and the
/// mass.
double plane_through_stop(const Layout& layout);

} // namespace graze
