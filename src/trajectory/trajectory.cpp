#include "graze/trajectory/trajectory.hpp"

#include "flow/cyclic.hpp"
#include "flow/table_steps.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/flow/mode_flow.hpp"
#include "trajectory/probe_tracker.hpp"
#include "trajectory/series.hpp"
#include "trajectory/tangents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace graze {

namespace {

/// A step longer than the last one by more than this factor is checked at interior times too.
constexpr double longest_leap = 2;

} // namespace

Trajectory::Trajectory(const Simulation& simulation, std::span<const double> parameters,
                       std::shared_ptr<Observer> observer)
    : simulation_(simulation), observer_(observer ? std::move(observer) : std::make_shared<Observer>()),
      parameters_(parameters.begin(), parameters.end()), step_size_(simulation.order(), simulation.options().tolerance),
      step_check_(simulation.system(), simulation.order(), simulation.options().tolerance),
      dormant_states_(simulation.system()), roots_(simulation.order()), states_(simulation.system().states()),
      order_(simulation.order()), longest_allowed_(simulation.options().largest_step) {
    const System& compiled = simulation.system();
    require_size(parameters_.size(), compiled.parameters(), "independent parameters");
    std::size_t most_watched = 0, most_tables = 0;
    for (std::size_t m = 0; m < compiled.model().modes.size(); ++m) {
        most_watched = std::max(most_watched, compiled.mode(m).watched.size());
        most_tables = std::max(most_tables, compiled.mode(m).tables.size());
    }
    table_steps_ = TableSteps::of(compiled, order_);
    if (table_steps_)
        table_steps_->set_parameters(parameters_);
    state_.resize(states_);
    before_.resize(states_);
    after_.resize(states_);
    inputs_.resize(states_ + parameters_.size());
    work_.resize(2 * compiled.workspace() + simulation.phase_values().workspace());
    std::copy(parameters_.begin(), parameters_.end(), inputs_.begin() + static_cast<std::ptrdiff_t>(states_));
    lane_series_.resize(states_ + most_watched + compiled.observed() + most_tables);
    watches_.resize(most_watched);
    together_.reserve(most_watched);
    histories_.resize(compiled.model().events.size());
    event_sizes_.resize(histories_.size());
    surface_values_.resize(histories_.size());
    holds_.resize(histories_.size());
    uncertain_.resize(inputs_.size());
    step_check_.set_parameters(parameters_);
    dormant_states_.set_parameters(parameters_);
    periods_.resize(states_);
    compiled.periods().evaluate(parameters_, periods_, work_);
    for (std::size_t i = 0; i < states_; ++i)
        if (compiled.model().states[i].period)
            cyclic_states_.push_back(i);
    std::vector<double> phase_values(simulation.probes().size());
    simulation.phase_values().evaluate(parameters_, phase_values, work_);
    probes_ = std::make_unique<ProbeTracker>(simulation, phase_values, periods_);
}

Trajectory::~Trajectory() = default;
Trajectory::Trajectory(Trajectory&&) noexcept = default;

