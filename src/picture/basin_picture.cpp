#include "base/special_numbers.hpp"
#include "picture/grid_axis.hpp"
#include "picture/picture_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace graze {

namespace {

/// Attractors are distinguished by their kind. Orbits and equilibria, which Newton's method has computed to many
/// digits, are distinguished also by the mean, least and greatest of every value, which do not depend on the first
/// point of an orbit.
struct KnownAttractor {
    std::string kind;
    std::vector<double> marks;              ///< mean, least and greatest of each value along the orbit
    std::optional<std::size_t> first_point; ///< its number, if Newton's method has computed it
};

std::string kind_text(const ResultFile::Rows& row) {
    std::string text = row.text(0);
    if (text == "periodic")
        text = fmt::format("period {}{}{}{}", row.text(1), row.is_null(3) || row.integer(3) == 0 ? "" : ", symmetric",
                           row.text(2).empty() ? "" : ", ", row.text(2));
    return text;
}

/// The kind of an attractor in maps, which do not distinguish attractors of the same kind.
std::string short_kind(const ResultFile::Rows& row) {
    return row.text(0) == name_of(Label::periodic) ? fmt::format("period {}", row.text(1)) : row.text(0);
}

/// Replaces dots on a grid by filled cells; dots that do not form a grid stay.
void fill_cells(FigurePanel& panel) {
    std::vector<double> xs, ys;
    for (const FigureSeries& series : panel.series)
        for (const PlanePoint& point : series.points) {
            xs.push_back(point.x);
            ys.push_back(point.y);
        }
    const GridAxis x(xs, panel.logarithmic_x), y(ys, panel.logarithmic_y);
    if (x.size() < 2 || y.size() < 2 || 2 * xs.size() < x.size() * y.size())
        return;
    for (FigureSeries& series : panel.series) {
        struct GridCell {
            std::size_t row, column, number;
            auto operator<=>(const GridCell&) const = default;
        };
        std::vector<GridCell> cells;
        for (std::size_t i = 0; i < series.points.size(); ++i)
            cells.push_back({y.index(series.points[i].y), x.index(series.points[i].x), series.numbers[i]});
        std::sort(cells.begin(), cells.end());
        for (std::size_t i = 0; i < cells.size(); ++i) {
            series.cells.push_back({x.edge_before(cells[i].column), x.edge_behind(cells[i].column),
                                    y.edge_before(cells[i].row), y.edge_behind(cells[i].row)});
            series.numbers[i] = cells[i].number;
        }
        series.style = FigureSeries::Style::cells;
        series.points.clear();
    }
}

/// Draws one direction of a run.
class BasinPanel {
public:
    BasinPanel(const StudyPicture& picture, const StoredRun& run)
        : picture_(&picture), run_(&run), map_(picture.kind == "map"), x_(first_coordinate(picture, run)),
          y_(picture.y.empty() ? run.record.coordinates[1].name : picture.y.front()) {}

    FigurePanel drawn(const std::string& direction, Table& table) {
        panel_ = panel_of(*picture_, *run_, x_, y_, 0);
        const std::vector<double> spreads = map_ ? std::vector<double>{} : spreads_of_attractors(direction);
        auto rows = run_->rows({.columns = {"label", "period", "signature", "symmetric", "number"},
                                .quantities = {x_, y_},
                                .statistics = map_ ? std::vector<std::string>{} : run_->value_names(),
                                .directions = {direction}});
        while (rows.next()) {
            KnownAttractor one{map_ ? short_kind(rows) : kind_text(rows), {}, {}};
            one.marks.resize(map_ ? 0 : 3 * run_->record.values.size());
            if (rows.text(0) == name_of(Label::periodic) || rows.text(0) == name_of(Label::equilibrium)) {
                one.first_point = static_cast<std::size_t>(rows.integer(4));
                for (std::size_t v = 0; v < one.marks.size(); ++v)
                    one.marks[v] = rows.number(7 + v);
            }
            series_of(std::move(one), rows.text(0), spreads)
                .add({rows.number(5), rows.number(6)}, static_cast<std::size_t>(rows.integer(4)));
        }
        name_all(table);
        fill_cells(panel_);
        if (!map_)
            mark_attractors();
        return std::move(panel_);
    }

private:
    /// Ranges of the values over all attractors, as the scale of their differences; unbounded motions do not count.
    std::vector<double> spreads_of_attractors(const std::string& direction) const {
        const std::size_t values = run_->record.values.size();
        constexpr double rounding = 1e-6; // for values that are nearly constant
        std::vector<double> least(values, infinity), greatest(values, -infinity), spreads;
        auto rows = run_->rows({.columns = {"label"}, .statistics = run_->value_names(), .directions = {direction}});
        while (rows.next())
            for (std::size_t v = 0; v < values && drawn_as(rows.text(0)) == DrawnAs::attractor; ++v) {
                least[v] = std::min(least[v], rows.number(2 + 3 * v));
                greatest[v] = std::max(greatest[v], rows.number(3 + 3 * v));
            }
        for (std::size_t v = 0; v < values; ++v)
            spreads.push_back(std::max(0.0, greatest[v] - least[v]) +
                              rounding * std::max(std::abs(least[v]), std::abs(greatest[v])));
        return spreads;
    }

