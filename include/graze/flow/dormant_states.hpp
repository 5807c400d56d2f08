#pragma once

#include "graze/flow/step_size.hpp"
#include "graze/flow/system.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace graze {

class ModeCouplings;

/// Chooses steps in the presence of dormant states, which have hardly begun to move, such as the last ones of a long
/// chain that is driven at its first. Relative to its own size, each of them would limit a step to little more than the
/// time at which the next one begins to move: a chain of 60 oscillators takes 450 steps. Dormant states are therefore
/// judged by the size to which other states can bring them during the step. This is done only where it cannot hide
/// anything: through couplings that are constant in state space, for states whose rates are polynomials of low degree.
///
/// Motions without dormant states are unaffected: from time to time a test shows whether steps could be much longer.
class DormantStates {
public:
    explicit DormantStates(const System& system);
    ~DormantStates();
    DormantStates(DormantStates&&) noexcept;
    DormantStates& operator=(DormantStates&&) noexcept;
    /// To be called before the first step. @param parameters one for each parameter of the system
    void set_parameters(std::span<const double> parameters);
    /// To be called at the beginning of a motion: forgets all dormant states.
    void begin();

    /// Returns the next step; `floors` belong to it.
    /// @param series of the states, and of other functions that a step has to resolve, which have no floors
    /// @param step chosen by `step_size`; @param previous the step before, 0 if there is none
    double step(const StepSize& step_size, std::size_t mode, std::span<const Series> series, double step,
                double previous);
    /// Returns the sizes below which series need not be resolved, one for each series; empty while no state is dormant.
    std::span<const double> floors() const {
        return dormant_ ? std::span<const double>(floors_) : std::span<const double>{};
    }

private:
    double with_floors(const StepSize& step_size, std::size_t mode, std::span<const Series> series, double previous);

    System system_;
    std::vector<double> parameters_;
    std::unique_ptr<ModeCouplings> couplings_; ///< made by the first test
    std::vector<double> floors_, sizes_, state_, raised_floors_;
    std::vector<Series> raised_, others_;
    bool dormant_ = false;
    int until_test_ = 0, interval_ = 0; ///< number of steps until the next test, and between two tests
};

} // namespace graze
