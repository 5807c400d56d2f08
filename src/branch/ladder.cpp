#include "graze/branch/ladder.hpp"

#include "graze/grazing/cycle_map.hpp"
#include "graze/symbolic/input_error.hpp"

#include <fmt/format.h>

namespace graze {

namespace {

/// A grazing as it is, or the touch of an orbit on a curve of touches as one.
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
        if (!touch.at_end) {
            SpecialPoint grazing = point;
            grazing.type = PointType::grazing;
            grazing.segment = touch.segment;
            grazing.event = touch.event;
            grazing.time = touch.time;
            grazing.at_end = false;
            return grazing;
        }
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
    if ((settings.least && first.parameter < *settings.least) ||
        (settings.greatest && first.parameter > *settings.greatest))
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

bool Ladder::take(const std::optional<SpecialPoint>& end, const std::string& outcome) {
    const bool reached = end && end->type == PointType::grazing;
    if (reached && !end->at_end && end->event == grazings_.back().event) {
        grazings_.push_back(*end);
        return true;
    }
    if (!reached)
        why_ = end ? fmt::format("{}{}{}", name_of(end->type), end->detail.empty() ? "" : ": ", end->detail) : outcome;
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

Ladder climb(const System& system, const SpecialPoint& grazing, const BranchSettings& settings, std::size_t grazings,
             const std::function<bool(std::size_t rung, const Branch& branch)>& visit) {
    Ladder ladder(system, grazing, settings);
    while (ladder.grazings().size() < grazings) {
        const auto start = ladder.next();
        if (!start)
            break;
        OrbitBranch follower(system, start->orbit, ladder.settings());
        Branch branch;
        std::optional<SpecialPoint> end;
        for (bool going = follower.start_along(start->direction, start->distance); going; going = follower.step()) {
            branch.points.push_back(follower.point());
            branch.special.insert(branch.special.end(), follower.found().begin(), follower.found().end());
            end.reset();
            if (ends_at_point(follower.outcome()) && !follower.found().empty())
                end = follower.found().back();
        }
        branch.outcome = follower.outcome();
        branch.detail = follower.detail();
        const std::size_t rung = ladder.grazings().size() + 1;
        ladder.take(end,
                    fmt::format("{}{}{}", name_of(branch.outcome), branch.detail.empty() ? "" : ": ", branch.detail));
        if (visit && !visit(rung, branch))
            break;
    }
    return ladder;
}

} // namespace graze
