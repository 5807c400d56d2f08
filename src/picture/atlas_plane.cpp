#include "graze/atlas/atlas_tables.hpp"
#include "graze/base/input_error.hpp"
#include "picture/atlas_drawing.hpp"
#include "picture/attractor_classes.hpp"
#include "picture/branch_lines.hpp"
#include "picture/curve_names.hpp"
#include "picture/grid_axis.hpp"
#include "picture/picture_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace graze {

namespace {

/// The colour of curves of a type; dark, since they lie on tints.
std::size_t colour_of(PointType type) {
    constexpr std::array<std::pair<PointType, std::size_t>, 8> colours{{{PointType::grazing, FigureSeries::black},
                                                                        {PointType::fold, 12},
                                                                        {PointType::flip, 0},
                                                                        {PointType::torus, 14},
                                                                        {PointType::asymmetry, 13},
                                                                        {PointType::branch_point, 6},
                                                                        {PointType::vanishing, 8},
                                                                        {PointType::two_events, 9}}};
    for (const auto& [one, colour] : colours)
        if (one == type)
            return colour;
    return 1;
}

class AtlasPlane {
public:
    AtlasPlane(const StudyPicture& picture, const DrawnAtlas& atlas)
        : picture_(&picture), atlas_(&atlas), findings_(&atlas.findings), classes_(atlas.motions, {}),
          panel_(panel_of(picture, atlas.run, findings_->axes[0].name, findings_->axes[1].name, 0)) {
        for (auto [axis, range] : {std::pair(0, &panel_.x_range), std::pair(1, &panel_.y_range)})
            if (!*range)
                *range = shown_range(findings_->axes[static_cast<std::size_t>(axis)]);
    }

    ResultPicture drawn() {
        add_regions();
        read_curves();
        for (const DrawnBranch& curve : curves_)
            add_lines(panel_, curve, 0);
        add_points();
        add_names();
        add_legend();
        ResultPicture made;
        made.figure.panels.push_back(std::move(panel_));
        made.table = curves_and_points(*findings_);
        return made;
    }

private:
    /// A cell of the grid, and what the motions of both directions do there.
    struct Region {
        const AtlasMotion *up = nullptr, *down = nullptr;
    };

    void add_regions() {
        std::vector<double> values;
        std::map<std::pair<std::size_t, double>, Region> regions; // by row and value, so that neighbours follow
        for (std::size_t m = 0; m < atlas_->motions.size(); ++m) {
            const AtlasMotion& motion = atlas_->motions[m];
            values.push_back(motion.value);
            Region& region = regions[{motion.row, motion.value}];
            (atlas_->directions[m] == "down" ? region.down : region.up) = &motion;
        }
        const GridAxis x(values, panel_.logarithmic_x), y(findings_->rows, panel_.logarithmic_y);
        for (const AttractorClass& one : classes_.all()) {
            FigureSeries series{shown_name(*picture_, one.name), FigureSeries::Style::cells};
            series.colour = one.colour >= FigureSeries::grey ? one.colour : FigureSeries::pale + one.colour;
            series.hatch = one.hatch;
            series.run = findings_->run;
            panel_.series.push_back(std::move(series));
        }
        const auto add = [&](const PlaneBox& box, const AtlasMotion& motion) {
            FigureSeries& series = panel_.series[classes_.index_of(motion)];
            series.cells.push_back(box);
            series.numbers.push_back(motion.number);
        };
        bool split = false;
        for (const auto& [place, region] : regions) {
            const PlaneBox box = cell(x, x.index(place.second), y, y.index(findings_->rows[place.first]));
            if (!region.up || !region.down || classes_.index_of(*region.up) == classes_.index_of(*region.down)) {
                add(box, region.up ? *region.up : *region.down);
                continue;
            }
            split = true;
            PlaneBox lower = box, upper = box;
            lower.high = upper.low = y.middle(box.low, box.high);
            add(lower, *region.up);
            add(upper, *region.down);
        }
        if (split)
            panel_.notes.push_back(fmt::format("halves of a region: lower half, as {0} rises; upper half, as {0} falls",
                                               findings_->axes[0].name));
    }

    /// Cells do not reach beyond the parameters of the atlas, unless there is a single value.
    static PlaneBox cell(const GridAxis& x, std::size_t column, const GridAxis& y, std::size_t row) {
        const auto [left, right] = x.clipped(column);
        const auto [low, high] = y.clipped(row);
        return {left, right, low, high};
    }

    void read_curves() {
        StudyPicture all = *picture_;
        all.directions.clear(); // which are those of motions
        all.points.clear();
        for (const AtlasCurve& curve : findings_->curves) {
            const StoredRun run(atlas_->run.file, curve.run, picture_->place);
            DrawnBranch& drawn = curves_.emplace_back();
            drawn.run = curve.run;
            drawn.points = drawn_points(run, all, findings_->axes[0].name, {findings_->axes[1].name});
            drawn.kept = curve.type;
            drawn.colour = colour_of(curve.type);
        }
    }

