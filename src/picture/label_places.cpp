#include "picture/label_places.hpp"

#include "picture/curve.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace graze {

namespace {

// In units of the height of a label.
constexpr double letters_beyond = 0.25, gap_at_mark = 0.1;
constexpr std::array<double, 14> distances{0, 0.1, 0.5, 0.8, 1.1, 1.4, 1.8, 2.3, 2.8, 3.4, 4, 4.7, 5.5, 6.5};
constexpr double led_from = 0.3; ///< least distance of a label from its symbol at which a leader line joins them
constexpr std::size_t tried_directions = 32;

constexpr double cost_of_distance = 3, cost_of_curve = 8, cost_of_crossing = 0.5, cost_of_side = 0.3;
constexpr double cost_of_any_curve = 35; ///< so large that a long leader is preferred to a label on a curve
constexpr std::size_t most_labels = 30, most_in_one = 3, most_listed = 40;
constexpr double room_of_label = 8; ///< area of a panel for each label, in areas of a label with four characters
// In units of the diameter of a symbol.
constexpr double as_one = 0.5;       ///< closer symbols cannot be distinguished: they have one label
constexpr double nearer = 0.2;       ///< margin by which a label is nearer to its own symbol than to others
constexpr double clear_of_led = 0.3; ///< least distance of a label with a leader from symbols of others

/// True when the line between two points intersects a box.
bool crosses(const PlanePoint& from, const PlanePoint& to, const Box& box) {
    return part_within(from, to, box).has_value();
}

bool lines_cross(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c, const PlanePoint& d) {
    const auto side = [](const PlanePoint& p, const PlanePoint& q, const PlanePoint& r) {
        return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    };
    return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

/// Raster of the squares of a panel that curves cross.
class CurveMap {
public:
    explicit CurveMap(const Box& frame)
        : frame_(frame), columns_(static_cast<std::size_t>(frame.width() / side) + 2),
          rows_(static_cast<std::size_t>(frame.height() / side) + 2), cells_(columns_ * rows_, false) {}

    void add(const PlanePoint& point) {
        if (frame_.holds(point))
            cells_[index(column(point.x), row(point.y))] = true;
    }
    void add_line(const PlanePoint& from, const PlanePoint& to) {
        if (!crosses(from, to, frame_))
            return;
        const auto steps = static_cast<std::size_t>(std::min(distance_of(from, to), 1e5) / (0.5 * side)) + 1;
        for (std::size_t i = 0; i <= steps; ++i)
            add(between(from, to, static_cast<double>(i) / static_cast<double>(steps)));
    }
    /// Fraction of a box's squares that curves cross.
    double share(const Box& box) const {
        const std::size_t left = column(box.left), right = column(box.right), low = row(box.low), high = row(box.high);
        std::size_t found = 0;
        for (std::size_t r = low; r <= high; ++r)
            for (std::size_t c = left; c <= right; ++c)
                found += cells_[index(c, r)] ? 1 : 0;
        return static_cast<double>(found) / static_cast<double>((right + 1 - left) * (high + 1 - low));
    }
    bool is_taken(const PlanePoint& point) const { return cells_[index(column(point.x), row(point.y))]; }

private:
    static constexpr double side = 2; ///< side of a square in points
    std::size_t column(double x) const {
        return static_cast<std::size_t>(std::clamp((x - frame_.left) / side, 0.0, static_cast<double>(columns_ - 1)));
    }
    std::size_t row(double y) const {
        return static_cast<std::size_t>(std::clamp((y - frame_.low) / side, 0.0, static_cast<double>(rows_ - 1)));
    }
    std::size_t index(std::size_t column, std::size_t row) const { return row * columns_ + column; }

    Box frame_;
    std::size_t columns_, rows_;
    std::vector<bool> cells_;
};

/// The labels of points whose symbols coincide, which are placed as one.
struct WantedLabel {
    std::vector<const FigureLabel*> labels; ///< lower ranks first; without duplicates
    std::size_t colour = 0;
    int rank = 0;
    PlanePoint point{};
};

/// The names of labels in a list under the panel.
std::vector<std::string> listed_names(const WantedLabel& wanted) {
    std::vector<std::string> names;
    for (const FigureLabel* label : wanted.labels)
        names.push_back(label->owner.empty() ? label->text : fmt::format("{} ({})", label->text, label->owner));
    return names;
}

/// The texts of the labels without duplicates; points of several curves may have the same text.
std::vector<std::string> texts_of(const WantedLabel& wanted) {
    std::vector<std::string> texts;
    for (const FigureLabel* label : wanted.labels)
        if (std::find(texts.begin(), texts.end(), label->text) == texts.end())
            texts.push_back(label->text);
    return texts;
}

/// Distance between a box and a point; 0 inside.
double distance_to(const Box& box, const PlanePoint& point) {
    return std::hypot(std::max({box.left - point.x, point.x - box.right, 0.0}),
                      std::max({box.low - point.y, point.y - box.high, 0.0}));
}

/// Search for the places of a panel's labels: each label takes the free place of least cost among candidates at 32
/// directions and 14 distances.
class LabelSearch {
public:
    LabelSearch(const FigurePanel& panel, const Box& frame, const PanelAxis& x, const PanelAxis& y, double font)
        : frame_(frame), x_(&x), y_(&y), font_(label_font(font)), mark_(mark_size(font)), height_(1.2 * font_),
          curves_(frame) {
        for (const FigureSeries& series : panel.series)
            add(series, panel);
        for (const double mark : panel.marks)
            curves_.add_line(place_of({mark, 0}, true), place_of({mark, 1}, true));
    }

    LabelPlaces find(const FigurePanel& panel) {
        std::vector<WantedLabel> wanted = wanted_of(panel);
        std::stable_sort(wanted.begin(), wanted.end(),
                         [](const WantedLabel& a, const WantedLabel& b) { return a.rank < b.rank; });
        const double room = frame_.width() * frame_.height() / (room_of_label * 2.8 * font_ * height_);
        const std::size_t most = std::min(most_labels, static_cast<std::size_t>(room));
        std::vector<std::string> omitted;
        for (const WantedLabel& one : wanted) {
            if (found_.labels.size() < most && place(one))
                continue;
            ++found_.omitted;
            const std::vector<std::string> names = listed_names(one);
            omitted.insert(omitted.end(), names.begin(), names.end());
        }
        list("without room for a label: ", std::move(omitted));
        return std::move(found_);
    }

private:
    PlanePoint place_of(const PlanePoint& point, bool vertical_share = false) const {
        return {frame_.left + x_->share(point.x) * frame_.width(),
                frame_.low + (vertical_share ? point.y : y_->share(point.y)) * frame_.height()};
    }

    void add(const FigureSeries& series, const FigurePanel& panel) {
        using Style = FigureSeries::Style;
        const bool symbols = series.style == Style::symbols || series.style == Style::circles;
        const bool joined = !symbols && series.style != Style::dots;
        bool begun = false;
        PlanePoint last{};
        for (const PlanePoint& point : smoothed(series.points, series.along, series.corners)) {
            if (!is_drawn(point, panel)) {
                begun = false;
                continue;
            }
            const PlanePoint here = place_of(point);
            if (symbols && frame_.holds(here))
                found_.marks.push_back(Box::around(here, mark_, mark_));
            curves_.add(here);
            if (joined && begun)
                curves_.add_line(last, here);
            last = here;
            begun = true;
        }
    }

    void list(const std::string& what, std::vector<std::string> names) {
        if (names.empty())
            return;
        std::string more;
        if (names.size() > most_listed) {
            more = fmt::format(", and {} more", names.size() - most_listed);
            names.resize(most_listed);
        }
        found_.notes.push_back(fmt::format("{}{}{}", what, fmt::join(names, ", "), more));
    }

    std::vector<WantedLabel> wanted_of(const FigurePanel& panel) const {
        std::vector<WantedLabel> wanted;
        for (const FigureLabel& label : panel.labels) {
            if (!is_drawn(label.at, panel) || label.text.empty())
                continue;
            const PlanePoint here = place_of(label.at);
            if (!frame_.holds(here))
                continue;
            const auto same = std::find_if(wanted.begin(), wanted.end(), [&](const WantedLabel& one) {
                return distance_of(here, one.point) < as_one * mark_;
            });
            if (same == wanted.end()) {
                wanted.push_back({{&label}, label.colour, label.rank, here});
                continue;
            }
            const bool known = std::any_of(same->labels.begin(), same->labels.end(), [&](const FigureLabel* other) {
                return other->text == label.text && other->owner == label.owner;
            });
            if (!known)
                same->labels.insert(label.rank < same->rank ? same->labels.begin() : same->labels.end(), &label);
            if (label.colour != same->colour) // a label of several curves is black
                same->colour = FigureSeries::black;
            same->rank = std::min(same->rank, label.rank);
        }
        return wanted;
    }

    /// Places one label. @return false if no candidate is free
    bool place(const WantedLabel& wanted) {
        PlacedLabel label;
        const std::vector<std::string> texts = texts_of(wanted);
        const bool keyed = texts.size() > most_in_one;
        label.text = keyed ? fmt::format("[{}]", keys_ + 1) : fmt::format("{}", fmt::join(texts, ", "));
        label.colour = wanted.colour;
        label.point = wanted.point;
        const double width = width_of(rich(label.text)) * font_ + letters_beyond * font_;
        const double radius = mark_ / 2 + gap_at_mark * height_;
        double least = std::numeric_limits<double>::infinity();
        PlacedLabel best;
        for (const double distance : distances)
            for (std::size_t d = 0; d < tried_directions; ++d) {
                // Directions to points on a square, from its upper right corner, the preferred place.
                const double angle = 2 * std::numbers::pi * (static_cast<double>(d) / tried_directions + 0.125);
                const double size = std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
                const PlanePoint direction{std::cos(angle) / size, std::sin(angle) / size};
                const double away = radius + distance * height_;
                label.box = Box::around({label.point.x + direction.x * (width / 2 + away),
                                         label.point.y + direction.y * (height_ / 2 + away)},
                                        width, height_);
                label.led = distance > led_from;
                lead(label, direction);
                const double cost =
                    cost_of_distance * distance + cost_of_side * static_cast<double>(d) / tried_directions;
                if (cost >= least || !is_free(label))
                    continue;
                if (const double all = cost + cost_of(label); all < least) {
                    least = all;
                    best = label;
                }
            }
        if (!std::isfinite(least))
            return false;
        found_.labels.push_back(best);
        if (keyed) {
            list(label.text + ": ", listed_names(wanted));
            ++keys_;
        }
        return true;
    }

    /// Sets the leader from the edge of the symbol to the nearest point of the box.
    void lead(PlacedLabel& label, const PlanePoint& direction) const {
        const Box& box = label.box;
        label.leader_end = {std::clamp(label.point.x, box.left, box.right),
                            std::clamp(label.point.y, box.low, box.high)};
        const PlanePoint to{label.leader_end.x - label.point.x, label.leader_end.y - label.point.y};
        const double length = std::max(std::hypot(to.x, to.y), 1e-9);
        label.leader_start = {label.point.x + to.x * mark_ / 2 / length, label.point.y + to.y * mark_ / 2 / length};
        if (length <= mark_ / 2)
            label.leader_start = {label.point.x + direction.x * mark_ / 2, label.point.y + direction.y * mark_ / 2};
    }

    bool is_free(const PlacedLabel& label) const {
        if (!frame_.grown(-1).holds(label.box))
            return false;
        for (const Box& mark : found_.marks)
            if (label.box.meets(mark) || seems_to_belong_to(label, mark))
                return false;
        return std::none_of(found_.labels.begin(), found_.labels.end(), [&](const PlacedLabel& other) {
            return label.box.meets(other.box) ||
                   (other.led && crosses(other.leader_start, other.leader_end, label.box.grown(0.5))) ||
                   (label.led && crosses(label.leader_start, label.leader_end, other.box.grown(0.5))) ||
                   (label.led && other.led &&
                    lines_cross(label.leader_start, label.leader_end, other.leader_start, other.leader_end));
        });
    }

    /// True when a reader could take the label for that of another symbol.
    bool seems_to_belong_to(const PlacedLabel& label, const Box& mark) const {
        const PlanePoint middle = mark.middle();
        if (distance_of(label.point, middle) < as_one * mark_)
            return false;
        const double away = distance_to(label.box, middle);
        if (!label.led)
            return away < distance_to(label.box, label.point) + nearer * mark_;
        return away < (0.5 + clear_of_led) * mark_ || crosses(label.leader_start, label.leader_end, mark);
    }

    double cost_of(const PlacedLabel& label) const {
        const double share = curves_.share(label.box);
        double cost = share > 0 ? cost_of_any_curve + cost_of_curve * std::min(1.0, 4 * share) : 0;
        if (!label.led)
            return cost;
        constexpr int parts = 8;
        for (int i = 2; i < parts; ++i)
            if (curves_.is_taken(between(label.leader_start, label.leader_end, static_cast<double>(i) / parts)))
                cost += cost_of_crossing;
        return cost;
    }

    Box frame_;
    const PanelAxis *x_, *y_;
    double font_, mark_, height_;
    CurveMap curves_;
    std::size_t keys_ = 0; ///< number of references to lists of names
    LabelPlaces found_;
};

} // namespace

double mark_size(double font) {
    return 0.55 * font;
}

double label_font(double font) {
    return 0.85 * font;
}

LabelPlaces place_labels(const FigurePanel& panel, const Box& frame, const PanelAxis& x, const PanelAxis& y,
                         double font) {
    return LabelSearch(panel, frame, x, y, font).find(panel);
}

} // namespace graze
