#include "picture/layout_labels.hpp"

#include "layout/grid_lengths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// The outermost vertical side of an outline, to the right or to the left, as a box of width 0.
GridBox outermost_side(const GridPolygon& outline, bool to_right) {
    const GridBox all = bounding_box(outline);
    const std::int64_t x = to_right ? all.right : all.left;
    GridBox side{x, all.top, x, all.bottom};
    for (const GridPoint& corner : outline)
        if (corner.x == x) {
            side.bottom = std::min(side.bottom, corner.y);
            side.top = std::max(side.top, corner.y);
        }
    return side;
}

std::int64_t share_between(std::int64_t low, std::int64_t high, double part) {
    return low + std::llround(part * static_cast<double>(high - low));
}

/// A point in a box, given by fractions of its sides from the lower left corner.
GridPoint within(const GridBox& box, double along_x, double along_y) {
    return {share_between(box.left, box.right, along_x), share_between(box.bottom, box.top, along_y)};
}

std::vector<PartLabel> labels_of_electrode(const DeviceDrawing& drawing) {
    const DeviceDimensions& d = drawing.dimensions;
    const GridBox mass = bounding_box(drawing.mass), &chamber = drawing.chamber_box;
    // The face towards the mass, the outer end of the pad, and the outer end of the base below it.
    const GridBox face = outermost_side(drawing.electrode, true), pad = outermost_side(drawing.electrode, false);
    const GridBox base = outermost_side(drawing.base, false);
    const GridBox gap{face.right, face.bottom, mass.left, face.top};
    const GridBox plate{face.left - nanometres(d.electrode_width), face.bottom, face.left, face.top};
    const std::int64_t pad_end = pad.left + nanometres(d.pad_length), moat = nanometres(d.moat);
    return {{"chamber on the back", {mass.left, chamber.top}, true},
            {fmt::format("gap d = {:.6g} µm", d.gap), within(gap, 0.5, 0.95), true},
            {"fixed electrode", within(plate, 0.5, 0.78), true},
            {"its bonded base", within(base, 0, 0.7), true},
            {"contact pad", within({pad.left, pad.bottom, pad_end, pad.top}, 0.3, 0.4), true},
            {fmt::format("moat, {:.6g} µm", d.moat),
             within({pad.left, pad.bottom - moat, pad_end, pad.bottom}, 0.3, 0.5), true}};
}

} // namespace

std::vector<PartLabel> part_labels(const DeviceDrawing& drawing) {
    const DeviceDimensions& d = drawing.dimensions;
    const FlexureDrawing& flexure = drawing.flexure;
    const GridBox mass = bounding_box(drawing.mass), stop = bounding_box(drawing.stops.front());
    const std::size_t first = flexure.beams.size() / 2; // the first beam to the right of the centre
    const GridBox beam = drawing.in_device(flexure.beams[first], false),
                  next = drawing.in_device(flexure.beams[first + 1], false),
                  finger = drawing.in_device(flexure.finger, false),
                  lug = drawing.in_device(flexure.lugs.back(), false),
                  truss = drawing.in_device(flexure.trusses.front(), true);
    const GridBox bar{mass.right - nanometres(d.bar_width), mass.bottom, mass.right, mass.top};
    // The label of the frame lies above the chamber, or beyond the trench if the chamber ends there.
    const std::int64_t trench = mass.right + nanometres(d.clearance),
                       beyond = nanometres(d.chamber_margin > 0 ? d.chamber_margin : d.clearance);
    std::vector<PartLabel> labels = labels_of_electrode(drawing);
    labels.insert(
        labels.end(),
        {{"finger (anchor)",
          within({finger.left, finger.top, finger.right, finger.top + nanometres(d.clearance)}, 0.75, 0.5), false},
         {"lug", within(lug, 0.5, 0.5), false},
         {fmt::format("folded flexure, {} beams", flexure.beams.size()), within(beam, 0.5, 0.8), false},
         {fmt::format("beam, {:.6g} by {:.6g} µm", d.flexure_width, d.flexure_length), within(next, 0.5, 0.5), false},
         {"mass (H)", within(bar, 0.5, 0.67), false},
         {fmt::format("stop, gap {:.6g} µm", d.stop_gap), within(stop, 0.5, 0.75), false},
         {fmt::format("channel, {:.6g} µm", d.channel_width), {drawing.chamber_box.right, 0}, false},
         {"truss", within(truss, 0.9, 0.5), false},
         {"frame", {trench + beyond / 2, share_between(mass.bottom, mass.top, 0.2)}, false}});
    return labels;
}

double round_length(double longest) {
    const double power = std::pow(10.0, std::floor(std::log10(longest)));
    for (const double factor : {5.0, 2.0})
        if (factor * power <= longest)
            return factor * power;
    return power;
}

} // namespace graze
