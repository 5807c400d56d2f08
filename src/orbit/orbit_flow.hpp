#pragma once

#include "graze/flow/mode_flow.hpp"
#include "graze/trajectory/simulation.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>
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
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    RowMajor rows(static_cast<Eigen::Index>(state.size()),
                  static_cast<Eigen::Index>(state.size() + flow.free().size()));
    const auto ending =
        flow.run(mode, state, duration, std::span(rows.data(), static_cast<std::size_t>(rows.size())), watched);
    if (ending == ModeFlow::Ending::done)
        derivatives = rows;
    return ending;
}

} // namespace graze
