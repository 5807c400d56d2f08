#include "graze/branch/ladder.hpp"

#include "branch/bounds.hpp"
#include "graze/base/input_error.hpp"
#include "graze/grazing/cycle_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// Returns a grazing unchanged, and a point on a curve of touches as a grazing.
SpecialPoint as_grazing(const System& system, const SpecialPoint& point) {
    if (point.type == PointType::grazing) {
        if (point.at_end)
            throw InputError("a ladder cannot begin where a contact loses its speed",
                             "start from a grazing within an arc");
        return point;
    }
    if (point.type == PointType::chatter)
        throw InputError("the point is the onset of chatter already", "start from a grazing (GR)");
    for (const OrbitTouch& touch : touches_of(system, point.solution.orbit))
        if (!touch.at_end)
            return grazing_at(point, touch);
    throw InputError(
        fmt::format("the orbit, of type {} ({}), touches nothing", short_name(point.type), name_of(point.type)),
        "start from a grazing (GR), or from a point of a curve of them");
}

} // namespace

Ladder::Ladder(const System& system, const SpecialPoint& grazing, const BranchSettings& settings)
    : system_(system), settings_(settings), grazings_{as_grazing(system, grazing)} {
    settings_.stop_at = {PointType::grazing};
    settings_.validate(system.model());
    SpecialPoint& first = grazings_.front();
    first.parameter = first.solution.orbit.parameters[settings.parameter.place()];
    if (is_outside(settings, first.parameter))
        throw InputError(fmt::format("the grazing from which the ladder starts, at {:.9g}, lies outside of its bounds",
                                     first.parameter),
                         "give wider bounds");
}

std::optional<BranchStart> Ladder::next() {
    if (!why_.empty())
        return std::nullopt;
    try {
        return branches_at(system_, grazings_.back(), settings_).front();
    } catch (const InputError& error) {
        why_ = error.problem();
        return std::nullopt;
    }
}

/// Returns an explanation for a ladder that ends because its slowest contacts are below resolution: the heights between
/// contacts, which scale with the power 3/2 of the speeds, are differences of positions. Empty if they are resolved.
std::string Ladder::beyond_resolution() const {
    constexpr double resolved = 1e-8; // share of the largest height
    const SpecialPoint& last = grazings_.back();
    const Certificate& certificate = last.solution.certificate;
    const Signature& signature = last.solution.orbit.signature;
    double slowest = std::numeric_limits<double>::infinity(), fastest = 0;
    for (std::size_t k = 0; k < certificate.approach_speeds.size(); ++k)
        if (signature[k].end == SegmentEnd::event &&
            system_.model().transitions[signature[k].index].event == last.event) {
            slowest = std::min(slowest, certificate.approach_speeds[k]);
            fastest = std::max(fastest, certificate.approach_speeds[k]);
        }
    if (!(slowest > 0 && fastest > 0) || std::pow(slowest / fastest, 1.5) > resolved)
        return "";
    return fmt::format(
        "contacts have become too slow to be told from touches, the slowest one with {:.1e} of the speed "
        "of the fastest: ",
        slowest / fastest);
}

bool Ladder::take(const std::optional<SpecialPoint>& end, const std::string& outcome) {
    const bool reached = end && end->type == PointType::grazing;
    if (reached && !end->at_end && end->event == grazings_.back().event) {
        grazings_.push_back(*end);
        return true;
    }
    if (!end)
        why_ = beyond_resolution() + outcome;
    else if (!reached)
        why_ = fmt::format("{}{}{}", name_of(end->type), end->detail.empty() ? "" : ": ", end->detail);
    else if (end->at_end)
        why_ = "a contact loses its speed";
    else
        why_ = fmt::format("another event is touched: {}", end->detail);
    return false;
}

ChatterLimit Ladder::limit() const {
    if (grazings_.size() < 2) {
        ChatterLimit none;
        none.problem = why_.empty() ? "there is one grazing only" : why_;
        return none;
    }
    return chatter_limit(system_, grazings_, settings_.parameter, settings_.orbit.tolerance);
}

bool climb(Ladder& ladder, std::size_t grazings, const RungFollower& follow) {
    while (ladder.grazings().size() < grazings) {
        const std::optional<BranchStart> start = ladder.next();
        if (!start)
            break;
        const std::optional<RungEnd> end = follow(ladder.grazings().size() + 1, *start);
        if (!end)
            return false;
        ladder.take(end->point, end->outcome);
        if (!end->wanted)
            break;
    }
    return true;
}

Ladder climb(const System& system, const SpecialPoint& grazing, const BranchSettings& settings, std::size_t grazings,
             const std::function<bool(std::size_t rung, const Branch& branch)>& visit,
             const std::function<bool()>& interrupted) {
    Ladder ladder(system, grazing, settings);
    climb(ladder, grazings, [&](std::size_t rung, const BranchStart& start) -> std::optional<RungEnd> {
        OrbitBranch follower(system, start.orbit, ladder.settings());
        Branch branch;
        std::optional<SpecialPoint> end;
        for (bool going = follower.start_along(start.direction, start.distance); going; going = follower.step()) {
            branch.points.push_back(follower.point());
            branch.special.insert(branch.special.end(), follower.found().begin(), follower.found().end());
            if (interrupted && interrupted())
                return std::nullopt;
            end.reset();
            if (ends_in_found(follower))
                end = follower.found().back();
        }
        branch.outcome = follower.outcome();
        branch.detail = follower.detail();
        return RungEnd{end,
                       fmt::format("{}{}{}", name_of(branch.outcome), branch.detail.empty() ? "" : ": ", branch.detail),
                       !visit || visit(rung, branch)};
    });
    return ladder;
}

} // namespace graze
