#include "graze/flow/mode_flow.hpp"

#include "flow/grouped_directions.hpp"
#include "flow/table_steps.hpp"
#include "flow/uniformised_flow.hpp"
#include "graze/base/require.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace graze {

namespace {

constexpr std::size_t most_steps_of_mode = 2'000'000;
/// A step shorter than this fraction of an arc means that the solution ceases to exist.
constexpr double smallest_share = 1e-14;
/// Fraction of an arc over which sizes are measured where the initial state does not show them.
constexpr double first_share = 1e-10;
/// Share of a duration within which steps beside a zero of a radicand are not shown.
constexpr double hidden_share = 1e-11;
/// The first step after it is about this share of it; shorter ones lead to the zero at the end.
constexpr double shortest_shown = 1e-2;
/// A step longer than the last one by more than this factor is also checked at interior times.
constexpr double longest_leap = 2;

int order_of(double tolerance, int order) {
    return order != 0 ? order : order_for_tolerance(tolerance);
}

/// Returns the chosen states, or all if none are chosen.
std::vector<std::size_t> starts_of(const System& system, std::optional<std::vector<std::size_t>> chosen) {
    if (chosen)
        return std::move(*chosen);
    std::vector<std::size_t> all(system.states());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
}

} // namespace

ModeFlow::ModeFlow(const System& system, double tolerance, int order, std::vector<ParameterId> free,
                   std::optional<std::vector<std::size_t>> starts)
    : system_(system), free_(std::move(free)), starts_(starts_of(system, std::move(starts))), states_(system.states()),
      directions_(starts_.size() + free_.size()), step_size_(order_of(tolerance, order), tolerance),
      step_check_(system, order_of(tolerance, order), tolerance), dormant_states_(system),
      jets_(system, order_of(tolerance, order), LaneKind::single),
      tangents_(system, tolerance, directions_), allowance_{StepCheck::allowance * tolerance,
                                                            StepCheck::value_allowance * tolerance,
                                                            StepCheck::smallest_size},
      table_steps_(TableSteps::of(system, order_of(tolerance, order))), grouped_(system.model().modes.size()),
      tolerance_(tolerance), order_(order) {
    if (directions_ > 0)
        jets_.add_tangents();
    for (const ParameterId parameter : free_)
        require_index(parameter.place(), system.parameters(), "independent parameter");
    for (const std::size_t state : starts_)
        require_index(state, states_, "state");
    parameter_seeds_.assign(system.parameters() * directions_, 0.0);
    for (std::size_t f = 0; f < free_.size(); ++f)
        parameter_seeds_[free_[f].place() * directions_ + starts_.size() + f] = 1;
    sums_.resize(std::max<std::size_t>(states_, 1));
    slopes_.resize(sums_.size());
    next_.resize(states_ * directions_);
    matrix_.resize(states_ * directions_);
}

ModeFlow::~ModeFlow() = default;
ModeFlow::ModeFlow(ModeFlow&&) noexcept = default;
ModeFlow& ModeFlow::operator=(ModeFlow&&) noexcept = default;

void ModeFlow::require_fitting(std::size_t mode, std::span<const double> state) const {
    require_index(mode, system_.model().modes.size(), "mode");
    require_size(state.size(), states_, "states");
    if (parameters_.size() != system_.parameters())
        throw OrderError("the flow of a mode has no parameters before they are set");
}

void ModeFlow::set_parameters(std::span<const double> parameters) {
    require_size(parameters.size(), system_.parameters(), "independent parameters");
    parameters_.resize(parameters.size());
    std::copy(parameters.begin(), parameters.end(), parameters_.begin());
    jets_.set_parameters(parameters_);
    step_check_.set_parameters(parameters_);
    if (table_steps_)
        table_steps_->set_parameters(parameters_);
    dormant_states_.set_parameters(parameters_);
    tangents_.set_parameters(parameters_, parameter_seeds_);
    for (const auto& directions : grouped_)
        if (directions && *directions)
            (*directions)->set_parameters(parameters_);
    if (uniformised_)
        uniformised_->set_parameters(parameters_);
}

/// Compares all states and events with the model at once; the result also begins the next step.
bool ModeFlow::agrees(std::size_t mode, double length) {
    if (!(length > 0))
        return false;
    const Jet& jet = jets_(mode);
    Jet& next = jets_.next(mode);
    jet.evaluate_states({&length, 1}, sums_, slopes_);
    next.begin(std::span<const double>(sums_).first(states_));
    double disagreement = 0;
    jet.find_disagreement(next, allowance_, {&length, 1}, sums_, slopes_, {&disagreement, 1});
    seen_ = length;
    return disagreement <= 0;
}

