#include "atlas/explored_orbits.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

namespace graze {

namespace {

/// The one in the middle.
template <class One>
const One& middle(const std::vector<One>& all) {
    return all[all.size() / 2];
}

} // namespace

ExploredOrbits::ExploredOrbits(const Study& study, const StudyRun& atlas, const ResultFile& file)
    : atlas_(&atlas), runs_(read_atlas(study, atlas, file)), comparison_(study, atlas, file) {
    read_decisions(file);
    find_same_branches();
    find_same_curves();
    explain();
}

/// Lines of a stranger harm nothing: a branch that is not known, or that cannot be the one, is not used.
void ExploredOrbits::read_decisions(const ResultFile& file) {
    std::istringstream lines(file.note(note_of(*atlas_)).value_or(""));
    std::string word, run, other;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        words >> word >> run;
        std::size_t number = 0, point = 0;
        if (word == "same" && words >> other)
            same_[run] = other;
        else if (word == "on" && words >> number >> other >> point)
            explanations_[{run, number}] = {other, point, ""};
        else if (word == "not" && words >> number)
            while (words >> other)
                compared_[{run, number}].insert(other);
    }
    std::erase_if(explanations_, [&](const auto& one) { return !is_possible(one.first, one.second); });
}

/// Whether a branch has been followed in the row of a sample, about its value.
bool ExploredOrbits::is_possible(const SampleKey& key, const Explanation& explanation) const {
    const auto sample = std::ranges::find_if(runs_.samples, [&](const SampledMotion& one) {
        return one.run->name == key.first && one.number == key.second;
    });
    const auto branch = std::ranges::find(runs_.branches, explanation.branch, &FollowedRun::name);
    if (sample == runs_.samples.end() || branch == runs_.branches.end() || branch->row != sample->row ||
        !is_followable(*sample))
        return false;
    const auto before = std::ranges::find(branch->orbits, explanation.number, &FollowedOrbit::number);
    if (before == branch->orbits.end() || before + 1 == branch->orbits.end())
        return false;
    const auto [low, high] = std::minmax(before->mark.at[0], (before + 1)->mark.at[0]);
    const double room = same_place * runs_.scales.at[0];
    return sample->value >= low - room && sample->value <= high + room;
}

std::string ExploredOrbits::decisions() const {
    std::string text;
    for (const auto& [run, earlier] : same_)
        text += fmt::format("same {} {}\n", run, earlier);
    for (const auto& [sample, explanation] : explanations_)
        if (!explanation.branch.empty())
            text +=
                fmt::format("on {} {} {} {}\n", sample.first, sample.second, explanation.branch, explanation.number);
        else if (const auto found = compared_.find(sample); found != compared_.end() && !found->second.empty())
            text += fmt::format("not {} {} {}\n", sample.first, sample.second, fmt::join(found->second, " "));
    return text;
}

void ExploredOrbits::find_same_branches() {
    for (std::size_t i = 0; i < runs_.branches.size(); ++i) {
        FollowedRun& one = runs_.branches[i];
        if (one.orbits.empty())
            continue;
        if (const auto known = same_.find(one.name()); known != same_.end()) {
            for (std::size_t k = 0; k < i; ++k)
                if (runs_.branches[k].is_found() && runs_.branches[k].name() == known->second)
                    one.same_as = &runs_.branches[k];
            if (one.same_as || known->second == "-")
                continue;
        }
        // Its orbit in the middle, far from where branches meet.
        std::vector<const FollowedOrbit*> regular;
        for (const FollowedOrbit& orbit : one.orbits)
            if (!orbit.is_special())
                regular.push_back(&orbit);
        const OrbitMark& mark = regular.empty() ? middle(one.orbits).mark : middle(regular)->mark;
        for (std::size_t k = 0; k < i && !one.same_as; ++k) {
            const FollowedRun& other = runs_.branches[k];
            if (other.is_found() && other.row == one.row && comparison_.place_on(other, mark, runs_.scales, false))
                one.same_as = &other;
        }
        same_[one.name()] = one.same_as ? one.same_as->name() : "-";
    }
}

