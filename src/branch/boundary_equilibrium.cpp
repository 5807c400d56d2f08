#include "branch/boundary_equilibrium.hpp"

#include "base/concatenated.hpp"
#include "base/linear_systems.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/solve_equilibrium.hpp"
#include "sweep/field_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

constexpr double at_surface = 1e-7; ///< share of its size below which a function of the located point is zero

/// Pairs of jump and mode to which the motion may go on from a mode at an event, or from which it comes.
std::vector<std::pair<std::size_t, std::size_t>> neighbours(const Model& model, std::size_t mode, std::size_t event) {
    std::vector<std::pair<std::size_t, std::size_t>> result;
    const auto add = [&](std::size_t jump, std::size_t next) {
        const std::pair one(jump, next);
        if (next != mode && std::ranges::find(result, one) == result.end())
            result.push_back(one);
    };
    for (const Transition& transition : model.transitions) {
        if (transition.mode == mode && transition.event == event) {
            for (const Alternative& alternative : transition.next)
                if (alternative.mode)
                    add(transition.jump, *alternative.mode);
            if (transition.chatter)
                add(transition.chatter->jump, transition.chatter->mode);
        }
        for (const Alternative& alternative : transition.next)
            if (alternative.mode == mode)
                add(0, transition.mode); // the motion that comes from there has not been changed at the surface
    }
    return result;
}

/// Values and gradients of the rates along the branch.
struct Slope {
    double value = 0, size = 0, by_parameter = 0;
};

/// How a function changes along the branch of equilibria through a point, by the branch parameter.
Slope slope_of(const Function& function, const EquilibriumEvaluation& at) {
    const Eigen::Index n = at.size();
    const std::vector<double> all = function(concatenated(at.state, at.parameters));
    const Eigen::VectorXd gradient = at.gradient_of(std::span(all).subspan(1));
    Eigen::VectorXd rate(0);
    if (n > 0)
        rate = FullLU<double>(at.field).solve(-at.jacobian.col(n));
    double size = 0;
    for (Eigen::Index k = 0; k < gradient.size(); ++k)
        size = std::max(size, std::abs(gradient[k]));
    return {all[0], size, gradient[n] + (n > 0 ? gradient.head(n).dot(rate) : 0)};
}

int sign_of(double value) {
    return value > 0 ? 1 : value < 0 ? -1 : 0;
}

} // namespace

bool changes_motion(const Model& model, std::size_t mode, std::size_t event) {
    const Transition* transition = model.find_transition(mode, event);
    return transition && !changes_nothing(*transition);
}

int admissible_direction(const EquilibriumEvaluation& at, std::size_t event) {
    return sign_of(slope_of(at.equations->system().event(event), at).by_parameter);
}

std::vector<MeetingEquilibrium> meeting_equilibria(const System& system, const Orbit& orbit, std::size_t event,
                                                   const BranchSettings& settings) {
    const Model& model = system.model();
    const std::size_t mode = orbit.signature.front().mode;
    std::vector<MeetingEquilibrium> found;
    for (const auto& [jump, next] : neighbours(model, mode, event)) {
        const std::vector<double> image = system.jump(jump).identity
                                              ? orbit.starts[0]
                                              : system.jump(jump).map(concatenated(orbit.starts[0], orbit.parameters));
        MeetingEquilibrium one{orbit_of_rest(next, image, orbit.parameters)};
        EquilibriumProblem problem(system, one.orbit, settings);
        EquilibriumEvaluation at;
        if (!problem.equations().why_none(orbit.parameters).empty() ||
            !problem.describe(problem.unknowns_of(one.orbit), at) ||
            std::ranges::any_of(found, [&](const auto& other) { return other.orbit.signature == one.orbit.signature; }))
            continue;
        if (at.size() > 0 && !(at.rates.cwiseAbs().maxCoeff() <= at_surface * at.jacobian.norm()))
            continue;
        // All surfaces on which it lies must be left in one direction.
        int direction = 0;
        bool agree = true;
        for (const std::size_t watched : model.modes[next].watched) {
            const Slope slope = slope_of(system.event(watched), at);
            if (!changes_motion(model, next, watched) || !(std::abs(slope.value) <= at_surface * slope.size) ||
                !(std::abs(slope.by_parameter) > at_surface * slope.size))
                continue;
            const int side = sign_of(slope.by_parameter);
            agree = agree && (direction == 0 || direction == side);
            direction = side;
        }
        one.admissible = agree ? direction : 0;
        found.push_back(std::move(one));
    }
    return found;
}

std::string boundary_in_words(const Model& model, int own, const std::vector<MeetingEquilibrium>& others) {
    if (others.empty())
        return "no equilibrium of another mode is there";
    std::vector<std::string> words;
    for (const MeetingEquilibrium& other : others) {
        const std::string& name = model.modes[other.orbit.signature.front().mode].name;
        words.push_back(other.admissible == 0 || own == 0 ? fmt::format("an equilibrium of mode '{}' is there", name)
                        : other.admissible == own ? fmt::format("nonsmooth fold with an equilibrium of mode '{}'", name)
                                                  : fmt::format("persists as an equilibrium of mode '{}'", name));
    }
    return fmt::format("{}", fmt::join(words, "; "));
}

} // namespace graze
