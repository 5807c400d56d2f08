#pragma once

#include "graze/layout/device_drawing.hpp"
#include "plane_frame.hpp"

#include <algorithm>
#include <set>
#include <vector>

namespace graze {

/// The whole device as a plane frame, from the boxes of its drawing (vertical walls at the drawn edges): beams,
/// trusses, lugs, fingers, bars and bridge are beams along their centre lines, rigid where they overlap others.
/// Micrometres; E = h = 1.
class DrawnFrame {
public:
    explicit DrawnFrame(const DeviceDrawing& drawing) : drawing_(&drawing) {
        const FlexureDrawing& flexure = drawing.flexure;
        const double half_bridge = drawing.dimensions.bridge_width / 2;
        for (const bool right : {false, true}) {
            const double inner = um(right ? flexure.notch.right : flexure.notch.left);
            bars_[right] = inner + (right ? 0.5 : -0.5) * drawing.dimensions.bar_width;
            const std::size_t joint = frame_.add_joint(bars_[right], 0), face = frame_.add_joint(inner, 0);
            rigid(joint, face);
            bridge_.push_back(joint);
            faces_.push_back(face);
        }
        bridge_middle_ = frame_.add_joint(0.5 * (bars_[0] + bars_[1]), 0);
        for (const std::size_t face : faces_)
            beam(face, bridge_middle_, 2 * half_bridge);
        for (const double side : {1.0, -1.0})
            add_flexure(side, half_bridge);
    }

    /// Stiffness at the middle of the bridge.
    double stiffness() const { return frame_.driven({bridge_middle_}, held_).first; }
    /// The same with rigid bars: both flexures' ends move together.
    double with_rigid_mass() const { return frame_.driven(lug_ends_, held_).first; }

private:
    static double um(std::int64_t nanometres) { return static_cast<double>(nanometres) / grid_per_micrometre; }
    void beam(std::size_t from, std::size_t to, double width) {
        frame_.add_beam(from, to, width * width * width / 12, width, 0, 1); // a cubic polynomial is exact
    }
    void rigid(std::size_t from, std::size_t to) {
        const double width = 20 * drawing_->dimensions.truss_width; // thousands of times stiffer than nearby parts
        frame_.add_beam(from, to, width * width * width / 12, width, 0, 1);
    }

    /// The joint on the centre line of a truss or a lug above or below a beam's end.
    struct Attached {
        double from, to; ///< interval of the beam's width
        std::size_t end; ///< joint at the beam's end
    };
    /// Adds a truss with the beams at one of its edges, from left to right. @return joints at its ends
    std::pair<std::size_t, std::size_t> add_across(const GridBox& box, double side, double offset) {
        const double y = side * (offset + 0.5 * um(box.bottom + box.top)), width = um(box.top - box.bottom);
        std::vector<Attached> here;
        for (const End& end : ends_)
            if (end.level >= box.bottom && end.level <= box.top && end.box.left >= box.left &&
                end.box.right <= box.right)
                here.push_back({um(end.box.left), um(end.box.right), end.joint});
        const std::size_t first = frame_.add_joint(um(box.left), y), final = frame_.add_joint(um(box.right), y);
        std::size_t last = first;
        double x = um(box.left);
        const auto go = [&](double to, bool is_joint) {
            if (to <= x)
                return;
            const std::size_t next = to == um(box.right) ? final : frame_.add_joint(to, y);
            if (is_joint)
                rigid(last, next);
            else
                beam(last, next, width);
            last = next;
            x = to;
        };
        std::sort(here.begin(), here.end(), [](const Attached& a, const Attached& b) { return a.from < b.from; });
        for (const Attached& one : here) {
            go(one.from, false);
            go(0.5 * (one.from + one.to), true);
            rigid(one.end, last);
            go(one.to, true);
        }
        go(um(box.right), false);
        return {first, final};
    }

    void add_flexure(double side, double offset) {
        const FlexureDrawing& flexure = drawing_->flexure;
        ends_.clear();
        const GridBox& finger = flexure.finger;
        const double middle = 0.5 * um(finger.left + finger.right);
        const std::size_t foot = frame_.add_joint(middle, side * (offset + um(finger.bottom)));
        held_.push_back(frame_.add_joint(middle, side * (offset + um(finger.top) + drawing_->dimensions.clearance)));
        beam(foot, held_.back(), um(finger.width()));
        for (const GridBox& one : flexure.beams) {
            const double x = 0.5 * um(one.left + one.right);
            const std::size_t low = frame_.add_joint(x, side * (offset + um(one.bottom)));
            const std::size_t high = frame_.add_joint(x, side * (offset + um(one.top)));
            beam(low, high, um(one.width()));
            ends_.push_back({one, one.bottom, low});
            if (one.left >= finger.left && one.right <= finger.right)
                rigid(high, foot);
            else
                ends_.push_back({one, one.top, high});
        }
        for (const GridBox& truss : flexure.trusses)
            add_across(truss, side, offset);
        for (const GridBox& lug : flexure.lugs) {
            const bool right = lug.right == flexure.notch.right;
            const auto [first, final] = add_across(lug, side, offset);
            const std::size_t at_bar = right ? final : first;
            const double y = side * (offset + 0.5 * um(lug.bottom + lug.top));
            const std::size_t line = frame_.add_joint(bars_[right], y);
            const std::size_t below = frame_.add_joint(bars_[right], side * (offset + um(lug.bottom)));
            const std::size_t root = frame_.add_joint(bars_[right], side * offset);
            rigid(at_bar, line);
            rigid(line, below);
            beam(below, root, drawing_->dimensions.bar_width);
            rigid(root, bridge_[right]);
            lug_ends_.push_back(at_bar);
        }
    }

    struct End {
        GridBox box;
        std::int64_t level;
        std::size_t joint;
    };
    const DeviceDrawing* drawing_;
    PlaneFrame frame_;
    std::array<double, 2> bars_{}; ///< their centre lines
    std::size_t bridge_middle_ = 0;
    std::vector<std::size_t> bridge_, faces_, held_, lug_ends_;
    std::vector<End> ends_; ///< ends of a flexure's beams, except those at the finger
};

} // namespace graze
