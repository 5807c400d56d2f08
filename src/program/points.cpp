#include "base/letter_case.hpp"
#include "graze/base/input_error.hpp"
#include "graze/branch/special_point.hpp"
#include "graze/results/point_list.hpp"
#include "program/commands.hpp"
#include "program/values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace graze {

namespace {

std::vector<std::string> all_types() {
    std::vector<std::string> names;
    for (const PointKind& kind : point_kinds())
        names.emplace_back(kind.short_name);
    return names;
}

std::vector<PointType> chosen_types(const std::vector<std::string>& names) {
    std::vector<PointType> types;
    for (const std::string& name : names) {
        const auto type = point_type(in_capitals(name));
        if (!type)
            throw InputError({"--type", 0, 0}, fmt::format("there is no type of points '{}'", name),
                             fmt::format("known are: {}", fmt::join(all_types(), ", ")));
        types.push_back(*type);
    }
    return types;
}

} // namespace

int points_command(const PointsArguments& arguments, const Console& console) {
    const ResultFile file(result_path(arguments.file), ResultFile::Access::read);
    const OutputArguments& output = arguments.output;
    const bool for_people = output.format == TableFormat::table;
    const PointList list = listed_points(file, {.runs = split_list(arguments.runs),
                                                .types = chosen_types(split_list(arguments.types)),
                                                .regular = output.all,
                                                .images = output.all || !for_people,
                                                .place = {"--run", 0, 0}});
    JsonObject heading;
    heading.add("file", file.path());
    // If the table is too wide, these columns stay. A curve has two parameters, both of which are needed.
    std::vector<std::string> kept{"label", list.followed, "period", "signature", "stable", "multiplier", "physical"};
    kept.insert(kept.end(), list.differing.begin(),
                list.differing.begin() + std::min<std::ptrdiff_t>(2, std::ssize(list.differing)));
    deliver(point_table(list, {for_people, !output.all, output.shown_digits()}), output, heading, console, kept);
    if (list.images_left_out > 0)
        console.err << fmt::format(
            "graze: {} points are left out that are images of others under the model's symmetry; "
            "--all lists them\n",
            list.images_left_out);
    for (const StoredRun& run : list.runs)
        if (run.record.status == RunStatus::failed)
            console.err << fmt::format("graze: run '{}' failed: {}\n", run.record.name, run.record.failure);
        else if (run.record.status == RunStatus::unfinished)
            console.err << fmt::format("graze: run '{}' is unfinished; graze run does it to its end\n",
                                       run.record.name);
    if (list.points.empty())
        console.err << "graze: there are no such points; --all lists the regular ones too\n";
    return exit_success;
}

} // namespace graze
