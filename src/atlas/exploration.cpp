#include "atlas/exploration.hpp"

#include "base/read_whole.hpp"
#include "branch/point_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

namespace graze {

namespace {

constexpr std::size_t most_tries = 3; ///< motions of one kind in a row from which a branch is begun
constexpr std::size_t every = 4;      ///< values of the first parameter at which motions begin at random
constexpr double wider = 0.25;        ///< share of the extent by which random states may lie beyond it

/// Types of points on branches from which another branch of orbits leaves.
bool has_departure(PointType type) {
    return kind_of(type).has_bifurcating_branch && type != PointType::hopf;
}

/// Types whose curves are followed. Branch points have curves in symmetric models only, or along simpler orbits.
bool may_be_kept(PointType type) {
    return kind_of(type).may_be_kept && type != PointType::branch_point && type != PointType::hopf &&
           type != PointType::boundary_equilibrium; // equilibria are not explored
}

/// Points of curves from which no other curve is followed: no bifurcations, and branch points where a curve meets
/// simpler orbits.
bool is_plain(PointType type) {
    static constexpr std::array plain{PointType::extremum,     PointType::bound, PointType::crossing,
                                      PointType::branch_point, PointType::end,   PointType::regular};
    return std::ranges::find(plain, type) != plain.end();
}

/// Whether a motion has reached where it stays.
bool has_settled(Label label) {
    static constexpr std::array settled{Label::periodic, Label::quasi_periodic, Label::chaotic, Label::transient,
                                        Label::equilibrium};
    return std::ranges::find(settled, label) != settled.end();
}

std::string short_name_of(const FollowedOrbit& point) {
    return std::string(short_name(point.type));
}

/// The one in the middle.
template <class One>
const One& middle(const std::vector<One>& all) {
    return all[all.size() / 2];
}

/// A point of a branch.
struct BranchPlace {
    const FollowedRun* branch = nullptr;
    const FollowedOrbit* point = nullptr;
};

} // namespace

Exploration::Exploration(const Study& study, const StudyRun& atlas, const ResultFile& file)
    : study_(&study), atlas_(&atlas), explored_(study, atlas, file) {
    constexpr std::size_t greatest = 1'000'000; // a name with a greater number was given by a stranger
    for (const StudyRun& run : study.runs)
        if (is_made_by(run.name, atlas.name)) {
            const std::size_t end = run.name.find_last_not_of("0123456789") + 1;
            std::size_t number = 0;
            if (read_whole(run.name.substr(end), number) && number <= greatest)
                counts_[run.name.substr(0, end)] = std::max(counts_[run.name.substr(0, end)], number);
        }
}

std::string Exploration::text_of(const std::vector<double>& at) const {
    std::string text;
    for (std::size_t i = 0; i < at.size(); ++i)
        text += fmt::format("{}{} = {:.6g}", text.empty() ? "" : ", ", known().axis(i).name, at[i]);
    return text;
}

void Exploration::leave(const std::string& what, const OrbitMark& mark, const std::string& why) {
    left_out_.push_back({what, text_of(mark.at), why});
}

bool Exploration::was_tried(const std::string& run, const std::string& point, const std::string& onto) const {
    return std::ranges::any_of(study_->runs, [&](const StudyRun& one) {
        return is_made_by(one.name, atlas_->name) && one.is_branch() && one.start && one.start->run == run &&
               one.start->point == point && one.start->onto == onto;
    });
}

StudyRun Exploration::blank(RunKind kind, const std::string& stem) {
    StudyRun run = *atlas_;
    const std::string name = atlas_->name + "." + stem;
    run.name = fmt::format("{}{}", name, ++counts_[name]);
    run.text.clear();
    run.place = {};
    run.point_names.clear();
    run.set_kind(kind);
    return run;
}

StudyRun Exploration::following(RunKind kind, const std::string& run, const std::string& point,
                                const std::string& onto) {
    StudyRun result = blank(kind, kind == RunKind::curve ? "curve" : "branch");
    result.start = StartFrom{};
    result.start->run = run;
    result.start->point = point;
    result.start->onto = onto;
    BranchRequest& request = result.branch();
    request.direction = SweepDirection::both;
    request.attractor = atlas_->motion().attractor;
    request.simulation = atlas_->motion().simulation;
    request.settings.monitors = mark_monitors(atlas_->model);
    request.settings.parameter = known().axis(0).parameter;
    request.settings.least = known().range(0).first;
    request.settings.greatest = known().range(0).second;
    if (kind == RunKind::curve) {
        const ParameterId second = known().axis(1).parameter;
        request.settings.free = {second};
        request.settings.free_bounds = {{second, known().range(1).first, known().range(1).second}};
        // Where it crosses a row of samples it is compared with the points of branches there.
        Monitor& row = request.settings.monitors.emplace_back();
        row.name = "row";
        row.unit = known().axis(1).unit;
        row.kind = Monitor::Kind::start;
        row.expression = atlas_->model.symbol(known().axis(1).name);
        row.segment = "1";
        row.crossings = known().rows;
    }
    return result;
}

/// Cuts a list of runs to what the limits allow, and notes what is left out.
std::vector<StudyRun> Exploration::within_limits(std::vector<StudyRun> runs, RunKind kind, std::size_t most) {
    const std::size_t there = kind == RunKind::curve ? known().curves.size() : known().branches.size();
    const std::size_t room = most - std::min(most, there);
    for (std::size_t i = room; i < runs.size(); ++i)
        left_out_.push_back(
            {kind == RunKind::curve ? "curve" : "branch",
             fmt::format("from {} of {}", runs[i].start->point, runs[i].start->run),
             fmt::format("{} {} have been followed: {}", most, kind == RunKind::curve ? "curves" : "branches",
                         kind == RunKind::curve ? "`curves`" : "`branches`")});
    limited_ = limited_ || runs.size() > room;
    if (runs.size() > room)
        runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(room), runs.end());
    return runs;
}

