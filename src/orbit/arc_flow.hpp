#pragma once

#include "graze/flow/step_check.hpp"
#include "graze/flow/step_size.hpp"
#include "graze/trajectory/simulation.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace graze {

/// The smooth flow of one mode over a given time, which may be negative, whatever events it passes: what multiple
/// shooting asks for. With derivatives with respect to the start and chosen parameters.
class ArcFlow {
public:
    /// @param free parameters with respect to which there are derivatives
    ArcFlow(const Simulation& simulation, std::vector<std::size_t> free);

    const Simulation& simulation() const { return simulation_; }
    void set_parameters(std::span<const double> parameters);
    std::span<const double> parameters() const { return parameters_; }

    enum class Ending { done, singular, undefined, too_long };
    /// One step: series in s from its start, which is `time` after the arc's; states, then watched events.
    using StepVisitor = std::function<void(const Jet& jet, double time, double length)>;

    /// The state after a time. @param state start, replaced by the end
    Ending run(std::size_t mode, std::span<double> state, double duration, const StepVisitor& visit = {});
    /// The same with derivatives. @param derivatives states x (states + free), those of the end at fixed time
    Ending run(std::size_t mode, std::span<double> state, double duration, Eigen::MatrixXd& derivatives);

    std::size_t steps() const { return steps_; } ///< since it was made

private:
    double step_of(std::size_t mode, const Jet& jet, double remaining, bool watched);
    void load(std::size_t mode, std::span<const double> state, std::size_t first, std::size_t count);

    Simulation simulation_;
    std::vector<std::size_t> free_;
    std::size_t states_, directions_, lanes_;
    StepSize step_size_;
    StepCheck step_check_;
    double tolerance_;
    JetSet single_, tangent_;
    std::vector<double> parameters_, parameter_lanes_, seeds_, sums_, slopes_, next_, times_, guarded_;
    std::vector<double> matrix_; ///< states x directions, row by row
    double previous_ = 0;
    std::size_t steps_ = 0;
};

} // namespace graze