void Trajectory::start(std::span<const double> state, std::size_t mode, double time, double end_time) {
    const Model& model = simulation_.model();
    require_size(state.size(), states_, "states");
    require_index(mode, model.modes.size(), "mode");
    for (std::size_t i = 0; i < states_; ++i) {
        if (!std::isfinite(state[i]))
            throw InputError(fmt::format("the initial value of state '{}' is {}", model.states[i].name, state[i]),
                             "give a finite number");
        if (model.states[i].period && !(periods_[i] > 0 && std::isfinite(periods_[i])))
            throw InputError(fmt::format("the period of state '{}' is {}", model.states[i].name, periods_[i]),
                             "choose parameters that make it positive");
    }
    for (std::size_t j = 0; j < parameters_.size(); ++j)
        if (!std::isfinite(parameters_[j]))
            throw InputError(fmt::format("parameter '{}' is {}", model.independent_parameters()[j], parameters_[j]),
                             "give a finite number");
    if (!std::isfinite(time) || !(end_time >= time))
        throw InputError(fmt::format("a trajectory cannot run from time {} to {}", time, end_time),
                         "give an end that is not before the start");
    std::copy(state.begin(), state.end(), state_.begin());
    wrap_cyclic_states(true);
    set_mode(mode);
    series_ = {};
    outcome_ = {};
    steps_ = 0;
    time_ = start_time_ = time;
    time_low_ = 0;
    end_time_ = end_time;
    previous_step_ = largest_step_ = believed_ = descent_start_ = 0;
    floored_ = false;
    dormant_states_.begin();
    arc_start_ = true;
    branch_ahead_ = states_;
    stuck_ = false;
    start_event_ = no_event;
    stop_after_contact_ = false;
    pending_.reset();
    together_.clear();
    touches_.clear();
    std::fill(histories_.begin(), histories_.end(), ContactHistory{});
    std::fill(event_sizes_.begin(), event_sizes_.end(), EventSize{});
    std::fill(surface_values_.begin(), surface_values_.end(), 0.0);
    std::fill(holds_.begin(), holds_.end(), Hold{});
    contacts_ = 0;
    contacts_now_ = contacts_nearby_ = 0;
    nearby_since_ = time;
    crossings_.clear();
    tangents_.reset();
    probes_->start(state_);
}

void Trajectory::require_started() const {
    if (!is_started())
        throw OrderError("a trajectory has no state before it is started: call start first");
}

void Trajectory::set_mode(std::size_t mode) {
    mode_ = mode;
    compiled_mode_ = &simulation_.system().mode(mode);
}

void Trajectory::limit_step(double longest) {
    if (!(longest >= 0))
        throw InputError(fmt::format("the longest step {} is not a positive time", longest), "give 0 for no bound");
    const double largest = simulation_.options().largest_step;
    longest_allowed_ = longest > 0 && largest > 0 ? std::min(longest, largest) : std::max(longest, largest);
}

void Trajectory::extend(double end_time) {
    require_started();
    if (outcome_.ending != Ending::end_time && outcome_.ending != Ending::stopped)
        return;
    if (!(end_time >= time_))
        throw InputError(fmt::format("a trajectory cannot go on from time {} to {}", time_, end_time),
                         "give an end that is not before the present time");
    outcome_ = {};
    end_time_ = end_time;
    stop_after_contact_ = false;
}

void Trajectory::carry_tangents(std::span<const double> seeds, std::size_t directions) {
    require_started();
    const std::size_t inputs = states_ + parameters_.size();
    // Divided, since the product could overflow.
    if (directions == 0 || seeds.size() % directions != 0 || seeds.size() / directions != inputs)
        throw InputError("the directions of derivatives do not fit the model",
                         fmt::format("give at least one, and {} numbers for each", inputs));
    require_finite(seeds, "a component of a direction of derivatives");
    tangents_ = std::make_unique<Tangents>(simulation_, parameters_, seeds, directions);
}

void Trajectory::carry_derivatives(std::span<const std::string> names) {
    const Model& model = simulation_.model();
    const std::size_t inputs = states_ + parameters_.size();
    std::vector<double> seeds(names.size() * inputs, 0.0);
    for (std::size_t d = 0; d < names.size(); ++d) {
        const auto state = model.find_state(names[d]);
        seeds[d * inputs + (state ? *state : states_ + model.independent_parameter(names[d]).place())] = 1;
    }
    carry_tangents(seeds, names.size());
}

double Trajectory::derivative(std::size_t state, std::size_t direction) const {
    const std::size_t directions = tangents_ ? tangents_->directions() : 0;
    if (state >= states_ || direction >= directions)
        throw InputError(fmt::format("there is no derivative of state {} in direction {}", state, direction),
                         fmt::format("{} states and {} directions are counted from 0; carry_derivatives says which",
                                     states_, directions));
    return tangents()[state * directions + direction];
}

