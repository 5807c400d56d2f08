#include "graze/layout/lumped_table.hpp"

#include "graze/layout/lumped_model.hpp"

namespace graze {

void add_lumped_rows(Table& table, const DeviceFile& file, const DrawnDevice& device) {
    const LumpedModel lumped = lumped_model_of(device.drawing, file);
    const auto add = [&](const char* what, double value, const char* unit) {
        table.add(device.cell, what, value, unit);
    };
    constexpr double micro = 1e-6, nano = 1e-9, mega = 1e6;
    add("model: mass", lumped.mass / nano, "ug");
    add("model: stiffness", lumped.stiffness, "N/m");
    add("model: stiffness, were the mass rigid", lumped.rigid_mass, "N/m");
    add("model: stiffness, were all but beams rigid", lumped.stiff_trusses, "N/m");
    add("model: natural frequency", lumped.frequency(), "Hz");
    add("model: damping ratio", lumped.damping_ratio(), "");
    add("model: damping by the electrodes' gas", lumped.electrode_film / micro, "uN s/m");
    add("model: damping by the stops' gas", lumped.stop_films / micro, "uN s/m");
    add("model: damping by the chamber's gas", lumped.chamber_film / micro, "uN s/m");
    add("model: squeeze number", lumped.squeeze, "");
    add("model: area with fringe", lumped.area / (micro * micro), "um^2");
    add("model: gap of the electrodes", lumped.gap / micro, "um");
    add("model: way to the stops", lumped.stop / micro, "um");
    add("model: snap-through at rest", lumped.pull_in(), "V");
    add("model: stress at the stops", lumped.stress_per_travel * lumped.stop / mega, "MPa");
    add("model: stress at closed electrodes", lumped.stress_per_travel * lumped.closure / mega, "MPa");
}

} // namespace graze
