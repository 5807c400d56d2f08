#include "identify/piece_motion.hpp"

#include "base/linear_systems.hpp"

#include <Eigen/Core>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

bool all_finite(std::span<const double> values) {
    return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

} // namespace

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

/// Takes samples from the steps of a trajectory, and extrapolates beyond contacts.
class PieceMotion::Watcher : public Observer {
public:
    Watcher(PieceMotion& owner, const MotionPiece& piece)
        : owner_(&owner), piece_(&piece), state_(owner.simulation_.system().states()),
          matrix_(state_.size() * owner.directions()) {}

    void watch(const Trajectory& trajectory) { trajectory_ = &trajectory; }
    std::size_t taken() const { return next_; }
    /// Takes samples before a time by extrapolating the motion of the initial mode.
    void take_until(double time) {
        owner_->evaluator_.begin(piece_->mode, piece_->state, piece_->seeds);
        for (; next_ < piece_->times.size() && piece_->times[next_] < time; ++next_) {
            owner_->motion_.differentiable &=
                owner_->evaluator_.at(piece_->times[next_] - piece_->begin, state_, matrix_);
            owner_->take(next_, state_, matrix_);
        }
    }

    void step(const Step& step) override {
        start_ = step.start;
        mode_ = step.mode;
        first_.resize(state_.size());
        for (std::size_t i = 0; i < state_.size(); ++i)
            first_[i] = step.states[i][0];
        first_matrix_.assign(trajectory_->tangents().begin(), trajectory_->tangents().end());
        bool begun = false;
        for (; next_ < piece_->times.size() && piece_->times[next_] <= step.start + step.length; ++next_) {
            const double s = std::max(0.0, piece_->times[next_] - step.start);
            if (!begun)
                owner_->evaluator_.begin(step.mode, first_, first_matrix_);
            begun = true;
            // The motion's own polynomials are more accurate than those computed with its tangents.
            owner_->motion_.differentiable &= owner_->evaluator_.at(s, state_, matrix_);
            for (std::size_t i = 0; i < state_.size(); ++i)
                state_[i] = step.state(i, s);
            owner_->take(next_, state_, matrix_);
        }
    }

    bool stop() override {
        owner_->is_interrupted_ = owner_->is_interrupted_ || (owner_->interrupted_ && owner_->interrupted_());
        return owner_->is_interrupted_;
    }

    void contact(const Contact& contact) override {
        if (contact.kind == ContactKind::touch)
            return;
        ++owner_->motion_.contacts;
        owner_->motion_.constrained = is_constrained(contact);
        if (contact.kind != ContactKind::crossing || trajectory_->finished() || !(piece_->reach > 0))
            return;
        const std::vector<double> after(contact.after.begin(), contact.after.end());
        const std::vector<double> after_matrix(trajectory_->tangents().begin(), trajectory_->tangents().end());
        const auto from = std::lower_bound(piece_->times.begin(), piece_->times.end(), contact.time - piece_->reach);
        const auto to = std::upper_bound(piece_->times.begin(), piece_->times.end(), contact.time + piece_->reach);
        const auto middle = std::lower_bound(from, to, contact.time);
        const auto index = [&](auto place) { return static_cast<std::size_t>(place - piece_->times.begin()); };
        // Extrapolate the motion after the contact backwards in time, and the motion before it forwards.
        owner_->evaluator_.begin(contact.mode_after, after, after_matrix);
        for (std::size_t i = index(middle); i-- > index(from);)
            if (!look(i, piece_->times[i] - contact.time, contact.time))
                break;
        if (first_.empty()) // a contact at the start of the piece
            return;
        owner_->evaluator_.begin(mode_, first_, first_matrix_);
        for (std::size_t i = index(middle); i < index(to); ++i)
            if (!look(i, piece_->times[i] - start_, contact.time))
                break;
    }

private:
    /// Whether the jump of a contact has a singular Jacobian, so that fewer states are free after it.
    bool is_constrained(const Contact& contact) {
        const System& system = owner_->simulation_.system();
        const Transition& transition = owner_->simulation_.model().transitions[contact.transition];
        const System::CompiledJump& jump = system.jump(
            contact.kind == ContactKind::sticking && transition.chatter ? transition.chatter->jump : transition.jump);
        std::vector<double> work(system.workspace()), values(system.jacobian_entries());
        jump.jacobian.evaluate(owner_->inputs_of(contact.before), values, work);
        const auto states = static_cast<Eigen::Index>(state_.size());
        Eigen::MatrixXd map = Eigen::MatrixXd::Identity(states, states);
        for (const std::size_t i : jump.changed)
            map.row(static_cast<Eigen::Index>(i)).setZero();
        for (std::size_t k = 0; k < jump.entries.size(); ++k)
            if (jump.entries[k].column < state_.size())
                map(static_cast<Eigen::Index>(jump.entries[k].row), static_cast<Eigen::Index>(jump.entries[k].column)) =
                    values[k];
        return !jump.identity && FullLU<double>(map).rank() < states;
    }

