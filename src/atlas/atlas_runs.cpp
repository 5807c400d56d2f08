#include "atlas/atlas_runs.hpp"

#include "base/read_whole.hpp"
#include "graze/orbit/signature.hpp"
#include "graze/results/stored_orbit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string_view>

namespace graze {

namespace {

/// What a run that makes orbits takes over from the point at which it begins.
struct Origin {
    std::size_t multiple = 1;
    PointType type = PointType::regular;
    bool at_end = false; ///< of a touch
};

/// The same signature, however it is turned round: where the list of segments begins has no meaning.
Signature turned(const Model& model, const Signature& signature) {
    const auto names = [&](const Signature& one) {
        std::vector<std::string> all;
        for (const Segment& segment : one)
            all.push_back(end_name(model, segment));
        return all;
    };
    Signature best = signature, next = signature;
    for (std::size_t i = 1; i < signature.size(); ++i) {
        std::rotate(next.begin(), next.begin() + 1, next.end());
        if (names(next) < names(best))
            best = next;
    }
    return best;
}

constexpr std::string_view chattering = "*"; ///< behind the label of a contact, in signatures of motions

class Reader {
public:
    Reader(const Study& study, const StudyRun& atlas, const ResultFile& file) : study_(&study), file_(&file) {
        runs_.atlas = &atlas;
        for (const Variation& axis : atlas.motion().axes)
            runs_.scales.at.push_back(axis.values.back() - axis.values.front());
        runs_.rows = runs_.has_rows() ? runs_.axis(1).values : std::vector{std::numeric_limits<double>::quiet_NaN()};
        for (double& width : runs_.scales.at)
            width = width > 0 ? width : 1;
    }

    AtlasRuns read() {
        read_samples(*runs_.atlas);
        for (const StudyRun& run : study_->runs)
            if (is_made_by(run.name, runs_.atlas->name))
                run.has_motions() ? read_samples(run) : read_followed(run);
        std::vector<const OrbitMark*> marks;
        for (const auto* all : {&runs_.branches, &runs_.curves})
            for (const FollowedRun& one : *all)
                for (const FollowedOrbit& orbit : one.orbits)
                    marks.push_back(&orbit.mark);
        runs_.scales.fit(marks);
        return std::move(runs_);
    }

private:
    bool is_barrier(std::size_t event) const { return runs_.atlas->model.events[event].kind == EventKind::barrier; }

    /// @param touch whether one of them has no speed, which does not count
    std::size_t contacts_of(const Orbit& orbit, bool touch) const {
        const auto count = std::ranges::count_if(orbit.signature, [&](const Segment& one) {
            return ends_by_transition(one) && is_barrier(runs_.atlas->model.transitions[one.index].event);
        });
        return (static_cast<std::size_t>(count) - (touch && count > 0 ? 1 : 0)) * (orbit.symmetry ? 2 : 1);
    }

    /// The transition whose label comes next in a signature; null: none does. Labels may contain blanks and colons, so
    /// that the longest one counts.
    const Transition* transition_at(std::string_view text) const {
        const Transition* longest = nullptr;
        for (const Transition& one : runs_.atlas->model.transitions) {
            const std::string_view label = one.label;
            if (!text.starts_with(label) || (longest && longest->label.size() >= label.size()))
                continue;
            const std::string_view rest = text.substr(label.size());
            if (rest.empty() || rest.front() == ' ' || rest.front() == '^' || rest.starts_with(chattering))
                longest = &one;
        }
        return longest;
    }

    /// Counts the contacts in the signature of a sample, "J1 J8 impact^3".
    void count_contacts(SampledMotion& sample) const {
        std::string_view text = sample.result.signature;
        while (!text.empty()) {
            const Transition* const next = transition_at(text);
            if (next)
                text.remove_prefix(next->label.size());
            std::string_view word = text.substr(0, text.find(' ')); // what follows the label
            text.remove_prefix(std::min(word.size() + 1, text.size()));
            if (!next)
                continue; // it was written by somebody else
            if (word.starts_with(chattering)) {
                sample.accumulates = true;
                word.remove_prefix(chattering.size());
            }
            std::size_t times = 1;
            if (word.starts_with('^') && !read_whole(std::string(word.substr(1)), times))
                times = 1;
            sample.contacts += is_barrier(next->event) ? times : 0;
        }
    }

