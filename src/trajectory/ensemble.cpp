#include "graze/trajectory/ensemble.hpp"

#include "graze/base/input_error.hpp"

#include "trajectory/stoppable_run.hpp"

#include <algorithm>

namespace graze {

namespace {

constexpr auto no_slot = static_cast<std::size_t>(-1);

/// Fewest trajectories, and inverse share of the lanes, for which lanes are faster than single runs: empty lanes cost
/// as much as occupied ones.
constexpr std::size_t fewest = 3;
constexpr std::size_t least_share = 4;

} // namespace

Ensemble::Ensemble(const Simulation& simulation, InstructionSet set)
    : simulation_(simulation), lanes_(static_cast<std::size_t>(lanes_of(LaneKind::ensemble, set))),
      jets_(simulation, LaneKind::ensemble, set), single_(simulation, LaneKind::single, set),
      preview_(simulation, static_cast<int>(lanes_)), slot_in_lane_(lanes_, no_slot),
      slots_of_mode_(simulation.model().modes.size(), std::vector<std::size_t>(lanes_, no_slot)),
      waiting_in_mode_(simulation.model().modes.size()), states_(simulation.system().states() * lanes_),
      parameters_(simulation.system().parameters() * lanes_) {}

void Ensemble::run(std::span<Trajectory> trajectories) {
    std::vector<Trajectory*> all;
    for (Trajectory& trajectory : trajectories)
        all.push_back(&trajectory);
    run(all, [](std::size_t) { return nullptr; });
}

/// Called after each step.
bool Ensemble::must_stop() {
    constexpr std::size_t seldom = 256; // steps
    return ++steps_ % seldom == 0 && is_stopped_ && is_stopped_();
}

/// Records that a trajectory is in a slot.
void Ensemble::admit(const Trajectory& trajectory) {
    if (!(trajectory.simulation() == simulation_))
        throw InputError("a trajectory of one simulation cannot run in an ensemble of another", "");
    if (!trajectory.is_started())
        throw OrderError("a trajectory has to be started before it can run");
    if (!present_.insert(&trajectory).second)
        throw InputError("a trajectory cannot run in two slots at once", "");
}

void Ensemble::run(std::span<Trajectory* const> slots, const NextTrajectory& next_of) {
    if (!next_of)
        throw InputError("an ensemble has to be told what comes after a trajectory: give a function", "");
    slots_.assign(slots.begin(), slots.end());
    present_.clear();
    for (const Trajectory* trajectory : slots_)
        if (trajectory)
            admit(*trajectory);
    for (auto& lanes : slots_of_mode_)
        std::fill(lanes.begin(), lanes.end(), no_slot);
    // With several modes, more trajectories than lanes are kept running so that the lanes of the chosen mode can be
    // filled.
    const std::size_t capacity = lanes_ * std::min<std::size_t>(slots_of_mode_.size(), 4);
    std::size_t next = 0;
    waiting_.clear();
    const auto fill_up = [&] {
        for (; waiting_.size() < capacity && next < slots_.size(); ++next)
            if (slots_[next] && (!slots_[next]->finished() || refill(next, next_of)))
                waiting_.push_back(next);
    };
    fill_up();
    while (!waiting_.empty()) {
        if (waiting_.size() < std::max(fewest, lanes_ / least_share)) {
            if (!run_until(*slots_[waiting_.front()], single_, [this] { return must_stop(); }))
                return;
        } else {
            const std::size_t mode = most_frequent_mode();
            assign_lanes(mode);
            while (step_lanes(mode))
                if (must_stop())
                    return;
            if (must_stop())
                return;
        }
        std::erase_if(waiting_, [&](std::size_t slot) { return slots_[slot]->finished() && !refill(slot, next_of); });
        fill_up();
    }
}

/// Replaces the finished trajectory of a slot by its successor. @return false if there is none
bool Ensemble::refill(std::size_t slot, const NextTrajectory& next_of) {
    do {
        present_.erase(slots_[slot]);
        slots_[slot] = next_of(slot);
        if (!slots_[slot])
            return false;
        admit(*slots_[slot]);
        // Lanes that hold the parameters of the finished trajectory are free.
        for (auto& lanes : slots_of_mode_)
            std::replace(lanes.begin(), lanes.end(), slot, no_slot);
    } while (slots_[slot]->finished());
    return true;
}

/// Makes one step of all lanes. @return whether all of them can make another one in this mode
bool Ensemble::step_lanes(std::size_t mode) {
    load_states();
    Jet& jet = jets_.computed(mode, states_);
    const std::span<double> lengths = preview_.lengths();
    for (std::size_t lane = 0; lane < lanes_; ++lane)
        lengths[lane] = slot_in_lane_[lane] != no_slot ? slots_[slot_in_lane_[lane]]->previous_step() : 1;
    preview_.find_steps(jet);
    for (std::size_t lane = 0; lane < lanes_; ++lane)
        if (slot_in_lane_[lane] != no_slot)
            lengths[lane] = slots_[slot_in_lane_[lane]]->propose(jet, lengths[lane], lane);
    preview_.evaluate_ends(jet, jets_.next(mode), mode);
    bool all_continue = true;
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        if (slot_in_lane_[lane] == no_slot)
            continue;
        Trajectory& trajectory = *slots_[slot_in_lane_[lane]];
        trajectory.advance(preview_, lane);
        all_continue = all_continue && trajectory.mode() == mode && !trajectory.finished();
    }
    return all_continue;
}

