#include "graze/atlas/atlas_findings.hpp"

#include "atlas/exploration.hpp"
#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

namespace graze {

namespace {

/// 0 -> "a", 25 -> "z", 26 -> "aa".
std::string letters(std::size_t number) {
    std::string text(1, static_cast<char>('a' + number % 26));
    return number < 26 ? text : letters(number / 26 - 1) + text;
}

bool is_listed(PointType type) {
    return type != PointType::end && type != PointType::crossing && type != PointType::bound &&
           type != PointType::regular && type != PointType::extremum;
}

bool is_of_codimension_two(PointType type) {
    return type >= PointType::cusp && type <= PointType::flip_torus;
}

bool crosses(const AtlasCurve& curve, double value, double low, double high) {
    for (std::size_t i = 0; i + 1 < curve.line.size(); ++i) {
        const auto& [x1, y1] = curve.line[i];
        const auto& [x2, y2] = curve.line[i + 1];
        if ((x1 < value) == (x2 < value))
            continue;
        const double y = y1 + (value - x1) / (x2 - x1) * (y2 - y1);
        if (y >= low && y <= high)
            return true;
    }
    return false;
}

class Summary {
public:
    Summary(const Exploration& exploration, AtlasFindings& findings)
        : exploration_(&exploration), explored_(&exploration.explored()), runs_(&explored_->runs()),
          findings_(&findings) {}

    void make() {
        note_axes();
        note_curves();
        note_branches();
        note_points();
        note_motions();
        note_changes();
        note_remainders();
    }

private:
    void note_axes() {
        for (const Variation& axis : runs_->atlas->motion().axes)
            findings_->axes.push_back({axis.name, axis.unit, axis.values.front(), axis.values.back()});
        if (runs_->has_rows())
            findings_->rows = runs_->rows;
    }

    static std::vector<std::string> ends_of(const FollowedRun& run) {
        std::vector<std::string> ends;
        for (const auto& [part, why] : run.ends)
            ends.push_back(part + ": " + why);
        if (!run.failure.empty())
            ends.push_back(run.failure);
        return ends;
    }

    static std::vector<std::string> same_as(const FollowedRun& run, const std::vector<FollowedRun>& all) {
        std::vector<std::string> names;
        for (const FollowedRun& one : all)
            if (one.same_as == &run)
                names.push_back(one.name());
        return names;
    }

    void note_curves() {
        std::map<PointType, std::size_t> counts;
        for (const FollowedRun& run : runs_->curves) {
            if (!run.is_found())
                continue;
            AtlasCurve& curve = findings_->curves.emplace_back();
            curve.name = fmt::format("{}-{}", short_name(run.kept), letters(counts[run.kept]++));
            curve.type = run.kept;
            curve.run = run.name();
            curve.same = same_as(run, runs_->curves);
            curve.multiple = run.multiple;
            curve.contacts = run.start().contacts;
            curve.signature = run.start().signature;
            curve.ends = ends_of(run);
            for (const FollowedOrbit& orbit : run.orbits)
                curve.line.push_back({orbit.mark.at[0], orbit.mark.at[1]});
        }
    }

    void note_branches() {
        for (const FollowedRun& run : runs_->branches) {
            if (!run.is_found())
                continue;
            AtlasBranch& branch = findings_->branches.emplace_back();
            branch.run = run.name();
            branch.same = same_as(run, runs_->branches);
            branch.row = *run.row;
            branch.multiple = run.multiple;
            branch.contacts = run.start().contacts;
            branch.signature = run.start().signature;
            branch.ends = ends_of(run);
            branch.least = branch.greatest = run.start().mark.at[0];
            for (const FollowedOrbit& orbit : run.orbits) {
                branch.least = std::min(branch.least, orbit.mark.at[0]);
                branch.greatest = std::max(branch.greatest, orbit.mark.at[0]);
            }
            for (const auto& stretch : ExploredOrbits::stable_stretches(run)) {
                const auto [from, to] = ends_of(run, stretch);
                const SampledMotion* motion = explored_->confirmation(run, stretch);
                branch.stable.push_back(
                    {from, to, motion ? fmt::format("{}:{}", motion->run->name, motion->number) : ""});
            }
        }
    }

