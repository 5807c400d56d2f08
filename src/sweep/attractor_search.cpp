#include "sweep/attractor_search.hpp"

#include "base/concatenated.hpp"
#include "base/special_numbers.hpp"
#include "graze/base/require.hpp"
#include "sweep/transient_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

constexpr double soonest = 1e-3;            ///< earliest next return, as a share of the time of a return
constexpr double least_growth_of_chaos = 5; ///< logarithm of the growth of a small distance that indicates chaos
constexpr double outward_share = 0.5;       ///< share of the growth of a small distance due to growth of the motion
constexpr double much_growth = 20;          ///< logarithm of the growth of the extents after which growth is examined
constexpr std::size_t least_extension = 400;
constexpr std::size_t most_chaotic = 3; ///< number of times that a motion is considered chaotic and followed for longer
constexpr std::size_t returns_between_checks = 25;
constexpr std::size_t extension = 4; ///< factor of the largest period in the last part of a search
constexpr double longest_step = 8;   ///< in periods of the section's clock: passages end steps anyway

std::optional<StepMaps> maps_of(const VariationalModes& modes) {
    return modes.suit() ? std::optional<StepMaps>(std::in_place, modes) : std::nullopt;
}

std::optional<MotionDerivatives> derivatives_of(const VariationalModes& modes, std::optional<StepMaps>& maps) {
    return maps ? std::optional<MotionDerivatives>(std::in_place, modes, *maps) : std::nullopt;
}

} // namespace

AttractorSearch::AttractorSearch(std::shared_ptr<const AttractorSetting> setting)
    : setting_(std::move(setting)), maps_(maps_of(setting_->variational)),
      of_orbit_(derivatives_of(setting_->variational, maps_)), of_motion_(derivatives_of(setting_->variational, maps_)),
      watcher_(setting_->map, 2 * extension * setting_->options.largest_period + 1, setting_->options.bounds),
      recorder_(setting_->layout, 0), finder_(setting_->map, setting_->field, setting_->layout, setting_->image,
                                              setting_->image_modes, of_orbit_ ? &*of_orbit_ : nullptr),
      exponent_(setting_->map, of_motion_ ? &*of_motion_ : nullptr), equilibria_(setting_->field),
      growth_(setting_->field, setting_->map) {}

void AttractorSearch::begin(std::span<const double> parameters, std::span<const double> state, std::size_t mode) {
    const System& compiled = setting_->simulation.system();
    require_size(parameters.size(), compiled.parameters(), "independent parameters");
    require_size(state.size(), compiled.states(), "states");
    require_index(mode, compiled.model().modes.size(), "mode");
    parameters_.assign(parameters.begin(), parameters.end());
    periods_.resize(compiled.states());
    std::vector<double> work(compiled.workspace());
    main_.emplace(setting_->simulation, parameters, borrowed(watcher_));
    compiled.periods().evaluate(parameters_, periods_, work);
    recorder_.begin(parameters);
    recorder_.set_origin(0);
    watcher_.begin(parameters, periods_, &recorder_);
    thresholds_.assign(2 * extension * setting_->options.largest_period + 1, setting_->options.recurrence);
    watcher_.watch_recurrence(&thresholds_, setting_->options.largest_period);
    watcher_.allow_any_steps(setting_->options.longest_return > 0);
    watcher_.watch_rest(true);
    watcher_.start_leg(0, 0);
    exponent_.clear();
    equilibria_.begin(parameters, periods_);
    growth_.begin(parameters, periods_);
    unstable_.clear();
    visited_ = {};
    for (std::size_t i = 0; i < periods_.size(); ++i)
        if (setting_->map.takes_part(i))
            visited_.periods.push_back(periods_[i]);
    limit_ = setting_->options.cycles;
    disturbances_ = tries_ = chaotic_ = passed_period_ = collapses_ = 0;
    staying_ = repeating_ = plane_left_ = lengthened_ = landing_unseen_ = false;
    finding_ = confirming_ = centre_tried_ = limits_tried_ = guessed_ = near_stable_ = false;
    guesses_.clear();
    chaos_.reset();
    growth_seen_ = much_growth;
    result_ = {};
    limit_steps(state, mode);
    main_->start(state, mode, 0, setting_->options.longest_return > 0 ? setting_->options.longest_return : infinity);
    const std::size_t before = exponent_cycles();
    watcher_.stop_after(limit_ > before ? limit_ - before : 1);
}

Trajectory& AttractorSearch::trajectory() {
    return finding_ ? finder_.trajectory() : *main_;
}

