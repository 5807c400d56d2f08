#include "sweep/motion_derivatives.hpp"

#include "trajectory/saltation.hpp"

#include <algorithm>
#include <utility>

namespace graze {

MotionDerivatives::MotionDerivatives(const VariationalModes& modes, StepMaps& maps)
    : modes_(&modes), maps_(&maps), states_(modes.simulation().system().states()) {}

void MotionDerivatives::begin(std::span<const double> parameters, std::span<const double> scale, Matrix derivatives,
                              AtMark at_mark) {
    const System& system = modes_->simulation().system();
    parameters_.assign(parameters.begin(), parameters.end());
    scale_.assign(scale.begin(), scale.end());
    at_mark_ = std::move(at_mark);
    broken_ = false;
    items_.clear();
    ahead_.clear();
    numbers_.clear();
    inputs_.resize(states_ + parameters.size());
    std::ranges::copy(parameters, inputs_.begin() + static_cast<std::ptrdiff_t>(states_));
    work_.resize(system.workspace());
    fields_.resize(2 * states_);
    gradient_.resize(1 + inputs_.size());
    jacobian_.resize(system.jacobian_entries());
    set(std::move(derivatives));
}

void MotionDerivatives::set(Matrix derivatives) {
    derivatives_ = std::move(derivatives);
    valid_ = true;
}

std::size_t MotionDerivatives::keep(std::span<const double> state) {
    const std::size_t at = numbers_.size();
    numbers_.insert(numbers_.end(), state.begin(), state.end());
    return at;
}

void MotionDerivatives::mark_ahead(double time, std::size_t mode, std::span<const double> state) {
    if (!broken_)
        ahead_.push_back({time, mode, keep(state)});
}

void MotionDerivatives::mark(double time, std::size_t mode, std::span<const double> state) {
    if (!broken_)
        items_.push_back({.kind = Item::Kind::mark, .mode = mode, .time = time, .numbers = keep(state)});
}

void MotionDerivatives::grazing() {
    if (!broken_)
        items_.push_back({.kind = Item::Kind::grazing});
}

void MotionDerivatives::step(const Step& step) {
    constexpr std::size_t most_items = 8192; // after which derivatives are propagated without a request
    constexpr double nothing = 1e-12;        // share of the step within which a mark is at its end
    if (broken_)
        return;
    double from = 0;
    for (const Ahead& ahead : ahead_) {
        double at = std::clamp(ahead.time - step.start, from, step.length);
        if (step.length - at <= nothing * step.length)
            at = step.length;
        add_step(step, from, at);
        items_.push_back({.kind = Item::Kind::mark, .mode = ahead.mode, .time = ahead.time, .numbers = ahead.numbers});
        from = at;
    }
    ahead_.clear();
    add_step(step, from, step.length);
    if (items_.size() > most_items)
        carry();
}

void MotionDerivatives::add_step(const Step& step, double from, double to) {
    if (!(to > from))
        return;
    items_.push_back({.kind = Item::Kind::step, .mode = step.mode, .time = to - from, .numbers = numbers_.size()});
    for (std::size_t i = 0; i < states_; ++i)
        numbers_.push_back(from > 0 ? step.state(i, from) : step.states[i][0]);
}

void MotionDerivatives::contact(const Contact& contact) {
    broken_ = broken_ || contact.kind == ContactKind::sticking;
    if (broken_ || contact.kind != ContactKind::crossing)
        return;
    items_.push_back({.kind = Item::Kind::contact,
                      .mode = contact.mode_before,
                      .mode_after = contact.mode_after,
                      .event = contact.event,
                      .transition = contact.transition,
                      .rate = contact.rate_before,
                      .numbers = keep(contact.before)});
    keep(contact.after);
}

void MotionDerivatives::carry() {
    maps_->begin(parameters_, scale_);
    for (Item& item : items_)
        if (item.kind == Item::Kind::step)
            item.map = maps_->add(item.mode, state_at(item.numbers), item.time);
    maps_->compute();
    for (const Item& item : items_)
        take(item);
    maps_->clear();
    items_.clear();
    // Marks ahead belong to the next step.
    std::vector<double> kept;
    for (Ahead& ahead : ahead_) {
        const std::span<const double> state = state_at(ahead.numbers);
        ahead.numbers = kept.size();
        kept.insert(kept.end(), state.begin(), state.end());
    }
    numbers_ = std::move(kept);
}

void MotionDerivatives::take(const Item& item) {
    switch (item.kind) {
    case Item::Kind::step:
        return pass_step(item.map);
    case Item::Kind::contact:
        return pass_contact(item);
    case Item::Kind::grazing:
        valid_ = false;
        return;
    case Item::Kind::mark:
        if (at_mark_)
            at_mark_({item.time, item.mode, state_at(item.numbers)});
        return;
    }
}

void MotionDerivatives::pass_step(std::size_t number) {
    valid_ = valid_ && maps_->is_known(number);
    const std::span<const double> map = maps_->map(number);
    const std::vector<std::size_t>& directions = modes_->directions();
    const std::size_t count = directions.size();
    next_.setZero(derivatives_.rows(), derivatives_.cols());
    for (Eigen::Index c = 0; c < derivatives_.cols(); ++c)
        for (std::size_t d = 0; d < count; ++d) {
            const double before = derivatives_(static_cast<Eigen::Index>(directions[d]), c);
            for (std::size_t r = 0; r < count; ++r)
                next_(static_cast<Eigen::Index>(directions[r]), c) += map[d * count + r] * before;
        }
    derivatives_.swap(next_);
}

/// The contact of a neighbouring motion happens later by -dh / h'.
void MotionDerivatives::pass_contact(const Item& item) {
    const System& system = modes_->simulation().system();
    const std::span<double> before = std::span(fields_).first(states_), after = std::span(fields_).last(states_);
    const System::CompiledJump& jump = system.jump(system.transition(item.transition).jump);
    std::ranges::copy(state_at(item.numbers), inputs_.begin());
    system.mode(item.mode).rates.evaluate(inputs_, before, work_);
    system.event(item.event).evaluate(inputs_, gradient_, work_);
    jump.jacobian.evaluate(inputs_, jacobian_, work_);
    std::ranges::copy(state_at(item.numbers + states_), inputs_.begin());
    system.mode(item.mode_after).rates.evaluate(inputs_, after, work_);
    shift_.assign(static_cast<std::size_t>(derivatives_.cols()), 0.0);
    for (std::size_t c = 0; c < shift_.size(); ++c) {
        for (std::size_t i = 0; i < states_; ++i)
            shift_[c] -= gradient_[1 + i] * derivatives_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c));
        shift_[c] /= item.rate;
    }
    next_.resize(derivatives_.rows(), derivatives_.cols());
    const auto numbers = [](Matrix& matrix) {
        return std::span(matrix.data(), static_cast<std::size_t>(matrix.size()));
    };
    // Neighbouring motions have the same parameters.
    pass_jump({shift_, before, after, jump, jacobian_, {}}, numbers(derivatives_), numbers(next_));
}

} // namespace graze
