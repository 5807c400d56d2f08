#include "graze/branch/special_point.hpp"
#include "graze/results/stored_orbit.hpp"
#include "graze/study/stored_study.hpp"
#include "picture/branch_lines.hpp"
#include "picture/picture_kinds.hpp"
#include "study/point_limits.hpp"
#include "study/start_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace graze {

namespace {

constexpr std::size_t most_panels = 4;

/// The type of points that a curve follows, from the point where it starts; none: the run is a branch.
std::optional<PointType> kept_of(const StoredRun& run) {
    if (run.record.kind != name_of(RunKind::curve))
        return std::nullopt;
    const StudyRun asked = stored_run(run.record);
    if (asked.start && point_type(asked.start->onto))
        return point_type(asked.start->onto);
    const auto parent = asked.start ? run.file.find_run(asked.start->run) : std::nullopt;
    return parent ? orbit_to_start_from(*asked.start, stored_run(*parent), run.file).point.type : PointType::regular;
}

/// Returns what varies along a run: the coordinate of a family, or the first parameter.
std::string coordinate_of(const StudyPicture& picture, const StoredRun& run) {
    if (run.record.kind == name_of(RunKind::follow))
        if (const auto family = stored_run(run.record).branch().settings.family)
            return family->name();
    return first_coordinate(picture, run);
}

/// Monitors of the first run that all runs have, or the period; for a curve its second parameter.
std::vector<std::string> default_values(const std::vector<StoredRun>& runs) {
    std::vector<std::string> names;
    if (runs.front().record.kind == name_of(RunKind::curve))
        return {runs.front().record.coordinates.at(1).name};
    for (const ResultColumn& column : runs.front().record.values)
        if (names.size() < most_panels &&
            std::all_of(runs.begin(), runs.end(), [&](const StoredRun& run) { return run.has_value(column.name); }))
            names.push_back(column.name);
    return names.empty() ? std::vector<std::string>{"period"} : names;
}

/// Colours of the runs; runs with the same shown name have the same colour.
std::vector<std::size_t> colours_of(const StudyPicture& picture, const std::vector<StoredRun>& runs) {
    std::map<std::string, std::size_t> known;
    std::vector<std::size_t> colours;
    for (const StoredRun& run : runs)
        colours.push_back(known.try_emplace(shown_name(picture, run.record.name), known.size()).first->second);
    return colours;
}

/// Meanings of the line styles of curves; empty if each style belongs to one run, whose name tells it.
std::map<FigureSeries::Style, std::string> curve_styles(const std::vector<DrawnBranch>& branches) {
    std::set<PointType> types;
    for (const DrawnBranch& branch : branches)
        if (branch.kept)
            types.insert(*branch.kept);
    std::map<FigureSeries::Style, std::string> meanings;
    if (types.size() < 2 || types.size() == branches.size())
        return meanings;
    for (const PointType type : types) {
        std::string& meaning = meanings[style_of(type)];
        meaning += (meaning.empty() ? "" : ", ") + std::string(kind_of(type).name);
    }
    return meanings;
}

/// Adds the colours of the runs and the meanings of the used styles and symbols to the legend.
void add_legend(FigurePanel& panel, const StudyPicture& picture, const std::vector<DrawnBranch>& branches) {
    if (branches.size() > 1)
        for (const DrawnBranch& branch : branches)
            if (!branch.points.empty())
                add_to_legend(panel, branch.owner,
                              branch.kept    ? style_of(*branch.kept)
                              : branch.apart ? FigureSeries::Style::circles
                                             : FigureSeries::Style::line,
                              branch.colour);
    for (const auto& [style, meaning] : curve_styles(branches))
        add_to_legend(panel, meaning, style, FigureSeries::black);
    const std::size_t colour = branches.size() > 1 ? FigureSeries::black : 0;
    add_looks(panel, branches, colour);
    add_point_types(panel, picture, branches, colour);
}

} // namespace

ResultPicture branch_picture(const StudyPicture& picture, const ResultFile& file) {
    std::vector<StoredRun> runs;
    for (const std::string& name : picture.runs) {
        const StoredRun& run = runs.emplace_back(file, name, picture.place);
        if (!run.record.is_branch())
            throw InputError(picture.place, fmt::format("run '{}' is of kind {}, not a branch", name, run.record.kind),
                             "leave the kind of picture out to have it drawn by its own kind");
    }
    const std::string x = picture.x.empty() ? coordinate_of(picture, runs.front()) : picture.x;
    const std::vector<std::string> values = picture.y.empty() ? default_values(runs) : picture.y;
    const std::vector<std::size_t> colours = colours_of(picture, runs);
    std::vector<DrawnBranch> branches;
    for (const StoredRun& run : runs) {
        DrawnBranch& branch = branches.emplace_back();
        branch.run = run.record.name;
        branch.points = drawn_points(run, picture, x, values);
        branch.kept = kept_of(run);
        branch.apart = !run.record.is_followed();
        branch.colour = colours[branches.size() - 1];
        if (runs.size() > 1)
            branch.owner = shown_name(picture, branch.run);
    }
    Figure figure;
    figure.columns = values.size() > 1 ? 2 : 1;
    for (std::size_t v = 0; v < values.size(); ++v) {
        FigurePanel panel = panel_of(picture, runs.front(), x, values[v], v);
        panel.roomy_y = true;
        if (values.size() > 1 || runs.size() == 1)
            panel.title = (values.size() > 1 ? panel_letter(v) + " " : std::string()) +
                          (runs.size() == 1 ? shown_name(picture, runs.front().record.name) : std::string());
        for (const DrawnBranch& branch : branches) {
            add_lines(panel, branch, v);
            add_symbols(panel, picture, branch, v);
        }
        add_legend(panel, picture, branches);
        figure.panels.push_back(std::move(panel));
    }
    return {std::move(figure)};
}

} // namespace graze
