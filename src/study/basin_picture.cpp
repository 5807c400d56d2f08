#include "study/picture_kinds.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

namespace {

/// Tells attractors apart: by what they are and, for orbits and equilibria, which Newton's method has computed to many
/// digits, by the mean, least and greatest of every value along them, which do not depend on where along the orbit one
/// begins.
class AttractorNames {
public:
    /// @param marks of the orbit, three for each value; @param spreads of the values
    std::size_t index(const std::string& kind, const std::vector<double>& marks, const std::vector<double>& spreads) {
        constexpr double same_orbit = 1e-6;
        for (std::size_t i = 0; i < known_.size(); ++i) {
            bool same = known_[i].kind == kind;
            for (std::size_t v = 0; same && v < marks.size(); ++v)
                same = std::abs(marks[v] - known_[i].marks[v]) <= same_orbit * spreads[v / 3];
            if (same)
                return i;
        }
        known_.push_back({kind, marks});
        return known_.size() - 1;
    }
    const std::string& kind(std::size_t index) const { return known_[index].kind; }
    std::size_t count() const { return known_.size(); }

private:
    struct Known {
        std::string kind;
        std::vector<double> marks;
    };
    std::vector<Known> known_;
};

std::string kind_text(const ResultFile::Rows& row) {
    std::string text = row.text(0);
    if (text == "periodic")
        text = fmt::format("period {}{}{}{}", row.text(1), row.is_null(3) || row.integer(3) == 0 ? "" : ", symmetric",
                           row.text(2).empty() ? "" : ", ", row.text(2));
    return text;
}

/// Motions that do not last are grey or black, so that attractors stand out.
std::size_t colour_of(const std::string& kind, std::size_t attractors) {
    if (kind == name_of(Label::singular) || kind == name_of(Label::failed))
        return FigureSeries::black;
    if (kind == name_of(Label::escaped) || kind == name_of(Label::ended) || kind == name_of(Label::chattering) ||
        kind == name_of(Label::unsettled) || kind == name_of(Label::unbounded))
        return FigureSeries::grey;
    return attractors;
}

} // namespace

ResultPicture basin_picture(const StudyPicture& picture, const ResultFile& file) {
    const StoredRun run(file, picture.runs.front(), picture.place);
    if (run.record.coordinates.size() < 2)
        throw InputError(picture.place, fmt::format("run '{}' varies fewer than two things", run.record.name),
                         "draw a bifurcation diagram or a scatter plot of it");
    const std::string x = first_coordinate(picture, run);
    const std::string y = picture.y.empty() ? run.record.coordinates[1].name : picture.y.front();
    const std::vector<double> spreads = run.value_spreads();
    auto rows = run.rows({.columns = {"label", "period", "signature", "symmetric"},
                          .quantities = {x, y},
                          .statistics = run.value_names()});
    ResultPicture result;
    FigurePanel panel = panel_of(picture, x, run.unit(x), y, run.unit(y));
    AttractorNames names;
    std::size_t attractors = 0;
    while (rows.next()) {
        std::vector<double> marks(3 * run.record.values.size());
        const bool told_apart = rows.text(0) == name_of(Label::periodic) || rows.text(0) == name_of(Label::equilibrium);
        for (std::size_t v = 0; told_apart && v < marks.size(); ++v)
            marks[v] = rows.number(6 + v);
        const std::size_t index = names.index(kind_text(rows), marks, spreads);
        if (index >= panel.series.size()) {
            const std::size_t colour = colour_of(names.kind(index), attractors);
            attractors += colour == attractors ? 1 : 0;
            panel.series.push_back({"", FigureSeries::Style::dots, colour, {}});
        }
        panel.series[index].points.push_back({rows.number(4), rows.number(5)});
    }
    result.table = Table({{"attractor", ""}, {"kind", ""}, {"points", ""}});
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
        panel.series[i].title = fmt::format("{} ({})", names.kind(i), panel.series[i].points.size());
        result.table.add(static_cast<double>(i + 1));
        result.table.add(names.kind(i));
        result.table.add(static_cast<double>(panel.series[i].points.size()));
    }
    result.figure.panels.push_back(std::move(panel));
    return result;
}

} // namespace graze
