#pragma once

#include "graze/flow/mode_jets.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace graze {

class Couplings;
class ModeCouplings;
class TangentSeries;

/// Propagates derivatives of a flow in several directions along its steps. The series of the flow are computed once per
/// step; directions are convolved with them side by side, as many as registers hold, or a single one.
///
/// The error of a direction's component is measured against the component's size, or, if larger, against the size to
/// which the direction's other components can bring it within the response time of the flow (see docs/method.md): the
/// errors allowed in those cause as much error there. A component that has only begun to differ from zero, such as the
/// motion of the far end of a chain of oscillators, therefore needs no shorter steps than the others.
///
/// Matrices are row by row, [row * directions + direction].
class TangentSteps {
public:
    /// Tolerance of derivatives in units of that of the states: the truncation error is far below the last terms.
    static constexpr double allowance = 50;
    /// Largest number of parts of a step for directions that are faster than the motion.
    static constexpr int most_parts = 200'000;

    /// Returns how many of `directions` directions are computed side by side.
    static std::size_t together(std::size_t directions);

    /// @param tolerance of the states; @param directions number of directions
    /// @param whole share of a step from which on tails alone are no reason to take the step in parts: the rest of a
    /// step takes as much work as the whole, which is not worthwhile for a few percent
    TangentSteps(const System& system, double tolerance, std::size_t directions, double whole = 1);
    ~TangentSteps();
    TangentSteps(TangentSteps&&) noexcept;
    TangentSteps& operator=(TangentSteps&&) noexcept;

    /// Sets parameters. @param seeds changes of the parameters in the directions, parameters x directions
    void set_parameters(std::span<const double> parameters, std::span<const double> seeds);

    /// Begins a step.
    /// @param jet single jet with tangents (see ModeJets), computed from the state
    /// @param state, matrix at the beginning of the step. All three must exist, unchanged, until the next step begins
    void begin(Jet& jet, std::size_t mode, std::span<const double> state, std::span<const double> matrix);
    /// Propagates all directions along the step, or along the longest part for which all series are accurate.
    /// @param next another jet of the mode, which is begun at the end; @param length of the step, may be negative
    /// @param after the matrix at the end; @param end the state at the end of the whole step, if known
    /// @return the length of the part
    double carry(Jet& next, double length, std::span<double> after, std::span<const double> end = {});
    /// Propagates all directions along a step as short as round-off, whatever the rates at its end.
    void cross(double length, std::span<double> after);
    /// Returns the state at the end of the last `carry` or `cross`.
    std::span<const double> state() const { return state_; }

    /// Computes the derivatives of a watched event's function at the end of the last `carry`; `next` and `after` as it
    /// left them.
    void event_at_end(Jet& next, std::span<const double> after, std::size_t watched, std::span<double> row) const;
    /// Computes the derivatives of coefficient k (at most 2) of a watched event's series on the step.
    void event_coefficient(std::size_t watched, std::size_t k, std::span<double> row);

private:
    struct Lanes {
        std::unique_ptr<TangentSeries> here, there;
    };
    Lanes& lanes_of_mode();
    void load(std::size_t first);
    void begin_end(Jet& next, double step);
    double follow(Jet& next, double length);
    std::span<const double> floors(double time);
    std::span<const double> noise();
    const Couplings& couplings_here();
    std::vector<std::uint32_t> groups_with_events() const;

    System system_;
    std::size_t states_, directions_;
    double tolerance_, whole_;
    std::vector<double> parameter_seeds_;
    std::vector<char> moving_;          ///< for each parameter, whether any direction changes it
    std::vector<std::uint32_t> groups_; ///< groups of deferred expressions that are needed
    std::vector<Lanes> lanes_;          ///< for each mode, made when first needed
    // State of the present step
    Jet* jet_ = nullptr;
    std::size_t mode_ = 0, first_ = 0;
    bool loaded_ = false; ///< the directions from `first_` on have been computed
    std::span<const double> place_, matrix_;
    double at_ = 0; ///< time of `state_` since the beginning of the step
    std::vector<double> state_, sums_, slopes_;
    std::unique_ptr<ModeCouplings> couplings_;
    const Couplings* measured_ = nullptr; ///< couplings at the beginning of the step, if they have been needed
    std::vector<double> floors_, noise_;  ///< [state * width + direction]
};

} // namespace graze