    /// Up to the special points that end a stretch.
    static std::pair<double, double> ends_of(const FollowedRun& run, std::pair<std::size_t, std::size_t> stretch) {
        auto [first, last] = stretch;
        while (first > 0 && run.orbits[first - 1].is_special())
            --first;
        while (last + 1 < run.orbits.size() && run.orbits[last + 1].is_special())
            ++last;
        return std::minmax({run.orbits[first].mark.at[0], run.orbits[last].mark.at[0]});
    }

    std::string curve_name(const FollowedRun& run) const {
        for (const AtlasCurve& curve : findings_->curves)
            if (curve.run == run.name())
                return curve.name;
        return "";
    }

    struct Gathered {
        OrbitMark mark;
        AtlasPoint point;
    };

    /// What has been gathered of this orbit; it is begun where nothing has. Of an orbit and its repetition, which
    /// branches and curves of doubled orbits have where they meet it, the orbit tells.
    Gathered& gathered(std::vector<Gathered>& all, const FollowedRun& run, const FollowedOrbit& orbit) const {
        auto found = std::ranges::find_if(
            all, [&](const Gathered& one) { return is_same_orbit(one.mark, orbit.mark, runs_->scales, true); });
        if (found == all.end()) {
            all.emplace_back().point.on_row = true;
            found = all.end() - 1;
        } else if (found->point.multiple <= run.multiple) {
            return *found;
        }
        found->mark = orbit.mark;
        AtlasPoint& point = found->point;
        point.at = orbit.mark.at;
        point.period = orbit.mark.period;
        point.multiple = run.multiple;
        point.contacts = orbit.contacts;
        point.signature = orbit.signature;
        point.detail = orbit.detail;
        return *found;
    }

    /// A point of a curve is one of the curve's own type, too, where that is of codimension one as well.
    void gather(std::vector<Gathered>& all, const FollowedRun& run) const {
        for (const FollowedOrbit& orbit : run.orbits) {
            if (!orbit.is_special() || !orbit.located || !is_listed(orbit.type))
                continue;
            AtlasPoint& point = gathered(all, run, orbit).point;
            point.types.push_back(orbit.type);
            point.found.push_back(run.name() + ":" + orbit.label);
            if (!run.is_curve())
                continue;
            point.on_row = false;
            point.types.push_back(run.kept);
            point.curves.push_back(curve_name(run.same_as ? *run.same_as : run));
        }
    }

    /// A point lies on the curves of its own types, too, of which it is no special point.
    void add_own_curves(Gathered& one) {
        for (const FollowedRun& run : runs_->curves) {
            const bool is_own = std::ranges::find(one.point.types, run.kept) != one.point.types.end();
            if (is_own && !run.orbits.empty() && run.special_at(one.mark, runs_->scales))
                one.point.curves.push_back(curve_name(run.same_as ? *run.same_as : run));
        }
        make_unique(one.point.curves);
        for (AtlasCurve& curve : findings_->curves)
            curve.crossings +=
                one.point.on_row && std::ranges::find(one.point.curves, curve.name) != one.point.curves.end();
    }

    template <class List>
    static void make_unique(List& list) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }

    /// Where there is a type of codimension two, others tell nothing more; nor do branch points where branches meet at
    /// a point of another type.
    static void settle_types(AtlasPoint& point) {
        make_unique(point.types);
        if (point.types.size() > 1)
            std::erase(point.types, PointType::branch_point);
        if (std::ranges::any_of(point.types, is_of_codimension_two))
            std::erase_if(point.types, [](PointType type) { return !is_of_codimension_two(type); });
    }

