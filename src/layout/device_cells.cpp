#include "layout/device_cells.hpp"

#include "graze/layout/alignment_mark.hpp"
#include "graze/layout/mask_letters.hpp"
#include "layout/device_rules.hpp"
#include "layout/grid_lengths.hpp"

#include <fmt/format.h>

namespace graze {

namespace {

LayoutCell flexure_cell(const DeviceDrawing& drawing, const std::string& name) {
    LayoutCell cell{.name = name};
    cell.add_all(mask_layers::front, drawing.flexure.etched);
    cell.add_all(mask_layers::beams, drawing.flexure.beams);
    cell.add_all(mask_layers::trusses, drawing.flexure.trusses);
    return cell;
}

/// Adds the dimensions as texts, each at its place.
void add_notes(LayoutCell& cell, const DeviceDrawing& drawing) {
    const DeviceDimensions& d = drawing.dimensions;
    const GridBox mass = bounding_box(drawing.mass), electrode = bounding_box(drawing.electrode);
    const GridBox beam = drawing.beams().front(), stop = bounding_box(drawing.stops.front());
    const auto note = [&](GridPoint at, const char* what, double value) {
        constexpr double small = 0.1; // relative to the mass's width: readable in a view of the whole device
        cell.texts.push_back({mask_layers::notes, at, fmt::format("{} = {:.10g} um", what, value),
                              small * static_cast<double>(mass.width()) / grid_per_micrometre});
    };
    note({mass.left, 0}, "gap", d.gap);
    note({mass.left, electrode.top}, "electrode_length", d.electrode_length);
    note({stop.left, stop.top}, "stop_gap", d.stop_gap);
    note({stop.right, 0}, "channel_width", d.channel_width);
    note({beam.left, beam.top}, "flexure_width", d.flexure_width);
    note({beam.left, beam.bottom}, "flexure_length", d.flexure_length);
    note({electrode.left, electrode.bottom}, "moat", d.moat);
    note({drawing.chamber_box.left, drawing.chamber_box.top}, "chamber_margin", d.chamber_margin);
}

} // namespace

void add_letters(LayoutCell& cell, MaskLayer layer, const std::string& text, GridPoint at, std::int64_t height,
                 bool mirrored) {
    const std::int64_t width = letters_width(text, height);
    for (const GridBox& box : letter_boxes(text, height))
        cell.shapes.push_back(
            {layer,
             polygon_of(
                 (mirrored ? GridBox{width - box.right, box.bottom, width - box.left, box.top} : box).moved(at))});
}

void add_device_cells(LayoutLibrary& library, const DeviceDrawing& drawing, const std::string& ending) {
    const DeviceDimensions& d = drawing.dimensions;
    const std::string flexure = "FLEXURE" + ending, mark = "MARK" + ending;
    library.cells.push_back(flexure_cell(drawing, flexure));
    if (d.mark_size > 0)
        library.cells.push_back(alignment_mark(mark, nanometres(d.mark_size)));
    LayoutCell cell{.name = "DEVICE" + ending};
    cell.add_all(mask_layers::back, drawing.chambers);
    cell.add_all(mask_layers::front, drawing.etched);
    cell.add(mask_layers::mass, drawing.mass);
    cell.add(mask_layers::electrode, drawing.electrode);
    cell.add(mask_layers::base, drawing.base);
    cell.add_all(mask_layers::stops, drawing.stops);
    cell.add(mask_layers::die, drawing.die);
    cell.references.push_back({flexure, drawing.upper, false, 0});
    cell.references.push_back({flexure, drawing.lower, true, 0});
    const std::int64_t edge = edge_distance(d), letters = nanometres(d.label_height), size = nanometres(d.mark_size);
    const std::string label = label_of(d);
    if (letters > 0)
        add_letters(cell, mask_layers::front_letters, label,
                    {drawing.die.left + edge, drawing.die.top - edge - letters}, letters);
    cell.texts.push_back(
        {mask_layers::notes, {drawing.die.left + edge, drawing.die.top - edge}, label, d.label_height});
    add_notes(cell, drawing);
    if (size > 0) {
        // The mark's origin is its middle; for an odd size the right half is a nanometre longer.
        const std::int64_t x = drawing.die.right - edge - (size - size / 2);
        cell.references.push_back({mark, {x, drawing.die.top - edge - (size - size / 2)}, false, 0});
        cell.references.push_back({mark, {x, drawing.die.bottom + edge + size / 2}, false, 0});
    }
    library.cells.push_back(std::move(cell));
}

} // namespace graze