std::size_t Ensemble::most_frequent_mode() {
    std::fill(waiting_in_mode_.begin(), waiting_in_mode_.end(), 0);
    for (const std::size_t i : waiting_)
        ++waiting_in_mode_[slots_[i]->mode()];
    return static_cast<std::size_t>(std::max_element(waiting_in_mode_.begin(), waiting_in_mode_.end()) -
                                    waiting_in_mode_.begin());
}

/// Assigns the waiting trajectories of one mode to lanes, each to its earlier lane if possible.
void Ensemble::assign_lanes(std::size_t mode) {
    auto& lanes = slots_of_mode_[mode];
    std::fill(slot_in_lane_.begin(), slot_in_lane_.end(), no_slot);
    std::size_t taken = 0, without_lane = 0;
    for (const std::size_t i : waiting_) {
        if (slots_[i]->mode() != mode)
            continue;
        const auto lane = static_cast<std::size_t>(std::find(lanes.begin(), lanes.end(), i) - lanes.begin());
        if (lane < lanes_) {
            slot_in_lane_[lane] = i;
            ++taken;
        } else {
            ++without_lane;
        }
    }
    if (without_lane > 0 && taken < lanes_) {
        for (const std::size_t i : waiting_) {
            const auto free = std::find(slot_in_lane_.begin(), slot_in_lane_.end(), no_slot);
            if (free == slot_in_lane_.end())
                break;
            if (slots_[i]->mode() == mode &&
                std::find(slot_in_lane_.begin(), slot_in_lane_.end(), i) == slot_in_lane_.end())
                *free = i;
        }
        const std::size_t count = simulation_.system().parameters();
        // Empty lanes repeat an occupied one: their results are not used, but must not trap or be slow.
        const std::size_t stand_in =
            *std::find_if(slot_in_lane_.begin(), slot_in_lane_.end(), [](auto i) { return i != no_slot; });
        for (std::size_t lane = 0; lane < lanes_; ++lane) {
            lanes[lane] = slot_in_lane_[lane];
            const auto from = slots_[slot_in_lane_[lane] == no_slot ? stand_in : slot_in_lane_[lane]]->parameters();
            for (std::size_t j = 0; j < count; ++j)
                parameters_[j * lanes_ + lane] = from[j];
        }
        jets_.set_parameters(mode, parameters_);
    }
}

void Ensemble::load_states() {
    const std::size_t stand_in =
        *std::find_if(slot_in_lane_.begin(), slot_in_lane_.end(), [](auto i) { return i != no_slot; });
    const std::size_t count = simulation_.system().states();
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        const auto from = slots_[slot_in_lane_[lane] == no_slot ? stand_in : slot_in_lane_[lane]]->state();
        for (std::size_t i = 0; i < count; ++i)
            states_[i * lanes_ + lane] = from[i];
    }
}

} // namespace graze
