#include "program/label_places.hpp"

#include "program/gnuplot_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace graze {

namespace {

// All lengths are parts of the width and height of the area that is drawn in, which is about 380 by 190 pixels large.
constexpr double letter_width = 6.0 / 380, letter_height = 13.0 / 190;
constexpr double symbol_width = 8.0 / 380, symbol_height = 8.0 / 190;

struct Box {
    double left, right, low, high;
    bool meets(const Box& other) const {
        return left < other.right && other.left < right && low < other.high && other.low < high;
    }
    bool holds(const PlanePoint& point) const {
        return left < point.x && point.x < right && low < point.y && point.y < high;
    }
};

Box box_around(const PlanePoint& centre, double width, double height) {
    return {centre.x - width / 2, centre.x + width / 2, centre.y - height / 2, centre.y + height / 2};
}

/// Where something lies on an axis: 0 at its beginning, 1 at its end.
class Scale {
public:
    Scale(const FigurePanel& panel, bool horizontal)
        : logarithmic_(horizontal ? panel.logarithmic_x : panel.logarithmic_y) {
        if (const auto& range = horizontal ? panel.x_range : panel.y_range) {
            add(range->first);
            add(range->second);
        } else {
            for (const FigureSeries& series : panel.series)
                for (const PlanePoint& point : series.points)
                    add(horizontal ? point.x : point.y);
            if ((horizontal ? panel.roomy_x : panel.roomy) && least_ < greatest_) {
                const double margin = roomy_margin * (greatest_ - least_);
                least_ -= margin;
                greatest_ += margin;
            }
        }
    }
    double operator()(double value) const {
        constexpr double resolved = 1e-9; // what differs by less is drawn as a constant
        const double span = greatest_ - least_;
        return span > resolved * std::max(std::abs(least_), std::abs(greatest_)) ? (transformed(value) - least_) / span
                                                                                 : 0.5;
    }

private:
    double transformed(double value) const { return logarithmic_ ? std::log(value) : value; }
    void add(double value) {
        const double place = transformed(value);
        if (!std::isfinite(place))
            return;
        least_ = std::min(least_, place);
        greatest_ = std::max(greatest_, place);
    }
    bool logarithmic_;
    double least_ = std::numeric_limits<double>::infinity(), greatest_ = -std::numeric_limits<double>::infinity();
};

/// Finds room for one label after the other.
class LabelPlaces {
public:
    explicit LabelPlaces(const FigurePanel& panel) : x_(panel, true), y_(panel, false) {
        for (const FigureSeries& series : panel.series) {
            const bool symbols = series.style == FigureSeries::Style::symbols;
            for (const PlanePoint& point : series.points)
                if (const PlanePoint place = place_of(point); std::isfinite(place.x) && std::isfinite(place.y))
                    (symbols ? symbols_ : others_).push_back(place);
        }
    }

    PlanePoint place_of(const PlanePoint& point) const { return {x_(point.x), y_(point.y)}; }

    /// By how much the middle of a text is to be moved away from its point; none where it would lie on another one.
    std::optional<PlanePoint> shift_for(const PlanePoint& place, const std::string& text) {
        const double width = letter_width * static_cast<double>(text.size() + 1);
        const double beside = (width + symbol_width) / 2, above = (letter_height + symbol_height) / 2;
        const std::array<PlanePoint, 8> ways{
            {{1, 1}, {-1, 1}, {1, -1}, {-1, -1}, {0, 1.1}, {0, -1.1}, {1.1, 0}, {-1.1, 0}}};
        std::optional<PlanePoint> best;
        double least = std::numeric_limits<double>::infinity();
        for (const double distance : {1.0, 1.9, 2.8})
            for (const PlanePoint& way : ways) {
                const PlanePoint shift{way.x * beside * (distance > 1 ? 0.6 * distance : 1), way.y * above * distance};
                const Box box = box_around({place.x + shift.x, place.y + shift.y}, width, letter_height);
                const double cost = cost_of(box) + 4 * (distance - 1);
                if (cost < least) {
                    least = cost;
                    best = shift;
                }
            }
        if (best)
            taken_.push_back(box_around({place.x + best->x, place.y + best->y}, width, letter_height));
        return best;
    }

private:
    /// Infinite on another label and outside of the panel.
    double cost_of(const Box& box) const {
        if (box.left < -0.01 || box.right > 1.01 || box.low < -0.01 || box.high > 1.01 ||
            std::any_of(taken_.begin(), taken_.end(), [&](const Box& other) { return box.meets(other); }))
            return std::numeric_limits<double>::infinity();
        double cost = 0;
        for (const PlanePoint& symbol : symbols_)
            cost += box.meets(box_around(symbol, symbol_width, symbol_height)) ? 3 : 0;
        constexpr double most = 2; // a line beneath a label is not worse the more points it has
        double line = 0;
        for (const PlanePoint& point : others_)
            line = std::min(most, line + (box.holds(point) ? 0.5 : 0));
        return cost + line;
    }

    Scale x_, y_;
    std::vector<PlanePoint> symbols_, others_;
    std::vector<Box> taken_;
};

} // namespace

std::string label_commands(const FigurePanel& panel) {
    if (panel.labels.empty())
        return {};
    LabelPlaces places(panel);
    std::vector<FigureLabel> labels = panel.labels;
    // Those at the sides first, which have the least choice.
    const auto from_side = [&](const FigureLabel& label) {
        const double x = places.place_of(label.at).x;
        return std::min(x, 1 - x);
    };
    std::stable_sort(labels.begin(), labels.end(),
                     [&](const FigureLabel& a, const FigureLabel& b) { return from_side(a) < from_side(b); });
    std::string text;
    for (const FigureLabel& label : labels) {
        const PlanePoint place = places.place_of(label.at);
        if (!(place.x >= 0 && place.x <= 1 && place.y >= 0 && place.y <= 1))
            continue;
        if (const auto shift = places.shift_for(place, label.text))
            text += fmt::format(
                "set label \"{}\" at first {:.10g},{:.10g} center offset graph {:.4f},{:.4f} font ',8' tc rgb '{}' "
                "front\n",
                plain(label.text), label.at.x, label.at.y, shift->x, shift->y, colour_text(label.colour));
    }
    return text;
}

} // namespace graze
