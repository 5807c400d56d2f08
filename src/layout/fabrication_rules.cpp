#include "graze/layout/fabrication_rules.hpp"

#include "graze/base/input_errors.hpp"
#include "layout/free_way.hpp"
#include "layout/grid_lengths.hpp"
#include "layout/mask_outlines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

constexpr std::size_t most_places = 5; // listed places of one rule; further ones are counted

class RuleCheck {
public:
    RuleCheck(const DeviceFile& file, const Layout& layout, const DrawnDevice& device)
        : file_(&file), limits_(&file.rules), drawing_(&device.drawing), device_(device.cell) {
        for (const PlacedShape& shape : flattened(layout.library, device.cell)) {
            const int mask = shape.layer.layer;
            if (mask == mask_layers::front.layer)
                front_.push_back(shape.polygon);
            else if (mask == mask_layers::back.layer)
                back_.push_back(shape.polygon);
        }
    }

    std::vector<RuleFinding> find() {
        front_places_ = facing_edges(mask_edges(front_));
        back_places_ = facing_edges(mask_edges(back_));
        add_widths("smallest_line", limits_->smallest_line, false);
        add_widths("smallest_gap", limits_->smallest_gap, true);
        add_etched_widths("smallest_etched_line", limits_->smallest_etched_line, false);
        add_etched_widths("smallest_etched_gap", limits_->smallest_etched_gap, true);
        add_aspects();
        add_overlap();
        add_undercut();
        add_motion();
        add_free_ways();
        return std::move(findings_);
    }

private:
    /// A place with its value; lower is worse.
    struct Measured {
        double value;
        std::string part;
        GridPoint at;
    };

    void add(const std::string& rule, double limit, const char* unit, bool at_least, std::vector<Measured> places) {
        if (!std::isfinite(limit))
            return;
        std::stable_sort(places.begin(), places.end(), [&](const Measured& a, const Measured& b) {
            return at_least ? a.value < b.value : a.value > b.value;
        });
        std::size_t count = 0;
        for (const Measured& one : places) {
            RuleFinding finding{rule,   one.value, limit, unit,         at_least, one.part,
                                one.at, device_,   false, key_of(rule), "",       0};
            if (!tell(std::move(finding), count))
                break;
        }
    }
    /// Adds a finding: the worst place of a rule always, others if they break the rule, up to a number.
    /// @param count number of findings of the rule so far @return whether more may be added
    bool tell(RuleFinding finding, std::size_t& count) {
        if (count > 0 && finding.holds())
            return false;
        if (++count > most_places)
            ++findings_.back().more;
        else
            findings_.push_back(std::move(finding));
        return true;
    }

    /// Key that is responsible: the rule, or the process where it shifts all widths.
    std::string key_of(const std::string& rule) const {
        if (!rule.starts_with("smallest_etched"))
            return "rules." + rule;
        const ProcessConditions& conditions = file_->conditions;
        const double by_taper = conditions.wall().slope * file_->process.layer_thickness();
        return std::abs(by_taper) > std::abs(conditions.bias) ? "process.taper" : "process.bias";
    }

    static bool within_any(const std::vector<GridPolygon>& polygons, GridPoint point) {
        return std::any_of(polygons.begin(), polygons.end(),
                           [&](const GridPolygon& one) { return contains(one, point); });
    }

    /// Name of the part of the front at a point.
    std::string part_at(GridPoint point) const {
        const auto in_any = [&](const std::vector<GridBox>& of_flexure) {
            return std::any_of(of_flexure.begin(), of_flexure.end(),
                               [&](const GridBox& box) { return drawing_->has(box, point); });
        };
        if (in_any(drawing_->flexure.beams))
            return "a beam";
        if (in_any(drawing_->flexure.trusses))
            return "a truss";
        if (contains(drawing_->mass, point))
            return "the mass";
        if (contains(drawing_->electrode, point))
            return "the fixed electrode";
        return within_any(drawing_->stops, point) ? "a stop" : "the frame";
    }

    /// A point just beyond an edge, on its other side.
    static GridPoint beyond(GridPoint edge, GridPoint from) {
        const auto step = [](std::int64_t d) { return d > 0 ? 1 : d < 0 ? -1 : 0; };
        return {edge.x + step(edge.x - from.x), edge.y + step(edge.y - from.y)};
    }

