#include "picture/drawn_labels.hpp"

#include "graze/picture/figure.hpp"
#include "graze/study/study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>

namespace graze {

namespace {

struct LabelMark {
    Label label;
    MarkOfLabel mark;
};

constexpr std::array<LabelMark, 8> label_marks{{
    {Label::unsettled, {FigureSeries::grey, 2, 4}},
    {Label::transient, {FigureSeries::grey, 6, 3}},
    {Label::escaped, {FigureSeries::grey, 1, 5}},
    {Label::unbounded, {FigureSeries::grey, 8, 7}},
    {Label::ended, {FigureSeries::grey, 4, 6}},
    {Label::chattering, {FigureSeries::grey, 10, 1}},
    {Label::singular, {FigureSeries::black, 12, 2}},
    {Label::failed, {FigureSeries::black, 3, 0}},
}};

} // namespace

DrawnAs drawn_as(std::string_view label) {
    for (const Label settled : {Label::periodic, Label::quasi_periodic, Label::chaotic, Label::equilibrium})
        if (label == name_of(settled))
            return DrawnAs::attractor;
    return label == name_of(Label::unsettled) || label == name_of(Label::transient) ? DrawnAs::uncertain
                                                                                    : DrawnAs::nothing;
}

bool seeks_attractors(const RunRecord& run) {
    const auto kind = run_kind(run.kind);
    return kind && seeks_attractors(*kind);
}

std::string note_of_left_out(const StoredRun& run, const std::vector<std::string>& directions) {
    if (!seeks_attractors(run.record))
        return "";
    std::map<std::string, std::size_t> counts;
    std::size_t all = 0;
    auto rows = run.rows({.columns = {"label"}, .directions = directions});
    for (; rows.next(); ++all)
        if (const std::string label = rows.text(0); drawn_as(label) == DrawnAs::nothing)
            ++counts[label];
    std::vector<std::string> parts;
    for (const auto& [label, count] : counts)
        parts.push_back(fmt::format("{} {}", count, label));
    return parts.empty() ? ""
                         : fmt::format("without an attractor, not drawn: {} of {} points", fmt::join(parts, ", "), all);
}

MarkOfLabel mark_of_label(std::string_view label) {
    for (const LabelMark& one : label_marks)
        if (label == name_of(one.label))
            return one.mark;
    return label_marks.front().mark;
}

} // namespace graze