/// Returns the length of the next step, with the sign of `remaining`: chosen from the series, then shortened to where
/// they agree with the model. @param watched whether event functions are needed too, as accurate as the states
double ModeFlow::step_of(std::size_t mode, const Jet& jet, double remaining, bool watched) {
    const std::span<const Series> all = jet.series(),
                                  series = watched || !system_.mode(mode).tables.empty() ? all : all.first(states_);
    double step = step_size_(series, previous_);
    // The size of a state that starts almost at zero, such as a phase of 1e-18, says nothing about its changes.
    if (previous_ == 0 && step < smallest_share * std::abs(remaining))
        step = step_size_(series, first_share * std::abs(remaining));
    if (std::isnan(step))
        return step;
    if (!system_.mode(mode).has_roots)
        step = dormant_states_.step(step_size_, mode, series, step, previous_);
    const bool leap = !(step <= longest_leap * previous_) && !system_.mode(mode).polynomial;
    const bool bounded = step < std::numeric_limits<double>::infinity();
    guarded_.assign(static_cast<std::size_t>(jet.width()), std::numeric_limits<double>::infinity());
    guarded_[0] = std::min(step, std::abs(remaining));
    jet.guard_steps(guarded_);
    const double allowed = std::copysign(guarded_[0], remaining),
                 to_knot = table_steps_ ? table_steps_->limit(mode, all, allowed) : allowed;
    if (std::isnan(to_knot))
        return to_knot;
    at_knot_ = std::abs(to_knot) < guarded_[0];
    crosses_knot_ = at_knot_ && table_steps_->crosses();
    guarded_[0] = std::abs(to_knot);
    const double wanted = std::copysign(guarded_[0], remaining);
    // This test accepts most steps; the others go to StepCheck, which allows more.
    const double longest = crosses_knot_ || (!leap && agrees(mode, wanted))
                               ? guarded_[0]
                               : std::abs(step_check_.longest(mode, series, wanted, leap, dormant_states_.floors()));
    at_knot_ = at_knot_ && longest == guarded_[0];
    if (longest < std::min(step, std::abs(remaining)) && !at_knot_)
        previous_ = longest;
    else if (bounded)
        previous_ = step;
    return longest < std::abs(remaining) ? std::copysign(longest, remaining) : remaining;
}

/// Returns the flow through zeros of radicands, if the mode ends at one; null otherwise.
UniformisedFlow* ModeFlow::uniformised(std::size_t mode) {
    if (!system_.mode(mode).ends_at_root)
        return nullptr;
    if (system_.uniformised().roots(mode).empty())
        return nullptr;
    if (!uniformised_) {
        uniformised_ = std::make_unique<UniformisedFlow>(system_, tolerance_, order_, free_, starts_);
        uniformised_->set_parameters(parameters_);
    }
    return uniformised_.get();
}

/// Returns the directions of the mode in groups; null if they are followed one by one.
GroupedDirections* ModeFlow::grouped(std::size_t mode) {
    auto& directions = grouped_[mode];
    if (!directions) {
        directions = GroupedDirections::of(system_, mode, tolerance_, order_of(tolerance_, order_), starts_, free_);
        if (*directions)
            (*directions)->set_parameters(parameters_);
    }
    return directions->get();
}

/// Runs through zeros of radicands. Steps in time, which become short near these, are made besides for `visit`.
ModeFlow::Ending ModeFlow::run_uniformised(std::size_t mode, std::span<double> state, double duration,
                                           std::span<double> derivatives, const StepVisitor& visit) {
    if (!std::isfinite(duration))
        return Ending::undefined;
    if (visit && duration != 0) {
        const double hidden = hidden_share * duration;
        std::vector<double> here(state.begin(), state.end());
        bool first = true;
        const StepVisitor visit_from_start = [&](const Jet& jet, double time, double length) {
            visit(jet, first ? 0 : hidden + time, first ? hidden + length : length);
            first = false;
        };
        const StepEnd too_short = [&](const Jet&, double& length) {
            return std::abs(length) < shortest_shown * std::abs(hidden);
        };
        if (uniformised_->run(mode, here, hidden, {}) == Ending::done)
            follow(mode, here, duration - hidden, {.visit = &visit_from_start, .end = &too_short});
    }
    const std::size_t before = uniformised_->steps();
    const Ending ending = uniformised_->run(mode, state, duration, derivatives);
    steps_ += uniformised_->steps() - before;
    return ending;
}

ModeFlow::Ending ModeFlow::run(std::size_t mode, std::span<double> state, double duration, const StepVisitor& visit) {
    require_fitting(mode, state);
    if (uniformised(mode) != nullptr)
        return run_uniformised(mode, state, duration, {}, visit);
    return follow(mode, state, duration, {.visit = visit ? &visit : nullptr});
}

ModeFlow::Ending ModeFlow::run_until(std::size_t mode, std::span<double> state, double longest, const StepEnd& end,
                                     std::span<double> derivatives) {
    require_fitting(mode, state);
    if (derivatives.empty())
        return follow(mode, state, longest, {.end = &end});
    require_size(derivatives.size(), states_ * directions_, "derivatives");
    return follow(mode, state, longest, derivatives, {.end = &end});
}

