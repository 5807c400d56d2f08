#include "graze/picture/motion_recorder.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// A step of high order covers a good part of an oscillation; the curve is thinned out again before it is drawn.
constexpr int points_of_step = 32;
constexpr std::size_t most_points = 2'000'000;

} // namespace

MotionRecorder::MotionRecorder(const Simulation& simulation, MotionPanelChoice contents)
    : simulation_(simulation), contents_(std::move(contents)), evaluate_(simulation.model(), contents_.columns) {
    const Model& model = simulation.model();
    periods_ = simulation.system().periods()(model.parameter_values());
    state_.resize(periods_.size());
    for (const NamedValue& column : contents_.columns) {
        const auto state = column.value.is_symbol() ? model.find_state(column.value.name()) : std::nullopt;
        column_periods_.push_back(state ? periods_[*state] : 0);
    }
}

std::vector<double> MotionRecorder::evaluate(std::span<const double> state) {
    for (std::size_t i = 0; i < state_.size(); ++i)
        state_[i] = periods_[i] > 0 ? state[i] - std::floor(state[i] / periods_[i]) * periods_[i] : state[i];
    const auto values = evaluate_(state_);
    return {values.begin(), values.end()};
}

void MotionRecorder::step(const Step& step) {
    if (points_ >= most_points) {
        complete_ = false;
        return;
    }
    if (std::exchange(new_arc_, false))
        arcs_.emplace_back();
    Arc& arc = arcs_.back();
    std::vector<double> state(state_.size());
    for (int k = arc.times.empty() ? 0 : 1; k <= points_of_step; ++k) {
        const double s = k == points_of_step ? step.length : step.length * k / points_of_step;
        for (std::size_t i = 0; i < state.size(); ++i)
            state[i] = step.state(i, s);
        const std::vector<double> values = evaluate(state);
        arc.times.push_back(step.start + s);
        arc.values.insert(arc.values.end(), values.begin(), values.end());
        ++points_;
    }
}

void MotionRecorder::contact(const Contact& contact) {
    const bool touch = contact.kind == ContactKind::touch;
    if (!touch)
        new_arc_ = true;
    if (complete_)
        jumps_.push_back(
            {contact.time, evaluate(contact.before), evaluate(contact.after), contents_.marked[contact.event]});
}

void MotionRecorder::passage(const Passage& passage) {
    if (complete_ && passage.probe < contents_.sections)
        passages_.push_back({passage.time, evaluate(passage.state)});
}

std::string MotionRecorder::section_names() const {
    std::string names;
    for (std::size_t i = 0; i < contents_.sections; ++i)
        names += (i > 0 ? ", " : "") + simulation_.probes()[i].name;
    return names;
}

void MotionRecorder::finish(const Trajectory& trajectory) {
    if (trajectory.outcome().ending == Ending::singular)
        singularity_ = trajectory.outcome().time;
}

} // namespace graze