/// Ranges of initial states at random: those that are asked for, or about the extents of the sampled motions that have
/// settled. Others may have grown without bound.
std::vector<AtlasStart> Exploration::ranges_of_starts() const {
    const Model& model = atlas_->model;
    const std::vector<AtlasStart>& given = atlas_->motion().atlas.starts;
    std::vector<AtlasStart> ranges = given;
    for (std::size_t i = 0; given.empty() && i < model.states.size(); ++i) {
        double least = std::numeric_limits<double>::infinity(), greatest = -least;
        for (const SampledMotion& sample : known().samples)
            if (sample.run == atlas_ && has_settled(sample.result.label) && i < sample.result.state.size()) {
                least = std::min(least, sample.result.state[i]);
                greatest = std::max(greatest, sample.result.state[i]);
            }
        if (model.states[i].period || model.states[i].drifting || greatest <= least)
            continue;
        const double room = wider * (greatest - least), reach = std::max(std::abs(least), std::abs(greatest));
        AtlasStart range{model.states[i].name, least - room, greatest + room};
        // Other attractors often lie on the other side of zero, unless the state stays far from it.
        if (greatest - least > reach / 2) {
            range.low = std::min(range.low, -reach);
            range.high = std::max(range.high, reach);
        }
        ranges.push_back(range);
    }
    return ranges;
}

/// Motions from states at random, at some of the sampled parameters.
std::vector<StudyRun> Exploration::random_motions() {
    const AtlasLimits& limits = atlas_->motion().atlas;
    const std::string name = atlas_->name + ".starts";
    if (limits.draws == 0 || study_->find_run(name))
        return {};
    const std::vector<AtlasStart> starts = ranges_of_starts();
    if (starts.empty())
        return {};
    StudyRun run = *atlas_;
    run.name = name;
    run.text.clear();
    run.kind = RunKind::basin;
    MotionRequest& request = run.motion();
    request.carry = false;
    request.direction = SweepDirection::up;
    request.seed = limits.seed;
    request.draws = limits.draws;
    request.atlas = {};
    std::vector<double> some;
    for (std::size_t i = every / 2; i < request.axes[0].values.size(); i += every)
        some.push_back(request.axes[0].values[i]);
    if (some.empty())
        some.push_back(middle(request.axes[0].values));
    request.axes[0].values = some;
    for (const AtlasStart& start : starts) {
        Variation& axis = request.axes.emplace_back();
        axis.name = start.state;
        axis.state = atlas_->model.find_state(start.state);
        axis.unit = atlas_->model.states[*axis.state].unit;
        axis.low = start.low;
        axis.high = start.high;
    }
    return {run};
}

