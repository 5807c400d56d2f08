#pragma once

#include "graze/flow/step_size.hpp"
#include "graze/flow/system.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace graze {

class ModeCouplings;

/// States that have hardly begun to move, such as the last of a long chain, of which only the first is pushed. Measured
/// by what it is, each would let a step lead to little more than where the next one begins: a chain of 60 takes 450 of
/// them. They are measured by what others make of them over a step. That is done where it cannot hide anything: through
/// couplings that are the same at all places, for states whose rates are polynomials of low degree.
///
/// Nothing changes for motions without such states: now and then it is looked whether steps could be far longer.
class LateStates {
public:
    explicit LateStates(const System& system);
    ~LateStates();
    LateStates(LateStates&&) noexcept;
    LateStates& operator=(LateStates&&) noexcept;
    /// Before the first step. @param parameters as many as the system has
    void set_parameters(std::span<const double> parameters);
    /// A motion begins, of which nothing is known.
    void begin();

    /// The next step; `floors` belong to it.
    /// @param series of states, and of whatever else a step has to be right for, which has no floors
    /// @param step by sizes of their own; @param previous the step before, 0 if there is none
    double step(const StepSize& step_size, std::size_t mode, std::span<const Series> series, double step,
                double previous);
    /// Sizes below which nothing need be known, one for each series; empty while no state is late.
    std::span<const double> floors() const {
        return late_ ? std::span<const double>(floors_) : std::span<const double>{};
    }

private:
    double with_floors(const StepSize& step_size, std::size_t mode, std::span<const Series> series, double previous);

    System system_;
    std::vector<double> parameters_;
    std::unique_ptr<ModeCouplings> couplings_; ///< once it has been looked
    std::vector<double> floors_, sizes_, state_, raised_floors_;
    std::vector<Series> raised_, others_;
    bool late_ = false;
    int until_look_ = 0, interval_ = 0; ///< in steps
};

} // namespace graze
