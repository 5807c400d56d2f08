#include "layout/device_rules.hpp"

#include "graze/layout/alignment_mark.hpp"
#include "graze/layout/mask_letters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

namespace graze {

namespace {

class Requirements {
public:
    explicit Requirements(const DeviceFile& file) : file_(&file) {}

    /// @param key the dimension to blame
    void require(bool holds, const char* key, const std::string& problem, const std::string& remedy) const {
        if (!holds)
            throw InputError(file_->place(std::string("device.") + key), problem, remedy);
    }

private:
    const DeviceFile* file_;
};

std::string at(GridPoint point) {
    return fmt::format("({:.3f}, {:.3f}) um", static_cast<double>(point.x) / grid_per_micrometre,
                       static_cast<double>(point.y) / grid_per_micrometre);
}

/// Of what takes room, that which takes most: what does not fit is most likely due to it.
const char* greatest(std::initializer_list<std::pair<const char*, double>> parts) {
    return std::max_element(parts.begin(), parts.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
}

struct Part {
    std::string name;
    GridBox box;
};

/// Parts that do not belong together must be apart.
void require_apart(const std::vector<Part>& some, const std::vector<Part>& others, const DeviceFile& file) {
    for (const Part& one : some)
        for (const Part& other : others)
            if (one.box.meets(other.box))
                throw InputError(file.place("device"), fmt::format("{} touches {}", one.name, other.name),
                                 "give dimensions that keep them apart");
}

} // namespace

std::int64_t nanometres(double micrometres) {
    return std::llround(micrometres * grid_per_micrometre);
}

std::string label_of(const DeviceDimensions& d) {
    return fmt::format("G{:.6g} S{:.6g} W{:.6g} L{:.6g} N{}", d.gap, d.stop_gap, d.flexure_width, d.flexure_length,
                       d.folds);
}

std::int64_t edge_distance(const DeviceDimensions& dimensions) {
    return nanometres(dimensions.frame_width) / 4;
}

void require_drawable(const DeviceDimensions& d, const DeviceFile& file) {
    const Requirements rules(file);
    for (const LengthField<DeviceDimensions>& field : device_fields())
        try {
            length_on_grid(d.*field.member, std::string("device.") + field.name, field.may_be_zero);
        } catch (const InputError& error) {
            throw InputError(file.place(std::string("device.") + field.name), error.problem(), error.remedy());
        }
    rules.require(d.folds >= 1 && d.folds <= most_folds, "folds", fmt::format("device.folds is {}", d.folds),
                  fmt::format("give a whole number from 1 to {}", most_folds));
    const double half = d.mass_half_length();
    const double across = 2 * (half + d.clearance + d.chamber_margin + d.frame_width);
    const char* longest = greatest({{"flexure_length", 2 * d.flexure_length},
                                    {"truss_width", 4 * d.truss_width},
                                    {"bridge_width", d.bridge_width},
                                    {"clearance", 4 * d.clearance},
                                    {"chamber_margin", 2 * d.chamber_margin},
                                    {"frame_width", 2 * d.frame_width}});
    rules.require(
        across <= d.die_width, longest,
        fmt::format("flexures of {} um make a mass {} um long, which with clearance, chamber and frame takes {} um "
                    "of a die {} um wide",
                    d.flexure_length, 2 * half, across, d.die_width),
        fmt::format("give a smaller {}, or a die_width of at least {} um", longest, across));
    rules.require(
        d.electrode_length <= 2 * half, "electrode_length",
        fmt::format("the fixed electrode, {} um long, is longer than the mass of {} um", d.electrode_length, 2 * half),
        "give a shorter electrode, or longer flexures");
    rules.require(d.stop_gap < d.clearance, "stop_gap",
                  fmt::format("the stops do not reach out of the frame: stop_gap is {} um, clearance {} um", d.stop_gap,
                              d.clearance),
                  "give a stop_gap less than clearance");
    rules.require(d.channel_width + 2 * d.stop_width <= 2 * half, "channel_width",
                  fmt::format("channel and stops take {} um, the mass is {} um long",
                              d.channel_width + 2 * d.stop_width, 2 * half),
                  "give a narrower channel or stops, so that the stops face the mass");
    rules.require(2 * d.base_inset < std::min(d.electrode_length, d.pad_width) && d.base_inset < d.electrode_width &&
                      d.base_inset < d.pad_length,
                  "base_inset", fmt::format("nothing is left of the electrode's base, set back by {} um", d.base_inset),
                  "give a smaller base_inset, or a larger electrode and pad");
    const double half_across = std::max(d.electrode_length, d.pad_width) / 2 + d.moat + d.chamber_margin;
    rules.require(
        2 * (half_across + d.frame_width) <= d.die_width,
        d.pad_width > d.electrode_length ? "pad_width" : "electrode_length",
        fmt::format("the fixed electrode with its moat takes {} um of a die {} um wide", 2 * half_across, d.die_width),
        fmt::format("give a smaller electrode and pad, or a die_width of at least {} um",
                    2 * (half_across + d.frame_width)));
    const double left = std::max(d.clearance, d.moat + d.pad_length + d.electrode_width + d.gap);
    const double length = left + 2 * d.bar_width + 2 * d.notch_half_width() + d.clearance + 2 * d.chamber_margin;
    const auto beams = 4 * static_cast<double>(d.folds);
    longest = greatest({{"pad_length", d.pad_length},
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
    rules.require(
        length + 2 * d.frame_width <= d.die_length, longest,
        fmt::format("device and frame, {} um long, do not fit on a die {} um long", length + 2 * d.frame_width,
                    d.die_length),
        fmt::format("give a smaller {}, or a die_length of at least {} um", longest, length + 2 * d.frame_width));
    // Letters and marks stand in the strip between the chamber and the die's upper edge.
    const double edge = d.frame_width / 4;
    const double strip = d.die_width / 2 - std::max(half + d.clearance + d.chamber_margin, half_across) - 2 * edge;
    rules.require(d.mark_size <= strip, "mark_size",
                  fmt::format("an alignment mark of {} um does not fit beside the chamber, where {} um are free",
                              d.mark_size, strip),
                  "give a smaller mark_size, or a larger die_width");
    rules.require(d.mark_size == 0 || nanometres(d.mark_size) >= least_mark, "mark_size",
                  fmt::format("a mark of {} um is too small to be drawn", d.mark_size),
                  "give a greater mark_size, or 0 for none");
    rules.require(
        d.label_height <= strip, "label_height",
        fmt::format("letters of {} um do not fit beside the chamber, where {} um are free", d.label_height, strip),
        "give a smaller label_height, or a larger die_width");
    if (d.label_height > 0) {
        rules.require(nanometres(d.label_height) >= letter_rows, "label_height",
                      "the letters are too small to be drawn", "give a greater label_height, or 0 for none");
        const double written =
            static_cast<double>(letters_width(label_of(d), nanometres(d.label_height))) / grid_per_micrometre;
        rules.require(written <= d.die_length - 3 * edge - d.mark_size, "label_height",
                      fmt::format("'{}' is {} um long, for which the die has no room", label_of(d), written),
                      "give a smaller label_height, or a larger die_length");
    }
}

void require_well_drawn(const DeviceDrawing& drawing, const DeviceFile& file) {
    std::int64_t least = nanometres(greatest_length);
    for (const LengthField<DeviceDimensions>& field : device_fields())
        if (const std::int64_t length = nanometres(drawing.dimensions.*field.member); length > 0)
            least = std::min(least, length);
    const auto check = [&](const GridPolygon& polygon, const char* name) {
        if (const auto fault = polygon_fault(polygon, (least + 1) / 2))
            throw InputError(file.place("device"),
                             fmt::format("the outline of {} {}, at {} of the die", name, fault->text, at(fault->at)),
                             "change a dimension there: two edges lie almost, or just, at one place");
    };
    check(drawing.mass, "the mass");
    check(drawing.electrode, "the fixed electrode");
    check(drawing.base, "the electrode's base");
    for (const GridPolygon& one : drawing.stops)
        check(one, "a stop");
    for (const GridPolygon& one : drawing.flexure.etched)
        check(one, "what is etched in the notches");
    for (const GridPolygon& one : drawing.etched)
        check(one, "what is etched from the front");
    for (const GridPolygon& one : drawing.chambers)
        check(one, "the chamber");

    const FlexureDrawing& flexure = drawing.flexure;
    std::vector<Part> trusses, beams, frame{{"the frame's finger", flexure.finger}}, lugs;
    for (const GridBox& box : flexure.trusses)
        trusses.push_back({"a truss", box});
    for (const GridBox& box : flexure.beams)
        beams.push_back({"a beam", box});
    for (const GridBox& box : flexure.lugs)
        lugs.push_back({"the mass", box});
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
    for (std::size_t i = 0; i < beams.size(); ++i)
        require_apart({beams[i]}, {beams.begin(), beams.begin() + static_cast<std::ptrdiff_t>(i)}, file);
    for (std::size_t i = 0; i < trusses.size(); ++i)
        require_apart({trusses[i]}, {trusses.begin(), trusses.begin() + static_cast<std::ptrdiff_t>(i)}, file);
    // Everything that is not joined to the mass faces it.
    const GridBox mass = bounding_box(drawing.mass), electrode = bounding_box(drawing.electrode);
    require_apart({{"the fixed electrode", electrode}}, {{"the mass", mass}}, file);
    for (const GridPolygon& one : drawing.stops)
        require_apart({{"a stop", bounding_box(one)}}, {{"the mass", mass}}, file);
}

} // namespace graze
