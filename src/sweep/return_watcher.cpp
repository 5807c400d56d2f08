#include "sweep/return_watcher.hpp"

#include "base/special_numbers.hpp"

#include <cmath>
#include <utility>

namespace graze {

namespace {

/// Share of the time since the last return within which two occurrences count as simultaneous.
constexpr double simultaneous = 1e-10;
/// Extents below this share of the largest extent of a state are noise.
constexpr double least_extent = 1e-6;
/// Extents smaller than this share of a state's size are its round-off.
constexpr double round_off_of_return = 1e-12;
/// The effect of rounding on a state within a return is at most this share of its scale, less than the tolerance at
/// which orbits close.
constexpr double noise_share = 1e-10;
/// Shares of the threshold of a recurrence: for one that needs no further evidence, and for the one before it.
constexpr double striking = 1e-3;
constexpr double approaching = 30;
/// Distance of a return that repeats an earlier one exactly.
constexpr double exact = 1e-10;
constexpr std::size_t most_steps_to_return = 100'000; ///< longest run without a return
constexpr std::size_t first_check = 64; ///< steps without a return after which the motion is first examined

constexpr std::size_t most_parts = 6; ///< largest number of parts; they are merged in pairs when there are more

} // namespace

void MotionPart::include(const MotionPart& other) {
    include(other.least);
    include(other.greatest);
    contacts = contacts || other.contacts;
}

void MotionPart::include(std::span<const double> state) {
    for (std::size_t i = 0; i < state.size(); ++i) {
        least[i] = std::min(least[i], state[i]);
        greatest[i] = std::max(greatest[i], state[i]);
    }
}

void MotionParts::clear() {
    parts_.clear();
    length_ = 1;
    in_current_ = quiet_ = 0;
}

void MotionParts::add(const MotionPart& one) {
    quiet_ = one.contacts ? 0 : quiet_ + 1;
    if (in_current_ == 0)
        current_ = one;
    else
        current_.include(one);
    if (++in_current_ < length_)
        return;
    in_current_ = 0;
    parts_.push_back(current_);
    if (parts_.size() < most_parts)
        return;
    for (std::size_t k = 0; k < most_parts / 2; ++k) {
        parts_[2 * k].include(parts_[2 * k + 1]);
        if (k > 0)
            parts_[k] = std::move(parts_[2 * k]);
    }
    parts_.resize(most_parts / 2);
    length_ *= 2;
}

ReturnWatcher::ReturnWatcher(const SectionMap& map, std::size_t kept, std::vector<StateBounds> bounds)
    : map_(&map), bounds_(std::move(bounds)), scale_(map.states(), 1), noise_(map.states()), difference_(map.states()),
      least_(map.states()), greatest_(map.states()), widest_(map.states()), ring_(kept) {}

void ReturnWatcher::begin(std::span<const double> parameters, std::span<const double> periods,
                          SampleRecorder* recorder) {
    workspace_ = map_->workspace(parameters);
    periods_.assign(periods.begin(), periods.end());
    recorder_ = recorder;
    derivatives_ = nullptr;
    next_ = returns_ = last_stuck_ = 0;
    alike_.assign(ring_.size(), {});
    escaped_ = stuck_ = paused_ = false;
    std::ranges::fill(widest_, 0.0);
    std::ranges::fill(scale_, 1.0);
    thresholds_ = nullptr;
    early_.clear();
    parts_.clear();
    lowest_.assign(least_.size(), infinity);
    highest_.assign(least_.size(), -infinity);
}

void ReturnWatcher::start_leg(double time, double shortest) {
    leg_start_ = time;
    shortest_ = shortest;
    pending_ = stop_ = false;
    recurrent_ = steps_ = 0;
    next_check_ = first_check;
    current_.contacts.clear();
    std::ranges::fill(least_, infinity);
    std::ranges::fill(greatest_, -infinity);
}

void ReturnWatcher::include(std::size_t state, double value) {
    least_[state] = std::min(least_[state], value);
    greatest_[state] = std::max(greatest_[state], value);
}

void ReturnWatcher::include(std::span<const double> state) {
    for (std::size_t i = 0; i < state.size(); ++i)
        include(i, state[i]);
}

void ReturnWatcher::step(const Step& step) {
    if (derivatives_)
        derivatives_->step(step);
    for (std::size_t i = 0; i < least_.size(); ++i)
        include(i, step.states[i][0]);
    for (const StateBounds& bounds : bounds_)
        escaped_ = escaped_ || !bounds.contain(step.state(bounds.state, step.length));
    stuck_ = ++steps_ > most_steps_to_return && !any_steps_;
    paused_ = rest_ && steps_ >= next_check_;
    if (paused_) {
        next_check_ *= 2;
        widen();
    }
    stop_ = stop_ || escaped_ || stuck_ || paused_;
}

void ReturnWatcher::contact(const Contact& contact) {
    if (recorder_)
        recorder_->contact(contact);
    if (derivatives_)
        derivatives_->contact(contact);
    if (contact.kind == ContactKind::touch)
        return;
    // The step after the contact is only reported when the return to which it leads is complete.
    include(contact.before);
    include(contact.after);
    current_.contacts.push_back(
        static_cast<std::uint32_t>(2 * contact.transition + (contact.kind == ContactKind::sticking ? 1 : 0)));
    // If the section is the surface of an event, a return is complete when its jump has been made.
    if (pending_) {
        pending_ = false;
        if (derivatives_)
            derivatives_->mark(pending_time_, contact.mode_after, contact.after);
        arrive(pending_time_, contact.mode_after, contact.after);
    }
}

void ReturnWatcher::passage(const Passage& passage) {
    if (recorder_ && passage.probe != map_->probe())
        recorder_->passage(passage);
    if (passage.probe != map_->probe() || passage.time - leg_start_ <= shortest_)
        return;
    const double since = passage.time - (returns_ > 0 ? std::max(recent(0).time, leg_start_) : leg_start_);
    if (map_->is_on_event(workspace_, passage.mode, passage.state, periods_, simultaneous * since)) {
        pending_ = true;
        pending_time_ = passage.time;
        return;
    }
    if (derivatives_)
        derivatives_->mark_ahead(passage.time, passage.mode, passage.state);
    arrive(passage.time, passage.mode, passage.state);
}

void ReturnWatcher::grazing() {
    derivatives_->grazing();
}

void ReturnWatcher::arrive(double time, std::size_t mode, std::span<const double> state) {
    Return& place = ring_[next_];
    place.time = time;
    place.mode = mode;
    place.state.assign(state.begin(), state.end());
    include(state);
    widen();
    place.least = least_;
    place.greatest = greatest_;
    place.contacts.swap(current_.contacts);
    current_.contacts.clear();
    std::ranges::fill(least_, infinity);
    std::ranges::fill(greatest_, -infinity);
    next_ = (next_ + 1) % ring_.size();
    ++returns_;
    if (has_stuck(1))
        last_stuck_ = returns_;
    parts_.add(part(0));
    compare_contacts();
    steps_ = 0;
    next_check_ = first_check;
    paused_ = false;
    if (recorder_)
        recorder_->mark();
    for (const StateBounds& bounds : bounds_)
        escaped_ = escaped_ || !bounds.contain(state[bounds.state]);
    stop_ = stop_ || escaped_;
    if (thresholds_ && !stop_) {
        recurrent_ = find_recurrence();
        stop_ = recurrent_ != 0;
    }
    stop_ = stop_ || (stop_after_ > 0 && returns_ >= stop_after_) || (derivatives_ && derivatives_->broken());
}

MotionPart ReturnWatcher::part(std::size_t before) const {
    const Return& one = recent(before);
    MotionPart part{one.least, one.greatest, !one.contacts.empty()};
    if (before + 1 < remembered())
        part.include(recent(before + 1).state);
    return part;
}

void ReturnWatcher::compare_contacts() {
    for (std::size_t period = 1; thresholds_ && period < remembered(); ++period)
        if (Alike& alike = alike_[period]; recent(0).contacts == recent(period).contacts) {
            ++alike.now;
        } else {
            alike.longest = std::max(alike.longest, alike.now);
            alike.now = 0;
        }
}

void ReturnWatcher::widen() {
    for (std::size_t i = 0; i < widest_.size(); ++i) {
        widest_[i] = std::max(widest_[i], greatest_[i] - least_[i]);
        lowest_[i] = std::min(lowest_[i], least_[i]);
        highest_[i] = std::max(highest_[i], greatest_[i]);
    }
    if (early_.empty() && (returns_ > 0 || paused_))
        early_ = widest_;
}

void ReturnWatcher::update_scale() {
    const std::size_t known = std::min(remembered(), std::max<std::size_t>(largest_, 1));
    find_noise();
    for (std::size_t i = 0; i < scale_.size(); ++i) {
        if (periods_[i] > 0) {
            scale_[i] = periods_[i];
            continue;
        }
        double low = infinity, high = -infinity;
        for (std::size_t k = 0; k < known; ++k) {
            low = std::min(low, recent(k).least[i]);
            high = std::max(high, recent(k).greatest[i]);
        }
        const double extent = std::max(high - low, least_extent * widest_[i]);
        // A state that does not move at all is measured by its size.
        const double size = std::max(std::abs(high), std::abs(low));
        scale_[i] = extent > round_off_of_return * size ? extent : size > 0 ? size : 1;
        // A state that is moved only by the rounding of its rate has no extent of its own.
        scale_[i] = std::max(scale_[i], noise_[i] / noise_share);
    }
}

/// Estimates the displacement of each state by rounding since the last return.
void ReturnWatcher::find_noise() {
    std::ranges::fill(noise_, 0.0);
    const Return& last = recent(0);
    const double since = remembered() > 1 ? last.time - std::max(recent(1).time, leg_start_) : last.time - leg_start_;
    for (const std::vector<double>* const place : {&last.state, &last.least, &last.greatest})
        map_->add_round_off(workspace_, last.mode, *place, since, noise_);
}

double ReturnWatcher::distance(std::span<const double> a, std::span<const double> b) {
    subtract_states(a, b, periods_, difference_);
    double largest = 0;
    for (std::size_t i = 0; i < difference_.size(); ++i)
        if (map_->takes_part(i))
            largest = std::max(largest, std::abs(difference_[i]) / scale_[i]);
    return largest;
}

std::size_t ReturnWatcher::find_recurrence() {
    if (remembered() < 2)
        return 0;
    update_scale();
    for (std::size_t n = 1; n <= largest_ && n < remembered(); ++n) {
        const double threshold = (*thresholds_)[n];
        if (recent(n).mode != recent(0).mode)
            continue;
        const double now = distance(recent(0).state, recent(n).state);
        if (now > threshold)
            continue;
        if (now <= striking * threshold)
            return n;
        // Chaotic motions recur by chance, but not twice in a row and closer.
        if (remembered() <= 2 * n)
            continue;
        const double before = distance(recent(n).state, recent(2 * n).state);
        if (now < before && before < approaching * threshold)
            return n;
    }
    return find_exact_recurrence();
}

/// Finds an exact recurrence with a period longer than those searched. Two periods must have had the same contacts.
std::size_t ReturnWatcher::find_exact_recurrence() {
    for (std::size_t n = std::max(largest_, returns_ - last_stuck_) + 1; last_stuck_ > 0 && n < remembered(); ++n)
        if (recent(n).mode == recent(0).mode && alike(n) >= n &&
            distance(recent(0).state, recent(n).state) <= std::min(exact, (*thresholds_)[n]))
            return n;
    return 0;
}

bool ReturnWatcher::has_stuck(std::size_t count) const {
    for (std::size_t k = 0; k < std::min(count, remembered()); ++k)
        for (const std::uint32_t code : recent(k).contacts)
            if (code % 2 == 1)
                return true;
    return false;
}

std::vector<std::uint32_t> ReturnWatcher::contacts(std::size_t count) const {
    std::vector<std::uint32_t> all;
    for (std::size_t k = count; k-- > 0;)
        all.insert(all.end(), recent(k).contacts.begin(), recent(k).contacts.end());
    return all;
}

bool ReturnWatcher::stop() {
    const bool result = stop_;
    stop_ = false;
    return result;
}

} // namespace graze
