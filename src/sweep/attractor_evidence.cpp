// Evidence for labels: motions are followed for longer before they are labelled periodic or chaotic. Results.

#include "sweep/attractor_search.hpp"
#include "sweep/field_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

namespace graze {

namespace {

constexpr std::size_t longest_stay = 20;  ///< longest test whether the motion stays with an orbit, in `cycles`
constexpr std::size_t beside_orbits = 10; ///< factor by which the test for chaos is longer if the motion may settle
constexpr double last_share = 0.25;       ///< share of the returns, the last ones, with an exponent of their own
constexpr double part_still = 0.25;       ///< least ratio of that exponent to the exponent over all returns

/// Turns a cyclic sequence so that it begins where its order is the first of all turns in the alphabet: whoever begins
/// to read it elsewhere gets the same. Compares two beginnings, and leaves out those that a difference excludes, which
/// takes a time in proportion to the length.
void turn_to_first(std::vector<std::uint32_t>& cycle) {
    const std::size_t length = cycle.size();
    std::size_t one = 0, other = 1, same = 0;
    while (one < length && other < length && same < length) {
        const std::uint32_t a = cycle[(one + same) % length], b = cycle[(other + same) % length];
        if (a == b) {
            ++same;
            continue;
        }
        (a > b ? one : other) += same + 1;
        if (one == other)
            ++other;
        same = 0;
    }
    std::rotate(cycle.begin(), cycle.begin() + static_cast<std::ptrdiff_t>(std::min(one, other)), cycle.end());
}

/// Removes from a cyclic sequence the contacts that accumulate: an odd number stands for all of them.
std::vector<std::uint32_t> without_accumulating(const std::vector<std::uint32_t>& cycle) {
    const std::size_t length = cycle.size();
    std::vector<bool> removed(length, false);
    for (std::size_t i = 0; i < length; ++i)
        for (std::size_t k = 1; cycle[i] % 2 == 1 && k < length; ++k) {
            const std::size_t before = (i + length - k) % length;
            if (cycle[before] + 1 != cycle[i])
                break;
            removed[before] = true;
        }
    std::vector<std::uint32_t> result;
    for (std::size_t i = 0; i < length; ++i)
        if (!removed[i])
            result.push_back(cycle[i]);
    return result;
}

/// Returns the labels of transitions, without those that change nothing; repetitions are written as powers, and
/// contacts that accumulate as a star, as in signatures of orbits.
/// @param period in returns. Which return of several an orbit begins with is chance: the order is made unique.
std::string signature_of(const Model& model, std::span<const std::uint32_t> contacts, std::size_t period) {
    std::vector<std::uint32_t> seen;
    for (const std::uint32_t code : contacts)
        if (code % 2 == 1 || !changes_nothing(model.transitions[code / 2]))
            seen.push_back(code);
    seen = without_accumulating(seen);
    if (period > 1)
        turn_to_first(seen);
    std::vector<std::pair<std::string, std::size_t>> parts;
    for (const std::uint32_t code : seen) {
        std::string name = model.transitions[code / 2].label + (code % 2 == 1 ? "*" : "");
        if (!parts.empty() && parts.back().first == name)
            ++parts.back().second;
        else
            parts.emplace_back(std::move(name), 1);
    }
    std::string text;
    for (const auto& [name, count] : parts)
        text += fmt::format("{}{}{}", text.empty() ? "" : " ", name, count > 1 ? fmt::format("^{}", count) : "");
    return text;
}

} // namespace

/// Returns over which the exponent is taken: the second half of `cycles`, or `lyapunov_cycles` if that is more.
std::size_t AttractorSearch::exponent_cycles() const {
    const AttractorOptions& options = setting_->options;
    return options.lyapunov_cycles == 0
               ? 0
               : std::min(options.cycles, std::max(options.lyapunov_cycles, options.cycles / 2));
}

/// The motion is close to a stable orbit: starts the test whether it stays there.
bool AttractorSearch::begin_stay() {
    const System& compiled = setting_->simulation.system();
    const bool events = !finder_.contacts().empty() || !compiled.mode(finder_.mode()).watched.empty();
    stay_.begin(finder_, watcher_, periods_, events);
    staying_ = true;
    return go_on_staying();
}

/// Returns whether the orbit neither attracts nor repels: it belongs to a continuous family, or a state is redundant,
/// such as the height of a body that is at rest on a moving table.
bool AttractorSearch::is_neutral() const {
    constexpr double neutral = 1e-6; ///< possible error of a double multiplier 1
    return !finder_.multipliers().empty() && std::abs(std::abs(finder_.multipliers().front()) - 1) <= neutral;
}

/// Returns whether the motion is, to within round-off, on such an orbit.
bool AttractorSearch::repeats_exactly() {
    constexpr double round_off = 1e-10; ///< relative to the extents of the states
    return is_neutral() && watcher_.distance(watcher_.recent(0).state, finder_.point()) <= round_off;
}

OrbitStay::Verdict AttractorSearch::go_on_repeating() {
    constexpr std::size_t long_enough = 50; ///< periods
    const std::size_t period = finder_.period(), gone = watcher_.returns() - repeating_since_;
    if (gone % period != 0)
        return OrbitStay::Verdict::staying;
    if (gone > 0 && (!repeats_exactly() || !same_contacts(finder_, watcher_, 1)))
        return OrbitStay::Verdict::left;
    return gone < long_enough * period ? OrbitStay::Verdict::staying : OrbitStay::Verdict::stayed;
}

bool AttractorSearch::go_on_staying() {
    const OrbitStay::Verdict verdict = repeating_ ? go_on_repeating() : stay_.judge(finder_, watcher_, periods_);
    if (verdict == OrbitStay::Verdict::stayed)
        return finish_periodic();
    const std::size_t most = longest_stay * setting_->options.cycles;
    if (verdict == OrbitStay::Verdict::staying && !repeating_ && stay_.gone(watcher_) >= most) {
        finish(Label::unsettled);
        result_.outcome.detail = fmt::format(
            "the motion has stayed close to a stable orbit of period {} for {} returns; to know that it does not "
            "leave again takes {}: raise `cycles`",
            finder_.period(), stay_.gone(watcher_), stay_.needed());
        return false;
    }
    if (verdict == OrbitStay::Verdict::staying) {
        watcher_.stop_after(watcher_.returns() + 1);
        extend();
        return true;
    }
    note_passed_orbit();
    staying_ = repeating_ = guessed_ = false;
    // Allow time for the exponent if it became due during the test.
    if (!exponent_.begun())
        limit_ = std::max(limit_, watcher_.returns() + exponent_cycles());
    if (finder_.period() < thresholds_.size())
        thresholds_[finder_.period()] /= 3; // the next attempt starts closer to the orbit
    if (++tries_ > most_tries && finder_.period() < thresholds_.size())
        thresholds_[finder_.period()] = -1; // no further attempt
    return go_on();
}

/// Records the period of a stable orbit that the motion has left.
void AttractorSearch::note_passed_orbit() {
    const auto& multipliers = finder_.multipliers();
    if (multipliers.empty() || std::abs(multipliers.front()) < 1)
        passed_period_ = finder_.period();
}

std::size_t AttractorSearch::usual_chaos() const {
    return std::max(setting_->options.cycles, setting_->options.chaos_cycles);
}

/// Returns the number of returns for which a motion must remain chaotic: more than usual if it has passed by a stable
/// orbit, on which it may settle by chance; or if all neighbours have merged, or may have, at an accumulation of
/// contacts, as when a ball comes to rest on its table. If neighbours merge repeatedly there is no chaos, however
/// much they separate in between, since the motion is the same after each merging.
std::size_t AttractorSearch::chaos_needed() const {
    return passed_period_ > 0 || collapses_ > 0 || landing_unseen_ ? beside_orbits * usual_chaos() : usual_chaos();
}

/// For a motion that looked chaotic after `cycles`: restores the state and samples of that time, with the label
/// `transient` if the motion has settled since. Does nothing if it is unsettled or failed.
void AttractorSearch::return_to_chaos() {
    const bool chaotic = result_.label == Label::chaotic;
    if (!chaotic && (result_.label == Label::unsettled || result_.label == Label::failed))
        return;
    if (!chaotic) {
        PointResult result;
        result.label = Label::transient;
        result.outcome = result_.outcome;
        result.outcome.detail = fmt::format(
            "chaotic for up to {} returns, then {}{}", result_.cycles, name_of(result_.label),
            result_.label == Label::periodic ? fmt::format(" with period {}", result_.period) : std::string());
        result.cycles = result_.cycles;
        result.periods_run = result_.periods_run;
        result.time = result_.time;
        result.lyapunov = chaos_->lyapunov;
        result.lyapunov_error = chaos_->error;
        result_ = std::move(result);
    }
    result_.state = chaos_->state;
    result_.mode = chaos_->mode;
    result_.samples = std::move(chaos_->samples);
}

/// Many transients look chaotic until they suddenly settle: follows the motion for longer. Also searches for a stable
/// orbit at the centre of the motion.
std::optional<bool> AttractorSearch::confirm_chaos() {
    confirming_ = true;
    if (++chaotic_ == 1 && setting_->options.stay_in_transients) {
        recorder_.keep_last(setting_->options.keep);
        const Return& last = watcher_.recent(0);
        chaos_ = Chaos{last.state, last.mode, recorder_.samples(), exponent_.value(), exponent_.error()};
    }
    chaotic_since_ = watcher_.returns();
    limit_ = chaotic_since_ + chaos_needed();
    visited_.values.clear();
    std::ranges::fill(thresholds_, setting_->options.recurrence);
    guesses_ = {middle_of(watcher_, setting_->map, 1, periods_)};
    return try_next_guess();
}

/// Contacts accumulate for neighbours too. After an accumulation that the derivatives could not follow the exponent
/// starts again; one at which all neighbours merge is counted as a collapse.
void AttractorSearch::add_to_exponent() {
    const bool lost = exponent_.external_derivatives() && of_motion_->broken(), stuck = watcher_.has_stuck(1);
    landing_unseen_ = lost || (landing_unseen_ && !stuck);
    if (stuck && exponent_.vanishes(*main_)) {
        ++collapses_;
        grown_before_ = last_grown_;
        last_grown_ = exponent_.most_grown();
    } else if (!lost) {
        return exponent_.add_return(*main_);
    }
    measure_growth(true);
    if (!confirming_)
        return;
    chaotic_since_ = watcher_.returns();
    if (collapses_repeatedly()) { // it may still settle
        confirming_ = false;
        lengthen();
    }
    limit_ = chaotic_since_ + (collapses_repeatedly() ? usual_chaos() : chaos_needed());
}

/// Returns whether the motion between two collapses of all neighbours follows from its start beyond round-off:
/// otherwise round-off, amplified as neighbours separate, would decide, and repetitions would be by chance.
bool AttractorSearch::follows_from_rest() const {
    constexpr double most_grown = 25; ///< logarithm of the growth from round-off to 1e-5 of the extents
    return collapses_repeatedly() && std::max(last_grown_, grown_before_) < most_grown;
}

/// A motion that was considered chaotic has been followed for longer.
std::optional<bool> AttractorSearch::conclude_chaos() {
    exponent_.catch_up();
    if (exponent_.known() && exponent_.is_positive() &&
        exponent_.value_over_last(last_share) > part_still * exponent_.value() &&
        !growth_.is_linear(watcher_, exponent_.returns())) {
        if (watcher_.returns() < chaotic_since_ + chaos_needed()) {
            limit_ = chaotic_since_ + chaos_needed();
            return std::nullopt;
        }
        finish(Label::chaotic);
        if (collapses_ > 0)
            result_.outcome.detail = fmt::format("chaotic for {} returns since neighbouring motions merged at an "
                                                 "accumulation of contacts; if that happens again it is not chaos",
                                                 watcher_.returns() - chaotic_since_);
        else if (passed_period_ > 0)
            result_.outcome.detail = fmt::format("chaotic for {} returns; as it passes by a stable orbit of period {} "
                                                 "it may be a transient that settles there later",
                                                 result_.cycles, passed_period_);
        return false;
    }
    // The motion has changed its behaviour: start a new exponent.
    confirming_ = false;
    start_exponent();
    lengthen();
    return std::nullopt;
}

bool AttractorSearch::finish_periodic() {
    finish(Label::periodic);
    result_.period = finder_.period();
    result_.duration = finder_.duration();
    result_.signature = signature_of(setting_->simulation.model(), finder_.contacts(), result_.period);
    result_.symmetric = finder_.symmetric();
    result_.multipliers = finder_.multipliers();
    result_.residual = finder_.residual();
    result_.state.assign(finder_.point().begin(), finder_.point().end());
    keep_signs(result_.state);
    result_.mode = finder_.mode();
    result_.samples = std::move(finder_.samples());
    result_.lyapunov.reset();
    result_.lyapunov_error.reset();
    if (chaotic_ > 0)
        result_.outcome.detail = fmt::format("after a chaotic transient of up to {} returns", result_.cycles);
    if (repeating_)
        result_.outcome.detail = "repeats itself, as neighbours may in their own ways: a multiplier is 1";
    if (!result_.multipliers.empty() && std::abs(result_.multipliers.front()) > 0)
        result_.lyapunov = std::log(std::abs(result_.multipliers.front())) / result_.duration;
    return false;
}

bool AttractorSearch::finish_equilibrium(const Equilibrium& equilibrium) {
    finish(Label::equilibrium);
    result_.state = equilibrium.state;
    result_.mode = equilibrium.mode;
    result_.lyapunov.reset();
    result_.lyapunov_error.reset();
    if (!equilibrium.driven && equilibrium.values.size() > 0) {
        result_.lyapunov = equilibrium.growth();
        result_.eigenvalues.assign(equilibrium.values.begin(), equilibrium.values.end());
    }
    if (setting_->map.is_phase() && watcher_.remembered() > 1) {
        // Returns continue as those of an orbit of period 1.
        result_.period = 1;
        result_.duration = watcher_.recent(0).time - watcher_.recent(1).time;
        if (equilibrium.driven) {
            result_.multipliers = finder_.multipliers();
            if (!result_.multipliers.empty() && std::abs(result_.multipliers.front()) > 0)
                result_.lyapunov = std::log(std::abs(result_.multipliers.front())) / finder_.duration();
        }
        for (const std::complex<double> value : equilibrium.values)
            if (!equilibrium.driven)
                result_.multipliers.push_back(std::exp(value * result_.duration));
    }
    recorder_.rest(main_->time(), result_.state);
    keep_signs(result_.state);
    result_.samples = std::move(recorder_.samples());
    return false;
}

bool AttractorSearch::finish(Label label) {
    result_.label = label;
    result_.cycles = watcher_.returns();
    result_.periods_run += watcher_.returns();
    result_.time = main_->time();
    result_.state.assign(main_->state().begin(), main_->state().end());
    result_.mode = main_->mode();
    result_.outcome = main_->outcome();
    if (label == Label::unbounded)
        result_.outcome.detail.clear(); // the overflow is no fault of the model
    if (watcher_.stuck())
        result_.outcome.detail = "no return to the section came; choose another section";
    if (label != Label::periodic && label != Label::equilibrium)
        exponent_.catch_up();
    if (collapses_repeatedly()) {
        // The exponent would be minus infinity.
        if (label == Label::unsettled && result_.outcome.detail.empty())
            result_.outcome.detail = fmt::format("neighbouring motions have merged at {} accumulations of contacts: "
                                                 "this is not chaos, but a long period or a long transient",
                                                 collapses_);
    } else if (exponent_.known()) {
        result_.lyapunov = exponent_.value();
        result_.lyapunov_error = exponent_.error();
    }
    recorder_.keep_last(setting_->options.keep);
    result_.samples = std::move(recorder_.samples());
    return false;
}

} // namespace graze
