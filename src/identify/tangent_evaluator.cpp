#include "identify/tangent_evaluator.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

TangentEvaluator::Group::Group(const Simulation& simulation, std::size_t from_direction, std::size_t directions)
    : first(from_direction), count(directions), jets(simulation.system(), simulation.order(), LaneKind::single),
      steps(simulation.system(), simulation.options().tolerance, directions),
      matrix(simulation.system().states() * directions), next(matrix.size()) {
    jets.add_tangents();
}

TangentEvaluator::TangentEvaluator(const Simulation& simulation, std::size_t directions)
    : states_(simulation.system().states()), directions_(directions) {
    const std::size_t lanes = TangentSteps::together(directions);
    for (std::size_t first = 0; first < directions; first += lanes)
        groups_.push_back(std::make_unique<Group>(simulation, first, std::min(lanes, directions - first)));
}

void TangentEvaluator::set_parameters(std::span<const double> parameters, std::span<const double> seeds) {
    for (const auto& group : groups_) {
        std::vector<double> some(parameters.size() * group->count);
        for (std::size_t j = 0; j < parameters.size(); ++j)
            std::copy_n(&seeds[j * directions_ + group->first], group->count, &some[j * group->count]);
        group->jets.set_parameters(parameters);
        group->steps.set_parameters(parameters, some);
    }
}

void TangentEvaluator::begin(std::size_t mode, std::span<const double> state, std::span<const double> matrix) {
    mode_ = mode;
    for (const auto& group : groups_) {
        group->state.assign(state.begin(), state.end());
        for (std::size_t i = 0; i < states_; ++i)
            std::copy_n(&matrix[i * directions_ + group->first], group->count, &group->matrix[i * group->count]);
        group->from = 0;
        group->begun = false;
    }
}

bool TangentEvaluator::follow(Group& group, double s) {
    for (int part = 0; part < TangentSteps::most_parts; ++part) {
        const double length = s - group.from;
        if (length == 0) {
            group.next = group.matrix;
            return true;
        }
        if (!group.begun)
            group.steps.begin(group.jets.computed(mode_, group.state), mode_, group.state, group.matrix);
        group.begun = true;
        const double made = group.steps.carry(group.jets.next(mode_), length, group.next);
        if (made == length)
            return true;
        if (made == 0 || !std::isfinite(made))
            return false;
        group.state.assign(group.steps.state().begin(), group.steps.state().end());
        group.matrix = group.next;
        group.from += made;
        group.begun = false;
    }
    return false;
}

bool TangentEvaluator::at(double s, std::span<double> state, std::span<double> matrix) {
    for (const auto& group : groups_) {
        if (!follow(*group, s))
            return false;
        const std::span<const double> here =
            s == group->from ? std::span<const double>(group->state) : group->steps.state();
        if (group == groups_.front())
            std::copy(here.begin(), here.end(), state.begin());
        for (std::size_t i = 0; i < states_; ++i)
            std::copy_n(&group->next[i * group->count], group->count, &matrix[i * directions_ + group->first]);
    }
    return true;
}

} // namespace graze
