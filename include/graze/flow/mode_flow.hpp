#pragma once

#include "graze/flow/late_states.hpp"
#include "graze/flow/mode_jets.hpp"
#include "graze/flow/step_check.hpp"
#include "graze/flow/step_size.hpp"
#include "graze/flow/tangent_steps.hpp"
#include "graze/flow/watched_series.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// The smooth flow of one mode over a given time, which may be negative, whatever events it passes: what multiple
/// shooting asks for. With derivatives with respect to the start and chosen parameters.
class ModeFlow {
public:
    /// @param tolerance of each step, as of SimulationOptions; @param order of the series, 0: chosen by the tolerance
    /// @param free independent parameters with respect to which there are derivatives
    /// @param starts states of the start with respect to which there are derivatives; all unless they are given
    /// @throws InputError for a tolerance, order, parameter or state that is out of range
    ModeFlow(const System& system, double tolerance, int order = 0, std::vector<ParameterId> free = {},
             std::optional<std::vector<std::size_t>> starts = std::nullopt);

    const System& system() const { return system_; }
    const std::vector<ParameterId>& free() const { return free_; }
    const std::vector<std::size_t>& starts() const { return starts_; }
    /// To be called before `run`. @throws InputError unless there are as many as the system has
    void set_parameters(std::span<const double> parameters);
    /// None before they are set.
    std::span<const double> parameters() const { return parameters_; }

    enum class Ending { done, singular, undefined, too_long };
    /// One step: series in s from its start, which is `time` after the arc's; states, then watched events.
    using StepVisitor = std::function<void(const Jet& jet, double time, double length)>;

    /// The state after a time. @param state start, replaced by the end
    /// @throws InputError, here and below, for a mode or numbers that do not fit the system
    Ending run(std::size_t mode, std::span<double> state, double duration, const StepVisitor& visit = {});
    /// @param watched what the mode's events do on the way
    Ending run(std::size_t mode, std::span<double> state, double duration, WatchedSeries& watched);
    /// The same with derivatives. @param derivatives of the end at fixed time with respect to the states of the start
    /// and the free parameters, states x (starts + free) row by row
    /// @param watched what the mode's events do on the way, unless null
    Ending run(std::size_t mode, std::span<double> state, double duration, std::span<double> derivatives,
               WatchedSeries* watched = nullptr);

    std::size_t steps() const { return steps_; } ///< since it was made

private:
    double step_of(std::size_t mode, const Jet& jet, double remaining, bool watched);
    bool agrees(std::size_t mode, double length);
    void require_fitting(std::size_t mode, std::span<const double> state) const;

    System system_;
    std::vector<ParameterId> free_;
    std::vector<std::size_t> starts_;
    std::size_t states_, directions_;
    StepSize step_size_;
    StepCheck step_check_;
    LateStates late_states_;
    ModeJets jets_;
    TangentSteps tangents_;
    EndAllowance allowance_;
    std::vector<double> parameters_, parameter_seeds_, sums_, slopes_, guarded_;
    double seen_ = 0;                   ///< length of a step whose end is in `sums_`; 0: none
    std::vector<double> matrix_, next_; ///< states x directions, row by row
    double previous_ = 0;
    std::size_t steps_ = 0;
};

} // namespace graze
