#include "graze/results/stored_run.hpp"
#include "graze/study/picture.hpp"
#include "program/commands.hpp"
#include "program/figure.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace graze {

namespace {

double number_of(const std::string& text, const char* option) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        throw InputError({option, 0, 0}, fmt::format("'{}' is not a number", text), "give a number");
    return value;
}

std::optional<std::pair<double, double>> range_of(const std::string& text, const char* option) {
    if (text.empty())
        return std::nullopt;
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos)
        throw InputError({option, 0, 0}, fmt::format("'{}' is not a range", text), "write it as A:B");
    const std::pair<double, double> range{number_of(text.substr(0, colon), option),
                                          number_of(text.substr(colon + 1), option)};
    if (!(range.first < range.second))
        throw InputError({option, 0, 0}, fmt::format("the range '{}' is empty", text), "give the smaller number first");
    return range;
}

FigureStyle style_of(const PlotArguments& arguments) {
    FigureStyle style;
    if (!arguments.size.empty()) {
        const std::size_t cross = arguments.size.find('x');
        style.width = number_of(arguments.size.substr(0, cross), "--size");
        if (cross != std::string::npos)
            style.height = number_of(arguments.size.substr(cross + 1), "--size");
    }
    const std::string& font = arguments.font;
    const std::size_t comma = font.find(',');
    const bool only_size = !font.empty() && font.find_first_not_of("0123456789.") == std::string::npos;
    if (only_size || comma != std::string::npos)
        style.font_size = number_of(only_size ? font : font.substr(comma + 1), "--font");
    if (!only_size)
        style.font = font.substr(0, comma);
    check_style(style, {arguments.size.empty() ? "--font" : "--size", 0, 0});
    return style;
}

StudyPicture picture_of(const PlotArguments& arguments, const RunRecord& run) {
    StudyPicture picture = default_picture(run);
    picture.points = split_list(arguments.points);
    if (!arguments.kind.empty())
        picture.kind = arguments.kind;
    else if (!picture.points.empty())
        picture.kind = arguments.x == "t" ? "history" : "portrait";
    if (!picture.points.empty() && !run.is_branch())
        throw InputError({"--point", 0, 0}, fmt::format("run '{}' has no orbits of a branch", run.name),
                         "choose points of other runs by --at NAME=VALUE");
    picture.x = arguments.x;
    picture.title = arguments.title;
    picture.group = arguments.group;
    picture.successive = arguments.successive;
    picture.y = split_list(arguments.y);
    picture.samplings = split_list(arguments.samples);
    picture.directions = split_list(arguments.directions);
    picture.x_range = range_of(arguments.x_range, "--x-range");
    picture.y_range = range_of(arguments.y_range, "--y-range");
    picture.fit = range_of(arguments.fit, "--fit");
    for (const std::string& item : split_list(arguments.at)) {
        const std::size_t equals = item.find('=');
        if (equals == std::string::npos)
            throw InputError({"--at", 0, 0}, fmt::format("'{}' names no point", item), "write NAME=VALUE");
        picture.at.emplace_back(item.substr(0, equals), number_of(item.substr(equals + 1), "--at"));
    }
    for (const std::string& item : arguments.names) {
        const std::size_t equals = item.find('=');
        if (equals == std::string::npos || equals == 0)
            throw InputError({"--name", 0, 0}, fmt::format("'{}' names nothing", item), "write NAME=TEXT");
        picture.names.emplace_back(item.substr(0, equals), item.substr(equals + 1));
    }
    picture.x_label = arguments.x_label;
    picture.y_labels = arguments.y_labels;
    picture.style = style_of(arguments);
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

/// Branches go into one picture. @return whether these do
bool draw_together(const PlotArguments& arguments, const ResultFile& file, const std::vector<std::string>& names,
                   const Console& console) {
    StudyPicture picture;
    const std::vector<RunRecord> all = file.runs();
    const bool followed = std::any_of(all.begin(), all.end(), [](const RunRecord& run) { return run.is_followed(); });
    for (const std::string& name : names) {
        const StoredRun run(file, name, {"--run", 0, 0});
        if (arguments.runs.empty() && followed && run.record.kind == "orbit")
            continue; // where a branch started: one of its orbits
        const StudyPicture one = picture_of(arguments, run.record);
        if (!run.record.is_branch() || one.kind != "branch")
            return false;
        if (picture.runs.empty())
            picture = one;
        else
            picture.runs.push_back(name);
    }
    draw_figure(make_picture(picture, file).figure, arguments.output, arguments.data);
    console.out << arguments.output << '\n';
    return true;
}

} // namespace

int plot_command(const PlotArguments& arguments, const Console& console) {
    const ResultFile file(result_path(arguments.file), ResultFile::Access::read);
    std::vector<std::string> names = split_list(arguments.runs);
    if (names.empty())
        for (const RunRecord& run : file.runs())
            names.push_back(run.name);
    if (names.empty())
        throw InputError("there are no runs in the file", "run the study first");
    if (names.size() > 1 && !arguments.output.empty() && draw_together(arguments, file, names, console))
        return exit_success;
    if (names.size() > 1 && !arguments.output.empty())
        throw InputError({"--output", 0, 0}, "several runs cannot go into one picture", "choose one by --run NAME");
    for (const std::string& name : names) {
        const StoredRun run(file, name, {"--run", 0, 0});
        const std::string path = arguments.output.empty() ? name + ".png" : arguments.output;
        const ResultPicture made = make_picture(picture_of(arguments, run.record), file);
        draw_figure(made.figure, path, arguments.data);
        if (made.table.rows() > 0)
            deliver(made.table, {TableFormat::table, 6, "", true}, {}, console);
        console.out << path << '\n';
    }
    return exit_success;
}

} // namespace graze
