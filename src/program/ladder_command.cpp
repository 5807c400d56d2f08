#include "graze/study/stored_ladder.hpp"
#include "program/commands.hpp"
#include "program/interrupt.hpp"
#include "program/status_line.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace graze {

namespace {

JsonObject ladder_heading(const ResultFile& file, const StoredLadder& found) {
    const auto& [stored, parameter, ladder, leaving, limit, interrupted] = found;
    JsonObject heading = heading_of_point(file, stored);
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

/// Prints the end of the ladder and its limit for people, beside the table.
void tell_ladder(const Ladder& ladder, const ChatterLimit& limit, const std::string& parameter,
                 const Console& console) {
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
    LadderRequest request;
    request.point = arguments.point;
    request.point_place = {"POINT", 0, 0};
    request.parameter = arguments.parameter;
    request.parameter_place = {"--parameter", 0, 0};
    request.grazings = static_cast<std::size_t>(arguments.rungs);
    request.interrupted = [] { return InterruptGuard::requested(); };
    const InterruptGuard guard;
    StatusLine line(console, console.terminal);
    request.progress = [&](std::size_t grazing) {
        if (line.is_due())
            line.show(fmt::format("grazing {} of {}", grazing, arguments.rungs));
    };
    const StoredLadder found = stored_ladder(file, request);
    const Model& model = found.first.run.model;
    const std::string parameter = model.independent_parameters()[found.parameter.place()];
    deliver(ladder_table(found), arguments.output, ladder_heading(file, found), console);
    const std::size_t grazings = found.ladder.grazings().size();
    if (found.interrupted) {
        console.err << fmt::format("graze: interrupted after grazing {} of {}\n", grazings, arguments.rungs);
        return InterruptGuard::exit_code();
    }
    if (arguments.output.format == TableFormat::table)
        tell_ladder(found.ladder, found.limit, parameter, console);
    return grazings > 1 ? exit_success : exit_irregular;
}

} // namespace graze