ModeFlow::Ending ModeFlow::follow(std::size_t mode, std::span<double> state, double duration,
                                  const Watchers& watchers) {
    if (!std::isfinite(duration))
        return Ending::undefined;
    double time = 0, remaining = duration;
    previous_ = 0;
    dormant_states_.begin();
    bool ends = false;
    for (std::size_t count = 0; remaining != 0 && !ends; ++count) {
        if (count >= most_steps_of_mode)
            return Ending::too_long;
        const Jet& jet = jets_.computed(mode, state);
        seen_ = 0;
        double step = step_of(mode, jet, remaining, watchers.needs_events());
        if (std::isnan(step))
            return Ending::undefined;
        if (std::abs(step) < std::abs(duration) * smallest_share && step != remaining && !at_knot_)
            return Ending::singular;
        ends = watchers.end != nullptr && (*watchers.end)(jet, step);
        if (watchers.visit != nullptr)
            (*watchers.visit)(jet, time, step);
        if (seen_ != step)
            jet.evaluate_states({&step, 1}, sums_);
        std::copy_n(sums_.begin(), states_, state.begin());
        ++steps_;
        time += step;
        remaining = step == remaining ? 0 : remaining - step;
    }
    return std::all_of(state.begin(), state.end(), [](double x) { return std::isfinite(x); }) ? Ending::done
                                                                                              : Ending::undefined;
}

ModeFlow::Ending ModeFlow::run(std::size_t mode, std::span<double> state, double duration, WatchedSeries& watched) {
    require_index(mode, system_.model().modes.size(), "mode");
    const std::size_t events = system_.mode(mode).watched.size();
    watched.begin(events);
    if (events == 0)
        return run(mode, state, duration);
    return run(mode, state, duration, [&](const Jet& jet, double time, double length) {
        watched.note(jet);
        watched.end_step(time, length);
    });
}

ModeFlow::Ending ModeFlow::run(std::size_t mode, std::span<double> state, double duration,
                               std::span<double> derivatives, WatchedSeries* watched) {
    require_fitting(mode, state);
    require_size(derivatives.size(), states_ * directions_, "derivatives");
    if (directions_ == 0)
        return watched ? run(mode, state, duration, *watched) : run(mode, state, duration);
    const std::size_t events = system_.mode(mode).watched.size();
    if (watched)
        watched->begin(events);
    const bool with_events = watched && events > 0;
    if (uniformised(mode) == nullptr)
        return follow(mode, state, duration, derivatives, {.watched = with_events ? watched : nullptr});
    if (!with_events)
        return run_uniformised(mode, state, duration, derivatives, {});
    return run_uniformised(mode, state, duration, derivatives, [&](const Jet& jet, double time, double length) {
        watched->note(jet);
        watched->end_step(time, length);
    });
}

ModeFlow::Ending ModeFlow::follow(std::size_t mode, std::span<double> state, double duration,
                                  std::span<double> derivatives, const Watchers& watchers) {
    if (!std::isfinite(duration))
        return Ending::undefined;
    std::fill(matrix_.begin(), matrix_.end(), 0.0);
    for (std::size_t d = 0; d < starts_.size(); ++d)
        matrix_[starts_[d] * directions_ + d] = 1;
    GroupedDirections* const groups = grouped(mode);
    TangentSteps& tangents = groups != nullptr ? groups->steps() : tangents_;
    if (groups != nullptr)
        groups->begin();
    double time = 0, remaining = duration;
    previous_ = 0;
    dormant_states_.begin();
    bool ends = false;
    for (std::size_t count = 0; remaining != 0 && !ends; ++count) {
        if (count >= most_steps_of_mode)
            return Ending::too_long;
        Jet& jet = jets_.computed(mode, state);
        seen_ = 0;
        double wanted = step_of(mode, jet, remaining, watchers.needs_events());
        if (std::isnan(wanted))
            return Ending::undefined;
        ends = watchers.end != nullptr && (*watchers.end)(jet, wanted);
        if (watchers.watched != nullptr)
            watchers.watched->note(jet);
        tangents.begin(jet, mode, state, groups != nullptr ? groups->seeds() : matrix_);
        const std::span<double> after = groups != nullptr ? groups->at_end() : std::span<double>(next_);
        const std::span<const double> end =
            seen_ == wanted ? std::span<const double>(sums_).first(states_) : std::span<const double>{};
        double step = wanted;
        if (crosses_knot_)
            tangents.cross(wanted, after);
        else
            step = tangents.carry(jets_.next(mode), wanted, after, end);
        if (std::isnan(step))
            return Ending::undefined;
        at_knot_ = at_knot_ && step == wanted;
        ends = ends && step == wanted;
        if (std::abs(step) < std::abs(duration) * smallest_share && step != remaining && !ends && !at_knot_)
            return Ending::singular;
        std::copy(tangents.state().begin(), tangents.state().end(), state.begin());
        if (watchers.watched != nullptr)
            watchers.watched->end_step(time, step);
        if (groups != nullptr)
            groups->multiply(matrix_, next_);
        matrix_.swap(next_);
        ++steps_;
        time += step;
        remaining = step == remaining ? 0 : remaining - step;
    }
    std::copy(matrix_.begin(), matrix_.end(), derivatives.begin());
    const auto all_finite = [](std::span<const double> values) {
        return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
    };
    return all_finite(state) && all_finite(derivatives) ? Ending::done : Ending::undefined;
}

} // namespace graze
