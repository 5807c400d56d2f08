#pragma once

#include "graze/flow/roots.hpp"
#include "graze/trajectory/observer.hpp"
#include "graze/trajectory/simulation.hpp"

#include <cmath>
#include <span>
#include <vector>

namespace graze {

/// Follows the probes of a simulation from step to step and finds every passage exactly once. A crossing that
/// round-off hides between two steps is found from the side on which its function was last known to be.
class ProbeTracker {
public:
    /// @param phase_values, periods at the parameters of this trajectory
    ProbeTracker(const Simulation& simulation, std::span<const double> phase_values, std::span<const double> periods);

    /// Forgets everything: a trajectory begins.
    void start(std::span<const double> state);
    /// A new arc: expressions may have jumped.
    void begin_arc() { arc_start_ = true; }
    /// A cyclic state has been moved by `shift`.
    void shift(std::size_t state, double shift);
    /// A jump has set a cyclic state anew.
    void relocate(std::size_t state, double before, double after);

    struct Found {
        std::size_t probe;
        double at; ///< s
        int direction;
        bool at_contact;
    };
    /// All passages in (0, length], in increasing order; valid until the next call.
    std::span<const Found> search(const Step& step);
    /// The step just searched ends at s instead: what lies behind is forgotten and will be found again.
    void cut(double s);

private:
    struct Tracked {
        int side = 0;
        double lower = 0, upper = 0;             ///< next values of a phase, below and above
        double lower_slack = 0, upper_slack = 0; ///< of a value just passed, until it is left behind
        bool on_section = false;                 ///< begins at `lower`: the motion tells which way it leaves
        double beyond_upper(double phase) const { return phase - upper - upper_slack; }
        double beyond_lower(double phase) const { return phase - lower + lower_slack; }
        bool is_near(double phase, double reach) const {
            return std::abs(beyond_upper(phase)) <= reach || std::abs(beyond_lower(phase)) <= reach;
        }
    };
    /// Something that a search has changed in what is known about a probe.
    struct Change {
        std::size_t probe;
        double at;
        int direction;
    };
    /// What is asked of the simulation at every step.
    struct Followed {
        Probe::Kind kind;
        std::size_t index;              ///< of a phase's state, or of what is observed
        std::vector<std::size_t> sizes; ///< of a phase's series in each mode: coefficients that may not be zero
    };
    void search_series(std::size_t probe, std::span<const double> c, double length, bool extremum);
    void search_phase(std::size_t probe, const Step& step, double reach);
    std::span<const double> without_gaps(const Series& series, std::size_t size);
    std::span<const double> series_of_phase(std::size_t probe, const Step& step);
    void remember_start();
    void note(std::size_t probe, double at, int direction, bool at_contact);
    void change(std::size_t probe, int direction);
    void leave_section(std::size_t probe, const Step& step);
    void locate(std::size_t probe, double value);

    Simulation simulation_;
    std::vector<double> phase_values_, periods_;
    RootFinder roots_;
    std::vector<Followed> followed_;
    std::vector<Tracked> tracked_, tracked_at_start_; ///< now, and at the start of the step just searched ...
    bool remembered_ = false;                         ///< ... unless nothing has changed
    std::vector<Change> changes_;
    std::vector<double> work_, gathered_;
    std::vector<Root> found_roots_;
    std::vector<Found> found_;
    bool arc_start_ = true;
};

} // namespace graze