bool AttractorSearch::proceed() {
    bool goes_on = true;
    if (!finding_) {
        goes_on = settle();
    } else if (!finder_.proceed()) {
        finding_ = false;
        result_.periods_run += finder_.returns_run();
        goes_on = consider_orbit();
    }
    if (!goes_on && chaos_)
        return_to_chaos();
    return goes_on;
}

/// Limits steps that span many periods of a clock, since they would be cut at the first passage of the section.
void AttractorSearch::limit_steps(std::span<const double> state, std::size_t mode) {
    if (!setting_->map.is_phase())
        return;
    const std::size_t clock = setting_->simulation.probes()[setting_->map.probe()].state;
    const System& compiled = setting_->simulation.system();
    const std::vector<double> rates = compiled.mode(mode).rates(concatenated(state, parameters_));
    const double longest = longest_step * periods_[clock] / std::abs(rates[clock]);
    main_->limit_step(std::isfinite(longest) ? longest : 0);
    finder_.limit_step(std::isfinite(longest) ? longest : 0);
}

/// Handles the end of the main trajectory.
bool AttractorSearch::settle() {
    const Ending ending = main_->outcome().ending;
    if (ending != Ending::stopped && ending != Ending::terminal && growth_.outgrows_everything(watcher_))
        return finish(Label::unbounded);
    if (ending == Ending::end_time)
        return finish(Label::unsettled);
    if (ending == Ending::singular && hardly_moves())
        return finish(Label::unsettled);
    if (ending != Ending::stopped)
        return finish(label_of(ending));
    if (watcher_.escaped())
        return finish(Label::escaped);
    if (watcher_.paused())
        return examine_without_return();
    if (watcher_.stuck())
        return finish(Label::unsettled);
    return examine_return();
}

/// Returns whether almost nothing happened in a time as long as all before: then numbers have underflowed, and there is
/// no singularity.
bool AttractorSearch::hardly_moves() {
    constexpr double hardly = 1e-6; ///< relative to the extent of the motion
    const std::span<const double> rates = equilibria_.rates(main_->state(), main_->mode());
    for (std::size_t i = 0; i < rates.size(); ++i)
        if (!(periods_[i] > 0) && setting_->map.takes_part(i) &&
            !(std::abs(rates[i]) * main_->time() <= hardly * watcher_.widest()[i]))
            return false;
    return true;
}

/// No return has come for long: tests whether the motion comes to rest or grows.
bool AttractorSearch::examine_without_return() {
    if (const auto next = consider_rest(main_->state(), main_->mode()))
        return *next;
    if (growth_.since_start(watcher_) > much_growth && growth_.goes_on(watcher_, main_->state(), main_->mode()))
        return finish(Label::unbounded);
    if (watcher_.stuck())
        return finish(Label::unsettled);
    extend();
    return true;
}

void AttractorSearch::extend() {
    const double longest = setting_->options.longest_return;
    main_->extend(longest > 0 ? main_->time() + longest : infinity);
}

bool AttractorSearch::examine_return() {
    if (exponent_.begun())
        add_to_exponent();
    const Return& last = watcher_.recent(0);
    if (watcher_.returns() > setting_->options.cycles && !confirming_)
        for (std::size_t i = 0; i < last.state.size(); ++i)
            if (setting_->map.takes_part(i))
                visited_.values.push_back(last.state[i]);
    const double grown = growth_.since_start(watcher_);
    if (grown > much_growth && growth_.outgrows_everything(watcher_))
        return finish(Label::unbounded);
    if (grown > growth_seen_) {
        growth_seen_ = 2 * grown;
        if (growth_.goes_on(watcher_))
            return finish(Label::unbounded);
    }
    if (staying_)
        return go_on_staying();
    const std::size_t n = watcher_.recurrent();
    if (n == 0 || (watcher_.recurs_exactly() && !follows_from_rest()))
        return go_on();
    if (const auto next = consider_rest(last.state, last.mode))
        return *next;
    if (unstable_.explain(watcher_, n, setting_->options.disturbance)) {
        ask_for_closer(n);
        return go_on();
    }
    return find_orbit(last.state, n, watcher_.scale());
}

/// Requires the motion to come clearly closer before an orbit of this period is tried again.
void AttractorSearch::ask_for_closer(std::size_t period) {
    thresholds_[period] =
        std::min(thresholds_[period], watcher_.distance(watcher_.recent(0).state, watcher_.recent(period).state) / 3);
}

bool AttractorSearch::find_orbit(std::span<const double> point, std::size_t period, std::span<const double> scale) {
    finding_ = true;
    finder_.begin(parameters_, periods_, point, watcher_.recent(0).mode, period, scale,
                  watcher_.recent(0).time - watcher_.recent(period).time, watcher_.has_stuck(period));
    return true;
}