    /// The series of an attractor, a new one if it is not known yet. @param spreads ranges of the values
    FigureSeries& series_of(KnownAttractor one, const std::string& label, const std::vector<double>& spreads) {
        constexpr double same_orbit = 1e-6;
        for (std::size_t i = 0; i < known_.size(); ++i) {
            bool same = known_[i].kind == one.kind;
            for (std::size_t v = 0; same && v < one.marks.size(); ++v)
                same = std::abs(one.marks[v] - known_[i].marks[v]) <= same_orbit * spreads[v / 3];
            if (same)
                return panel_.series[i];
        }
        known_.push_back(std::move(one));
        const bool settled = drawn_as(label) == DrawnAs::attractor;
        // The symbol and hatch of others show that they are no attractors, and their label.
        panel_.series.push_back(settled ? FigureSeries{.colour = attractors_} : series_of_label(label));
        panel_.series.back().run = run_->record.name;
        attractors_ += settled ? 1 : 0;
        return panel_.series.back();
    }

    void name_all(Table& table) {
        for (std::size_t i = 0; i < panel_.series.size(); ++i) {
            const std::size_t count = panel_.series[i].points.size();
            panel_.series[i].title = fmt::format("{} ({})", shown_name(*picture_, known_[i].kind), count);
            table.add(static_cast<double>(i + 1), known_[i].kind, static_cast<double>(count));
        }
    }

    /// Marks the samples of each attractor with its number in the table, if both axes are sampled values.
    void mark_attractors() {
        if (!run_->has_value(x_) || !run_->has_value(y_))
            return;
        for (std::size_t i = 0; i < known_.size(); ++i) {
            if (!known_[i].first_point)
                continue;
            const auto point = run_->file.point(run_->record.name, *known_[i].first_point);
            if (!point || run_->record.samplings.empty())
                continue;
            const std::string sampling = shown_samplings(*picture_, *run_).front();
            const std::vector<double> xs = samples_of(*point, *run_, x_, sampling, nullptr),
                                      ys = samples_of(*point, *run_, y_, sampling, nullptr);
            FigureSeries marks{"", FigureSeries::Style::symbols, FigureSeries::black};
            marks.run = run_->record.name;
            for (std::size_t k = 0; k < xs.size(); ++k) {
                marks.add({xs[k], ys[k]}, point->number);
                panel_.labels.push_back(
                    {{xs[k], ys[k]}, fmt::format("{}", i + 1), FigureSeries::black, 0, "", marks.run, point->number});
            }
            panel_.series.push_back(std::move(marks));
        }
    }

    const StudyPicture* picture_;
    const StoredRun* run_;
    bool map_;
    std::string x_, y_;
    FigurePanel panel_;
    std::vector<KnownAttractor> known_; ///< in the order of the panel's series
    std::size_t attractors_ = 0;
};

} // namespace

ResultPicture basin_picture(const StudyPicture& picture, const ResultFile& file) {
    const StoredRun run(file, picture.runs.front(), picture.place);
    if (run.record.coordinates.size() < 2)
        throw InputError(picture.place, fmt::format("run '{}' varies fewer than two things", run.record.name),
                         "draw a bifurcation diagram or a scatter plot of it");
    ResultPicture result;
    result.table = Table({{picture.kind == "map" ? "kind_number" : "attractor", ""}, {"kind", ""}, {"points", ""}});
    const std::vector<std::string> directions = picture.directions.empty() ? run.record.directions : picture.directions;
    for (const std::string& direction : directions) {
        result.figure.panels.push_back(BasinPanel(picture, run).drawn(direction, result.table));
        if (directions.size() > 1)
            result.figure.panels.back().title =
                fmt::format("{} {} {}", panel_letter(result.figure.panels.size() - 1),
                            shown_name(picture, run.record.coordinates.front().name), direction);
    }
    result.figure.columns = directions.size();
    return result;
}

} // namespace graze
