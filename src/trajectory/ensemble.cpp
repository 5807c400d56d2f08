#include "graze/trajectory/ensemble.hpp"

#include "graze/base/input_error.hpp"

#include "trajectory/stoppable_run.hpp"

#include <algorithm>

namespace graze {

namespace {

constexpr auto nobody = static_cast<std::size_t>(-1);

/// Trajectories, and share of the lanes, below which one after another is faster: empty lanes cost as much as others.
constexpr std::size_t fewest = 3;
constexpr std::size_t least_share = 4;

} // namespace

Ensemble::Ensemble(const Simulation& simulation, InstructionSet set)
    : simulation_(simulation), lanes_(static_cast<std::size_t>(lanes_of(LaneKind::ensemble, set))),
      jets_(simulation, LaneKind::ensemble, set), single_(simulation, LaneKind::single, set),
      outlook_(simulation, static_cast<int>(lanes_)), seats_(lanes_, nobody),
      seated_(simulation.model().modes.size(), std::vector<std::size_t>(lanes_, nobody)),
      crowd_(simulation.model().modes.size()), states_(simulation.system().states() * lanes_),
      parameters_(simulation.system().parameters() * lanes_) {}

void Ensemble::run(std::span<Trajectory> trajectories) {
    std::vector<Trajectory*> all;
    for (Trajectory& trajectory : trajectories)
        all.push_back(&trajectory);
    run(all, [](std::size_t) { return nullptr; });
}

/// Asked after each step.
bool Ensemble::must_stop() {
    constexpr std::size_t seldom = 256; // steps
    return ++steps_ % seldom == 0 && is_stopped_ && is_stopped_();
}

/// Notes that a trajectory is in a slot.
void Ensemble::admit(const Trajectory& trajectory) {
    if (!(trajectory.simulation() == simulation_))
        throw InputError("a trajectory of one simulation cannot run in an ensemble of another", "");
    if (!trajectory.is_started())
        throw OrderError("a trajectory has to be started before it can run");
    if (!present_.insert(&trajectory).second)
        throw InputError("a trajectory cannot run in two slots at once", "");
}

void Ensemble::run(std::span<Trajectory* const> slots, const Again& again) {
    if (!again)
        throw InputError("an ensemble has to be told what comes after a trajectory: give a function", "");
    slots_.assign(slots.begin(), slots.end());
    present_.clear();
    for (const Trajectory* trajectory : slots_)
        if (trajectory)
            admit(*trajectory);
    for (auto& seated : seated_)
        std::fill(seated.begin(), seated.end(), nobody);
    // With several modes, more than one laneful is kept at hand so that lanes of the mode in turn can be filled.
    const std::size_t capacity = lanes_ * std::min<std::size_t>(seated_.size(), 4);
    std::size_t next = 0;
    waiting_.clear();
    const auto fill_up = [&] {
        for (; waiting_.size() < capacity && next < slots_.size(); ++next)
            if (slots_[next] && (!slots_[next]->finished() || refill(next, again)))
                waiting_.push_back(next);
    };
    fill_up();
    while (!waiting_.empty()) {
        if (waiting_.size() < std::max(fewest, lanes_ / least_share)) {
            if (!run_until(*slots_[waiting_.front()], single_, [this] { return must_stop(); }))
                return;
        } else {
            const std::size_t mode = fullest_mode();
            take_seats(mode);
            while (step_lanes(mode))
                if (must_stop())
                    return;
            if (must_stop())
                return;
        }
        std::erase_if(waiting_, [&](std::size_t slot) { return slots_[slot]->finished() && !refill(slot, again); });
        fill_up();
    }
}

/// Puts what comes next into a slot whose trajectory has finished. @return false if nothing does
bool Ensemble::refill(std::size_t slot, const Again& again) {
    do {
        present_.erase(slots_[slot]);
        slots_[slot] = again(slot);
        if (!slots_[slot])
            return false;
        admit(*slots_[slot]);
        // Lanes that hold the parameters of what was here before hold those of nobody now.
        for (auto& seated : seated_)
            std::replace(seated.begin(), seated.end(), slot, nobody);
    } while (slots_[slot]->finished());
    return true;
}

/// One step of all that are seated. @return whether all of them can make another one in this mode
bool Ensemble::step_lanes(std::size_t mode) {
    load_states();
    Jet& jet = jets_.computed(mode, states_);
    const std::span<double> lengths = outlook_.lengths();
    for (std::size_t lane = 0; lane < lanes_; ++lane)
        lengths[lane] = seats_[lane] != nobody ? slots_[seats_[lane]]->previous_step() : 1;
    outlook_.find_steps(jet);
    for (std::size_t lane = 0; lane < lanes_; ++lane)
        if (seats_[lane] != nobody)
            lengths[lane] = slots_[seats_[lane]]->propose(jet, lengths[lane], lane);
    outlook_.look(jet, jets_.next(mode), mode);
    bool seated = true;
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        if (seats_[lane] == nobody)
            continue;
        Trajectory& trajectory = *slots_[seats_[lane]];
        trajectory.advance(outlook_, lane);
        seated = seated && trajectory.mode() == mode && !trajectory.finished();
    }
    return seated;
}

std::size_t Ensemble::fullest_mode() {
    std::fill(crowd_.begin(), crowd_.end(), 0);
    for (const std::size_t i : waiting_)
        ++crowd_[slots_[i]->mode()];
    return static_cast<std::size_t>(std::max_element(crowd_.begin(), crowd_.end()) - crowd_.begin());
}

/// Seats the waiting trajectories of one mode, each in its own lane if it had one before.
void Ensemble::take_seats(std::size_t mode) {
    auto& seated = seated_[mode];
    std::fill(seats_.begin(), seats_.end(), nobody);
    std::size_t taken = 0, newcomers = 0;
    for (const std::size_t i : waiting_) {
        if (slots_[i]->mode() != mode)
            continue;
        const auto lane = static_cast<std::size_t>(std::find(seated.begin(), seated.end(), i) - seated.begin());
        if (lane < lanes_) {
            seats_[lane] = i;
            ++taken;
        } else {
            ++newcomers;
        }
    }
    if (newcomers > 0 && taken < lanes_) {
        for (const std::size_t i : waiting_) {
            const auto free = std::find(seats_.begin(), seats_.end(), nobody);
            if (free == seats_.end())
                break;
            if (slots_[i]->mode() == mode && std::find(seats_.begin(), seats_.end(), i) == seats_.end())
                *free = i;
        }
        const std::size_t count = simulation_.system().parameters();
        // Empty lanes repeat an occupied one: their results are not used, but must not trap or slow down.
        const std::size_t stand_in = *std::find_if(seats_.begin(), seats_.end(), [](auto i) { return i != nobody; });
        for (std::size_t lane = 0; lane < lanes_; ++lane) {
            seated[lane] = seats_[lane];
            const auto from = slots_[seats_[lane] == nobody ? stand_in : seats_[lane]]->parameters();
            for (std::size_t j = 0; j < count; ++j)
                parameters_[j * lanes_ + lane] = from[j];
        }
        jets_.set_parameters(mode, parameters_);
    }
}

void Ensemble::load_states() {
    const std::size_t stand_in = *std::find_if(seats_.begin(), seats_.end(), [](auto i) { return i != nobody; });
    const std::size_t count = simulation_.system().states();
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        const auto from = slots_[seats_[lane] == nobody ? stand_in : seats_[lane]]->state();
        for (std::size_t i = 0; i < count; ++i)
            states_[i * lanes_ + lane] = from[i];
    }
}

} // namespace graze
