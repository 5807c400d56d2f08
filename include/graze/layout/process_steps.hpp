#pragma once

#include "graze/layout/device_file.hpp"
#include "graze/layout/layout.hpp"

#include <string>
#include <vector>

namespace graze {

enum class ProcessMaterial { silicon, resist, epoxy, aluminium };

/// A rectangle of a cross-section, in micrometres: x is that of the drawing, z is 0 at the back of the device's wafer.
struct ProcessSlab {
    ProcessMaterial material;
    double left = 0, right = 0, low = 0, high = 0;
};

/// What the wafers look like after a step.
struct ProcessStep {
    std::string text;
    std::vector<ProcessSlab> slabs;
};

/// Cross-sections of one device after each of the eleven steps in which it is made: B. E. Wilcox, "On the use of
/// impact-induced nonlinearities in limit switch design", section 6.3 and Fig. 6.5. Silicon and chambers are as thick
/// as the design says; films of resist, epoxy and metal are all too thin to be seen, and thicker here. Alignment marks,
/// which lie elsewhere along y, are where they are along x.
/// @param layout of one device @param y of the plane of the section, in micrometres
std::vector<ProcessStep> process_steps(const DeviceFile& file, const Layout& layout, double y);

/// A plane through the middle of a stop, which cuts the fixed electrode and the mass as well: y in micrometres.
double plane_through_stop(const Layout& layout);

} // namespace graze
