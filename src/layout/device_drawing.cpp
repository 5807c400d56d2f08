#include "graze/layout/device_drawing.hpp"

#include "layout/device_rules.hpp"
#include "layout/grid_lengths.hpp"
#include "layout/mask_outlines.hpp"

#include <algorithm>

namespace graze {

namespace {

/// An interval of a given length centred at zero; if odd, a nanometre longer above.
struct Span {
    std::int64_t low, high;
    explicit Span(double micrometres) {
        const std::int64_t length = nanometres(micrometres);
        low = -(length / 2);
        high = low + length;
    }
};

/// Positions of the beams of a flexure, counted outwards from the middle.
class BeamRow {
public:
    explicit BeamRow(const DeviceDimensions& d)
        : middle_(d.flexure_middle), width_(nanometres(d.flexure_width)),
          pitch_(width_ + nanometres(d.flexure_spacing)), count_(2 * static_cast<std::int64_t>(d.folds)) {}

    std::int64_t count() const { return count_; }
    /// Boundaries of a beam on either side.
    std::int64_t right_from(std::int64_t beam) const { return middle_.high + beam * pitch_; }
    std::int64_t right_to(std::int64_t beam) const { return right_from(beam) + width_; }
    std::int64_t left_to(std::int64_t beam) const { return middle_.low - beam * pitch_; }
    std::int64_t left_from(std::int64_t beam) const { return left_to(beam) - width_; }
    /// Faces of the bars.
    std::int64_t right_bar() const { return right_from(count_); }
    std::int64_t left_bar() const { return left_to(count_); }

private:
    Span middle_;
    std::int64_t width_, pitch_, count_;
};

FlexureDrawing draw_flexure(const DeviceDimensions& d) {
    const BeamRow row(d);
    const std::int64_t near = nanometres(d.clearance), truss = nanometres(d.truss_width);
    const std::int64_t low = near + truss, high = low + nanometres(d.flexure_length), end = high + truss;
    FlexureDrawing flexure;
    for (std::int64_t i = row.count() - 1; i >= 0; --i)
        flexure.beams.push_back({row.left_from(i), low, row.left_to(i), high});
    for (std::int64_t i = 0; i < row.count(); ++i)
        flexure.beams.push_back({row.right_from(i), low, row.right_to(i), high});
    flexure.trusses.push_back({row.left_from(1), near, row.right_to(1), low});
    for (std::int64_t i = 2; i < row.count(); i += 2) {
        flexure.trusses.push_back({row.left_from(i + 1), near, row.left_to(i), low});
        flexure.trusses.push_back({row.right_from(i), near, row.right_to(i + 1), low});
    }
    for (std::int64_t i = 1; i + 1 < row.count(); i += 2) {
        flexure.trusses.push_back({row.left_from(i + 1), high, row.left_to(i), end});
        flexure.trusses.push_back({row.right_from(i), high, row.right_to(i + 1), end});
    }
    flexure.finger = {row.left_from(0), high, row.right_to(0), end};
    flexure.lugs = {{row.left_bar(), high, row.left_to(row.count() - 1), end},
                    {row.right_from(row.count() - 1), high, row.right_bar(), end}};
    flexure.notch = {row.left_bar(), 0, row.right_bar(), end};
    std::vector<GridBox> stays = flexure.beams;
    stays.insert(stays.end(), flexure.trusses.begin(), flexure.trusses.end());
    stays.insert(stays.end(), flexure.lugs.begin(), flexure.lugs.end());
    stays.push_back(flexure.finger);
    flexure.etched = outlines(std::vector{flexure.notch}, stays, flexure.notch);
    return flexure;
}

/// All boxes of a device, first about the centre of the H.
class DeviceBoxes {
public:
    explicit DeviceBoxes(const DeviceDimensions& d, const FlexureDrawing& flexure) : d_(&d) {
        const Span bridge(d.bridge_width);
        const std::int64_t bar = nanometres(d.bar_width), clearance = nanometres(d.clearance);
        const GridBox& notch = flexure.notch;
        bridge_ = {notch.left, bridge.low, notch.right, bridge.high};
        mass_ = {notch.left - bar, bridge.low - notch.top, notch.right + bar, bridge.high + notch.top};
        add_mass(flexure);
        const GridBox& finger = flexure.finger;
        stays_ = {mass_,
                  {finger.left, mass_.top, finger.right, mass_.top + clearance},
                  {finger.left, mass_.bottom - clearance, finger.right, mass_.bottom}};
        window_ = {mass_.grown(clearance, clearance)};
        add_electrode();
        add_stops(clearance);
    }