/// @param sticks whether contacts are likely to accumulate
void AttractorSearch::measure_growth(bool sticks) {
    exponent_.begin(parameters_, watcher_.scale(), main_->time(), sticks);
    exponent_.seed(*main_);
    watcher_.follow(exponent_.external_derivatives());
    growth_.mark(watcher_);
}

void AttractorSearch::start_exponent() {
    measure_growth(watcher_.has_stuck(watcher_.remembered()) || collapses_ > 0 || landing_unseen_);
    std::ranges::fill(thresholds_, setting_->options.recurrence);
}

bool AttractorSearch::go_on() {
    const std::size_t returns = watcher_.returns();
    const bool look_again = lengthened_ && returns % returns_between_checks == 0 && !confirming_;
    if (returns >= limit_ || look_again)
        if (const auto next = conclude())
            return *next;
    const std::size_t before = exponent_cycles();
    if (before > 0 && !exponent_.begun() && returns + before >= setting_->options.cycles)
        start_exponent();
    const std::size_t seen = confirming_ ? limit_ : setting_->options.cycles;
    const std::size_t next = exponent_.external_derivatives() && returns < seen ? seen : returns + 1;
    watcher_.stop_after(exponent_.begun() ? next : setting_->options.cycles - before);
    extend();
    return true;
}

/// Examines the orbit that may have been found near the last return.
bool AttractorSearch::consider_orbit() {
    const std::size_t n = watcher_.recurrent();
    const bool is_corner = finder_.found() && has_no_size(), vanishes = finder_.found() && vanishes_at_rest();
    if (is_corner || vanishes) {
        if (is_corner ? shrinks_to_a_corner() : approaches_rest_slowly())
            return false;
    } else if (finder_.found()) {
        const std::optional<Equilibrium> equilibrium = equilibrium_of_orbit();
        if (approaches(finder_, watcher_, periods_, setting_->simulation.options().tolerance) &&
            !is_behind_event(equilibrium ? equilibrium->state : finder_.point()))
            return equilibrium ? finish_equilibrium(*equilibrium) : begin_stay();
        if (const auto next = leave_unstable_orbit(equilibrium ? &*equilibrium : nullptr))
            return *next;
        if (!equilibrium && repeats_exactly()) {
            // Since multipliers do not prove that the motion stays, it must repeat itself for a long time.
            repeating_ = staying_ = true;
            repeating_since_ = watcher_.returns();
            return go_on_staying();
        }
        note_passed_orbit();
        near_stable_ = near_stable_ || (guessed_ && is_near(finder_, watcher_, periods_));
    }
    if (!is_corner && !vanishes)
        unstable_.add(finder_, watcher_);
    if (const auto next = try_next_guess())
        return *next;
    guessed_ = false;
    // The motion has not yet arrived at this orbit: finding it again by its multiples would use up all attempts.
    if (finder_.found() && is_neutral())
        for (std::size_t m = finder_.period(); m < std::min(thresholds_.size(), watcher_.remembered());
             m += finder_.period())
            ask_for_closer(m);
    if (n > 0)
        ask_for_closer(n);
    if (n > 0 && ++tries_ > most_tries)
        thresholds_[n] = -1;
    return go_on();
}

/// Restarts the motion at a state, without derivatives.
void AttractorSearch::restart(std::span<const double> state, std::size_t mode, double duration) {
    const double time = main_->time(), longest = setting_->options.longest_return;
    watcher_.start_leg(time, soonest * duration);
    main_->start(state, mode, time, longest > 0 ? time + longest : infinity);
}

/// Called after all cycles, and repeatedly in the extension after them.
/// @return what `proceed` returns, if the point is done or another trajectory is to be run
std::optional<bool> AttractorSearch::conclude() {
    if (confirming_)
        return conclude_chaos();
    if (const auto next = consider_rest(watcher_.recent(0).state, watcher_.recent(0).mode))
        return next;
    if (!exponent_.begun())
        return finish(Label::unsettled);
    exponent_.catch_up();
    if (exponent_.known()) {
        if (exponent_.is_positive())
            if (const auto next = consider_growth())
                return next;
        if (fills_a_torus()) {
            if (centre_tried_)
                return finish(Label::quasi_periodic);
            // So close to a stable orbit that no shrinking is visible, there is no torus.
            centre_tried_ = true;
            guesses_ = {middle_of(watcher_, setting_->map, 1, periods_)};
            return try_next_guess();
        }
    }
    if (watcher_.returns() < limit_)
        return std::nullopt;
    if (!limits_tried_) {
        limits_tried_ = true;
        guesses_ = slow_limits(watcher_, setting_->map, setting_->options.largest_period, periods_);
        if (const auto next = try_next_guess())
            return next;
    }
    if (lengthened_ && !may_fill_a_torus())
        return finish(Label::unsettled);
    lengthen();
    return std::nullopt;
}

