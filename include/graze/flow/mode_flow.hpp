#pragma once

#include "graze/flow/dormant_states.hpp"
#include "graze/flow/mode_jets.hpp"
#include "graze/flow/step_check.hpp"
#include "graze/flow/step_size.hpp"
#include "graze/flow/tangent_steps.hpp"
#include "graze/flow/watched_series.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace graze {

class GroupedDirections;
class TableSteps;
class UniformisedFlow;

/// The smooth flow of one mode over a given time, which may be negative; events do not end it. Multiple shooting uses
/// it. Optionally with derivatives with respect to initial states and chosen parameters.
class ModeFlow {
public:
    /// @param tolerance of each step, as in SimulationOptions; @param order of the series, 0: chosen from the tolerance
    /// @param free independent parameters with respect to which derivatives are computed
    /// @param starts initial states with respect to which derivatives are computed; by default all
    /// @throws InputError for a tolerance, order, parameter or state out of range
    ModeFlow(const System& system, double tolerance, int order = 0, std::vector<ParameterId> free = {},
             std::optional<std::vector<std::size_t>> starts = std::nullopt);

    ~ModeFlow();
    ModeFlow(ModeFlow&&) noexcept;
    ModeFlow& operator=(ModeFlow&&) noexcept;

    const System& system() const { return system_; }
    const std::vector<ParameterId>& free() const { return free_; }
    const std::vector<std::size_t>& starts() const { return starts_; }
    /// To be called before `run`. @throws InputError for a wrong number of parameters
    void set_parameters(std::span<const double> parameters);
    /// Empty before parameters are set.
    std::span<const double> parameters() const { return parameters_; }

    enum class Ending { done, singular, undefined, too_long };
    /// Receives one step: the series, in the time since its start, of states, then watched events; the start is `time`
    /// after the start of the arc.
    using StepVisitor = std::function<void(const Jet& jet, double time, double length)>;

    // A mode that ends where the argument of a root or of a power with a fractional exponent vanishes, such as a Hertz
    // contact, may begin and end there: see docs/method.md. Where the argument is negative its powers are 0.

    /// Computes the state after a time. @param visit is not called within 1e-10 of the duration of such a zero.
    /// @param state initial state, replaced by the final one
    /// @throws InputError, here and below, for a mode or numbers that do not match the system
    Ending run(std::size_t mode, std::span<double> state, double duration, const StepVisitor& visit = {});
    /// @param watched receives the series of the mode's events along the arc
    Ending run(std::size_t mode, std::span<double> state, double duration, WatchedSeries& watched);
    /// The same with derivatives. @param derivatives of the final state at fixed time with respect to the initial
    /// states `starts()` and the parameters `free()`: states x (starts + free), row by row
    /// @param watched receives the series of the mode's events along the arc, unless null
    Ending run(std::size_t mode, std::span<double> state, double duration, std::span<double> derivatives,
               WatchedSeries* watched = nullptr);

    /// Decides, from the series at the start of a step, whether the run ends within it, and then shortens the step.
    using StepEnd = std::function<bool(const Jet& jet, double& length)>;
    /// The same as `run`, until `end` decides or for the longest duration. @param derivatives may be empty
    Ending run_until(std::size_t mode, std::span<double> state, double longest, const StepEnd& end,
                     std::span<double> derivatives);

    std::size_t steps() const { return steps_; } ///< since construction

private:
    struct Watchers {
        const StepVisitor* visit = nullptr;
        WatchedSeries* watched = nullptr;
        const StepEnd* end = nullptr;
        bool needs_events() const { return visit != nullptr || watched != nullptr || end != nullptr; }
    };
    Ending follow(std::size_t mode, std::span<double> state, double duration, const Watchers& watchers);
    Ending follow(std::size_t mode, std::span<double> state, double duration, std::span<double> derivatives,
                  const Watchers& watchers);
    UniformisedFlow* uniformised(std::size_t mode);
    GroupedDirections* grouped(std::size_t mode);
    Ending run_uniformised(std::size_t mode, std::span<double> state, double duration, std::span<double> derivatives,
                           const StepVisitor& visit);
    double step_of(std::size_t mode, const Jet& jet, double remaining, bool watched);
    bool agrees(std::size_t mode, double length);
    void require_fitting(std::size_t mode, std::span<const double> state) const;

    System system_;
    std::vector<ParameterId> free_;
    std::vector<std::size_t> starts_;
    std::size_t states_, directions_;
    StepSize step_size_;
    StepCheck step_check_;
    DormantStates dormant_states_;
    ModeJets jets_;
    TangentSteps tangents_;
    EndAllowance allowance_;
    std::vector<double> parameters_, parameter_seeds_, sums_, slopes_, guarded_;
    double seen_ = 0;                   ///< length of the step whose final state is in `sums_`; 0: none
    std::vector<double> matrix_, next_; ///< states x directions, row by row
    double previous_ = 0;
    std::size_t steps_ = 0;
    bool at_knot_ = false, crosses_knot_ = false; ///< whether a table ends the present step: see TableSteps
    std::unique_ptr<TableSteps> table_steps_;
    std::unique_ptr<UniformisedFlow> uniformised_; ///< made when first needed
    /// Of each mode, found when first needed; null where directions are not grouped.
    std::vector<std::optional<std::unique_ptr<GroupedDirections>>> grouped_;
    double tolerance_;
    int order_;
};

} // namespace graze
