#include "graze_run.hpp"

#include <stdexcept>

namespace peers {

namespace {

std::vector<graze::Probe> probes_of(const graze::Model& model, HeyokaOutput output) {
    std::vector<graze::Probe> result;
    if (output != HeyokaOutput::none)
        for (const char* section : {"phase0", "phasepi"})
            result.push_back(graze::section_probe(model, section));
    if (output == HeyokaOutput::extrema)
        result.push_back(graze::section_probe(model, "nearest"));
    return result;
}

void require_end(const graze::Trajectory& trajectory) {
    if (trajectory.outcome().ending != graze::Ending::end_time)
        throw std::runtime_error("graze does not reach the end: " + trajectory.outcome().detail);
}

} // namespace

void Told::contact(const graze::Contact& contact) {
    impacts += contact.kind == graze::ContactKind::crossing ? 1 : 0;
}

void Told::passage(const graze::Passage& passage) {
    passages.push_back({passage.state[0], passage.state[1], passage.state[2]});
}

GrazeRun::GrazeRun(const Course& course, double tolerance, HeyokaOutput output, std::size_t directions)
    : course_(&course),
      simulation_(graze::System(course.one.model), probes_of(course.one.model, output), {}, {.tolerance = tolerance}),
      jets_(simulation_, graze::LaneKind::single),
      trajectory_(simulation_, course.one.model.parameter_values(), borrowed(told_)),
      inputs_(course.inputs.begin(), course.inputs.begin() + static_cast<std::ptrdiff_t>(directions)) {}

void GrazeRun::run() {
    told_.impacts = 0;
    told_.passages.clear();
    trajectory_.start(course_->one.start, course_->one.mode, 0, course_->one.duration);
    if (!inputs_.empty())
        trajectory_.carry_derivatives(inputs_);
    graze::run(trajectory_, jets_);
    require_end(trajectory_);
}

double GrazeRun::derivative(std::size_t state, std::size_t direction) const {
    return trajectory_.derivative(state, direction) * course_->input_units[direction] / course_->one.units[state];
}

std::vector<Course::State> GrazeRun::passages() const {
    std::vector<Course::State> result;
    for (const Course::State& passage : told_.passages)
        result.push_back(course_->nondimensional(passage));
    return result;
}

GrazeGroup::GrazeGroup(const Course& course, std::span<const double> voltages, double tolerance)
    : course_(&course), simulation_(graze::System(course.one.model), {}, {}, {.tolerance = tolerance}),
      ensemble_(simulation_), told_(voltages.size()) {
    graze::Model model = course.one.model;
    for (std::size_t i = 0; i < voltages.size(); ++i) {
        model.set_parameter("V0", voltages[i] * course.one.parameter_unit);
        trajectories_.emplace_back(simulation_, model.parameter_values(), borrowed(told_[i]));
    }
}

void GrazeGroup::run() {
    for (std::size_t i = 0; i < trajectories_.size(); ++i) {
        told_[i].impacts = 0;
        trajectories_[i].start(course_->one.start, course_->one.mode, 0, course_->one.duration);
    }
    ensemble_.run(trajectories_);
    for (const graze::Trajectory& trajectory : trajectories_)
        require_end(trajectory);
}

std::size_t GrazeGroup::impacts() const {
    std::size_t result = 0;
    for (const Told& told : told_)
        result += told.impacts;
    return result;
}

} // namespace peers