    void draw(DeviceDrawing& drawing) {
        const std::int64_t margin = nanometres(d_->chamber_margin);
        GridBox box = window_[0].grown(margin, margin);
        for (const GridBox& one : window_)
            box = box.with(one.grown(margin, margin));
        const Span length(d_->die_length), width(d_->die_width);
        drawing.die = {length.low, width.low, length.high, width.high};
        const GridPoint centre{-(box.left + box.right) / 2, 0};
        drawing.centre = centre;
        drawing.chamber_box = box.moved(centre);
        drawing.upper = {centre.x, bridge_.top};
        drawing.lower = {centre.x, bridge_.bottom};
        drawing.mass = outline(h_, centre);
        drawing.electrode = outline(electrode_, centre);
        drawing.base = outline(base_, centre);
        for (const GridBox& one : stops_)
            drawing.stops.push_back(polygon_of(one.moved(centre)));
        const Span channel_span(d_->channel_width);
        const GridBox channel{window_[0].right + centre.x, channel_span.low, drawing.die.right, channel_span.high};
        drawing.etched = drawn(window_, stays_, centre, channel, drawing.die, 0, openings(drawing.flexure, centre));
        drawing.chambers = drawn(window_, base_, centre, channel, drawing.die, margin, {});
    }

private:
    void add_mass(const FlexureDrawing& flexure) {
        h_ = {{mass_.left, mass_.bottom, bridge_.left, mass_.top},
              {bridge_.right, mass_.bottom, mass_.right, mass_.top}};
        h_.push_back(bridge_);
        for (const GridBox& lug : flexure.lugs) {
            h_.push_back(lug.moved({0, bridge_.top}));
            h_.push_back({lug.left, bridge_.bottom - lug.top, lug.right, bridge_.bottom - lug.bottom});
        }
    }

    void add_electrode() {
        const Span length(d_->electrode_length), across(d_->pad_width);
        const std::int64_t face = mass_.left - nanometres(d_->gap), back = face - nanometres(d_->electrode_width);
        const GridBox plate{back, length.low, face, length.high};
        const GridBox pad{back - nanometres(d_->pad_length), across.low, back, across.high};
        electrode_ = {plate, pad};
        stays_.push_back(plate);
        stays_.push_back(pad);
        const std::int64_t moat = nanometres(d_->moat);
        window_.push_back({plate.left - moat, plate.bottom - moat, mass_.left, plate.top + moat});
        window_.push_back({pad.left - moat, pad.bottom - moat, std::min(pad.right + moat, mass_.left), pad.top + moat});
        // The base is the outline set back on all sides; where the two parts meet, the narrower one continues into the
        // wider one.
        const std::int64_t inset = nanometres(d_->base_inset);
        GridBox plate_base = plate.grown(-inset, -inset), pad_base = pad.grown(-inset, -inset);
        if (plate.height() < pad.height())
            plate_base.left = pad_base.right;
        else
            pad_base.right = plate_base.left;
        base_ = {plate_base, pad_base};
    }