    void note_points() {
        std::vector<Gathered> all;
        for (const auto* runs : {&runs_->branches, &runs_->curves})
            for (const FollowedRun& run : *runs)
                gather(all, run);
        for (Gathered& one : all) {
            add_own_curves(one);
            settle_types(one.point);
        }
        // Places that differ by round-off only are the same in the order.
        const auto order = [&](const Gathered& one) {
            constexpr double cells = 1e5; // of the width of the box
            std::vector<double> place;
            for (std::size_t i = 0; i < one.point.at.size(); ++i)
                place.push_back(std::round(one.point.at[i] / runs_->scales.at[i] * cells));
            return std::tuple(one.point.on_row, one.point.types, std::move(place));
        };
        std::ranges::stable_sort(all,
                                 [&](const Gathered& one, const Gathered& other) { return order(one) < order(other); });
        std::map<std::string, std::size_t> counts;
        for (Gathered& one : all) {
            std::string types;
            for (const PointType type : one.point.types)
                types += (types.empty() ? "" : "+") + std::string(short_name(type));
            one.point.name = fmt::format(
                "{}{}{}", types, std::isdigit(static_cast<unsigned char>(types.back())) ? "-" : "", ++counts[types]);
            findings_->points.push_back(std::move(one.point));
        }
    }

    void note_motions() {
        for (const SampledMotion& sample : runs_->samples) {
            AtlasMotion& motion = findings_->motions.emplace_back();
            motion.run = sample.run->name;
            motion.number = sample.number;
            motion.row = sample.row;
            motion.value = sample.value;
            motion.label = sample.result.label;
            motion.period = sample.result.period;
            motion.contacts = sample.contacts;
            motion.accumulates = sample.accumulates;
            motion.confirms = sample.run->start.has_value() && sample.run != runs_->atlas;
            motion.detail = sample.result.outcome.detail;
            if (!sample.is_valid()) {
                motion.claim = AtlasClaim::invalid;
            } else if (const Explanation* found = explored_->explanation(sample)) {
                motion.claim = found->branch.empty() ? AtlasClaim::unexplained : AtlasClaim::explained;
                motion.branch = found->branch;
                if (!found->why.empty())
                    motion.detail = found->why;
            } else if (sample.result.label == Label::periodic) {
                motion.claim = AtlasClaim::beyond;
            }
        }
    }

    using Class = std::pair<std::size_t, std::size_t>; ///< of orbits: period in returns, contacts

    /// Whether a row has stable orbits of a class at a value, reached by a motion or not.
    bool has_stable(std::size_t row, double value, const Class& orbits) const {
        return std::ranges::any_of(findings_->branches, [&](const AtlasBranch& branch) {
            return branch.row == row && Class(branch.multiple, branch.contacts) == orbits &&
                   std::ranges::any_of(branch.stable, [&](const AtlasStretch& stretch) {
                       return value >= stretch.from && value <= stretch.to;
                   });
        });
    }

    /// Compares neighbouring rows: an attractor of one that the other one lacks has been lost at a curve between them.
    void note_changes() {
        std::map<std::pair<double, std::size_t>, std::set<Class>> attractors; // by value and row
        for (const AtlasMotion& motion : findings_->motions)
            if (motion.run == findings_->run && motion.claim == AtlasClaim::explained)
                attractors[{motion.value, motion.row}].insert({motion.period, motion.contacts});
        for (const auto& [place, here] : attractors) {
            const double value = place.first;
            const std::size_t row = place.second;
            const auto next = attractors.find({value, row + 1});
            if (next == attractors.end())
                continue;
            const auto lacks = [&](const std::set<Class>& orbits, std::size_t other) {
                return std::ranges::any_of(orbits, [&](const Class& one) { return !has_stable(other, value, one); });
            };
            if (!lacks(here, row + 1) && !lacks(next->second, row))
                continue;
            ++findings_->changes;
            findings_->crossed += std::ranges::any_of(findings_->curves, [&](const AtlasCurve& curve) {
                return crosses(curve, value, runs_->rows[row], runs_->rows[row + 1]);
            });
        }
    }

    void remain(const std::string& what, const std::string& where, const std::string& why) {
        for (AtlasRemainder& one : findings_->remainders)
            if (one.what == what && one.why == why) {
                ++one.count;
                return;
            }
        findings_->remainders.push_back({what, where, why, 1});
    }

    std::string why_beyond(const AtlasMotion& motion) const {
        if (motion.accumulates)
            return "such orbits are not followed";
        return motion.period > runs_->atlas->motion().atlas.multiple ? "their period exceeds `multiple`"
                                                                     : "their contacts in a return exceed `contacts`";
    }

