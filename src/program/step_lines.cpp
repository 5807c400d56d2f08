#include "program/step_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace graze {

namespace {

constexpr int wide = 18, shown_digits = 10;

/// The second parameter of a curve, which has a column of its own; none for branches.
std::optional<ParameterId> second_parameter(const StudyRun& run) {
    const bool two = run.kind == RunKind::curve && !run.branch().settings.free.empty();
    return two ? std::optional(run.branch().settings.free.front()) : std::nullopt;
}

/// True for a monitor of the period, which has a column anyway.
bool is_period(const Monitor& monitor) {
    return monitor.kind == Monitor::Kind::duration && monitor.segment.empty();
}

} // namespace

void StepLines::begin(const StudyRun& run, const std::string& part) {
    const std::vector<std::string> names = run.model.independent_parameters();
    const BranchSettings& settings = run.branch().settings;
    const std::size_t parameter = settings.parameter.place();
    const std::string along = settings.family && run.kind != RunKind::curve ? settings.family->name()
                              : parameter < names.size()                    ? names[parameter]
                                                                            : "parameter";
    std::string line = fmt::format("{:>5} {:<4} {:<6} {:>{}}", "step", "type", "label", along, wide);
    if (const auto second = second_parameter(run))
        line += fmt::format(" {:>{}}", names[second->place()], wide);
    line += fmt::format(" {:>{}} {:<6}", "period", wide, "stable");
    for (const Monitor& monitor : run.branch().settings.monitors)
        if (!is_period(monitor))
            line += fmt::format(" {:>{}}", monitor.name, wide);
    line.erase(line.find_last_not_of(' ') + 1);
    *out_ << run.name << (part.empty() ? "" : ", ") << part << '\n' << line << '\n';
}

void StepLines::show(const std::string& name, const OrbitRecord& record) {
    const StudyRun* const run = study_->find_run(name);
    if (!run)
        return;
    const bool starts = record.point.step == 0; // the names of two consecutive parts may be equal
    if (run_ != name || part_ != record.part || starts)
        begin(*run, record.part);
    run_ = name;
    part_ = record.part;
    const SpecialPoint& point = record.point;
    const char* stable = !point.solution.certificate.admissible ? "unphys" : record.stable ? "yes" : "no";
    std::string line = fmt::format("{:>5} {:<4} {:<6} {:>{}.{}g}", point.step, short_name(point.type), record.label,
                                   point.parameter, wide, shown_digits);
    if (const auto second = second_parameter(*run))
        line += fmt::format(" {:>{}.{}g}", point.solution.orbit.parameters[second->place()], wide, shown_digits);
    line += fmt::format(" {:>{}.{}g} {:<6}", point.solution.orbit.period(), wide, shown_digits, stable);
    const std::vector<Monitor>& monitors = run->branch().settings.monitors;
    for (std::size_t m = 0; m < std::min(monitors.size(), point.monitors.size()); ++m)
        if (!is_period(monitors[m]))
            line += fmt::format(" {:>{}.{}g}", point.monitors[m], wide, shown_digits);
    line.erase(line.find_last_not_of(' ') + 1);
    *out_ << line << std::endl; // flushed, so that each line appears at once, also in a file
}

} // namespace graze
