#pragma once

#include "flow/uniformised_system.hpp"
#include "graze/flow/mode_flow.hpp"
#include "graze/flow/roots.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// The flow of a mode through zeros of a radicand, where rates have no power series in time. The motion enters and
/// leaves the side g > 0 at the speed of g, and moves on the other side as if the powers were zero there. That field is
/// continuous, so that derivatives pass the zeros unchanged (the saltation matrix is the identity).
class UniformisedFlow {
public:
    /// Arguments as of ModeFlow.
    UniformisedFlow(const System& system, double tolerance, int order, const std::vector<ParameterId>& free,
                    const std::vector<std::size_t>& starts);

    void set_parameters(std::span<const double> parameters);
    /// As ModeFlow::run. @param derivatives may be empty
    ModeFlow::Ending run(std::size_t mode, std::span<double> state, double duration, std::span<double> derivatives);
    std::size_t steps() const { return flow_.steps(); }

private:
    /// Value and derivatives of the radicand at the present state, and its rate along the field where it is zero.
    struct Place {
        double value = 0, rate = 0;
        std::span<const double> gradient; ///< by states, then parameters
    };
    ModeFlow::Ending follow(const UniformisedRoot& root, double duration);
    Place place(const UniformisedRoot& root);
    void find_field(const UniformisedRoot& root, double of_root);
    void find_slopes(const Place& here);
    void seed_inside(const UniformisedRoot& root, const Place& here, bool at_zero);
    bool ends_inside(const Jet& jet, double& length, double wanted);
    bool ends_in_time(const Jet& jet, double& length, std::size_t output, int way, bool at_zero);
    ModeFlow::Ending pass_inside(const UniformisedRoot& root, const Place& here, double duration, bool at_zero);
    void end_touch();
    ModeFlow::Ending pass_in_time(std::size_t mode, std::size_t output, int way, double duration, bool at_zero);
    ModeFlow::Ending advance(std::size_t mode, double longest, const ModeFlow::StepEnd& end);
    void load(const Series& series, double sign, double factor);

    const UniformisedSystem* system_;
    System own_; ///< keeps `system_`
    std::size_t states_, directions_, starts_count_;
    std::vector<ParameterId> free_;
    std::vector<std::size_t> starts_;
    ModeFlow flow_;
    RootFinder finder_;
    bool derived_ = false, first_step_ = false, reached_zero_ = false, reached_end_ = false;
    double time_ = 0;            ///< since the start of the run
    double margin_ = 0;          ///< radicand below which powers are neglected
    std::vector<double> state_;  ///< states, root, time since the start of the phase
    std::vector<double> matrix_; ///< derivatives of the states at fixed time, [state * directions + direction]
    std::vector<double> seeds_;  ///< the same of states, root and time at the beginning of a phase
    std::vector<double> by_seeds_, field_, inputs_, gradient_, work_, slopes_, coefficients_;
};

} // namespace graze