/// Neighbours separate: either with the motion, which then grows itself, or from it.
/// @return what `proceed` returns, if the point is done or another trajectory is to be run
std::optional<bool> AttractorSearch::consider_growth() {
    const double growth = exponent_.value() * exponent_.time_per_return();
    const double all = growth * static_cast<double>(exponent_.returns());
    const bool outward = growth_.outward(watcher_) > outward_share * all;
    const bool linear = growth_.is_linear(watcher_, exponent_.returns());
    if ((outward || linear) && growth_.goes_on(watcher_))
        return finish(Label::unbounded);
    if (linear && growth_.goes_on_slowly(watcher_))
        return finish(Label::unbounded);
    if (linear && !outward)
        return leave_plane();
    if (outward && !linear && watcher_.returns() < limit_) // restart the average where the motion has arrived
        start_exponent();
    if (linear || outward || !(all > least_growth_of_chaos) || chaotic_ >= most_chaotic || collapses_repeatedly())
        return std::nullopt;
    if (const auto next = leave_plane())
        return next;
    return confirm_chaos();
}

/// Searches an orbit near the next of the possible limits.
std::optional<bool> AttractorSearch::try_next_guess() {
    if (guesses_.empty())
        return std::nullopt;
    const Guess guess = guesses_.front();
    guesses_.erase(guesses_.begin());
    guessed_ = true;
    // The last returns of a slow motion extend over less than the distance to the orbit.
    std::vector<double> scale(watcher_.scale().begin(), watcher_.scale().end());
    for (std::size_t i = 0; i < scale.size(); ++i)
        scale[i] = periods_[i] > 0 ? scale[i] : std::max(scale[i], watcher_.range(i));
    return find_orbit(guess.state, guess.period, scale);
}

/// Returns whether averages converge and the length of small distances varies between bounds, as on a torus.
bool AttractorSearch::fills_a_torus() {
    constexpr double even = 1e-2;      ///< differences of averages that exclude chaos
    constexpr double very_even = 1e-4; ///< the same, whatever the separation of neighbours
    constexpr double most = 10;        ///< variation of the logarithm of a small distance
    if (near_stable_ || !(std::abs(exponent_.value()) <= exponent_.error()) ||
        !(exponent_.error() * exponent_.time() <= most))
        return false;
    const double difference = unevenness(visited_, extents_of_visited());
    return difference < very_even || (difference < even && exponent_.is_bounded());
}

/// Returns whether it is worthwhile to follow the motion for longer.
bool AttractorSearch::may_fill_a_torus() {
    constexpr std::size_t most_extensions = 4;
    constexpr double rather_even = 3;
    const std::size_t cycles = setting_->options.cycles;
    return !near_stable_ && exponent_.known() && exponent_.is_bounded() &&
           limit_ < cycles + most_extensions * std::max(least_extension, 2 * cycles) &&
           std::abs(exponent_.value()) <= exponent_.error() && unevenness(visited_, extents_of_visited()) < rather_even;
}

/// Extends the search for slow transients and quasi-periodic motions.
void AttractorSearch::lengthen() {
    limits_tried_ = false;
    lengthened_ = true;
    limit_ += std::max(least_extension, 2 * setting_->options.cycles);
    std::ranges::fill(thresholds_, setting_->options.recurrence);
    const std::size_t largest = setting_->options.largest_period;
    std::fill(thresholds_.begin() + static_cast<std::ptrdiff_t>(largest) + 1, thresholds_.end(),
              setting_->options.recurrence / 100);
    watcher_.watch_recurrence(&thresholds_, extension * largest);
}

std::vector<double> AttractorSearch::extents_of_visited() const {
    std::vector<double> extents;
    for (std::size_t i = 0; i < periods_.size(); ++i)
        if (setting_->map.takes_part(i))
            extents.push_back(watcher_.scale()[i]);
    return extents;
}

std::unique_ptr<SearchFactory> attractor_searches(const System& system, const AttractorOptions& options,
                                                  const std::vector<Sampling>& samplings,
                                                  const std::vector<Expression>& values,
                                                  const SimulationOptions& simulation) {
    return std::make_unique<SearchesOf<AttractorSetting, AttractorSearch>>(system, options, samplings, values,
                                                                           simulation);
}

} // namespace graze
