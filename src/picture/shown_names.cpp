#include "picture/shown_names.hpp"

#include "graze/base/input_error.hpp"
#include "graze/study/stored_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace graze {

namespace {

/// Descriptions of values that every run has.
constexpr std::array<std::pair<const char*, const char*>, 11> words_of_columns{{
    {"t", "time"},
    {"period", "period"},
    {"multiplier", "modulus of the largest multiplier"},
    {"arclength", "arclength"},
    {"lyapunov", "Lyapunov exponent"},
    {"ending_time", "time at the end"},
    {"cycles", "returns until settled"},
    {"slowest_approach", "least speed of approach"},
    {"error", "error"},
    {"rotation_number", "rotation number"},
    {"torus_growth", "growth of deviations per return"},
}};

/// Descriptions of the values of runs of kind identify.
constexpr std::array<std::pair<const char*, const char*>, 4> words_of_estimates{{
    {"t", "time"},
    {"peak", "peak of the decay"},
    {"before", "velocity before an impact"},
    {"after", "velocity after it"},
}};

const std::string* given_name(const StudyPicture& picture, const std::string& name) {
    for (const auto& one : picture.names)
        if (one.first == name)
            return &one.second;
    return nullptr;
}

template <class List>
std::string text_in(const List& list, const std::string& name) {
    for (const auto& one : list)
        if (one.name == name)
            return first_words(one.text);
    return "";
}

std::string words_of_model(const Model& model, const std::string& name) {
    for (const std::string& words : {text_in(model.parameters, name), text_in(model.states, name),
                                     text_in(model.quantities, name), text_in(model.definitions, name)})
        if (!words.empty())
            return words;
    return "";
}

/// Descriptions of the default monitors of branches, such as max_x.
std::string words_of_extremum(const StoredRun& run, const std::string& name) {
    for (const auto& [start, kind, which] : {std::tuple{"max_", Monitor::Kind::maximum, "greatest"},
                                             std::tuple{"min_", Monitor::Kind::minimum, "least"}}) {
        if (!name.starts_with(start))
            continue;
        const std::string words = words_of_model(run.model, name.substr(4));
        try {
            const StudyRun branch = stored_run(run.record);
            for (const Monitor& monitor : branch.branch().settings.monitors)
                if (!words.empty() && monitor.name == name && monitor.kind == kind)
                    return fmt::format("{} {}", which, words);
        } catch (const InputError&) { // settings of another version: only the name is shown
        }
    }
    return "";
}

} // namespace

std::string first_words(const std::string& text) {
    std::string words = text.substr(0, text.find_first_of(";,(:"));
    words.erase(words.find_last_not_of(" .") + 1);
    return words;
}

std::string shown_name(const StudyPicture& picture, const std::string& name) {
    if (const std::string* given = given_name(picture, name))
        return *given;
    std::string words = name;
    std::replace(words.begin(), words.end(), '_', ' ');
    return words;
}

std::string shown_value(const StudyPicture& picture, const StoredRun& run, const std::string& name, double value) {
    const std::string unit = run.unit(name);
    return fmt::format("{} = {:.10g}{}{}", shown_name(picture, name), value, unit.empty() ? "" : " ", unit);
}

std::string words_of(const StoredRun& run, const std::string& name) {
    // A value or monitor of the study may have the name of a column: the column's description is wrong then.
    if (std::string words = words_of_model(run.model, name);
        !words.empty() && !(run.record.is_branch() && run.has_value(name)))
        return words;
    if (run.record.is_branch() && run.has_value(name))
        return words_of_extremum(run, name);
    if (run.record.kind == name_of(RunKind::identify))
        for (const auto& [column, words] : words_of_estimates)
            if (name == column)
                return words;
    for (const auto& [column, words] : words_of_columns)
        if (name == column && !run.has_value(name))
            return words;
    return "";
}

void label_axes(FigurePanel& panel, const StudyPicture& picture, const StoredRun& run, const std::string& x,
                const std::string& y) {
    const auto shown = [&](const std::string& name) {
        return NamedValue{name, name == "t" ? run.model.time_unit : run.unit(name), words_of(run, name), {}};
    };
    label_axis(panel.x_label, panel.x_words, panel.x_unit, picture, shown(x));
    label_axis(panel.y_label, panel.y_words, panel.y_unit, picture, shown(y));
}

void label_axis(std::string& label, std::string& words, std::string& unit, const StudyPicture& picture,
                const NamedValue& value) {
    const std::string* given = given_name(picture, value.name);
    label = given ? *given : value.name;
    words = given ? "" : first_words(value.text);
    unit = value.unit;
}

void apply_labels(FigurePanel& panel, const StudyPicture& picture, std::size_t index) {
    if (!picture.x_label.empty()) {
        panel.x_label = picture.x_label;
        panel.x_unit = panel.x_words = "";
    }
    if (index < picture.y_labels.size() && !picture.y_labels[index].empty()) {
        panel.y_label = picture.y_labels[index];
        panel.y_unit = panel.y_words = "";
    }
}

} // namespace graze
