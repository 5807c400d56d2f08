#include "graze/picture/motion_recorder.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr std::size_t most_recorded = 2'000'000;

} // namespace

std::size_t MotionPanelChoice::column(NamedValue quantity) {
    const auto known = std::ranges::find(columns, quantity.name, &NamedValue::name);
    if (known != columns.end())
        return static_cast<std::size_t>(known - columns.begin());
    columns.push_back(std::move(quantity));
    return columns.size() - 1;
}

MotionRecorder::MotionRecorder(const Simulation& simulation, MotionPanelChoice contents, int points_of_step)
    : simulation_(simulation), contents_(std::move(contents)), evaluate_(simulation.model(), contents_.columns),
      points_of_step_(points_of_step) {
    state_.resize(simulation.system().states());
    motion_.values.resize(contents_.columns.size() + 1);
    set_parameters(simulation.model().parameter_values());
}

void MotionRecorder::set_parameters(std::span<const double> values) {
    const Model& model = simulation_.model();
    evaluate_.set_parameters(values);
    periods_ = simulation_.system().periods()(values);
    motion_.periods = {0};
    for (const NamedValue& column : contents_.columns) {
        const auto state = column.value.is_symbol() ? model.find_state(column.value.name()) : std::nullopt;
        motion_.periods.push_back(state ? periods_[*state] : 0);
    }
}

MotionRecorder::Row MotionRecorder::row_of(double time, std::span<const double> state) {
    for (std::size_t i = 0; i < state_.size(); ++i)
        state_[i] = periods_[i] > 0 ? state[i] - std::floor(state[i] / periods_[i]) * periods_[i] : state[i];
    Row row{time};
    const auto values = evaluate_(state_);
    row.insert(row.end(), values.begin(), values.end());
    return row;
}

void MotionRecorder::step(const Step& step) {
    const std::size_t rows = motion_.values.front().size();
    if (rows >= most_recorded) {
        complete_ = false;
        return;
    }
    if (new_arc_) {
        if (rows > 0)
            motion_.begins.push_back(rows);
        if (after_impact_)
            motion_.impacts.push_back(rows);
        motion_.modes.push_back(step.mode);
    }
    after_impact_ = false;
    std::vector<double> state(state_.size());
    for (int k = new_arc_ ? 0 : 1; k <= points_of_step_; ++k) {
        const double s = k == points_of_step_ ? step.length : step.length * k / points_of_step_;
        for (std::size_t i = 0; i < state.size(); ++i)
            state[i] = step.state(i, s);
        const Row row = row_of(step.start + s, state);
        for (std::size_t v = 0; v < row.size(); ++v)
            motion_.values[v].push_back(row[v]);
    }
    new_arc_ = false;
}

void MotionRecorder::contact(const Contact& contact) {
    const bool touch = contact.kind == ContactKind::touch;
    if (!touch) {
        new_arc_ = true;
        const std::size_t rows = motion_.values.front().size();
        // Contacts at the same time have the rows of the arcs before and after them.
        if (complete_ && contents_.marked[contact.event] && !after_impact_) {
            if (rows > 0)
                motion_.impacts.push_back(rows - 1);
            after_impact_ = true;
        }
    }
    if (complete_)
        jumps_.push_back({row_of(contact.time, contact.before), row_of(contact.time, contact.after),
                          contents_.marked[contact.event]});
}

void MotionRecorder::passage(const Passage& passage) {
    if (complete_ && passage.probe < contents_.sections)
        passages_.push_back(row_of(passage.time, passage.state));
}

std::string MotionRecorder::section_names() const {
    std::string names;
    for (std::size_t i = 0; i < contents_.sections; ++i)
        names += (i > 0 ? ", " : "") + simulation_.probes()[i].name;
    return names;
}

void MotionRecorder::finish(const Trajectory& trajectory) {
    motion_.outcome = trajectory.outcome();
}

} // namespace graze
