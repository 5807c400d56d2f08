#pragma once

#include "graze/flow/system.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Vector fields of all modes with their derivatives by the states. Immutable; threads may share it.
class FieldMap {
public:
    explicit FieldMap(const System& system);

    const System& system() const { return system_; }
    std::size_t states() const { return system_.states(); }

    /// Numbers that every use needs, for one thread.
    struct Workspace {
        std::vector<double> inputs, work;
        std::vector<double> rates;    ///< of the states
        std::vector<double> jacobian; ///< of the rates, row by row
        std::vector<double> events, event_gradients;
    };
    Workspace workspace(std::span<const double> parameters) const;

    void evaluate_rates(Workspace& workspace, std::size_t mode, std::span<const double> state) const;
    /// Rates and their derivatives.
    void evaluate(Workspace& workspace, std::size_t mode, std::span<const double> state) const;
    void evaluate_events(Workspace& workspace, std::size_t mode, std::span<const double> state) const;
    /// Whether the field beyond a state is affine over six decades, so that what grows there does so for ever.
    /// @param extents of the states; those that are zero, clocks and drifting states are left as they are
    bool is_affine_beyond(Workspace& workspace, std::size_t mode, std::span<const double> state,
                          std::span<const double> extents, std::span<const double> periods) const;

private:
    System system_;
    std::vector<Function> jacobians_; ///< of each mode
};

} // namespace graze
