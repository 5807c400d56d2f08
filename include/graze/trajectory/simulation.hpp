#pragma once

#include "graze/flow/system.hpp"
#include "graze/tape/jet.hpp"
#include "graze/trajectory/probe.hpp"

#include <cstddef>
#include <memory>
#include <vector>

namespace graze {

/// Options of `Simulation`.
struct SimulationOptions {
    double tolerance = 1e-12; ///< error of a step relative to the size of each state, 1e-16 .. 1e-2; larger is faster
    int order = 0;            ///< order of the Taylor polynomials, 4 .. 32; 0: chosen from the tolerance
    double largest_step = 0;  ///< longest step, in units of time; 0: no bound (steps are chosen by accuracy)
    std::size_t step_limit = 100'000'000; ///< more steps end in Ending::step_limit; a guard against endless runs
    int contacts_at_once = 100;           ///< more events than this at one time end in Ending::no_progress
    double touch = 0;    ///< barrier minima between 0 and this are touches; 0: 100 tolerances of their size
    bool minima = false; ///< report the least value of each watched event over each step; costs time
    /// @throws InputError naming the option that is out of range
    void validate() const;
};

/// A system with probes and options: everything needed to run trajectories. Immutable; threads may share it, and copies
/// are handles to the same object.
class Simulation {
public:
    /// @param observed further expressions whose series observers need; expressions may belong to any graph
    /// @throws InputError for a symbol that the model does not have
    explicit Simulation(const System& system, std::vector<Probe> probes = {},
                        const std::vector<Expression>& observed = {}, SimulationOptions options = {});

    const Model& model() const { return parts_->system.model(); }
    const System& system() const { return parts_->system; }
    const std::vector<Probe>& probes() const { return parts_->probes; }
    const SimulationOptions& options() const { return parts_->options; }
    int order() const { return parts_->order; }
    /// Returns the index of a probe's expression among the observed series; those of `observed` follow after the
    /// probes.
    /// @throws InputError when there is no such probe
    std::size_t series_of_probe(std::size_t probe) const {
        require_index(probe, parts_->series.size(), "probe");
        return parts_->series[probe];
    }
    std::size_t series_of_observed(std::size_t index) const {
        require_index(index, parts_->system.observed() - parts_->first_observed, "observed expression");
        return parts_->first_observed + index;
    }
    /// Returns the value of each phase probe (0 for others), as a function of the parameters.
    const Function& phase_values() const { return parts_->phase_values; }
    /// True when both are handles to the same object.
    bool operator==(const Simulation&) const = default;

private:
    struct Parts {
        System system;
        SimulationOptions options;
        std::vector<Probe> probes;
        std::vector<std::size_t> series;
        std::size_t first_observed = 0;
        int order = 0;
        Function phase_values;
    };
    std::shared_ptr<const Parts> parts_;
};

} // namespace graze