/// Branches through sampled orbits that lie on none yet: one of each kind in a row.
std::vector<StudyRun> Exploration::branches_of_motions() {
    using Kind = std::tuple<std::size_t, std::size_t, std::string>; // row, period, contacts
    std::map<Kind, std::vector<const SampledMotion*>> open;
    std::map<Kind, std::size_t> tries;
    for (const SampledMotion& sample : known().samples) {
        if (!explored_.is_followable(sample) || !explored_.explanation(sample)->branch.empty())
            continue;
        const Kind kind(sample.row, sample.result.period, sample.result.signature);
        if (was_tried(sample.run->name, std::to_string(sample.number)))
            ++tries[kind];
        else
            open[kind].push_back(&sample);
    }
    std::vector<StudyRun> runs;
    for (const auto& [kind, samples] : open)
        if (tries[kind] < most_tries)
            runs.push_back(
                following(RunKind::follow, middle(samples)->run->name, std::to_string(middle(samples)->number), ""));
    return within_limits(std::move(runs), RunKind::follow, atlas_->motion().atlas.branches);
}

/// Whether the branch that leaves a point is within the limits; notes it otherwise.
bool Exploration::may_leave(const FollowedRun& branch, const FollowedOrbit& point) {
    const AtlasLimits& limits = atlas_->motion().atlas;
    if (point.detail == returned_to_simpler) { // what leaves there is the simpler orbit run through twice
        leave("simpler orbits", point.mark, "no motion has settled on them");
        return false;
    }
    if (point.type == PointType::flip && 2 * branch.multiple > limits.multiple) {
        leave("orbits of twice the period", point.mark,
              fmt::format("their period of {} returns exceeds `multiple`", 2 * branch.multiple));
        return false;
    }
    return point.type != PointType::grazing || point.at_end ||
           may_have_contacts(point, point.contacts + 1, branch.multiple);
}

/// Whether orbits with so many contacts are within the limits; notes it otherwise.
bool Exploration::may_have_contacts(const FollowedOrbit& point, std::size_t contacts, std::size_t multiple) {
    if (contacts <= atlas_->motion().atlas.contacts * multiple)
        return true;
    leave("orbits with one contact more", point.mark, fmt::format("their {} contacts exceed `contacts`", contacts));
    return false;
}

/// Other branches that leave the special points of branches.
std::vector<StudyRun> Exploration::branches_of_points() {
    std::vector<StudyRun> runs;
    for (const FollowedRun& branch : known().branches) {
        if (!branch.is_found())
            continue;
        for (const FollowedOrbit& point : branch.orbits) {
            if (!point.is_special() || !point.located || !has_departure(point.type) ||
                was_tried(branch.name(), point.label, "other"))
                continue;
            const bool is_known = std::ranges::any_of(known().branches, [&](const FollowedRun& other) {
                return other.is_found() && &other != &branch && other.row == branch.row &&
                       other.special_at(point.mark, known().scales, true);
            });
            if (!is_known && may_leave(branch, point))
                runs.push_back(following(RunKind::follow, branch.name(), point.label, "other"));
        }
    }
    return within_limits(std::move(runs), RunKind::follow, atlas_->motion().atlas.branches);
}

/// Whether a touch with which a contact begins is a touch of orbits without this contact, too. These are better to
/// follow: their multipliers are defined.
bool Exploration::is_seen_from_inside(const FollowedRun& branch, const FollowedOrbit& point) const {
    return point.at_end && std::ranges::any_of(known().branches, [&](const FollowedRun& other) {
               if (!other.is_found() || other.row != branch.row)
                   return false;
               const FollowedOrbit* there = other.special_at(point.mark, known().scales, true);
               return there && there->type == point.type && !there->at_end;
           });
}

/// Curves through points of branches that lie on none yet: one of each kind.
std::vector<StudyRun> Exploration::curves_of_branches() {
    std::map<std::tuple<PointType, std::size_t, std::string>, std::vector<BranchPlace>> open;
    for (const FollowedRun& branch : known().branches) {
        if (!branch.is_found())
            continue;
        for (const FollowedOrbit& point : branch.orbits) {
            if (!point.is_special() || !point.located || was_tried(branch.name(), point.label, short_name_of(point)))
                continue;
            if (!may_be_kept(point.type)) {
                if (!is_plain(point.type))
                    leave(fmt::format("curves of type {}", short_name(point.type)), point.mark,
                          "such curves are not followed");
                continue;
            }
            const bool is_known = std::ranges::any_of(known().curves, [&](const FollowedRun& curve) {
                return !curve.orbits.empty() && curve.kept == point.type &&
                       curve.special_at(point.mark, known().scales);
            });
            if (!is_known && !is_seen_from_inside(branch, point))
                open[{point.type, branch.multiple, point.signature}].push_back({&branch, &point});
        }
    }
    std::vector<StudyRun> runs;
    for (const auto& [kind, starts] : open)
        runs.push_back(following(RunKind::curve, middle(starts).branch->name(), middle(starts).point->label,
                                 short_name_of(*middle(starts).point)));
    return within_limits(std::move(runs), RunKind::curve, atlas_->motion().atlas.curves);
}

