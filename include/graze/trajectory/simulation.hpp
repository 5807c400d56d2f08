#pragma once

#include "graze/flow/system.hpp"
#include "graze/tape/jet.hpp"
#include "graze/trajectory/probe.hpp"

#include <cstddef>
#include <memory>
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

/// A system with probes and options: all that is needed to run trajectories. Immutable; threads may share it, and
/// copies are handles of the same.
class Simulation {
public:
    /// @param observed further expressions whose series observers want to see
    /// Expressions may belong to any graph. @throws InputError for a symbol that the model does not have
    explicit Simulation(const System& system, std::vector<Probe> probes = {},
                        const std::vector<Expression>& observed = {}, SimulationOptions options = {});

    const Model& model() const { return parts_->system.model(); }
    const System& system() const { return parts_->system; }
    const std::vector<Probe>& probes() const { return parts_->probes; }
    const SimulationOptions& options() const { return parts_->options; }
    int order() const { return parts_->order; }
    /// Index among the observed series of a probe's expression; series of `observed` come after those.
    /// @throws InputError when there is no such probe
    std::size_t series_of_probe(std::size_t probe) const {
        require_index(probe, parts_->series.size(), "probe");
        return parts_->series[probe];
    }
    std::size_t series_of_observed(std::size_t index) const {
        require_index(index, parts_->system.observed() - parts_->first_observed, "observed expression");
        return parts_->first_observed + index;
    }
    /// Value of each phase probe's section (0 for others), from the parameters alone.
    const Function& phase_values() const { return parts_->phase_values; }
    /// The same simulation, another handle of it.
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