    std::size_t row_of(double value) const {
        std::size_t row = 0;
        for (std::size_t i = 1; i < runs_.rows.size(); ++i)
            if (std::abs(runs_.rows[i] - value) < std::abs(runs_.rows[row] - value))
                row = i;
        return row;
    }

    void read_samples(const StudyRun& run) {
        const auto record = file_->find_run(run.name);
        if (!record)
            return;
        std::vector<std::size_t> columns; // of the parameters of the atlas
        for (const Variation& axis : runs_.atlas->motion().axes)
            for (std::size_t i = 0; i < record->coordinates.size(); ++i)
                if (record->coordinates[i].name == axis.name)
                    columns.push_back(i);
        if (columns.size() != runs_.atlas->motion().axes.size())
            return;
        const auto next = file_->points(run.name);
        while (auto point = next()) {
            SampledMotion& sample = runs_.samples.emplace_back();
            sample.run = &run;
            sample.number = point->number;
            sample.value = point->coordinates[columns[0]];
            sample.row = runs_.has_rows() ? row_of(point->coordinates[columns[1]]) : 0;
            sample.result = std::move(point->result);
            sample.result.samples = {};
            count_contacts(sample);
        }
    }

    /// @return nothing where the run from which it starts is not there
    std::optional<Origin> origin_of(const StudyRun& run) const {
        if (!run.start)
            return std::nullopt;
        if (const FollowedRun* parent = runs_.find(run.start->run)) {
            const auto point = std::ranges::find(parent->orbits, run.start->point, &FollowedOrbit::label);
            if (point == parent->orbits.end())
                return std::nullopt;
            const bool doubles = run.kind == RunKind::follow && point->type == PointType::flip;
            return Origin{parent->multiple * (doubles ? 2 : 1), point->type, point->at_end};
        }
        for (const SampledMotion& sample : runs_.samples)
            if (sample.run->name == run.start->run && std::to_string(sample.number) == run.start->point)
                return Origin{std::max<std::size_t>(sample.result.period, 1)};
        return std::nullopt;
    }

    /// @param touch whether all orbits of the run have a contact of no speed
    FollowedOrbit orbit_of(const OrbitRecord& record, const std::vector<std::size_t>& extents,
                           std::optional<std::size_t> period, bool touch) const {
        const SpecialPoint& point = record.point;
        FollowedOrbit orbit;
        orbit.number = record.number;
        orbit.part = record.part;
        orbit.label = record.label;
        orbit.type = point.type;
        orbit.stable = record.stable;
        orbit.located = point.located;
        orbit.physical = !is_unphysical(record);
        orbit.at_end = point.at_end;
        orbit.detail = point.detail;
        orbit.contacts = contacts_of(point.solution.orbit, touch || (point.type == PointType::grazing && point.at_end));
        const Model& model = runs_.atlas->model;
        const Signature& signature = point.solution.orbit.signature;
        orbit.signature = point.solution.orbit.symmetry ? to_string(model, signature) + " and its image"
                                                        : to_string(model, turned(model, signature));
        for (const Variation& axis : runs_.atlas->motion().axes)
            orbit.mark.at.push_back(point.solution.orbit.parameters[axis.parameter.place()]);
        orbit.mark.period =
            period && *period < point.monitors.size() ? point.monitors[*period] : point.solution.orbit.period();
        for (const std::size_t i : extents)
            orbit.mark.extents.push_back(i < point.monitors.size() ? point.monitors[i] : 0);
        return orbit;
    }

