#pragma once

#include "graze/flow/mode_flow.hpp"
#include "graze/trajectory/simulation.hpp"
#include "orbit/eigen_index.hpp"

#include <utility>
#include <vector>

namespace graze {

/// Returns the flow of a simulation's modes, at its tolerance.
inline ModeFlow flow_of(const Simulation& simulation, std::vector<ParameterId> free = {}) {
    return {simulation.system(), simulation.options().tolerance, simulation.order(), std::move(free)};
}

/// Calls ModeFlow::run with the derivatives as a matrix.
inline ModeFlow::Ending run(ModeFlow& flow, std::size_t mode, std::span<double> state, double duration,
                            Eigen::MatrixXd& derivatives, WatchedSeries* watched = nullptr) {
    RowMajor rows(index(state.size()), index(state.size() + flow.free().size()));
    const auto ending = flow.run(mode, state, duration, numbers_of(rows), watched);
    if (ending == ModeFlow::Ending::done)
        derivatives = rows;
    return ending;
}

} // namespace graze
