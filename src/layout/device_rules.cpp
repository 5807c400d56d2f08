#include "layout/device_rules.hpp"

#include "graze/layout/alignment_mark.hpp"
#include "graze/layout/mask_letters.hpp"
#include "layout/grid_lengths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

namespace graze {

namespace {

/// Throws unless a rule holds. @param key the dimension to change
void require_rule(const DeviceFile& file, bool holds, const char* key, const std::string& problem,
                  const std::string& remedy) {
    if (!holds)
        throw InputError(file.place(std::string("device.") + key), problem, remedy);
}

std::string text_at(GridPoint point) {
    return fmt::format("({:.3f}, {:.3f}) um", micrometres(point.x), micrometres(point.y));
}

/// Name of the largest of several lengths, which is most likely the one to change.
const char* name_of_greatest(std::initializer_list<std::pair<const char*, double>> parts) {
    return std::max_element(parts.begin(), parts.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
}

struct Part {
    std::string name;
    GridBox box;
};

/// Checks that unconnected parts do not touch.
void require_apart(const std::vector<Part>& some, const std::vector<Part>& others, const DeviceFile& file) {
    for (const Part& one : some)
        for (const Part& other : others)
            if (one.box.meets(other.box))
                throw InputError(file.place("device"), fmt::format("{} touches {}", one.name, other.name),
                                 "give dimensions that keep them apart");
}

/// Whether a length is at most another one: both are multiples of half a nanometre, up to round-off.
bool fits(double length, double room) {
    constexpr double quarter = 0.25;
    return length <= room + quarter / grid_per_micrometre;
}

std::string text_of(double length) {
    return fmt::format("{:.10g} um", length);
}

/// Half the extent along y of electrode and pad, with moat and chamber.
double half_across_electrode(const DeviceDimensions& d) {
    return std::max(d.electrode_length, d.pad_width) / 2 + d.moat + d.chamber_margin;
}

void require_lengths(const DeviceFile& file, const DeviceDimensions& d) {
    for (const LengthField<DeviceDimensions>& field : device_fields())
        try {
            length_on_grid(d.*field.member, std::string("device.") + field.name, field.may_be_zero);
        } catch (const InputError& error) {
            require_rule(file, false, field.name, error.problem(), error.remedy());
        }
    require_rule(file, d.folds >= 1 && d.folds <= most_folds, "folds", fmt::format("device.folds is {}", d.folds),
                 fmt::format("give a whole number from 1 to {}", most_folds));
}

/// Extent along y from the middle to the end of the chamber.
double beyond_chamber(const DeviceDimensions& d) {
    return std::max(d.mass_half_length() + d.clearance + d.chamber_margin, half_across_electrode(d));
}

/// Width of a die that holds device, electrode, frame, marks and letters.
double sufficient_width(const DeviceDimensions& d) {
    const double edges = d.frame_width / 2;
    return 2 * (beyond_chamber(d) + std::max(d.frame_width, edges + std::max(d.mark_size, d.label_height)));
}

/// Checks extents along y.
void require_width(const DeviceFile& file, const DeviceDimensions& d) {
    const double half = d.mass_half_length();
    const double across = 2 * (half + d.clearance + d.chamber_margin + d.frame_width);
    const char* longest = name_of_greatest({{"flexure_length", 2 * d.flexure_length},
                                            {"truss_width", 4 * d.truss_width},
                                            {"bridge_width", d.bridge_width},
                                            {"clearance", 4 * d.clearance},
                                            {"chamber_margin", 2 * d.chamber_margin},
                                            {"frame_width", 2 * d.frame_width}});
    require_rule(
        file, fits(across, d.die_width), longest,
        fmt::format("flexures of {} make a mass {} long, which with clearance, chamber and frame takes {} of "
                    "a die {} wide",
                    text_of(d.flexure_length), text_of(2 * half), text_of(across), text_of(d.die_width)),
        fmt::format("give a smaller {}, or a die_width of at least {}", longest, text_of(sufficient_width(d))));
    const double electrode = 2 * (half_across_electrode(d) + d.frame_width);
    require_rule(
        file, fits(electrode, d.die_width), d.pad_width > d.electrode_length ? "pad_width" : "electrode_length",
        fmt::format("the fixed electrode with moat and frame takes {} of a die {} wide", text_of(electrode),
                    text_of(d.die_width)),
        fmt::format("give a smaller electrode and pad, or a die_width of at least {}", text_of(sufficient_width(d))));
}

/// Length of the label, in micrometres.
double written_length(const DeviceDimensions& d) {
    return micrometres(letters_width(label_of(d), nanometres(d.label_height)));
}

/// Length of a die that holds its label, a mark and three edges.
double length_of_letters(const DeviceDimensions& d) {
    return nanometres(d.label_height) < letter_rows ? 0 : written_length(d) + 0.75 * d.frame_width + d.mark_size;
}

/// Checks extents along x.
void require_length(const DeviceFile& file, const DeviceDimensions& d) {
    const double left = std::max(d.clearance, d.moat + d.pad_length + d.electrode_width + d.gap);
    const double length =
        left + 2 * d.bar_width + 2 * d.notch_half_width() + d.clearance + 2 * (d.chamber_margin + d.frame_width);
    const auto beams = 4 * static_cast<double>(d.folds);
    const char* longest = name_of_greatest({{"pad_length", d.pad_length},
                                            {"electrode_width", d.electrode_width},
                                            {"gap", d.gap},
                                            {"moat", d.moat},
                                            {"bar_width", 2 * d.bar_width},
                                            {"flexure_spacing", beams * d.flexure_spacing},
                                            {"flexure_width", beams * d.flexure_width},
                                            {"flexure_middle", d.flexure_middle},
                                            {"clearance", 2 * d.clearance},
                                            {"chamber_margin", 2 * d.chamber_margin},
                                            {"frame_width", 2 * d.frame_width}});
    const double sufficient = std::max(length, length_of_letters(d));
    require_rule(
        file, fits(length, d.die_length), longest,
        fmt::format("device and frame, {} long, do not fit on a die {} long", text_of(length), text_of(d.die_length)),
        fmt::format("give a smaller {}, or a die_length of at least {}", longest, text_of(sufficient)));
}

/// Checks the parts that face the mass, or lie below the electrode.
void require_parts(const DeviceFile& file, const DeviceDimensions& d) {
    const double length = 2 * d.mass_half_length();
    require_rule(file, fits(d.electrode_length, length), "electrode_length",
                 fmt::format("the fixed electrode, {} long, is longer than the mass of {}", text_of(d.electrode_length),
                             text_of(length)),
                 "give a shorter electrode, or longer flexures");
    require_rule(file, d.stop_gap < d.clearance, "stop_gap",
                 fmt::format("the stops do not reach out of the frame: stop_gap is {}, clearance {}",
                             text_of(d.stop_gap), text_of(d.clearance)),
                 "give a stop_gap less than clearance");
    require_rule(file, fits(d.channel_width + 2 * d.stop_width, length), "channel_width",
                 fmt::format("channel and stops take {}, the mass is {} long",
                             text_of(d.channel_width + 2 * d.stop_width), text_of(length)),
                 "give a narrower channel or stops, so that the stops face the mass");
    require_rule(file,
                 2 * d.base_inset < std::min(d.electrode_length, d.pad_width) && d.base_inset < d.electrode_width &&
                     d.base_inset < d.pad_length,
                 "base_inset",
                 fmt::format("nothing is left of the electrode's base, set back by {}", text_of(d.base_inset)),
                 "give a smaller base_inset, or a larger electrode and pad");
}

/// Checks letters and marks, which lie in the strip between the chamber and the die's upper edge.
void require_letters(const DeviceFile& file, const DeviceDimensions& d) {
    const double edge = d.frame_width / 4;
    const double strip = d.die_width / 2 - beyond_chamber(d) - 2 * edge;
    require_rule(file, fits(d.mark_size, strip), "mark_size",
                 fmt::format("an alignment mark of {} does not fit beside the chamber, where {} are free",
                             text_of(d.mark_size), text_of(strip)),
                 fmt::format("give a smaller mark_size, or a die_width of at least {}", text_of(sufficient_width(d))));
    require_rule(file, d.mark_size == 0 || nanometres(d.mark_size) >= least_mark, "mark_size",
                 fmt::format("a mark of {} is too small to be drawn", text_of(d.mark_size)),
                 "give a greater mark_size, or 0 for none");
    require_rule(
        file, fits(d.label_height, strip), "label_height",
        fmt::format("letters of {} do not fit beside the chamber, where {} are free", text_of(d.label_height),
                    text_of(strip)),
        fmt::format("give a smaller label_height, or a die_width of at least {}", text_of(sufficient_width(d))));
    if (d.label_height == 0)
        return;
    require_rule(file, nanometres(d.label_height) >= letter_rows, "label_height",
                 "the letters are too small to be drawn", "give a greater label_height, or 0 for none");
    require_rule(
        file, fits(length_of_letters(d), d.die_length), "label_height",
        fmt::format("'{}' is {} long, for which the die has no room", label_of(d), text_of(written_length(d))),
        fmt::format("give a smaller label_height, or a die_length of at least {}", text_of(length_of_letters(d))));
}

std::int64_t least_length(const DeviceDimensions& dimensions) {
    std::int64_t least = nanometres(greatest_length);
    for (const LengthField<DeviceDimensions>& field : device_fields())
        if (const std::int64_t length = nanometres(dimensions.*field.member); length > 0)
            least = std::min(least, length);
    return least;
}

void require_outlines(const DeviceDrawing& drawing, const DeviceFile& file) {
    const std::int64_t least = (least_length(drawing.dimensions) + 1) / 2;
    const auto check = [&](const std::vector<GridPolygon>& polygons, const char* name) {
        for (const GridPolygon& polygon : polygons)
            if (const auto fault = polygon_fault(polygon, least))
                throw InputError(
                    file.place("device"),
                    fmt::format("the outline of {} {}, at {} of the die", name, fault->text, text_at(fault->at)),
                    "change a dimension there: two edges lie almost, or just, at one place");
    };
    check({drawing.mass}, "the mass");
    check({drawing.electrode}, "the fixed electrode");
    check({drawing.base}, "the electrode's base");
    check(drawing.stops, "a stop");
    check(drawing.flexure.etched, "what is etched in the notches");
    check(drawing.etched, "what is etched from the front");
    check(drawing.chambers, "the chamber");
}

std::vector<Part> named_parts(const std::vector<GridBox>& boxes, const char* name) {
    std::vector<Part> parts;
    for (const GridBox& box : boxes)
        parts.push_back({name, box});
    return parts;
}

void require_each_apart(const std::vector<Part>& parts, const DeviceFile& file) {
    for (std::size_t i = 0; i < parts.size(); ++i)
        require_apart({parts[i]}, {parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(i)}, file);
}

} // namespace

std::string label_of(const DeviceDimensions& d) {
    return fmt::format("G{:.6g} S{:.6g} W{:.6g} L{:.6g} N{}", d.gap, d.stop_gap, d.flexure_width, d.flexure_length,
                       d.folds);
}

std::int64_t edge_distance(const DeviceDimensions& dimensions) {
    return nanometres(dimensions.frame_width) / 4;
}

void require_drawable(const DeviceDimensions& dimensions, const DeviceFile& file) {
    require_lengths(file, dimensions);
    require_width(file, dimensions);
    require_parts(file, dimensions);
    require_length(file, dimensions);
    require_letters(file, dimensions);
}

void require_well_drawn(const DeviceDrawing& drawing, const DeviceFile& file) {
    require_outlines(drawing, file);
    const FlexureDrawing& flexure = drawing.flexure;
    const std::vector<Part> frame{{"the frame's finger", flexure.finger}},
        lugs = named_parts(flexure.lugs, "the mass"), trusses = named_parts(flexure.trusses, "a truss"),
        beams = named_parts(flexure.beams, "a beam");
    const GridBox& notch = flexure.notch;
    const std::vector<Part> bars{{"the mass", {notch.left - 1, notch.bottom, notch.left, notch.top}},
                                 {"the mass", {notch.right, notch.bottom, notch.right + 1, notch.top}},
                                 {"the mass", {notch.left, notch.bottom - 1, notch.right, notch.bottom}}};
    require_apart(frame, trusses, file);
    require_apart(frame, lugs, file);
    require_apart(frame, bars, file);
    require_apart(trusses, lugs, file);
    require_apart(trusses, bars, file);
    require_apart(beams, bars, file);
    require_each_apart(beams, file);
    require_each_apart(trusses, file);
    // All parts that are not connected to the mass face it.
    const GridBox mass = bounding_box(drawing.mass), electrode = bounding_box(drawing.electrode);
    require_apart({{"the fixed electrode", electrode}}, {{"the mass", mass}}, file);
    for (const GridPolygon& one : drawing.stops)
        require_apart({{"a stop", bounding_box(one)}}, {{"the mass", mass}}, file);
}

} // namespace graze
