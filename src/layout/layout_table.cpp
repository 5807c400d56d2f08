#include "graze/layout/layout_table.hpp"

#include "graze/layout/device_measures.hpp"
#include "graze/layout/lumped_table.hpp"

#include <fmt/format.h>

#include <cstddef>

namespace graze {

namespace {

void add_measures(Table& table, const DrawnDevice& device, const DeviceFile& file) {
    const DeviceMeasures measures = measures_of(device.drawing);
    const auto length = [&](const char* what, double value) { table.add(device.cell, what, value, "um"); };
    const auto area = [&](const char* what, double value) { table.add(device.cell, what, value, "um^2"); };
    length("gap", measures.gap);
    length("facing length", measures.facing_length);
    length("stop gap", measures.stop_gap);
    length("stop length", measures.stop_length);
    table.add(device.cell, "beams", static_cast<double>(measures.beams), "");
    length("beam width", measures.beam_width);
    length("beam length", measures.beam_length);
    length("beam spacing", measures.beam_spacing);
    length("thickness", file.process.layer_thickness());
    area("mass", measures.mass_area);
    area("trusses", measures.truss_area);
    area("beams", measures.beam_area);
    area("fixed electrode", measures.electrode_area);
    area("its base", measures.base_area);
    area("chambers", measures.chamber_area);
    area("etched through", measures.etched_area);
    add_lumped_rows(table, file, device);
}

} // namespace

Table layout_table(const Layout& layout, const DeviceFile& file) {
    Table table({{"cell", ""}, {"what", ""}, {"value", ""}, {"unit", ""}});
    for (const DrawnDevice& device : layout.devices)
        add_measures(table, device, file);
    for (std::size_t i = 0; i < layout.sites.size(); ++i)
        table.add(layout.devices[layout.sites[i]].cell, fmt::format("direction of device {}", i + 1),
                  layout.site_degrees[i], "degrees");
    for (const auto& [layer, area] : areas_of(layout.library, layout.top))
        table.add(layout.top, fmt::format("layer {}/{}: {}", layer.layer, layer.datatype, layer_text(layer)), area,
                  "um^2");
    return table;
}

} // namespace graze