/// Two curves of the same type that have a located point in common are one curve, also where one of them has the orbits
/// of the other one run through twice. So do touches where orbits of twice the period with one contact begin.
void ExploredOrbits::find_same_curves() {
    for (std::size_t i = 0; i < runs_.curves.size(); ++i) {
        FollowedRun& one = runs_.curves[i];
        for (std::size_t k = 0; k < i && !one.same_as; ++k) {
            const FollowedRun& other = runs_.curves[k];
            if (other.kept != one.kept || !other.is_found())
                continue;
            const bool meets = std::ranges::any_of(one.orbits, [&](const FollowedOrbit& orbit) {
                if (!orbit.is_special() || orbit.type == PointType::end || orbit.type == PointType::branch_point)
                    return false;
                const FollowedOrbit* there = other.special_at(orbit.mark, runs_.scales, true);
                return there && there->type == orbit.type;
            });
            if (meets)
                one.same_as = &other;
        }
    }
}

bool ExploredOrbits::is_followable(const SampledMotion& sample) const {
    const AtlasLimits& limits = atlas_->motion().atlas;
    return sample.result.label == Label::periodic && !sample.accumulates && sample.result.period <= limits.multiple &&
           sample.contacts <= limits.contacts * sample.result.period;
}

void ExploredOrbits::explain() {
    for (const SampledMotion& sample : runs_.samples) {
        if (!is_followable(sample))
            continue;
        const std::pair key(sample.run->name, sample.number);
        Explanation& explanation = explanations_[key];
        if (!explanation.branch.empty())
            continue;
        std::set<std::string>& compared = compared_[key];
        std::optional<OrbitMark> mark;
        std::vector<const FollowedRun*> branches; // that from which it began first: others may have some of its orbits
        for (const FollowedRun& branch : runs_.branches)
            branches.insert(sample.run->start && sample.run->start->run == branch.name() ? branches.begin()
                                                                                         : branches.end(),
                            &branch);
        for (const FollowedRun* const one : branches) {
            const FollowedRun& branch = *one;
            if (!branch.is_found() || branch.row != sample.row || !compared.insert(branch.name()).second)
                continue;
            if (!mark)
                mark = comparison_.mark_of(sample, explanation.why);
            if (!mark)
                break;
            if (const auto point = comparison_.place_on(branch, *mark, runs_.scales, true)) {
                explanation = {branch.name(), *point, ""};
                break;
            }
        }
    }
}

const Explanation* ExploredOrbits::explanation(const SampledMotion& sample) const {
    const auto found = explanations_.find({sample.run->name, sample.number});
    return found == explanations_.end() ? nullptr : &found->second;
}

std::vector<std::pair<std::size_t, std::size_t>> ExploredOrbits::stable_stretches(const FollowedRun& branch) {
    std::vector<std::pair<std::size_t, std::size_t>> stretches;
    bool open = false;
    for (std::size_t i = 0; i < branch.orbits.size(); ++i) {
        const FollowedOrbit& orbit = branch.orbits[i];
        if (orbit.is_special())
            continue; // bifurcations are not stable; the orbits around them say what is
        if (!orbit.stable || !orbit.physical) {
            open = false;
            continue;
        }
        if (open)
            stretches.back().second = i;
        else
            stretches.emplace_back(i, i);
        open = true;
    }
    return stretches;
}

const SampledMotion* ExploredOrbits::confirmation(const FollowedRun& branch,
                                                  std::pair<std::size_t, std::size_t> stretch) const {
    for (const SampledMotion& sample : runs_.samples) {
        const Explanation* found = explanation(sample);
        if (!found || found->branch != branch.name())
            continue;
        const auto before = std::ranges::find(branch.orbits, found->number, &FollowedOrbit::number);
        const auto index = static_cast<std::size_t>(before - branch.orbits.begin());
        // The motion lies between this orbit and the next one.
        if (index + 1 >= stretch.first && index <= stretch.second)
            return &sample;
    }
    return nullptr;
}

} // namespace graze
