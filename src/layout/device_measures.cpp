#include "graze/layout/device_measures.hpp"

#include "graze/base/input_error.hpp"
#include "layout/grid_lengths.hpp"

#include <algorithm>

namespace graze {

namespace {

Facing require_facing(const GridPolygon& left, const GridPolygon& right) {
    const auto found = facing(left, right);
    if (!found)
        throw InternalError("two parts of a device do not face each other");
    return *found;
}

double total_area_of(const std::vector<GridBox>& boxes) {
    double sum = 0;
    for (const GridBox& one : boxes)
        sum += micrometres(one.width()) * micrometres(one.height());
    return sum;
}

} // namespace

DeviceMeasures measures_of(const DeviceDrawing& drawing) {
    DeviceMeasures result;
    const Facing capacitor = require_facing(drawing.electrode, drawing.mass);
    result.gap = micrometres(capacitor.distance);
    result.facing_length = micrometres(capacitor.length);
    std::int64_t nearest = 0, length = 0;
    for (const GridPolygon& stop : drawing.stops) {
        const Facing one = require_facing(drawing.mass, stop);
        nearest = length == 0 ? one.distance : std::min(nearest, one.distance);
        length += one.length;
    }
    result.stop_gap = micrometres(nearest);
    result.stop_length = micrometres(length);
    result.mass_area = area_of(drawing.mass);
    const std::vector<GridBox> beams = drawing.beams();
    result.truss_area = total_area_of(drawing.trusses());
    result.beam_area = total_area_of(beams);
    result.beams = beams.size();
    result.beam_width = micrometres(beams[0].width());
    result.beam_length = micrometres(beams[0].height());
    result.beam_spacing = micrometres(beams[1].left - beams[0].right);
    result.electrode_area = area_of(drawing.electrode);
    result.base_area = area_of(drawing.base);
    result.etched_area = total_area(drawing.etched) + 2 * total_area(drawing.flexure.etched);
    result.chamber_area = total_area(drawing.chambers);
    return result;
}

} // namespace graze