    std::string part_of(const FacingEdges& place, bool on_front) const {
        if (!on_front)
            return place.etched ? "a chamber" : "what remains between chambers";
        if (!place.etched)
            return part_at(place.middle());
        const std::string one = part_at(beyond(place.first, place.second)),
                          other = part_at(beyond(place.second, place.first));
        return one == other ? "the trench within " + one : fmt::format("the trench between {} and {}", one, other);
    }

    void add_widths(const char* rule, double limit, bool etched) {
        std::vector<Measured> places;
        for (const bool on_front : {true, false})
            for (const FacingEdges& place : on_front ? front_places_ : back_places_)
                if (place.etched == etched)
                    places.push_back({micrometres(place.distance), part_of(place, on_front), place.middle()});
        add(rule, limit, "um", true, std::move(places));
    }

    double depth_of(const FacingEdges& place, bool on_front) const {
        const ProcessData& process = file_->process;
        if (!on_front)
            return process.chamber_depth;
        return within_any(back_, place.middle()) ? process.layer_thickness() : process.wafer_thickness;
    }

    /// Adds widths of lines and trenches of the front after the etch.
    void add_etched_widths(const char* rule, double limit, bool etched) {
        std::vector<Measured> places;
        const EtchedWall wall = file_->conditions.wall();
        for (const FacingEdges& place : front_places_)
            if (place.etched == etched) {
                const double drawn = micrometres(place.distance), depth = depth_of(place, true);
                const EtchedWidth width = etched ? etched_trench(wall, drawn, depth) : etched_line(wall, drawn, depth);
                const char* end = width.top < width.bottom ? " at its top" : " at its bottom";
                places.push_back(
                    {width.least(), part_of(place, true) + (width.top == width.bottom ? "" : end), place.middle()});
            }
        add(rule, limit, "um", true, std::move(places));
    }

    void add_aspects() {
        std::vector<Measured> places;
        for (const bool on_front : {true, false})
            for (const FacingEdges& place : on_front ? front_places_ : back_places_)
                if (place.etched)
                    places.push_back({depth_of(place, on_front) / micrometres(place.distance), part_of(place, on_front),
                                      place.middle()});
        add("largest_aspect", limits_->largest_aspect, "", false, std::move(places));
    }

    /// Distances of a polygon's edges within an area from its outline; negative if a corner is outside.
    std::vector<Measured> margins(const GridPolygon& inner, const std::vector<GridPolygon>& area,
                                  const std::string& part) const {
        std::vector<Measured> places;
        const std::vector<MaskEdge> outline = mask_edges(area);
        for (const MaskEdge& edge : mask_edges(std::span(&inner, 1)))
            for (const MaskEdge& wall : outline) {
                // Parallel edges that overlap, with the area beyond the wall on the polygon's side.
                const std::int64_t low = std::max(edge.from, wall.from), high = std::min(edge.to, wall.to);
                const std::int64_t distance = edge.side * (edge.at - wall.at), along = (low + high) / 2;
                if (edge.upright != wall.upright || edge.side != wall.side || low >= high || distance < 0)
                    continue;
                places.push_back({micrometres(distance), part,
                                  edge.upright ? GridPoint{edge.at, along} : GridPoint{along, edge.at}});
            }
        for (const GridPoint& corner : inner)
            if (!within_any(area, corner))
                places.push_back({-distance_of(corner, outline), part + ", which reaches out of it", corner});
        return places;
    }

    /// Distance from the nearest edge.
    static double distance_of(GridPoint point, const std::vector<MaskEdge>& edges) {
        double least = std::numeric_limits<double>::infinity();
        for (const MaskEdge& edge : edges) {
            const std::int64_t across = edge.upright ? point.x : point.y, along = edge.upright ? point.y : point.x;
            const std::int64_t aside = along - std::clamp(along, edge.from, edge.to);
            least = std::min(least, std::hypot(micrometres(across - edge.at), micrometres(aside)));
        }
        return least;
    }

    void add_overlap() {
        std::vector<Measured> places = margins(drawing_->mass, back_, "the mass");
        const auto add_boxes = [&](const std::vector<GridBox>& boxes, const char* part) {
            for (const GridBox& box : boxes)
                for (Measured& one : margins(polygon_of(box), back_, part))
                    places.push_back(std::move(one));
        };
        add_boxes(drawing_->beams(), "a beam");
        add_boxes(drawing_->trusses(), "a truss");
        add("chamber_overlap", limits_->chamber_overlap, "um", true, std::move(places));
    }

    void add_undercut() {
        add("undercut", limits_->undercut, "um", true,
            margins(drawing_->base, {drawing_->electrode}, "the fixed electrode's base"));
    }