std::span<const double> Trajectory::tangents() const {
    return tangents_ ? tangents_->matrix() : std::span<const double>{};
}

bool Trajectory::tangents_valid() const {
    return tangents_ && tangents_->valid();
}

void Trajectory::find_series(const Jet& jet, std::size_t lane) {
    series_ = jet.series();
    if (jet.width() == 1)
        return;
    std::transform(series_.begin(), series_.end(), lane_series_.begin(), [&](const Series& series) {
        return Series{series.first + lane, series.stride};
    });
    series_ = std::span(lane_series_).first(series_.size());
}

std::span<const double> Trajectory::series(std::size_t index) {
    const auto size = static_cast<std::size_t>(order_) + 1;
    if (const Series& series = series_[index]; series.stride != 1) {
        gathered_.resize(lane_series_.size() * size);
        double* to = &gathered_[index * size];
        for (std::size_t k = 0; k < size; ++k)
            to[k] = series[k];
        lane_series_[index] = {to, 1};
    }
    return {series_[index].first, size};
}

double Trajectory::propose(const Jet& jet, double step, std::size_t lane) {
    require_started();
    require_index(lane, static_cast<std::size_t>(jet.width()), "lane");
    if (jet.order() != order_)
        throw InputError("a trajectory needs the jets of its own simulation", "");
    find_series(jet, lane);
    // Event functions and observed expressions must be as accurate as the states.
    step = limited_by_floors(step);
    const bool unlimited = !(previous_step_ > 0) || std::isinf(step);
    leap_ = !(step <= longest_leap * previous_step_) && !std::isnan(step) && !compiled_mode_->polynomial;
    if ((leap_ || unlimited) && !floored_)
        step = step_size_(series_, previous_step_);
    if (!floored_ && !compiled_mode_->has_roots)
        step = dormant_states_.step(step_size_, mode_, series_, step, previous_step_);
    const double remaining = (end_time_ - time_) - time_low_;
    proposed_ = !std::isinf(step) ? step : std::isinf(remaining) ? 1.0 : std::max(remaining, 1.0);
    if (believed_ > 0)
        proposed_ = std::min(proposed_, believed_);
    if (leap_) {
        guarded_.assign(static_cast<std::size_t>(jet.width()), std::numeric_limits<double>::infinity());
        guarded_[lane] = proposed_;
        jet.guard_steps(guarded_);
        proposed_ = guarded_[lane];
    }
    const double longest =
        std::min(longest_allowed_ > 0 ? std::min(proposed_, longest_allowed_) : proposed_, std::max(remaining, 0.0));
    const double limited = table_steps_ ? table_steps_->limit(mode_, series_, longest) : longest;
    if (std::isnan(limited)) // beyond the end of a table
        proposed_ = limited;
    return limited;
}

/// Steps that keep shrinking lead to a singularity, or to a multiple zero of a state or event function that they
/// resolve relative to its size. Once they have become far shorter, present sizes are kept as floors.
double Trajectory::limited_by_floors(double step) {
    constexpr double far_shorter = 1e-6;
    // A radicand that falls to zero has a definite end there.
    if (std::isnan(step) || compiled_mode_->has_roots)
        return step;
    if (arc_start_ || !(step < previous_step_)) {
        floored_ = false;
        descent_start_ = std::isinf(step) ? previous_step_ : step;
        return step;
    }
    if (!floored_ && step < far_shorter * descent_start_) {
        floored_ = true;
        floors_.resize(series_.size());
        for (std::size_t i = 0; i < series_.size(); ++i)
            floors_[i] = step_size_.size_of(series_[i], previous_step_);
    }
    return floored_ ? step_size_.with_floors(series_, previous_step_, floors_) : step;
}

/// Returns the sizes below which series need not be resolved over this step; usually empty.
std::span<const double> Trajectory::floors() const {
    return floored_ ? std::span<const double>(floors_) : dormant_states_.floors();
}

