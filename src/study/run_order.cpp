#include "graze/study/study.hpp"
#include "study/identify_run.hpp"
#include "study/run_schedule.hpp"
#include "study/start_point.hpp"
#include "study/study_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
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
    const bool swept = is_swept(kind) && !axes.empty() && !axes.front().values.empty();
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
    std::vector<std::vector<std::size_t>> needs(runs.size()); // a study may have ten thousand runs
    for (std::size_t r = 0; r < runs.size(); ++r)
        for (const auto& [need, place] : runs[r].needs()) {
            require_run(need, names, place);
            needs[r].push_back(static_cast<std::size_t>(std::ranges::find(names, need) - names.begin()));
        }
    std::vector<std::size_t> left(runs.size());
    std::iota(left.begin(), left.end(), std::size_t{0});
    std::vector<bool> is_done(runs.size());
    std::vector<StudyRun> ordered;
    while (!left.empty()) {
        const auto next = std::ranges::find_if(left, [&](std::size_t run) {
            return std::ranges::all_of(needs[run], [&](std::size_t need) { return is_done[need]; });
        });
        if (next == left.end()) {
            const StudyRun& run = runs[left.front()];
            throw InputError(run.needs().front().second,
                             fmt::format("run '{}' starts from itself, by way of others", run.name),
                             "let one of them start by itself");
        }
        is_done[*next] = true;
        ordered.push_back(std::move(runs[*next]));
        left.erase(next);
    }
    return ordered;
}

} // namespace graze