    void read_followed(const StudyRun& run) {
        FollowedRun followed;
        followed.run = &run;
        const auto record = file_->find_run(run.name);
        const auto origin = origin_of(run);
        if (!record || !origin)
            return;
        followed.failure = record->failure;
        followed.multiple = origin->multiple;
        if (run.kind == RunKind::curve)
            followed.kept = point_type(run.start->onto).value_or(origin->type);
        const bool touch = followed.kept == PointType::grazing && origin->at_end;
        std::vector<std::size_t> extents;
        std::optional<std::size_t> period;
        const std::vector<Monitor>& monitors = run.branch().settings.monitors;
        for (std::size_t i = 0; i < monitors.size(); ++i)
            if (monitors[i].kind == Monitor::Kind::maximum || monitors[i].kind == Monitor::Kind::minimum)
                extents.push_back(i);
            else if (monitors[i].kind == Monitor::Kind::duration)
                period = i;
        for (const OrbitRecord& one : file_->orbits(run.name, false))
            if (one.point.solution.outcome == OrbitOutcome::converged) {
                followed.orbits.push_back(orbit_of(one, extents, period, touch));
            } else if (followed.failure.empty()) {
                followed.failure = one.point.detail;
            }
        note_ends(followed);
        put_in_line(followed.orbits);
        if (!followed.is_curve() && !followed.orbits.empty())
            followed.row = runs_.has_rows() ? row_of(followed.start().mark.at[1]) : 0;
        (followed.is_curve() ? runs_.curves : runs_.branches).push_back(std::move(followed));
    }

    /// The last point of each part says why the part ends.
    static void note_ends(FollowedRun& run) {
        std::map<std::string, std::string> last;
        for (const FollowedOrbit& orbit : run.orbits)
            last[orbit.part] = orbit.detail.empty() ? std::string(name_of(orbit.type)) : orbit.detail;
        for (const auto& [part, detail] : last)
            run.ends.emplace_back(part, detail);
    }

    /// Both parts begin at the same orbit, which the first one has.
    static void put_in_line(std::vector<FollowedOrbit>& orbits) {
        if (!orbits.empty())
            std::reverse(orbits.begin(), std::ranges::find_if(orbits, [&](const FollowedOrbit& orbit) {
                             return orbit.part != orbits.front().part;
                         }));
    }

    const Study* study_;
    const ResultFile* file_;
    AtlasRuns runs_;
};

} // namespace

const FollowedOrbit* FollowedRun::special_at(const OrbitMark& mark, const MarkScales& scales, bool multiples) const {
    for (const FollowedOrbit& orbit : orbits)
        if (orbit.is_special() && is_same_orbit(orbit.mark, mark, scales, multiples))
            return &orbit;
    return nullptr;
}

const FollowedOrbit& FollowedRun::start() const {
    return *std::ranges::min_element(orbits, {}, &FollowedOrbit::number);
}

std::pair<double, double> AtlasRuns::range(std::size_t i) const {
    const std::vector<double>& values = axis(i).values;
    return {values.front(), values.back()};
}

const FollowedRun* AtlasRuns::find(const std::string& run) const {
    for (const auto* all : {&branches, &curves})
        for (const FollowedRun& one : *all)
            if (one.name() == run)
                return &one;
    return nullptr;
}

bool is_made_by(const std::string& run, const std::string& atlas) {
    return run.size() > atlas.size() + 1 && run.starts_with(atlas) && run[atlas.size()] == '.';
}

bool is_computed(const Study& study, const StudyRun& atlas, const ResultFile& file) {
    return std::ranges::all_of(study.runs, [&](const StudyRun& run) {
        const bool is_made = is_made_by(run.name, atlas.name);
        if (!is_made && run.name != atlas.name)
            return true;
        const auto record = file.find_run(run.name);
        return record && (record->status == RunStatus::complete || (is_made && record->status == RunStatus::failed));
    });
}

AtlasRuns read_atlas(const Study& study, const StudyRun& atlas, const ResultFile& file) {
    return Reader(study, atlas, file).read();
}

} // namespace graze
