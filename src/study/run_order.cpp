#include "graze/study/study.hpp"
#include "study/identify_run.hpp"
#include "study/run_schedule.hpp"
#include "study/start_point.hpp"
#include "study/study_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace graze {

std::vector<std::pair<std::string, Place>> StudyRun::needs() const {
    std::vector<std::pair<std::string, Place>> needed;
    if (start)
        needed.emplace_back(start->run, start->place);
    for (const std::string& run : parameters)
        needed.emplace_back(run, parameters_place);
    if (const auto* of_records = std::get_if<IdentifyRequest>(&request))
        for (const std::string& run : of_records->records)
            needed.emplace_back(run, of_records->records_place);
    return needed;
}

double MotionRequest::points() const {
    double product = static_cast<double>(std::max<std::size_t>(draws, 1));
    for (const Variation& axis : axes)
        product *= static_cast<double>(std::max<std::size_t>(axis.values.size(), 1));
    return product;
}

double MotionRequest::rows(RunKind kind) const {
    const bool swept = kind == RunKind::sweep && !axes.empty() && !axes.front().values.empty();
    return swept ? points() / static_cast<double>(axes.front().values.size()) : points();
}

std::vector<std::string> StudyRun::sampling_names() const {
    if (kind == RunKind::record)
        return record().sampling_names();
    if (kind == RunKind::identify)
        return {"measured", "fitted", "residual"};
    return is_branch() ? std::vector<std::string>() : names_of(motion().samplings);
}

namespace {

/// True when a run uses the parameters that another run has found, directly or through others.
bool refines(const StudyRun& run, const std::string& other, const Study& study) {
    return std::any_of(run.parameters.begin(), run.parameters.end(), [&](const std::string& name) {
        const StudyRun* one = study.find_run(name);
        return name == other || (one && one->name != run.name && refines(*one, other, study));
    });
}

/// Refuses two runs that find the same parameter, unless the later one uses the earlier one's estimate.
void check_found_once(const StudyRun& run, const Study& study) {
    for (std::size_t j = 0; j < run.parameters.size(); ++j)
        for (std::size_t i = 0; i < j; ++i) {
            const StudyRun *first = study.find_run(run.parameters[i]), *second = study.find_run(run.parameters[j]);
            if (run.parameters[i] == run.parameters[j])
                throw InputError(run.parameters_place, fmt::format("run '{}' is named twice", run.parameters[i]),
                                 "name it once");
            if (!first || !second || refines(*second, first->name, study))
                continue;
            const std::vector<std::string> one = names_found(first->identify()), two = names_found(second->identify());
            for (const std::string& name : one)
                if (run.model.find_independent_parameter(name) && std::find(two.begin(), two.end(), name) != two.end())
                    throw InputError(run.parameters_place,
                                     fmt::format("runs '{}' and '{}' both find '{}'", first->name, second->name, name),
                                     fmt::format("name one of them, or let the second go on from the first: "
                                                 "parameters = \"{}\" in '{}'",
                                                 first->name, second->name));
        }
}

} // namespace

void check_needs(const StudyRun& run, const Study& study) {
    const auto require_kind = [&](const std::vector<std::string>& names, const Place& place, RunKind kind) {
        for (const std::string& name : names)
            if (const StudyRun* one = study.find_run(name); one && one->kind != kind)
                throw InputError(place, fmt::format("run '{}' is of kind \"{}\"", name, name_of(one->kind)),
                                 fmt::format("name a run of kind \"{}\"", name_of(kind)));
    };
    require_kind(run.parameters, run.parameters_place, RunKind::identify);
    if (run.kind == RunKind::identify)
        require_kind(run.identify().records, run.identify().records_place, RunKind::record);
    check_found_once(run, study);
}

std::set<std::string> wanted_runs(const Study& study, const std::vector<std::string>& only) {
    for (const std::string& name : only)
        run_named(study, name);            // throws for the name of no run
    for (const StudyRun& run : study.runs) // a study may have been made in C++
        for (const auto& need : run.needs())
            run_named(study, need.first);
    std::set<std::string> wanted(only.begin(), only.end());
    for (auto run = study.runs.rbegin(); run != study.runs.rend(); ++run)
        if (only.empty() || wanted.contains(run->name)) {
            wanted.insert(run->name);
            for (const auto& need : run->needs())
                wanted.insert(need.first);
        }
    return wanted;
}

std::vector<StudyRun> in_order(std::vector<StudyRun> runs) {
    const std::vector<std::string> names = names_of(runs);
    for (const StudyRun& run : runs)
        for (const auto& [need, place] : run.needs())
            require_run(need, names, place);
    std::vector<StudyRun> ordered;
    const auto is_done = [&](const auto& need) {
        return std::any_of(ordered.begin(), ordered.end(), [&](const StudyRun& run) { return run.name == need.first; });
    };
    while (!runs.empty()) {
        const auto next = std::find_if(runs.begin(), runs.end(), [&](const StudyRun& run) {
            const auto needs = run.needs();
            return std::all_of(needs.begin(), needs.end(), is_done);
        });
        if (next == runs.end())
            throw InputError(runs.front().needs().front().second,
                             fmt::format("run '{}' starts from itself, by way of others", runs.front().name),
                             "let one of them start by itself");
        ordered.push_back(std::move(*next));
        runs.erase(next);
    }
    return ordered;
}

} // namespace graze
