#include "graze/page/page_file.hpp"
#include "graze/picture/figure_script.hpp"
#include "graze/picture/result_picture.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/showable_names.hpp"
#include "program/commands.hpp"
#include "program/drawing.hpp"
#include "program/output_file.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

std::optional<std::pair<double, double>> range_of(const std::string& text, const char* option) {
    if (text.empty())
        return std::nullopt;
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos)
        throw InputError({option, 0, 0}, fmt::format("'{}' is not a range", text), "write it as A:B");
    const std::pair<double, double> range{number_of_option(text.substr(0, colon), option),
                                          number_of_option(text.substr(colon + 1), option)};
    if (!(range.first < range.second))
        throw InputError({option, 0, 0}, fmt::format("the range '{}' is empty", text), "give the smaller number first");
    return range;
}

/// Pairs of name and text of `--name`.
std::vector<std::pair<std::string, std::string>> names_given(const PlotArguments& arguments) {
    std::vector<std::pair<std::string, std::string>> names;
    for (const std::string& item : arguments.names) {
        const std::size_t equals = item.find('=');
        if (equals == std::string::npos || equals == 0)
            throw InputError({"--name", 0, 0}, fmt::format("'{}' names nothing", item), "write NAME=TEXT");
        const std::string name = item.substr(0, equals);
        if (std::any_of(names.begin(), names.end(), [&](const auto& other) { return other.first == name; }))
            throw InputError({"--name", 0, 0}, fmt::format("'{}' is given twice", name), "leave one of them out");
        names.emplace_back(name, item.substr(equals + 1));
    }
    return names;
}

StudyPicture picture_of(const PlotArguments& arguments, const RunRecord& run) {
    const StudyPicture usual = default_picture(run);
    StudyPicture picture = arguments.picture;
    picture.name = usual.name;
    picture.runs = usual.runs;
    picture.points = split_list(picture.points);
    if (picture.kind.empty())
        picture.kind = picture.points.empty() ? usual.kind : picture.x == "t" ? "history" : "portrait";
    if (!picture.points.empty() && !run.is_branch())
        throw InputError({"--point", 0, 0}, fmt::format("run '{}' has no orbits of a branch", run.name),
                         "choose points of other runs by --at NAME=VALUE");
    if (picture.kind != "regression")
        for (const auto& [option, given] : {std::pair{"--group", !picture.group.empty()},
                                            {"--successive", picture.successive},
                                            {"--fit", !arguments.fit.empty()}})
            if (given)
                throw InputError({option, 0, 0}, fmt::format("a picture of kind '{}' has none", picture.kind),
                                 "leave it out, or choose --kind regression");
    picture.y = split_list(picture.y);
    picture.samplings = split_list(picture.samplings);
    picture.directions = split_list(picture.directions);
    picture.x_range = range_of(arguments.x_range, "--x-range");
    picture.y_range = range_of(arguments.y_range, "--y-range");
    picture.fit = range_of(arguments.fit, "--fit");
    for (const std::string& item : split_list(arguments.at)) {
        const std::size_t equals = item.find('=');
        if (equals == std::string::npos)
            throw InputError({"--at", 0, 0}, fmt::format("'{}' names no point", item), "write NAME=VALUE");
        picture.at.emplace_back(item.substr(0, equals), number_of_option(item.substr(equals + 1), "--at"));
    }
    picture.names = names_given(arguments);
    picture.style = figure_style(arguments.style);
    for (const std::string& axis : arguments.logarithmic) {
        picture.logarithmic_x = picture.logarithmic_x || axis == "x";
        picture.logarithmic_y = picture.logarithmic_y || axis == "y";
    }
    for (const std::string& sampling : picture.samplings)
        if (std::find(run.samplings.begin(), run.samplings.end(), sampling) == run.samplings.end())
            throw InputError({"--sample", 0, 0}, fmt::format("run '{}' has no sampling '{}'", run.name, sampling),
                             name_advice(sampling, run.samplings, "it has none"));
    for (const std::string& direction : picture.directions)
        if (!run.is_branch() &&
            std::find(run.directions.begin(), run.directions.end(), direction) == run.directions.end())
            throw InputError({"--direction", 0, 0}, fmt::format("run '{}' has no direction '{}'", run.name, direction),
                             name_advice(direction, run.directions, "it has none"));
    return picture;
}

/// The runs of a file that have points.
struct ShownRuns {
    std::vector<std::string> names;
    bool complete = true; ///< false: other runs have none
};

/// The runs to draw when none is named: those with points; the others get a warning.
ShownRuns runs_to_show(const ResultFile& file, const Console& console) {
    ShownRuns shown;
    for (const RunRecord& run : file.runs()) {
        if (!has_own_picture(run, file))
            continue;
        if (file.point_count(run.name) > 0) {
            shown.names.push_back(run.name);
            continue;
        }
        shown.complete = false;
        console.err << fmt::format("graze: warning: run '{}' was not drawn: it {}\n", run.name,
                                   run.status == RunStatus::failed ? "failed: " + run.failure : "has no points");
    }
    if (shown.names.empty())
        throw InputError(Place{file.path(), 0, 0},
                         shown.complete ? "there are no runs in the file" : "no run in the file has points",
                         "run the study first");
    return shown;
}

/// Checks the names of --name: each must occur in at least one of the runs.
void check_names(const PlotArguments& arguments, const ResultFile& file, const std::vector<std::string>& runs) {
    if (arguments.names.empty())
        return;
    StudyPicture picture = arguments.picture;
    picture.y = split_list(picture.y);
    ShowableNames showable(picture);
    for (const std::string& name : runs)
        showable.add(StoredRun(file, name, {"--run", 0, 0}).record);
    for (const auto& [name, text] : names_given(arguments))
        showable.require(name, {"--name", 0, 0}, fmt::format("'{}'", name));
}