    bool look(std::size_t sample, double s, double contact) {
        const double distance = std::abs(piece_->times[sample] - contact);
        PredictedMotion::Sample& one = owner_->motion_.samples[sample];
        if (!owner_->evaluator_.at(s, state_, matrix_) || !all_finite(state_) || !all_finite(matrix_))
            return false;
        if (one.other && one.distance <= distance)
            return true;
        one.other = true;
        one.distance = distance;
        one.other_state = state_;
        one.other_derivatives = matrix_;
        return true;
    }

    PieceMotion* owner_;
    const MotionPiece* piece_;
    const Trajectory* trajectory_ = nullptr;
    std::size_t next_ = 0;
    std::vector<double> state_, matrix_;
    double start_ = 0; ///< start of the last step
    std::size_t mode_ = 0;
    std::vector<double> first_, first_matrix_;
};

PieceMotion::PieceMotion(const Simulation& simulation, std::vector<std::size_t> moved)
    : simulation_(simulation), moved_(std::move(moved)), jets_(simulation, LaneKind::single),
      evaluator_(simulation, simulation.system().states() + moved_.size()) {}

void PieceMotion::set_parameters(std::span<const double> parameters) {
    const std::size_t states = simulation_.system().states();
    parameters_.assign(parameters.begin(), parameters.end());
    parameter_seeds_.assign(parameters.size() * directions(), 0.0);
    for (std::size_t d = 0; d < moved_.size(); ++d)
        parameter_seeds_[moved_[d] * directions() + states + d] = 1;
    evaluator_.set_parameters(parameters_, parameter_seeds_);
}

void PieceMotion::take(std::size_t sample, std::span<const double> state, std::span<const double> matrix) {
    PredictedMotion::Sample& one = motion_.samples[sample];
    one.state.assign(state.begin(), state.end());
    one.derivatives.assign(matrix.begin(), matrix.end());
}

const std::vector<double>& PieceMotion::inputs_of(std::span<const double> state) {
    inputs_.assign(state.begin(), state.end());
    inputs_.insert(inputs_.end(), parameters_.begin(), parameters_.end());
    return inputs_;
}

/// Index of a watched barrier that the state violates; the number of events if there is none.
std::size_t PieceMotion::violated(std::size_t mode, std::span<const double> state) {
    const System& system = simulation_.system();
    const System::CompiledMode& compiled = system.mode(mode);
    work_.resize(system.workspace());
    values_.resize(compiled.events.outputs());
    compiled.events.evaluate(inputs_of(state), values_, work_);
    for (std::size_t w = 0; w < compiled.watched.size(); ++w)
        if (simulation_.model().events[compiled.watched[w]].kind == EventKind::barrier && values_[w] < 0)
            return compiled.watched[w];
    return simulation_.model().events.size();
}

