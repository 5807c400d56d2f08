#include "graze/study/stored_ladder.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "graze/study/stored_study.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

/// Settings of the run that has the point, for branches in its parameter or in another one.
BranchSettings ladder_settings(const StoredRun& run, const LadderRequest& request) {
    const StudyRun stored = stored_run(run.record);
    BranchSettings settings = stored.branch().settings;
    settings.monitors.clear();
    settings.free.clear();
    settings.free_bounds.clear();
    settings.kept.reset();
    if (!request.parameter.empty()) {
        const ParameterId parameter =
            with_place(request.parameter_place, [&] { return run.model.independent_parameter(request.parameter); });
        if (parameter != settings.parameter)
            settings.least = settings.greatest = std::nullopt;
        settings.parameter = parameter;
    } else if (!stored.is_followed()) {
        throw InputError(request.point_place, fmt::format("run '{}' follows no parameter", run.record.name),
                         fmt::format("say which one varies: {} NAME", request.parameter_place.file));
    }
    return settings;
}

std::optional<double> first_of(const Branch& branch, PointType type) {
    const auto found = std::ranges::find(branch.special, type, &SpecialPoint::type);
    return found == branch.special.end() ? std::nullopt : std::optional(found->parameter);
}

} // namespace

StoredLadder stored_ladder(const ResultFile& file, const LadderRequest& request) {
    StoredOrbit first = find_closed_orbit(file, request.point, request.point_place);
    const BranchSettings settings = ladder_settings(first.run, request);
    const System system(first.run.model);
    std::vector<StoredLadder::Leaving> leaving;
    const auto visit = [&](std::size_t grazing, const Branch& branch) {
        leaving.push_back({first_of(branch, PointType::fold), first_of(branch, PointType::flip)});
        if (request.progress)
            request.progress(grazing);
        return true;
    };
    Ladder ladder = with_place(request.point_place, [&] {
        return climb(system, first.record.point, settings, request.grazings, visit, request.interrupted);
    });
    StoredLadder result{std::move(first), settings.parameter, std::move(ladder), std::move(leaving), {}, false};
    result.interrupted = request.interrupted && request.interrupted();
    if (result.interrupted)
        result.limit.problem = "interrupted";
    else
        result.limit = with_place(request.point_place, [&] { return result.ladder.limit(); });
    return result;
}

Table ladder_table(const StoredLadder& found) {
    const Model& model = found.first.run.model;
    const std::string parameter = model.independent_parameters()[found.parameter.place()];
    const std::string unit = model.parameter_unit(parameter);
    Table table({{"grazing", ""}, {parameter, unit}, {"lambda", ""}, {"flip", unit}, {"fold", unit}});
    const std::vector<SpecialPoint>& grazings = found.ladder.grazings();
    const auto& leaving = found.leaving;
    for (std::size_t k = 0; k < grazings.size(); ++k) {
        table.add(k + 1, grazings[k].parameter);
        const bool has_ratio = k + 2 < grazings.size();
        table.add(has_ratio ? (grazings[k + 2].parameter - grazings[k + 1].parameter) /
                                  (grazings[k + 1].parameter - grazings[k].parameter)
                            : not_a_number,
                  k < leaving.size() ? leaving[k].flip.value_or(not_a_number) : not_a_number,
                  k < leaving.size() ? leaving[k].fold.value_or(not_a_number) : not_a_number);
    }
    return table;
}

} // namespace graze
