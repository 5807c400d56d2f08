#include "graze/study/showable_names.hpp"

#include "graze/base/name_list.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/symbolic/parser.hpp"
#include "results/orbit_columns.hpp"
#include "results/point_columns.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

template <class Items>
void add_names(std::vector<std::string>& names, const Items& items) {
    for (const auto& item : items)
        names.push_back(item.name);
}

} // namespace

ShowableNames::ShowableNames(const StudyPicture& picture)
    : others_{"t", "multiplier", "frequency", picture.x, picture.group} {
    others_.insert(others_.end(), picture.y.begin(), picture.y.end());
    add_names(others_, kinds_of(point_columns()));
    add_names(others_, kinds_of(orbit_columns()));
    for (int label = 0; label <= static_cast<int>(Label::failed); ++label)
        others_.emplace_back(name_of(static_cast<Label>(label)));
}

void ShowableNames::add(const StudyRun& run) {
    own_.push_back(run.name);
    own_.insert(own_.end(), run.value_names.begin(), run.value_names.end());
    if (run.has_motions())
        add_names(own_, run.motion().axes);
    const std::vector<std::string> samplings = run.sampling_names();
    own_.insert(own_.end(), samplings.begin(), samplings.end());
    if (run.is_branch()) {
        own_.push_back(run.branch().attractor.section);
        add_names(own_, run.branch().settings.monitors);
    }
    add_model(run.model);
}

void ShowableNames::add(const RunRecord& run) {
    own_.push_back(run.name);
    add_names(own_, run.values);
    if (!run.is_branch()) // of which all parameters are there
        add_names(own_, run.coordinates);
    own_.insert(own_.end(), run.samplings.begin(), run.samplings.end());
    add_model(stored_model(run));
}

void ShowableNames::add_model(const Model& model) {
    add_names(others_, model.parameters);
    add_names(others_, model.states);
    add_names(others_, model.definitions);
    add_names(others_, model.quantities);
    add_names(others_, model.modes);
    add_names(others_, model.events);
    add_names(others_, model.sections);
    for (const Transition& transition : model.transitions)
        others_.push_back(transition.label);
}

void ShowableNames::require(const std::string& name, const Place& place, const std::string& subject) const {
    std::vector<std::string> own = own_;
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    std::vector<std::string> all = others_;
    all.insert(all.end(), own.begin(), own.end());
    // Attractors are called by their period and signature.
    if (name.starts_with("period ") || std::find(all.begin(), all.end(), name) != all.end())
        return;
    const std::string nearest = nearest_name(name, all);
    throw InputError(place, fmt::format("{}: the picture shows nothing of that name", subject),
                     name_advice(name, nearest.empty() ? own : std::vector<std::string>{nearest}, "there are none"));
}

} // namespace graze