/// Shortens a step until polynomials and model agree at its end, and at interior times after a leap. Returns false if
/// there is no such step.
bool Trajectory::check_step(double& step, const StepPreview& preview, std::size_t lane) {
    const bool agrees = preview.agrees(lane) && !leap_ && step == preview.length(lane);
    const double longest = agrees ? step : step_check_.longest(mode_, series_, step, leap_, floors());
    if (longest == step) {
        if (believed_ > 0)
            believed_ = proposed_ < believed_ ? 0 : 2 * proposed_;
        return true;
    }
    believed_ = 2 * longest;
    step = proposed_ = longest;
    return step > shortest_step();
}

/// Below this length a step hardly changes the time.
double Trajectory::shortest_step() const {
    return 32 * std::numeric_limits<double>::epsilon() * std::max(time_ - start_time_, largest_step_);
}

void Trajectory::advance(const StepPreview& preview, std::size_t lane) {
    require_started();
    if (finished())
        return;
    if (series_.empty())
        throw OrderError("a step has to be proposed before it can be made");
    const bool long_enough = proposed_ > 0 && proposed_ >= shortest_step();
    if (!long_enough && leave_branch())
        return;
    if (std::isnan(proposed_)) {
        announce_contact();
        return finish_undefined();
    }
    const double remaining = (end_time_ - time_) - time_low_;
    largest_step_ = std::max(largest_step_, std::min(proposed_, remaining));
    if (!long_enough) {
        announce_contact();
        if (double step = shortest_step(); compiled_mode_->has_roots && !arc_start_)
            if (const std::size_t watched = find_contact(step, preview, lane); watched != no_event)
                return make_contact(watched, step);
        return branch_ahead_ < states_ ? finish_at_branch(branch_ahead_) : finish_singular();
    }
    const bool crosses_knot = table_steps_ && table_steps_->crosses();
    if (tangents_) {
        Jet* const jet = preview.jet();
        const bool usable = jet != nullptr && jet->width() == 1 && jet->deferred_count() > 0;
        tangents_->use(usable ? jet : nullptr, preview.next());
        tangents_->cross_knot(crosses_knot);
    }
    double step = preview.length(lane);
    const std::size_t jumping = limit_to_branch(step);
    const double limited = step;
    // A step as short as round-off that passes a knot agrees no better than that.
    if (step > 0 && !crosses_knot && !check_step(step, preview, lane)) {
        announce_contact();
        return finish_unresolved();
    }
    previous_step_ = proposed_;

    if (arc_start_) {
        begin_arc(longest_allowed_ > 0 ? std::min(proposed_, longest_allowed_) : proposed_);
        if (finished() || arc_start_)
            return;
        if (observer_->stop() || stop_after_contact_)
            return finish(Ending::stopped, time_);
    }
    if (remaining <= 0)
        return finish(Ending::end_time, time_);
    if (steps_ >= simulation_.options().step_limit)
        return finish(Ending::step_limit, time_,
                      fmt::format("{} steps were not enough; ask for a shorter time or raise the limit", steps_));
    bool last = step >= remaining;
    std::size_t watched = step > 0 ? find_contact(step, preview, lane) : no_event;
    const double contact_at = step;
    bool stopped = make_step(step);
    if (stopped && watched != no_event &&
        contact_at - step <= 64 * std::numeric_limits<double>::epsilon() * std::max(std::abs(time_), largest_step_)) {
        // A contact at the same time as the passage belongs to this step: otherwise a clock that is reset at the end of
        // its period would miss it.
        step = contact_at;
        stop_after_contact_ = true;
        stopped = false;
    }
    if (stopped) {
        watched = no_event;
        last = false;
    }
    if (watched != no_event) {
        make_contact(watched, step);
    } else {
        move_along(step, last, preview, lane);
        if (jumping != states_ && step == limited && !stopped)
            return finish_at_branch(jumping);
    }
    if (!finished() && (stopped || observer_->stop()))
        finish(Ending::stopped, time_);
    // An arc that begins exactly at the end time still has its contact to report, in the next call.
    if (!finished() && !arc_start_ && time_ >= end_time_)
        finish(Ending::end_time, time_);
}

