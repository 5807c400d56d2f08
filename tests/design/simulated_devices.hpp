#pragma once

#include "graze/model/driven_parameter.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace graze::testing {

/// Whether devices trip, by simulation alone: from rest the control parameter is raised more and more slowly to a
/// value, cycle by cycle, and then held. It uses no orbits, touches or derivatives.
class SimulatedDevices {
public:
    struct Way {
        double begin = 0.5;  ///< first value, relative to the final one
        double keeps = 0.94; ///< factor of the remaining distance in each cycle; slower than the decay of the motion
        std::size_t cycles = 250; ///< cycles of the rise
        std::size_t rests = 100;  ///< cycles at the final value
    };
    SimulatedDevices(const Model& model, const std::string& control, Way way)
        : way_(way), place_(model.independent_parameter(control).place()),
          driven_(drive_parameter(model, control, DriveKind::shift)), simulation_(System(driven_.model)) {}

    /// @param parameters parameters of the device @param state state of rest @param cycle duration of a cycle
    bool trips(std::vector<double> parameters, std::vector<double> state, double cycle, double value) const {
        parameters[place_] = 0;
        parameters.push_back(0); // the shift itself is constant in time
        state.push_back(0);
        Trajectory trajectory(simulation_, parameters);
        JetSet jets(simulation_, LaneKind::single);
        std::size_t mode = driven_.model.initial_mode;
        double distance = (1 - way_.begin) * value;
        for (std::size_t k = 0; k < way_.cycles + way_.rests; ++k) {
            state.back() = k < way_.cycles ? value - distance : value;
            distance *= way_.keeps;
            // At the middle of an arc: a change at an event might come before or after it.
            constexpr double later = 0.3;
            const auto count = static_cast<double>(k);
            trajectory.start(state, mode, k == 0 ? 0 : (count + later) * cycle, (count + 1 + later) * cycle);
            run(trajectory, jets);
            const Ending ending = trajectory.outcome().ending;
            if (ending == Ending::singular || ending == Ending::terminal)
                return true;
            if (ending != Ending::end_time)
                throw std::runtime_error("a device could not be simulated: " + trajectory.outcome().detail);
            state.assign(trajectory.state().begin(), trajectory.state().end());
            mode = trajectory.mode();
        }
        return false;
    }

private:
    Way way_;
    std::size_t place_;
    DrivenParameter driven_;
    Simulation simulation_;
};

} // namespace graze::testing