/// Newton's method for the time at which the motion, extrapolated without events, is on the admissible side of a
/// surface by a thousandth of its present violation.
bool PieceMotion::find_side(const MotionPiece& piece, std::size_t event) {
    constexpr int most = 20;
    const System& system = simulation_.system();
    const std::size_t states = system.states();
    std::vector<double> gradient(1 + states + parameters_.size()), rates(states);
    side_ = 0;
    side_state_.assign(piece.state.begin(), piece.state.end());
    side_matrix_.assign(piece.seeds.begin(), piece.seeds.end());
    double aim = 0;
    for (int i = 0; i < most; ++i) {
        inputs_of(side_state_);
        system.event(event).evaluate(inputs_, gradient, work_);
        system.mode(piece.mode).rates.evaluate(inputs_, rates, work_);
        if (i == 0)
            aim = -1e-3 * gradient[0];
        else if (gradient[0] > 0 && gradient[0] < 2 * aim)
            return violated(piece.mode, side_state_) == simulation_.model().events.size();
        double rate = 0;
        for (std::size_t k = 0; k < states; ++k)
            rate += gradient[1 + k] * rates[k];
        side_ += (aim - gradient[0]) / rate;
        if (!(std::abs(side_) <= piece.end - piece.begin))
            return false;
        evaluator_.begin(piece.mode, piece.state, piece.seeds);
        if (!evaluator_.at(side_, side_state_, side_matrix_))
            return false;
    }
    return false;
}

const PredictedMotion& PieceMotion::follow(const MotionPiece& piece) {
    const std::size_t states = simulation_.system().states(), count = directions();
    motion_.samples.resize(piece.times.size());
    for (PredictedMotion::Sample& sample : motion_.samples)
        sample.other = false;
    motion_.contacts = 0;
    motion_.constrained = false;
    motion_.differentiable = true;
    motion_.detail.clear();
    std::span<const double> first = piece.state, first_seeds = piece.seeds;
    double begin = piece.begin;
    Watcher watcher(*this, piece);
    if (const std::size_t event = violated(piece.mode, piece.state);
        event != simulation_.model().events.size() && find_side(piece, event)) {
        first = side_state_;
        first_seeds = side_matrix_;
        begin += side_;
        watcher.take_until(begin);
    }
    seeds_.assign(count * (states + parameters_.size()), 0.0);
    for (std::size_t d = 0; d < count; ++d) {
        double* seed = &seeds_[d * (states + parameters_.size())];
        for (std::size_t i = 0; i < states; ++i)
            seed[i] = first_seeds[i * count + d];
        for (std::size_t j = 0; j < parameters_.size(); ++j)
            seed[states + j] = parameter_seeds_[j * count + d];
    }
    Trajectory trajectory(simulation_, parameters_, borrowed(watcher));
    trajectory.start(first, piece.mode, begin, piece.end);
    trajectory.carry_tangents(seeds_, count);
    watcher.watch(trajectory);
    run(trajectory, jets_);
    motion_.end_state.assign(trajectory.state().begin(), trajectory.state().end());
    motion_.end_derivatives.assign(trajectory.tangents().begin(), trajectory.tangents().end());
    motion_.end_mode = trajectory.mode();
    motion_.complete = trajectory.outcome().ending == Ending::end_time;
    motion_.differentiable = motion_.differentiable && trajectory.tangents_valid();
    if (!motion_.complete)
        motion_.detail = fmt::format(
            "the motion ends at time {:.9g}: {}{}{}{}", trajectory.outcome().time, name_of(trajectory.outcome().ending),
            trajectory.outcome().detail.empty() ? "" : ", ", trajectory.outcome().detail,
            trajectory.outcome().ending == Ending::chatter ? " in the model"
                                                           : "; begin from other guesses, or bound parameters");
    for (std::size_t i = watcher.taken(); i < piece.times.size(); ++i)
        take(i, motion_.end_state, motion_.end_derivatives);
    return motion_;
}

} // namespace graze