/// Moves to the end of a step without events.
/// @param last whether this is the end of the trajectory
void Trajectory::move_along(double step, bool last, const StepPreview& preview, std::size_t lane) {
    update_sides(step);
    if (tangents_)
        tangents_->advance(mode_, state_, step);
    if (step == preview.length(lane))
        for (std::size_t i = 0; i < states_; ++i)
            state_[i] = preview.state(i, lane);
    else
        for (std::size_t i = 0; i < states_; ++i)
            state_[i] = evaluate_state(i, step);
    if (last) {
        time_ = end_time_;
        time_low_ = 0;
    } else {
        add_time(step);
    }
    wrap_cyclic_states(false);
}

/// Reduces the cyclic states of a copy of the state to their periods.
void Trajectory::reduce_cyclic_states(std::span<double> state) const {
    for (std::size_t i = 0; i < states_; ++i)
        state[i] = within_period(state[i], periods_[i]);
}

void Trajectory::wrap_cyclic_states(bool snap) {
    for (const std::size_t i : cyclic_states_) {
        const double period = periods_[i];
        if (state_[i] < 0 || state_[i] >= period) {
            const double turns = std::floor(state_[i] / period);
            state_[i] -= turns * period;
            probes_->shift(i, -turns * period);
            if (tangents_)
                tangents_->set_back(i, turns);
        }
        // After a contact at the end of the period, the state must be at the beginning of the next period.
        if ((snap && period - state_[i] <= roundoff * period) || state_[i] >= period) {
            state_[i] = 0;
            probes_->shift(i, -period);
            if (tangents_)
                tangents_->set_back(i, 1);
        }
    }
}

void Trajectory::add_time(double step) {
    // Knuth's two-sum keeps the low-order part of the time, which would otherwise be lost over many steps.
    const double increment = step + time_low_;
    const double sum = time_ + increment;
    const double part = sum - time_;
    time_low_ = (time_ - (sum - part)) + (increment - part);
    time_ = sum;
}

void Trajectory::finish(Ending ending, double time, std::string detail) {
    outcome_.ending = ending;
    outcome_.time = time;
    outcome_.detail = std::move(detail);
}

std::string Trajectory::where() const {
    return fmt::format("in mode '{}' at time {:.15g}", simulation_.model().modes[mode_].name, time_);
}

void Trajectory::finish_unresolved() {
    finish(Ending::undefined, time_,
           fmt::format("no step could be found at whose end the rates agree with their Taylor series {}: make "
                       "abrupt changes events, or smooth them",
                       where()));
}

void Trajectory::finish_undefined() {
    const Model& model = simulation_.model();
    std::vector<double> rates(states_);
    std::copy(state_.begin(), state_.end(), inputs_.begin());
    compiled_mode_->rates.evaluate(inputs_, rates, work_);
    constexpr std::string_view unknown = "a derivative of the vector field";
    std::string culprit(unknown);
    const auto& mode = *compiled_mode_;
    values_.resize(mode.events.outputs());
    mode.events.evaluate(inputs_, values_, work_);
    for (std::size_t w = mode.watched.size(); w-- > 0;)
        if (!std::isfinite(values_[w]))
            culprit = fmt::format("the function of event '{}'", model.events[mode.watched[w]].name);
    for (std::size_t i = states_; i-- > 0;)
        if (!std::isfinite(rates[i]))
            culprit = fmt::format("the rate of state '{}'", model.states[i].name);
    finish(Ending::undefined, time_,
           fmt::format("{} is not finite {}: look for a division by zero, or a root or logarithm of a number that is "
                       "not positive{}",
                       culprit, where(),
                       culprit == unknown
                           ? "; or, if the motion is faster than some 10^15 per unit of time, count time "
                             "in a shorter unit"
                           : ""));
}

} // namespace graze
