#include "graze/layout/alignment_mark.hpp"
#include "graze/layout/layout.hpp"
#include "graze/layout/mask_letters.hpp"
#include "layout/device_cells.hpp"
#include "layout/device_rules.hpp"
#include "layout/grid_lengths.hpp"
#include "layout/turned_box.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace graze {

namespace {

constexpr double full_turn = 360;

/// Returns a circle with a flat at the bottom as a polygon. Nanometres. @param flat distance of the flat from the
/// centre
GridPolygon wafer_outline(double radius, double flat) {
    constexpr int corners = 720;
    const double lowest = -std::min(flat, radius), half = std::sqrt(std::max(0.0, radius * radius - lowest * lowest));
    const double from = std::atan2(lowest, half), to = std::numbers::pi - from;
    const bool is_round = half < 1; // no flat
    GridPolygon outline;
    for (int i = 0; i < (is_round ? corners : corners + 1); ++i) {
        const double angle = from + (is_round ? 2 * std::numbers::pi : to - from) * i / corners;
        outline.push_back({std::llround(radius * std::cos(angle)), std::llround(radius * std::sin(angle))});
    }
    return outline;
}

class WaferDrawing {
public:
    explicit WaferDrawing(const DeviceFile& file) : file_(file), plan_(file_.wafer) {
        // Errors in varied dimensions are reported at the plan.
        for (const auto& [name, values] : plan_.vary)
            file_.places.insert_or_assign("device." + name, file.place("wafer.vary." + name));
        radius_ = grid_per_micrometre * plan_.diameter / 2;
        require(plan_.flat_length < plan_.diameter, "flat_length",
                fmt::format("a flat of {:.6g} um is longer than the wafer's diameter, {:.6g} um", plan_.flat_length,
                            plan_.diameter),
                "give a shorter flat, or 0 for none");
        require(2 * plan_.exclusion < plan_.diameter, "exclusion",
                fmt::format("nothing is left within an exclusion of {:.6g} um", plan_.exclusion), "give a smaller one");
        const double half_flat = grid_per_micrometre * plan_.flat_length / 2;
        flat_ = std::sqrt(radius_ * radius_ - half_flat * half_flat);
    }

    Layout draw() {
        layout_.library.name = cell_name(file_.name);
        draw_devices();
        place_sites();
        require_places();
        add_wafer();
        return std::move(layout_);
    }

private:
    void require(bool holds, const char* key, const std::string& problem, const std::string& remedy) const {
        if (!holds)
            throw InputError(file_.place(std::string("wafer.") + key), problem, remedy);
    }

    void draw_devices() {
        std::vector<DeviceDimensions> different;
        for (std::size_t i = 0; i < plan_.devices; ++i) {
            DeviceDimensions one = file_.device;
            for (const auto& [name, values] : plan_.vary) {
                const double value = values[i % values.size()];
                if (name == "folds")
                    one.folds = static_cast<std::size_t>(value);
                for (const LengthField<DeviceDimensions>& field : device_fields())
                    if (name == field.name)
                        one.*field.member = value;
            }
            const auto found = std::find(different.begin(), different.end(), one);
            layout_.sites.push_back(static_cast<std::size_t>(found - different.begin()));
            if (found == different.end())
                different.push_back(one);
        }
        for (std::size_t i = 0; i < different.size(); ++i) {
            const std::string ending = different.size() > 1 ? fmt::format("_{}", i + 1) : "";
            layout_.devices.push_back({"DEVICE" + ending, draw_device(different[i], file_)});
            add_device_cells(layout_.library, layout_.devices.back().drawing, ending);
        }
    }

    const DeviceDrawing& device_at(std::size_t site) const { return layout_.devices[layout_.sites[site]].drawing; }

    /// The channel from the die's edge to the wafer's.
    GridBox channel_of(const DeviceDrawing& device, std::int64_t margin) const {
        const std::int64_t width = nanometres(device.dimensions.channel_width), low = -(width / 2);
        const std::int64_t edge = std::llround(radius_) - nanometres(plan_.radius);
        return {device.die.right, low - margin, std::max(edge, device.die.right), low + width + margin};
    }

