#include "graze/layout/process_steps.hpp"

#include "graze/base/require.hpp"
#include "layout/grid_lengths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace graze {

namespace {

/// An interval of the section, in micrometres.
struct Stretch {
    double left, right;
};
using Stretches = std::vector<Stretch>; ///< disjoint, from left to right

Stretches joined(Stretches all) {
    std::sort(all.begin(), all.end(), [](const Stretch& a, const Stretch& b) { return a.left < b.left; });
    Stretches result;
    for (const Stretch& one : all)
        if (!result.empty() && one.left <= result.back().right)
            result.back().right = std::max(result.back().right, one.right);
        else
            result.push_back(one);
    return result;
}

/// Stretches of a line y = const within polygons. Corners lie on the grid; the line is put between its rows.
Stretches cut(const std::vector<GridPolygon>& polygons, double y) {
    const double row = std::floor(y * grid_per_micrometre) + 0.5;
    Stretches all;
    for (const GridPolygon& polygon : polygons) {
        std::vector<double> crossings;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const GridPoint &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
            const auto low = static_cast<double>(from.y), high = static_cast<double>(to.y);
            if ((low < row) != (high < row))
                crossings.push_back(static_cast<double>(from.x) +
                                    (row - low) / (high - low) * static_cast<double>(to.x - from.x));
        }
        std::sort(crossings.begin(), crossings.end());
        for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
            all.push_back({crossings[i] / grid_per_micrometre, crossings[i + 1] / grid_per_micrometre});
    }
    return joined(std::move(all));
}

/// Complement of intervals within the whole.
Stretches outside_of(const Stretches& intervals, const Stretch& whole) {
    Stretches rest;
    double left = whole.left;
    for (const Stretch& one : intervals) {
        if (one.left > left)
            rest.push_back({left, one.left});
        left = std::max(left, one.right);
    }
    if (whole.right > left)
        rest.push_back({left, whole.right});
    return rest;
}

bool holds(const Stretches& intervals, double x) {
    return std::any_of(intervals.begin(), intervals.end(),
                       [&](const Stretch& one) { return one.left <= x && x < one.right; });
}

/// The intervals of a section, and its fabrication steps.
class CrossSection {
public:
    CrossSection(const DeviceFile& file, const Layout& layout, double y)
        : file_(&file), film_(file.process.wafer_thickness * film) {
        const GridBox& die = layout.devices.front().drawing.die;
        whole_ = {micrometres(die.left), micrometres(die.right)};
        std::vector<GridPolygon> back, front;
        for (PlacedShape& shape : flattened(layout.library, layout.top)) {
            if (shape.layer == mask_layers::front_marks) {
                const GridBox box = bounding_box(shape.polygon);
                marks_.push_back({micrometres(box.left), micrometres(box.right)});
            }
            if (shape.layer == mask_layers::back)
                back.push_back(std::move(shape.polygon));
            else if (shape.layer == mask_layers::front)
                front.push_back(std::move(shape.polygon));
        }
        chambers_ = cut(back, y);
        etched_ = cut(front, y);
        marks_ = joined(std::move(marks_));
    }

    std::vector<ProcessStep> steps() const {
        constexpr ProcessMaterial resist = ProcessMaterial::resist, aluminium = ProcessMaterial::aluminium;
        const double front = file_->process.wafer_thickness;
        const Stretches all{whole_}, kept = outside_of(etched_, whole_);
        const Slabs whole = film_of(ProcessMaterial::silicon, all, 0, front), with_chambers = carved(all),
                    through = carved(kept), below = base();
        const Slabs on_back = film_of(resist, outside_of(chambers_, whole_), -film_, 0),
                    around_marks = film_of(resist, outside_of(marks_, whole_), front, front + film_),
                    on_kept = film_of(resist, kept, front, front + film_),
                    marks = film_of(aluminium, marks_, front, front + film_ / 2);
        return {{"1  resist on the back, opened by mask 1", together({whole, on_back})},
                {fmt::format("2  chambers are etched, {:g} µm deep", file_->process.chamber_depth),
                 together({with_chambers, on_back})},
                {"3  the resist is stripped", with_chambers},
                {"4  resist on the front, opened at marks of mask 2", together({with_chambers, around_marks})},
                {"5  aluminium is sputtered, and lifted off but for the marks", together({with_chambers, marks})},
                {"6  epoxy on a second wafer", below},
                {"7  the wafers are bonded", together({below, with_chambers, marks})},
                {"8  resist opened by mask 2; developer takes the marks", together({below, with_chambers, on_kept})},
                {"9  silicon is etched through, to the epoxy", together({below, through, on_kept})},
                {"10  the resist is stripped", together({below, through})},
                {"11  aluminium on all that is seen from the front", together({below, through, coat(kept)})}};
    }

private:
    using Slabs = std::vector<ProcessSlab>;

