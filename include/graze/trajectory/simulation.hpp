#pragma once

#include "graze/flow/compiled_model.hpp"
#include "graze/tape/jet.hpp"
#include "graze/trajectory/probe.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

struct SimulationOptions {
    double tolerance = 1e-12; ///< of each step, relative to the size of each state; 1e-16 .. 1e-2
    int order = 0;            ///< of the Taylor polynomials; 0 chooses by tolerance
    double largest_step = 0;  ///< 0: no bound
    std::size_t step_limit = 100'000'000;
    int contacts_at_once = 100; ///< more events than this at one time end in Ending::no_progress
    double touch = 0;           ///< minima of barriers between 0 and this are reported as touches; 0: 100 tolerances
    bool minima = false;        ///< report the least value of every watched event over every step
    /// @throws InputError naming the option that is out of range
    void validate() const;
};

/// A model compiled together with probes: all that is needed to run trajectories. Immutable and shareable.
class Simulation {
public:
    /// @param observed further expressions whose series observers want to see
    Simulation(const Model& model, std::vector<Probe> probes = {}, const std::vector<Expression>& observed = {},
               SimulationOptions options = {});

    const Model& model() const { return compiled_.model(); }
    const CompiledModel& compiled() const { return compiled_; }
    const std::vector<Probe>& probes() const { return probes_; }
    const SimulationOptions& options() const { return options_; }
    int order() const { return order_; }
    /// Index among the observed series of a probe's expression; series of `observed` come after those.
    std::size_t series_of_probe(std::size_t probe) const { return series_[probe]; }
    std::size_t series_of_observed(std::size_t index) const { return first_observed_ + index; }
    /// Value of each phase probe's section (0 for others), from the parameters alone.
    const Function& phase_values() const { return phase_values_; }

private:
    SimulationOptions options_;
    std::vector<Probe> probes_;
    std::vector<std::size_t> series_;
    std::size_t first_observed_ = 0;
    int order_;
    CompiledModel compiled_;
    Function phase_values_;
};

} // namespace graze