/// Whether another curve through a point of a curve is not known yet and within the limits; notes it otherwise.
bool Exploration::may_begin(const FollowedRun& curve, const FollowedOrbit& point, PointType type) {
    if (type == curve.kept || !may_be_kept(type) || was_tried(curve.name(), point.label, std::string(short_name(type))))
        return false;
    const bool is_known = std::ranges::any_of(known().curves, [&](const FollowedRun& other) {
        return !other.orbits.empty() && other.kept == type && other.special_at(point.mark, known().scales);
    });
    const bool begins_contact = type != PointType::grazing && curve.kept == PointType::grazing;
    return !is_known && (!begins_contact || may_have_contacts(point, point.contacts + 1, curve.multiple));
}

/// Other curves that pass through the special points of curves, or begin there.
std::vector<StudyRun> Exploration::curves_of_curves() {
    std::vector<StudyRun> runs;
    for (const FollowedRun& curve : known().curves) {
        std::set<PointType> begun; // of each type one at a time: it may well lead to the next such point
        for (const FollowedOrbit& point : curve.orbits) {
            if (!point.is_special() || !point.located || is_plain(point.type))
                continue;
            for (const PointType type : explored_.comparison().curves_through(curve, point))
                if (!begun.contains(type) && may_begin(curve, point, type)) {
                    begun.insert(type);
                    runs.push_back(following(RunKind::curve, curve.name(), point.label, std::string(short_name(type))));
                }
        }
    }
    return within_limits(std::move(runs), RunKind::curve, atlas_->motion().atlas.curves);
}

/// A motion that begins on an orbit of a branch.
StudyRun Exploration::checking(const FollowedRun& branch, const FollowedOrbit& begin) {
    StudyRun run = blank(RunKind::basin, "check");
    run.motion() = atlas_->motion();
    run.motion().atlas = {};
    run.motion().carry = false;
    run.motion().direction = SweepDirection::up;
    for (std::size_t i = 0; i < run.motion().axes.size(); ++i)
        run.motion().axes[i].values = {begin.mark.at[i]};
    run.start = StartFrom{};
    run.start->run = branch.name();
    run.start->point = std::to_string(begin.number);
    return run;
}

/// Motions that begin on stable orbits where none has been sampled.
std::vector<StudyRun> Exploration::confirming_motions() {
    std::vector<StudyRun> runs;
    for (const FollowedRun& branch : known().branches) {
        if (!branch.is_found())
            continue;
        for (const auto& stretch : ExploredOrbits::stable_stretches(branch)) {
            if (explored_.confirmation(branch, stretch))
                continue;
            std::vector<const FollowedOrbit*> regular;
            for (std::size_t i = stretch.first; i <= stretch.second; ++i)
                if (!branch.orbits[i].is_special())
                    regular.push_back(&branch.orbits[i]);
            const FollowedOrbit& begin = *middle(regular);
            const bool tried = std::ranges::any_of(study_->runs, [&](const StudyRun& one) {
                return is_made_by(one.name, atlas_->name) && one.has_motions() && one.start &&
                       one.start->run == branch.name() && one.start->point == std::to_string(begin.number);
            });
            if (tried)
                continue;
            runs.push_back(checking(branch, begin));
        }
    }
    return runs;
}

std::vector<StudyRun> Exploration::next() {
    std::vector<StudyRun> runs = random_motions();
    const auto otherwise = [&](std::vector<StudyRun> (Exploration::*more)()) {
        if (runs.empty())
            runs = (this->*more)();
    };
    otherwise(&Exploration::branches_of_motions);
    otherwise(&Exploration::branches_of_points);
    if (known().has_rows()) {
        otherwise(&Exploration::curves_of_branches);
        otherwise(&Exploration::curves_of_curves);
    }
    otherwise(&Exploration::confirming_motions);
    return runs;
}

} // namespace graze