    /// Where a point of the atlas is stored: its run, and its number there; of those that are drawn, if possible.
    std::pair<std::string, std::size_t> stored(const AtlasPoint& point) const {
        for (const DrawnBranch& curve : curves_)
            for (const DrawnPoint& one : curve.points)
                if (!one.label.empty() &&
                    std::ranges::find(point.found, curve.run + ":" + one.label) != point.found.end())
                    return {curve.run, one.number};
        return {};
    }

    static bool is_shown(const AtlasPoint& point) { return !point.on_row && kind_of(point.types.front()).mark != 0; }

    // Where not all names fit: those of the longest curves come first, then points with types of their own, points
    // where curves meet, other curves, other points.
    static constexpr int of_longest_curves = 0, of_own_type = 1, of_meeting = 2, of_other_curve = 3, of_other_point = 4;
    static constexpr std::size_t longest = 15; ///< half as many as a panel has labels at most

    static int rank_of(const AtlasPoint& point) {
        return point.types.size() > 1                   ? of_meeting
               : point.types.front() >= PointType::cusp ? of_own_type
                                                        : of_other_point;
    }

    void add_points() {
        std::map<std::pair<std::string, int>, FigureSeries> symbols; // by run and symbol
        for (const AtlasPoint& point : findings_->points) {
            if (!is_shown(point))
                continue;
            const PlanePoint at{point.at[0], point.at[1]};
            const auto [run, number] = stored(point);
            const int symbol = kind_of(point.types.front()).mark;
            FigureSeries& series = symbols[{run, symbol}];
            series.style = FigureSeries::Style::symbols;
            series.colour = FigureSeries::black;
            series.symbol = symbol;
            series.run = run;
            series.points.push_back(at);
            if (!run.empty())
                series.numbers.push_back(number);
            panel_.labels.push_back({at, point.name, FigureSeries::black, rank_of(point), "", run, number});
        }
        for (auto& [key, series] : symbols)
            panel_.series.push_back(std::move(series));
    }

    void add_names() {
        struct Named {
            const AtlasCurve* curve;
            const DrawnBranch* drawn;
            double length;
        };
        std::vector<Named> named;
        const Box view{panel_.x_range->first, panel_.y_range->first, panel_.x_range->second, panel_.y_range->second};
        for (std::size_t c = 0; c < curves_.size(); ++c)
            named.push_back({&findings_->curves[c], &curves_[c], extent_of(findings_->curves[c], view)});
        std::ranges::stable_sort(named, std::greater{}, &Named::length); // the long ones choose first
        std::vector<std::vector<Polyline>> lines;
        for (const Named& one : named) {
            Polyline& points = lines.emplace_back().emplace_back();
            for (const auto& [x, y] : one.curve->line)
                points.push_back({x, y});
        }
        std::vector<PlanePoint> avoided;
        for (const FigureLabel& label : panel_.labels)
            avoided.push_back(label.at);
        const auto places = places_of_names(lines, avoided, view);
        for (std::size_t c = 0; c < named.size(); ++c)
            if (places[c])
                panel_.labels.push_back({*places[c], named[c].curve->name, named[c].drawn->colour,
                                         c < longest ? of_longest_curves : of_other_curve});
    }

    /// The sum of the extents of a curve in both directions, in widths of the view.
    static double extent_of(const AtlasCurve& curve, const Box& view) {
        Extent x, y;
        for (const auto& [one, other] : curve.line) {
            x.add(one);
            y.add(other);
        }
        return x.span() / view.width() + y.span() / view.height();
    }

    void add_legend() {
        std::set<PointType> types;
        for (const AtlasCurve& curve : findings_->curves)
            types.insert(curve.type);
        for (const PointType type : types)
            add_to_legend(panel_, fmt::format("curves {}: {}", short_name(type), name_of(type)), style_of(type),
                          colour_of(type));
        add_looks(panel_, curves_, FigureSeries::black);
        std::map<PointType, std::string> marked; // by the type that chooses the symbol
        for (const AtlasPoint& point : findings_->points) {
            if (!is_shown(point))
                continue;
            const PointType type = point.types.front();
            // Names such as SN+GR1 tell which other types there are.
            if (point.types.size() == 1)
                marked[type] = fmt::format("{}: {}", short_name(type), name_of(type));
            else
                marked.try_emplace(type, fmt::format("{}+...: {} and others", short_name(type), name_of(type)));
        }
        for (const auto& [type, words] : marked)
            add_to_legend(panel_, words, FigureSeries::Style::symbols, FigureSeries::black, kind_of(type).mark);
    }

    const StudyPicture* picture_;
    const DrawnAtlas* atlas_;
    const AtlasFindings* findings_;
    AttractorClasses classes_;
    FigurePanel panel_;
    std::vector<DrawnBranch> curves_; ///< in the order of the findings
};

} // namespace

ResultPicture atlas_plane(const StudyPicture& picture, const DrawnAtlas& atlas) {
    if (const std::string& y = atlas.findings.axes[1].name; !picture.y.empty() && picture.y != std::vector{y})
        throw InputError(picture.place, fmt::format("the y axis of an atlas is its second parameter, '{}'", y),
                         "leave y out");
    return AtlasPlane(picture, atlas).drawn();
}

} // namespace graze