    static Slabs together(std::initializer_list<Slabs> parts) {
        Slabs all;
        for (const Slabs& part : parts)
            all.insert(all.end(), part.begin(), part.end());
        return all;
    }
    static Slabs film_of(ProcessMaterial material, const Stretches& intervals, double low, double high) {
        Slabs slabs;
        for (const Stretch& one : intervals)
            slabs.push_back({material, one.left, one.right, low, high});
        return slabs;
    }
    /// The device wafer with its chambers, where it remains.
    Slabs carved(const Stretches& left) const {
        Slabs slabs;
        for (const Stretch& one : left) {
            std::vector<double> ends{one.left, one.right};
            for (const Stretch& chamber : chambers_)
                for (const double end : {chamber.left, chamber.right})
                    if (one.left < end && end < one.right)
                        ends.push_back(end);
            std::sort(ends.begin(), ends.end());
            for (std::size_t i = 0; i + 1 < ends.size(); ++i)
                slabs.push_back({ProcessMaterial::silicon, ends[i], ends[i + 1], floor_at((ends[i] + ends[i + 1]) / 2),
                                 file_->process.wafer_thickness});
        }
        return slabs;
    }
    double floor_at(double x) const { return holds(chambers_, x) ? file_->process.chamber_depth : 0; }
    Slabs base() const {
        return {
            {ProcessMaterial::silicon, whole_.left, whole_.right, -film_ - file_->conditions.base_thickness, -film_},
            {ProcessMaterial::epoxy, whole_.left, whole_.right, -film_, 0}};
    }
    /// Metal on the front, on the walls, and on epoxy that is visible from the front, but not below overhangs.
    Slabs coat(const Stretches& kept) const {
        const double front = file_->process.wafer_thickness, metal = film_ / 2;
        Slabs slabs = together({film_of(ProcessMaterial::aluminium, kept, front, front + metal),
                                film_of(ProcessMaterial::aluminium, outside_of(kept, whole_), 0, metal)});
        constexpr double beside_wall = 1e-3;
        for (const Stretch& one : kept) {
            const double of_wall = std::min(metal, (one.right - one.left) / 4);
            if (one.left > whole_.left)
                slabs.push_back({ProcessMaterial::aluminium, one.left, one.left + of_wall,
                                 floor_at(one.left + beside_wall), front});
            if (one.right < whole_.right)
                slabs.push_back({ProcessMaterial::aluminium, one.right - of_wall, one.right,
                                 floor_at(one.right - beside_wall), front});
        }
        return slabs;
    }

    static constexpr double film = 0.08; ///< relative to the wafer's thickness: displayed thickness of films
    const DeviceFile* file_;
    double film_;
    Stretch whole_{};
    Stretches chambers_, etched_, marks_;
};

} // namespace

std::vector<ProcessStep> process_steps(const DeviceFile& file, const Layout& layout, double y) {
    require_index(0, layout.devices.size(), "device");
    return CrossSection(file, layout, y).steps();
}

double plane_through_stop(const Layout& layout) {
    require_index(0, layout.devices.size(), "device");
    const GridBox stop = bounding_box(layout.devices.front().drawing.stops.front());
    return static_cast<double>(stop.bottom + stop.top) / 2 / grid_per_micrometre;
}

} // namespace graze