    void place_sites() {
        const auto count = static_cast<double>(plan_.devices);
        const double first = plan_.devices % 2 == 0 ? 0.5 : 0.25; // in pitches: keeps the x axis free
        const double radius = grid_per_micrometre * plan_.radius;
        for (std::size_t i = 0; i < plan_.devices; ++i) {
            const double degrees = full_turn * (static_cast<double>(i) + first) / count;
            const double angle = degrees * std::numbers::pi / (full_turn / 2);
            layout_.site_degrees.push_back(degrees);
            centres_.push_back({std::llround(radius * std::cos(angle)), std::llround(radius * std::sin(angle))});
            dies_.emplace_back(device_at(i).die, centres_.back(), angle);
            const GridBox channel = channel_of(device_at(i), nanometres(file_.device.chamber_margin));
            channels_.emplace_back(channel, centres_.back(), angle);
        }
    }

    std::string number(std::size_t site) const { return fmt::format("device {}", site + 1); }

    void require_places() const {
        const double usable = radius_ - grid_per_micrometre * plan_.exclusion;
        const double lowest = -(flat_ - grid_per_micrometre * plan_.exclusion);
        for (std::size_t i = 0; i < dies_.size(); ++i)
            for (const BoxCorner& corner : dies_[i].corners())
                require(std::hypot(corner.x, corner.y) <= usable && corner.y >= lowest, "radius",
                        fmt::format("{} reaches into the exclusion at the wafer's edge", number(i)),
                        "give a smaller radius, die or exclusion, or a larger wafer");
        double widest = 0;
        for (const TurnedBox& die : dies_)
            widest = std::max(widest, die.reach());
        for (std::size_t distance = 1; distance <= dies_.size() / 2; ++distance) { // neighbours first
            // Beyond this distance from the other's radius, along which its channel runs, they cannot meet.
            const double angle =
                2 * std::numbers::pi * static_cast<double>(distance) / static_cast<double>(dies_.size());
            if (grid_per_micrometre * plan_.radius * std::sin(std::min(angle, std::numbers::pi / 2)) > 2 * widest)
                break;
            for (std::size_t i = 0; i < dies_.size(); ++i) {
                const std::size_t j = (i + distance) % dies_.size();
                require(i == j ||
                            !(dies_[i].meets(dies_[j]) || dies_[i].meets(channels_[j]) || channels_[i].meets(dies_[j])),
                        "devices", fmt::format("{} and {} overlap", number(i), number(j)),
                        "give fewer devices, smaller dies, or a larger radius");
            }
        }
        require(plan_.mark_size == 0 || nanometres(plan_.mark_size) >= least_mark, "mark_size",
                fmt::format("a mark of {:.6g} um is too small to be drawn", plan_.mark_size),
                "give a greater mark_size, or 0 for none");
        for (const TurnedBox& mark : marks())
            for (std::size_t i = 0; i < dies_.size(); ++i)
                require(!mark.meets(dies_[i]) && !mark.meets(channels_[i]), "mark_radius",
                        fmt::format("an alignment mark of the wafer lies on {}", number(i)),
                        "give another mark_radius, or fewer devices");
        for (const TurnedBox& mark : marks())
            for (const BoxCorner& corner : mark.corners())
                require(std::hypot(corner.x, corner.y) <= radius_, "mark_radius",
                        "the wafer's alignment marks lie beyond its edge", "give a smaller mark_radius");
        require_label();
    }

    std::vector<TurnedBox> marks() const {
        const std::int64_t size = nanometres(plan_.mark_size), radius = nanometres(plan_.mark_radius);
        if (size == 0)
            return {};
        const GridBox box = GridBox{0, 0, size, size}.moved({-(size / 2), -(size / 2)});
        return {TurnedBox(box, {radius, 0}, 0), TurnedBox(box, {-radius, 0}, 0)};
    }

    /// Label of a mask; those of both masks lie one above the other.
    std::string label(int mask) const {
        return fmt::format("{} MASK {}", plan_.label.empty() ? file_.name : plan_.label, mask);
    }

    void require_label() const {
        const std::int64_t height = nanometres(plan_.label_height), width = letters_width(label(1), height);
        if (height == 0)
            return;
        const char* key = plan_.label.empty() ? "label_height" : "label";
        require(can_be_drawn(label(1)), key, fmt::format("'{}' has letters that are not drawn on masks", label(1)),
                "use letters of English, digits, blanks and . , - + = / _ : ( )");
        require(height >= letter_rows, "label_height", "the letters are too small to be drawn",
                "give a greater label_height, or 0 for none");
        const TurnedBox box({-(width / 2), -2 * height, width - width / 2, 2 * height}, {}, 0);
        const double usable = radius_ - grid_per_micrometre * plan_.exclusion;
        for (const BoxCorner& corner : box.corners())
            require(std::hypot(corner.x, corner.y) <= usable, key,
                    fmt::format("the letters '{}' reach beyond the part for devices", label(1)),
                    "give a shorter label or a smaller label_height");
        for (std::size_t i = 0; i < dies_.size(); ++i)
            require(!box.meets(dies_[i]) && !box.meets(channels_[i]), key,
                    fmt::format("the letters '{}' lie on {}", label(1), number(i)),
                    "give a shorter label or a smaller label_height");
        for (const TurnedBox& mark : marks())
            require(!box.meets(mark), key, fmt::format("the letters '{}' lie on an alignment mark", label(1)),
                    "give a shorter label or a smaller label_height");
    }

