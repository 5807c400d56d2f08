#include "graze/trajectory/ensemble.hpp"

#include <algorithm>
#include <stdexcept>

namespace graze {

namespace {

constexpr auto nobody = static_cast<std::size_t>(-1);

} // namespace

Ensemble::Ensemble(const Simulation& simulation, InstructionSet set)
    : simulation_(&simulation), lanes_(static_cast<std::size_t>(lanes_of(LaneKind::ensemble, set))),
      jets_(simulation, LaneKind::ensemble, set), single_(simulation, LaneKind::single, set),
      outlook_(simulation, static_cast<int>(lanes_)), seats_(lanes_, nobody),
      seated_(simulation.model().modes.size(), std::vector<std::size_t>(lanes_, nobody)),
      crowd_(simulation.model().modes.size()), states_(simulation.compiled().states() * lanes_),
      parameters_(simulation.compiled().parameters() * lanes_) {}

void Ensemble::run(std::span<Trajectory> trajectories) {
    for (const Trajectory& trajectory : trajectories)
        if (&trajectory.simulation() != simulation_)
            throw std::invalid_argument("a trajectory of one simulation cannot run in an ensemble of another");
    for (auto& seated : seated_)
        std::fill(seated.begin(), seated.end(), nobody);
    // With several modes, more than one laneful is kept at hand so that lanes of the mode in turn can be filled.
    const std::size_t capacity = lanes_ * std::min<std::size_t>(seated_.size(), 4);
    std::size_t next = 0;
    waiting_.clear();
    const auto admit = [&] {
        while (waiting_.size() < capacity && next < trajectories.size()) {
            if (!trajectories[next].finished())
                waiting_.push_back(next);
            ++next;
        }
    };
    admit();
    std::size_t mode = 0;
    bool seated = false;
    while (waiting_.size() > 1) {
        if (!seated) {
            mode = fullest_mode(trajectories);
            take_seats(trajectories, mode);
            seated = true;
        }
        load_states(trajectories);
        Jet& jet = jets_(mode);
        jet.compute(states_);
        const std::span<double> lengths = outlook_.lengths();
        for (std::size_t lane = 0; lane < lanes_; ++lane)
            lengths[lane] = seats_[lane] != nobody ? trajectories[seats_[lane]].previous_step() : 1;
        outlook_.find_steps(jet);
        for (std::size_t lane = 0; lane < lanes_; ++lane)
            if (seats_[lane] != nobody)
                lengths[lane] = trajectories[seats_[lane]].propose(jet, lengths[lane], lane);
        outlook_.look(jet, mode);
        for (std::size_t lane = 0; lane < lanes_; ++lane) {
            if (seats_[lane] == nobody)
                continue;
            Trajectory& trajectory = trajectories[seats_[lane]];
            trajectory.advance(outlook_, lane);
            seated = seated && trajectory.mode() == mode && !trajectory.finished();
        }
        if (seated)
            continue;
        std::erase_if(waiting_, [&](std::size_t i) { return trajectories[i].finished(); });
        admit();
    }
    if (waiting_.size() == 1)
        graze::run(trajectories[waiting_.front()], single_);
}

std::size_t Ensemble::fullest_mode(std::span<const Trajectory> trajectories) {
    std::fill(crowd_.begin(), crowd_.end(), 0);
    for (const std::size_t i : waiting_)
        ++crowd_[trajectories[i].mode()];
    return static_cast<std::size_t>(std::max_element(crowd_.begin(), crowd_.end()) - crowd_.begin());
}

/// Seats the waiting trajectories of one mode, each in its own lane if it had one before.
void Ensemble::take_seats(std::span<const Trajectory> trajectories, std::size_t mode) {
    auto& seated = seated_[mode];
    std::fill(seats_.begin(), seats_.end(), nobody);
    std::size_t taken = 0, newcomers = 0;
    for (const std::size_t i : waiting_) {
        if (trajectories[i].mode() != mode)
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
            if (trajectories[i].mode() == mode && std::find(seats_.begin(), seats_.end(), i) == seats_.end())
                *free = i;
        }
        const std::size_t count = simulation_->compiled().parameters();
        // Empty lanes repeat an occupied one: their results are not used, but must not trap or slow down.
        const std::size_t stand_in = *std::find_if(seats_.begin(), seats_.end(), [](auto i) { return i != nobody; });
        for (std::size_t lane = 0; lane < lanes_; ++lane) {
            seated[lane] = seats_[lane];
            const auto from = trajectories[seats_[lane] == nobody ? stand_in : seats_[lane]].parameters();
            for (std::size_t j = 0; j < count; ++j)
                parameters_[j * lanes_ + lane] = from[j];
        }
        jets_(mode).set_parameters(parameters_);
    }
}

void Ensemble::load_states(std::span<const Trajectory> trajectories) {
    const std::size_t stand_in = *std::find_if(seats_.begin(), seats_.end(), [](auto i) { return i != nobody; });
    const std::size_t count = simulation_->compiled().states();
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        const auto from = trajectories[seats_[lane] == nobody ? stand_in : seats_[lane]].state();
        for (std::size_t i = 0; i < count; ++i)
            states_[i * lanes_ + lane] = from[i];
    }
}

} // namespace graze