    void add_stops(std::int64_t clearance) {
        const Span channel(d_->channel_width);
        const std::int64_t from = mass_.right + nanometres(d_->stop_gap), to = mass_.right + clearance;
        const std::int64_t width = nanometres(d_->stop_width);
        stops_ = {{from, channel.high, to, channel.high + width}, {from, channel.low - width, to, channel.low}};
        stays_.insert(stays_.end(), stops_.begin(), stops_.end());
    }

    /// Positions where trenches of a notch open towards the frame. Adjacent polygons are cut there: they share corners,
    /// so that no crack opens when a device is rotated and its corners are rounded.
    static std::vector<std::int64_t> openings(const FlexureDrawing& flexure, GridPoint centre) {
        std::vector<std::int64_t> all;
        const auto add = [&](std::int64_t x) {
            if (x != flexure.notch.left && x != flexure.notch.right)
                all.push_back(x + centre.x);
        };
        for (const std::vector<GridBox>* boxes : {&flexure.trusses, &flexure.lugs})
            for (const GridBox& box : *boxes)
                if (box.top == flexure.notch.top) {
                    add(box.left);
                    add(box.right);
                }
        std::sort(all.begin(), all.end());
        return all;
    }

    static std::vector<GridBox> moved(std::vector<GridBox> boxes, GridPoint by) {
        for (GridBox& box : boxes)
            box = box.moved(by);
        return boxes;
    }

    static GridPolygon outline(const std::vector<GridBox>& boxes, GridPoint by) {
        const std::vector<GridBox> placed = moved(boxes, by);
        GridBox all = placed[0];
        for (const GridBox& one : placed)
            all = all.with(one);
        return outlines(placed, {}, all).at(0);
    }

    /// Returns the etched area: windows and channel, expanded by a margin, minus what remains. It is split in two
    /// halves so that polygons have no holes: all that remains inside crosses the line y = 0, or is connected to what
    /// does.
    /// @param cuts further cuts along y, in coordinates of the die
    static std::vector<GridPolygon> drawn(const std::vector<GridBox>& windows, const std::vector<GridBox>& stays,
                                          GridPoint centre, GridBox channel, const GridBox& die, std::int64_t margin,
                                          std::vector<std::int64_t> cuts) {
        std::vector<GridBox> all = moved(windows, centre);
        for (GridBox& one : all)
            one = one.grown(margin, margin);
        all.push_back(channel.grown(0, margin));
        const std::vector<GridBox> without = moved(stays, centre);
        cuts.push_back(die.right);
        std::vector<GridPolygon> result;
        for (const bool is_upper : {true, false}) {
            std::int64_t from = die.left;
            for (const std::int64_t to : cuts) {
                const GridBox part{from, is_upper ? 0 : die.bottom, to, is_upper ? die.top : 0};
                const std::vector<GridPolygon> found = outlines(all, without, part);
                result.insert(result.end(), found.begin(), found.end());
                from = to;
            }
        }
        return result;
    }

    const DeviceDimensions* d_;
    GridBox mass_, bridge_; ///< mass including its notches
    std::vector<GridBox> h_, electrode_, base_, stops_, window_, stays_;
};

} // namespace

GridBox DeviceDrawing::in_device(const GridBox& box, bool in_lower) const {
    return in_lower ? GridBox{box.left, -box.top, box.right, -box.bottom}.moved(lower) : box.moved(upper);
}

std::vector<GridBox> DeviceDrawing::in_both(const std::vector<GridBox>& of_flexure) const {
    std::vector<GridBox> all;
    for (const bool in_lower : {false, true})
        for (const GridBox& one : of_flexure)
            all.push_back(in_device(one, in_lower));
    return all;
}

DeviceDrawing draw_device(const DeviceDimensions& dimensions, const DeviceFile& file) {
    require_drawable(dimensions, file);
    DeviceDrawing drawing;
    drawing.dimensions = dimensions;
    drawing.flexure = draw_flexure(dimensions);
    DeviceBoxes(dimensions, drawing.flexure).draw(drawing);
    require_well_drawn(drawing, file);
    return drawing;
}

} // namespace graze