    /// End of a site's channel at a distance from its middle line, in the site's coordinates: at the rim, or at the
    /// flat.
    std::int64_t channel_end(std::size_t site, std::int64_t aside) const {
        const auto y = static_cast<double>(aside);
        const double radius = grid_per_micrometre * plan_.radius;
        double end = std::sqrt(radius_ * radius_ - y * y) - radius;
        const double angle = layout_.site_degrees[site] * std::numbers::pi / (full_turn / 2);
        if (const double falls = -std::sin(angle); falls > 0) // towards the flat
            end = std::min(end, (flat_ + std::cos(angle) * y) / falls - radius);
        return std::max<std::int64_t>(std::llround(std::floor(end)), device_at(site).die.right);
    }

    /// Adds the channel in two halves, like the die's part of it, so that corners are shared; it is cut off at the
    /// wafer's edge.
    void add_channel(LayoutCell& cell, MaskLayer layer, std::size_t site, const GridBox& channel) const {
        for (const std::int64_t aside : {channel.top, channel.bottom})
            cell.add(layer, GridPolygon{{channel.left, 0},
                                        {channel_end(site, 0), 0},
                                        {channel_end(site, aside), aside},
                                        {channel.left, aside}});
    }

    void add_site(std::size_t i) {
        const DeviceDrawing& device = device_at(i);
        const DeviceDimensions& d = device.dimensions;
        LayoutCell site{.name = fmt::format("SITE_{}", i + 1),
                        .references = {{layout_.devices[layout_.sites[i]].cell, {}, false, 0}}};
        if (const GridBox channel = channel_of(device, 0); channel.width() > 0) {
            add_channel(site, mask_layers::front, i, channel);
            add_channel(site, mask_layers::back, i, channel_of(device, nanometres(d.chamber_margin)));
        }
        const std::int64_t edge = edge_distance(d), letters = nanometres(d.label_height);
        if (letters > 0)
            add_letters(site, mask_layers::front_letters, fmt::format("{}", i + 1),
                        {device.die.left + edge, device.die.bottom + edge}, letters);
        layout_.library.cells.push_back(std::move(site));
    }

    void add_wafer() {
        LayoutCell wafer{.name = "WAFER"};
        for (std::size_t i = 0; i < dies_.size(); ++i) {
            add_site(i);
            wafer.references.push_back({fmt::format("SITE_{}", i + 1), centres_[i], false, layout_.site_degrees[i]});
        }
        const double exclusion = grid_per_micrometre * plan_.exclusion;
        wafer.add(mask_layers::wafer, wafer_outline(radius_, flat_));
        wafer.add(mask_layers::usable, wafer_outline(radius_ - exclusion, flat_ - exclusion));
        const std::int64_t size = nanometres(plan_.mark_size), at = nanometres(plan_.mark_radius);
        if (size > 0) {
            layout_.library.cells.push_back(alignment_mark("WAFER_MARK", size));
            wafer.references.push_back({"WAFER_MARK", {at, 0}, false, 0});
            wafer.references.push_back({"WAFER_MARK", {-at, 0}, false, 0});
        }
        const std::int64_t height = nanometres(plan_.label_height);
        if (height > 0) {
            const std::int64_t left = -(letters_width(label(1), height) / 2);
            add_letters(wafer, mask_layers::front_letters, label(2), {left, height / 2}, height);
            add_letters(wafer, mask_layers::back_letters, label(1), {left, -height / 2 - height}, height, true);
        }
        wafer.texts.push_back({mask_layers::notes, {0, 0}, file_.name, plan_.label_height});
        layout_.library.cells.push_back(std::move(wafer));
        layout_.top = "WAFER";
    }

    DeviceFile file_;
    const WaferPlan& plan_;
    double radius_ = 0, flat_ = 0; ///< nanometres; flat_ is the distance of the flat from the centre
    std::vector<GridPoint> centres_;
    std::vector<TurnedBox> dies_, channels_;
    Layout layout_;
};

} // namespace

Layout draw_wafer_layout(const DeviceFile& file) {
    return WaferDrawing(file).draw();
}

} // namespace graze