    /// Whether the etch removes a part completely: then there is no model, and its rule says so.
    bool is_etched_away() const {
        return std::any_of(findings_.begin(), findings_.end(), [](const RuleFinding& one) {
            return one.rule.starts_with("smallest_etched") && one.value <= 0 && !one.holds();
        });
    }

    void add_motion() {
        if (is_etched_away())
            return;
        const LumpedModel lumped = lumped_model_of(*drawing_, *file_);
        const GridPoint stop = bounding_box(drawing_->stops.front()).middle();
        const GridBox beam = drawing_->beams().front();
        const GridPoint at_beam{beam.middle().x, beam.top};
        add("largest_stop_share", limits_->largest_stop_share, "", false,
            {{lumped.stop / lumped.closure, "the stops, by the way until the electrodes touch", stop}});
        constexpr double mega = 1e6;
        add("largest_stress", limits_->largest_stress, "MPa", false,
            {{lumped.stress_per_travel * lumped.stop / mega, "a beam, when the mass is at the stops", at_beam},
             {lumped.stress_per_travel * lumped.closure / mega, "a beam, when the electrodes touch", at_beam}});
        add("largest_squeeze", limits_->largest_squeeze, "", false,
            {{lumped.squeeze, "the gas between the electrodes", bounding_box(drawing_->electrode).middle()}});
    }

    /// Adds the worst place in either direction, and all others where the mass is blocked.
    void add_free_ways() {
        std::vector<FreeWay> ways =
            free_ways(*drawing_, front_, file_->conditions.wall(), file_->process.layer_thickness());
        std::stable_sort(ways.begin(), ways.end(), [](const FreeWay& a, const FreeWay& b) { return a.way < b.way; });
        for (const bool to_stops : {true, false}) {
            const char* aim = to_stops ? "the stops" : "the fixed electrode";
            std::size_t count = 0;
            for (const FreeWay& one : ways) {
                if (one.to_stops != to_stops)
                    continue;
                RuleFinding finding{.rule = "free_way",
                                    .value = one.way,
                                    .limit = one.needed,
                                    .unit = "um",
                                    .at_least = true,
                                    .part = fmt::format("the mass on its way to {}, until {}", aim, one.part),
                                    .at = one.at,
                                    .device = device_,
                                    .beyond = true,
                                    .key = "device." + one.key,
                                    .remedy = fmt::format("give a greater {}, or a smaller {}: the model has no "
                                                          "contacts with other parts",
                                                          one.key, to_stops ? "stop_gap" : "gap")};
                if (!tell(std::move(finding), count))
                    break;
            }
        }
    }

    const DeviceFile* file_;
    const RuleLimits* limits_;
    const DeviceDrawing* drawing_;
    std::string device_;
    std::vector<GridPolygon> front_, back_;
    std::vector<FacingEdges> front_places_, back_places_;
    std::vector<RuleFinding> findings_;
};

} // namespace

std::string RuleFinding::text() const {
    const std::string in = unit.empty() ? "" : " " + unit;
    const char* bound = beyond ? "more than" : at_least ? "at least" : "at most";
    return fmt::format("{} is {:.6g}{} for {}, at ({:.3f}, {:.3f}) um of {}, where {} {:.6g}{} is {}{}", rule, value,
                       in, part, micrometres(at.x), micrometres(at.y), device, bound, limit, in,
                       beyond ? "needed" : "allowed",
                       more == 0 ? std::string() : fmt::format(" (and at {} more places)", more));
}

std::vector<RuleFinding> rule_findings(const DeviceFile& file, const Layout& layout, const DrawnDevice& device) {
    return RuleCheck(file, layout, device).find();
}

std::vector<RuleFinding> rule_findings(const DeviceFile& file, const Layout& layout) {
    std::vector<RuleFinding> all;
    for (const DrawnDevice& device : layout.devices)
        for (RuleFinding& one : rule_findings(file, layout, device))
            all.push_back(std::move(one));
    return all;
}

void require_rules(const DeviceFile& file, const std::vector<RuleFinding>& findings) {
    Mistakes mistakes;
    for (const RuleFinding& one : findings)
        mistakes.attempt([&] {
            if (!one.holds())
                throw InputError(
                    file.place(one.key), "rule " + one.text(),
                    one.remedy.empty()
                        ? fmt::format("change the dimension, or {} in [rules] (false: none), or draw it all "
                                      "the same",
                                      one.rule)
                        : one.remedy);
        });
    mistakes.throw_noted();
}

} // namespace graze