/// The picture with all branches. Nothing if the runs are not branches, or not to be drawn as such.
std::optional<StudyPicture> joint_picture(const PlotArguments& arguments, const ResultFile& file,
                                          const std::vector<std::string>& names) {
    StudyPicture picture;
    const std::vector<RunRecord> all = file.runs();
    const bool followed = std::any_of(all.begin(), all.end(), [](const RunRecord& run) { return run.is_followed(); });
    for (const std::string& name : names) {
        const StoredRun run(file, name, {"--run", 0, 0});
        if (arguments.picture.runs.empty() && followed && run.record.is_branch() && !run.record.is_followed())
            continue; // the starting orbit of a branch is one of the branch's points
        const StudyPicture one = picture_of(arguments, run.record);
        if (!run.record.is_branch() || one.kind != "branch")
            return std::nullopt;
        if (picture.runs.empty())
            picture = one;
        else
            picture.runs.push_back(name);
    }
    return picture;
}

/// Draws branches into one picture. @return false if the runs are not branches, or not to be drawn as such
bool draw_together(const PlotArguments& arguments, const ResultFile& file, const std::vector<std::string>& names,
                   const Console& console) {
    const std::optional<StudyPicture> picture = joint_picture(arguments, file, names);
    if (!picture)
        return false;
    draw_figure(make_picture(*picture, file).figure, arguments.output, arguments.data);
    console.out << arguments.output << '\n';
    return true;
}

/// Writes one HTML file with all runs, which a browser shows. The pictures that the options describe come first.
void write_page(const PlotArguments& arguments, const ResultFile& file, const std::vector<std::string>& names,
                const Console& console) {
    if (!arguments.data.empty())
        throw InputError({"--data", 0, 0}, "a page has its data in itself", "leave --data out");
    PageFileOptions page{.title = arguments.picture.title, .runs = names};
    if (auto joint = joint_picture(arguments, file, names); joint && joint->runs.size() > 1) {
        joint->name = "branches";
        page.pictures.push_back(std::move(*joint));
    } else {
        for (const std::string& name : names)
            page.pictures.push_back(picture_of(arguments, StoredRun(file, name, {"--run", 0, 0}).record));
    }
    write_file(arguments.output, page_file(file, page));
    console.out << arguments.output << '\n';
}

/// Checks names of attractors in --name. They consist of period and signature, which are known only after drawing.
void check_names_of_attractors(const StudyPicture& picture, const ResultPicture& made) {
    const auto is_shown = [&](const std::string& text) {
        return std::any_of(made.figure.panels.begin(), made.figure.panels.end(), [&](const FigurePanel& panel) {
            return std::any_of(panel.series.begin(), panel.series.end(),
                               [&](const FigureSeries& series) { return series.title.starts_with(text); });
        });
    };
    std::vector<std::string> kinds;
    for (std::size_t column = 0; column < made.table.columns().size(); ++column)
        for (std::size_t row = 0; made.table.columns()[column].name == "kind" && row < made.table.rows(); ++row)
            kinds.push_back(made.table.text(row, column));
    for (const auto& [name, text] : picture.names)
        if (name.starts_with("period ") && !is_shown(text))
            throw InputError({"--name", 0, 0}, fmt::format("'{}': the picture shows nothing of that name", name),
                             name_advice(name, kinds, "there is no attractor"));
}

void draw_alone(const PlotArguments& arguments, const ResultFile& file, const std::string& name,
                const Console& console) {
    const StoredRun run(file, name, {"--run", 0, 0});
    if (run.record.status == RunStatus::failed && run.points() == 0)
        throw InputError({"--run", 0, 0},
                         fmt::format("run '{}' has no points: it failed: {}", name, run.record.failure), "");
    const std::string path = arguments.output.empty() ? name + ".png" : arguments.output;
    const StudyPicture picture = picture_of(arguments, run.record);
    const ResultPicture made = make_picture(picture, file);
    check_names_of_attractors(picture, made);
    draw_figure(made.figure, path, arguments.data);
    if (made.table.rows() > 0)
        deliver(made.table, {TableFormat::table, 6, "", true}, {}, console);
    console.out << path << '\n';
}

} // namespace

int plot_command(const PlotArguments& arguments, const Console& console) {
    const ResultFile file(result_path(arguments.file), ResultFile::Access::read);
    ShownRuns shown{split_list(arguments.picture.runs)};
    if (shown.names.empty())
        shown = runs_to_show(file, console);
    const std::vector<std::string>& names = shown.names;
    check_names(arguments, file, names);
    if (arguments.output.ends_with(".html")) {
        write_page(arguments, file, names, console);
        return shown.complete ? exit_success : exit_irregular;
    }
    if (names.size() > 1 && !arguments.output.empty()) {
        if (!draw_together(arguments, file, names, console))
            throw InputError({"--output", 0, 0}, "several runs cannot go into one picture", "choose one by --run NAME");
        return shown.complete ? exit_success : exit_irregular;
    }
    std::size_t drawn = 0;
    for (const std::string& name : names)
        try {
            draw_alone(arguments, file, name, console);
            ++drawn;
        } catch (const InputError& error) {
            if (!arguments.picture.runs.empty() || (drawn == 0 && name == names.back()))
                throw;
            console.err << fmt::format("graze: warning: run '{}' was not drawn: {}\n", name, error.what());
            shown.complete = false;
        }
    return shown.complete ? exit_success : exit_irregular;
}

} // namespace graze