    /// Without the name of the run, and without what one could do if one had asked for the run.
    static std::string reason_of(const FollowedRun& run) {
        std::string text = run.failure;
        if (const std::string own = fmt::format("run '{}': ", run.name()); text.starts_with(own))
            text.erase(0, own.size());
        return text.substr(0, std::min(text.find("; choose "), text.find("; begin ")));
    }

    void note_remainders() {
        for (const LeftOut& one : exploration_->left_out())
            remain(one.what, one.where, one.why);
        for (const auto* all : {&runs_->branches, &runs_->curves})
            for (const FollowedRun& run : *all)
                if (!run.failure.empty() && !run.same_as)
                    remain(run.is_curve() ? "a curve" : "a branch",
                           fmt::format("{} of {}", run.run->start->point, run.run->start->run), reason_of(run));
        for (const AtlasBranch& branch : findings_->branches)
            for (const AtlasStretch& stretch : branch.stable)
                if (stretch.confirmed.empty())
                    remain("stable orbits that no motion confirms", place_of(branch.row, stretch.from),
                           findings_->finished ? "the motion that began there went elsewhere, or did not settle"
                                               : "no motion has begun there yet");
        for (const AtlasMotion& motion : findings_->motions)
            if (motion.claim == AtlasClaim::unexplained)
                remain(motion.attractor(), place_of(motion.row, motion.value),
                       motion.detail.empty() ? "no branch that is known has this orbit" : motion.detail);
            else if (motion.claim == AtlasClaim::beyond)
                remain(motion.accumulates ? "orbits with accumulating contacts" : "orbits of more contacts or returns",
                       place_of(motion.row, motion.value), why_beyond(motion));
    }

    std::string place_of(std::size_t row, double value) const {
        std::string text = fmt::format("{} = {:.6g}", findings_->axes[0].name, value);
        if (!findings_->rows.empty())
            text += fmt::format(", {} = {:.6g}", findings_->axes[1].name, findings_->rows[row]);
        return text;
    }

    const Exploration* exploration_;
    const ExploredOrbits* explored_;
    const AtlasRuns* runs_;
    AtlasFindings* findings_;
};

} // namespace

std::string_view name_of(AtlasClaim claim) {
    switch (claim) {
    case AtlasClaim::explained:
        return "explained";
    case AtlasClaim::unexplained:
        return "unexplained";
    case AtlasClaim::beyond:
        return "beyond limits";
    case AtlasClaim::other:
        return "not periodic";
    case AtlasClaim::invalid:
        return "invalid";
    }
    return "unknown";
}

std::string AtlasMotion::attractor() const {
    if (label != Label::periodic)
        return std::string(graze::name_of(label));
    if (accumulates)
        return fmt::format("period {}, accumulating contacts", period);
    return fmt::format("period {}, {} contact{}", period, contacts, contacts == 1 ? "" : "s");
}

std::size_t AtlasFindings::count(AtlasClaim claim) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        motions, [&](const AtlasMotion& motion) { return motion.claim == claim && !motion.confirms; }));
}

double AtlasFindings::share() const {
    std::size_t valid = 0;
    for (const AtlasClaim claim :
         {AtlasClaim::explained, AtlasClaim::unexplained, AtlasClaim::beyond, AtlasClaim::other})
        valid += count(claim);
    return valid == 0 ? 0 : static_cast<double>(count(AtlasClaim::explained)) / static_cast<double>(valid);
}

AtlasFindings atlas_findings(const Study& study, const std::string& run, const ResultFile& file) {
    const StudyRun* const atlas = study.find_run(run);
    if (!atlas || atlas->kind != RunKind::atlas)
        throw InputError(fmt::format("there is no atlas '{}'", run), "name a run of kind atlas");
    AtlasFindings findings;
    findings.run = run;
    Exploration exploration(study, *atlas, file);
    const bool is_left = !exploration.next().empty();
    findings.finished = !is_left && is_computed(study, *atlas, file);
    findings.limited = exploration.is_limited();
    Summary(exploration, findings).make();
    return findings;
}

} // namespace graze
