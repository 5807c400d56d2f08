#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "graze/branch/ladder.hpp"
#include "graze/results/stored_orbit.hpp"
#include "graze/study/stored_study.hpp"
#include "program/commands.hpp"
#include "program/empty_cell.hpp"
#include "program/interrupt.hpp"
#include "program/status_line.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace graze {

namespace {

/// Settings of the run that the point belongs to, for branches in its parameter or in another one.
BranchSettings settings_of(const StoredRun& run, const std::string& asked) {
    const StudyRun stored = stored_run(run.record);
    BranchSettings settings = stored.branch.settings;
    settings.monitors.clear();
    settings.free.clear();
    settings.free_bounds.clear();
    settings.kept.reset();
    if (!asked.empty()) {
        const ParameterId parameter = asked_parameter(run.model, asked);
        if (parameter != settings.parameter)
            settings.least = settings.greatest = std::nullopt;
        settings.parameter = parameter;
    } else if (!stored.is_followed()) {
        throw InputError(Place{"POINT", 0, 0}, fmt::format("run '{}' follows no parameter", run.record.name),
                         "say which one varies: --parameter NAME");
    }
    return settings;
}

/// Of a rung the parameter at the first point of a type; NaN where there is none.
double first_of(const Branch& branch, PointType type) {
    const auto found = std::find_if(branch.special.begin(), branch.special.end(),
                                    [type](const SpecialPoint& point) { return point.type == type; });
    return found == branch.special.end() ? nothing : found->parameter;
}

/// What is found on the branch that leaves a grazing.
struct Leaving {
    double fold = nothing, flip = nothing;
};

Table table_of(const Ladder& ladder, const std::vector<Leaving>& leaving, const std::string& parameter,
               const std::string& unit) {
    Table table({{"grazing", ""}, {parameter, unit}, {"lambda", ""}, {"flip", unit}, {"fold", unit}});
    const std::vector<SpecialPoint>& grazings = ladder.grazings();
    for (std::size_t k = 0; k < grazings.size(); ++k) {
        table.add(static_cast<double>(k + 1));
        table.add(grazings[k].parameter);
        const bool has_ratio = k + 2 < grazings.size();
        table.add(has_ratio ? (grazings[k + 2].parameter - grazings[k + 1].parameter) /
                                  (grazings[k + 1].parameter - grazings[k].parameter)
                            : nothing);
        table.add(k < leaving.size() ? leaving[k].flip : nothing);
        table.add(k < leaving.size() ? leaving[k].fold : nothing);
    }
    return table;
}

JsonObject heading_of(const ResultFile& file, const StoredOrbit& stored, const Ladder& ladder,
                      const ChatterLimit& limit) {
    JsonObject heading;
    heading.add("graze", GRAZE_VERSION);
    heading.add("file", file.path());
    heading.add("model", stored.run.model.name);
    heading.add("run", stored.run.record.name);
    heading.add("number", static_cast<double>(stored.record.number));
    heading.add("label", stored.record.label);
    heading.add("ends", ladder.why());
    if (limit.direct) {
        heading.add("limit", limit.direct->first);
        heading.add("limit_error", limit.direct->second);
        heading.add("restitution", limit.contacts.restitution);
        heading.add("ratio", limit.contacts.ratio);
    }
    if (limit.extrapolated) {
        heading.add("extrapolated", limit.extrapolated->first);
        heading.add("extrapolated_error", limit.extrapolated->second);
    }
    heading.add("no_limit", limit.problem);
    return heading;
}

/// The limit, for people: beside the table, as messages are.
void tell(const Ladder& ladder, const ChatterLimit& limit, const std::string& parameter, const Console& console) {
    if (!ladder.why().empty())
        console.err << fmt::format("graze: the ladder ends at grazing {}: {}\n", ladder.grazings().size(),
                                   ladder.why());
    if (!limit.direct) {
        console.err << fmt::format("graze: no limit: {}\n", limit.problem);
        return;
    }
    console.err << fmt::format("graze: it leads to {} = {:.12g} +- {:.1g}, the onset of chatter; the ratio goes to "
                               "{:.6g}, by a restitution of {:.6g}\n",
                               parameter, limit.direct->first, limit.direct->second, limit.contacts.ratio,
                               limit.contacts.restitution);
    if (limit.extrapolated)
        console.err << fmt::format("graze: the grazings alone say {:.12g} +- {:.1g}\n", limit.extrapolated->first,
                                   limit.extrapolated->second);
}

} // namespace

int ladder_command(const LadderArguments& arguments, const Console& console) {
    const ResultFile file(result_path(arguments.file), ResultFile::Access::read);
    const Place place{"POINT", 0, 0};
    const StoredOrbit stored = find_stored_orbit(file, arguments.point, place);
    const BranchSettings settings = settings_of(stored.run, arguments.parameter);
    const std::size_t followed = settings.parameter.place();
    const std::string parameter = stored.run.model.independent_parameters()[followed];
    const std::string unit = stored.run.model.parameters[*stored.run.model.find_parameter(parameter)].unit;
    const System system(stored.run.model);
    const InterruptGuard guard;
    std::vector<Leaving> leaving;
    StatusLine line(console, console.terminal);
    const Ladder ladder = with_place(place, [&] {
        return climb(
            system, stored.record.point, settings, static_cast<std::size_t>(arguments.rungs),
            [&](std::size_t rung, const Branch& branch) {
                leaving.push_back({first_of(branch, PointType::fold), first_of(branch, PointType::flip)});
                if (line.is_due())
                    line.show(fmt::format("grazing {} of {}", rung, arguments.rungs));
                return true;
            },
            [] { return InterruptGuard::requested(); });
    });
    ChatterLimit limit;
    if (InterruptGuard::requested())
        limit.problem = "interrupted";
    else
        limit = with_place(place, [&] { return ladder.limit(); });
    deliver(table_of(ladder, leaving, parameter, unit), arguments.output, heading_of(file, stored, ladder, limit),
            console);
    if (InterruptGuard::requested()) {
        console.err << fmt::format("graze: interrupted after grazing {} of {}\n", ladder.grazings().size(),
                                   arguments.rungs);
        return InterruptGuard::exit_code();
    }
    if (arguments.output.format == TableFormat::table)
        tell(ladder, limit, parameter, console);
    return ladder.grazings().size() > 1 ? exit_success : exit_irregular;
}

} // namespace graze
