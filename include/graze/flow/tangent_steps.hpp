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

/// Carries derivatives of a flow in several directions along its steps. The flow's own series are computed once a step;
/// directions are convolved with them side by side, as many at once as registers hold, or one alone.
///
/// The error of a direction's component is measured against the component's size, or, where that is less, against what
/// the direction's other components make of it within the response time of the flow (see docs/method.md): errors that
/// these are allowed come to as much there. A component that has only begun to differ from zero, such as the motion of
/// the far end of a chain of oscillators, therefore needs no shorter steps than the others.
///
/// Matrices are row by row, [row * directions + direction].
class TangentSteps {
public:
    /// What derivatives are allowed of the tolerance of the states: what is cut off is far smaller than the last terms.
    static constexpr double allowance = 50;
    /// Parts of a step that directions may need which are faster than the motion.
    static constexpr int most_parts = 200'000;

    /// How many of so many directions are computed side by side.
    static std::size_t together(std::size_t directions);

    /// @param tolerance of the states; @param directions any number of them
    /// @param whole share of a step below which derivatives take parts of it: where what is left over takes as much
    /// work as the step did, tails alone are no reason to leave a few percent of it
    TangentSteps(const System& system, double tolerance, std::size_t directions, double whole = 1);
    ~TangentSteps();
    TangentSteps(TangentSteps&&) noexcept;
    TangentSteps& operator=(TangentSteps&&) noexcept;

    /// @param seeds of the parameters in the directions, parameters x directions
    void set_parameters(std::span<const double> parameters, std::span<const double> seeds);

    /// A step begins.
    /// @param jet single jet with tangents (see ModeJets) that has been computed from the state
    /// @param state, matrix where the step begins. All three are looked at until the next step begins, and must stay
    void begin(Jet& jet, std::size_t mode, std::span<const double> state, std::span<const double> matrix);
    /// Carries all directions along the step, or along a part of it, as far as all may be carried at once.
    /// @param next another jet of the mode, which is begun at the end; @param length of the step, which may be negative
    /// @param after the matrix at the end; @param end the state at the end of the whole step, if it is known
    /// @return how far
    double carry(Jet& next, double length, std::span<double> after, std::span<const double> end = {});
    /// Where `carry` has led to.
    std::span<const double> state() const { return state_; }

    /// Derivatives of a watched event's function where `carry` has led to: `next` and `after` as it left them.
    void event_at_end(Jet& next, std::span<const double> after, std::size_t watched, std::span<double> row) const;
    /// Derivatives of coefficient k (at most 2) of the series that a watched event's function has on the step.
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
    std::vector<char> moving_;          ///< of each parameter, whether some direction changes it
    std::vector<std::uint32_t> groups_; ///< of followers that are needed
    std::vector<Lanes> lanes_;          ///< of modes, made when first needed
    // Of the present step
    Jet* jet_ = nullptr;
    std::size_t mode_ = 0, first_ = 0;
    bool loaded_ = false; ///< the directions from `first_` on have been computed
    std::span<const double> place_, matrix_;
    double at_ = 0; ///< where `state_` is along it
    std::vector<double> state_, sums_, slopes_;
    std::unique_ptr<ModeCouplings> couplings_;
    const Couplings* measured_ = nullptr; ///< what they are at its beginning, once it has been asked for
    std::vector<double> floors_, noise_;  ///< [state * width + direction]
};

} // namespace graze
