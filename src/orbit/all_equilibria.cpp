#include "orbit/all_equilibria.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/zero_search.hpp"
#include "orbit/solve_equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// The box of the active states.
struct ActiveBox {
    std::vector<double> lower, upper;
};

ActiveBox box_of(const EquilibriumEquations& equations, std::span<const StateBounds> within,
                 std::span<const double> periods) {
    ActiveBox box;
    for (const std::size_t i : equations.active()) {
        const auto range = std::ranges::find(within, i, &StateBounds::state);
        const Model& model = equations.system().model();
        if (range == within.end() && !(periods[i] > 0))
            throw InputError(fmt::format("the box has no range of state '{}', which moves in mode '{}'",
                                         model.states[i].name, model.modes[equations.mode()].name),
                             fmt::format("give one: {} = [LEAST, GREATEST]", model.states[i].name));
        box.lower.push_back(range == within.end() ? 0 : range->least);
        box.upper.push_back(range == within.end() ? periods[i] : range->greatest);
    }
    return box;
}

/// The states that neither move nor have a range: each value of theirs has its own equilibria.
std::string condition_of(const EquilibriumEquations& equations, std::span<const double> state) {
    std::string text;
    const Model& model = equations.system().model();
    for (std::size_t i = 0; i < state.size(); ++i) {
        const bool moves = std::ranges::find(equations.active(), i) != equations.active().end() ||
                           std::ranges::find(equations.clocks(), i) != equations.clocks().end() ||
                           model.states[i].drifting;
        if (!moves)
            text += fmt::format("{} {} = {:.10g}", text.empty() ? " at" : ",", model.states[i].name, state[i]);
    }
    return text;
}

/// True when two equilibria of cyclic states are the same but for whole periods.
bool is_same(const Orbit& one, const Orbit& other, std::span<const double> periods) {
    constexpr double same = 1e-9;
    bool turned = false;
    for (std::size_t i = 0; i < periods.size(); ++i) {
        const double difference = std::abs(one.starts[0][i] - other.starts[0][i]);
        const double size = std::max({std::abs(one.starts[0][i]), std::abs(other.starts[0][i]), periods[i]});
        const double apart = periods[i] > 0 ? std::min(difference, std::abs(periods[i] - difference)) : difference;
        turned = turned || (periods[i] > 0 && apart < same * size);
        if (apart > same * size)
            return false;
    }
    return turned;
}

} // namespace

EquilibriumSearch all_equilibria(const System& system, std::size_t mode, std::span<const StateBounds> within,
                                 std::span<const double> state, std::span<const double> parameters,
                                 const OrbitOptions& options, const std::function<bool()>& interrupted) {
    const EquilibriumEquations equations(system, mode, {});
    const std::vector<double> periods = system.periods()(parameters);
    EquilibriumSearch search;
    const auto solved_at = [&](std::span<const double> values) {
        Orbit guess = orbit_of_rest(mode, {state.begin(), state.end()}, {parameters.begin(), parameters.end()});
        for (std::size_t k = 0; k < values.size(); ++k)
            guess.starts[0][equations.active()[k]] = values[k];
        return solve_equilibrium(system, guess, options);
    };
    search.problem = equations.why_none(parameters);
    if (!search.problem.empty()) {
        search.complete = true;
        return search;
    }
    if (equations.size() == 0) {
        search.found = {solved_at({})};
        search.problem = search.found[0].detail;
        return search;
    }
    search.condition = condition_of(equations, state);
    const ActiveBox box = box_of(equations, within, periods);
    std::vector<double> others;
    for (std::size_t i = 0; i < state.size(); ++i)
        if (std::ranges::find(equations.active(), i) == equations.active().end())
            others.push_back(state[i]);
    others.insert(others.end(), parameters.begin(), parameters.end());
    ZeroSearchSettings settings;
    settings.interrupted = interrupted;
    const ZeroSearch zeros = find_zeros(equations.rates_for_search(), box.lower, box.upper, others, settings);
    const auto add = [&](std::vector<OrbitSolution>& list, OrbitSolution solution) {
        if (std::ranges::none_of(list,
                                 [&](const OrbitSolution& one) { return is_same(one.orbit, solution.orbit, periods); }))
            list.push_back(std::move(solution));
    };
    for (const VerifiedZero& zero : zeros.zeros)
        add(search.found, solved_at(zero.values));
    for (const IntervalBox& one : zeros.undecided) {
        std::vector<double> middle;
        for (const Interval& side : one)
            middle.push_back(0.5 * (side.lower + side.upper));
        add(search.undecided, solved_at(middle));
    }
    search.interrupted = zeros.ending == ZeroSearch::Ending::interrupted;
    search.complete = zeros.ending == ZeroSearch::Ending::complete;
    if (zeros.ending == ZeroSearch::Ending::too_many_boxes)
        search.problem = fmt::format("the search in mode '{}' ended after {} boxes: there may be others",
                                     system.model().modes[mode].name, zeros.boxes);
    return search;
}

} // namespace graze
