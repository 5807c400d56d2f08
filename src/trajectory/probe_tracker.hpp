#pragma once

#include "flow/kept_sign.hpp"
#include "graze/flow/roots.hpp"
#include "graze/trajectory/observer.hpp"
#include "graze/trajectory/simulation.hpp"

#include <limits>
#include <span>
#include <vector>

namespace graze {

/// Tracks the probes of a simulation from step to step and finds every passage exactly once. A crossing that round-off
/// hides between two steps is found from the side on which the function was last known to be.
class ProbeTracker {
public:
    /// @param phase_values, periods at the parameters of this trajectory
    ProbeTracker(const Simulation& simulation, std::span<const double> phase_values, std::span<const double> periods);

    /// Resets the tracker at the start of a trajectory.
    void start(std::span<const double> state);
    /// Marks a new arc, at whose start expressions may jump.
    void begin_arc() { arc_start_ = true; }
    /// Reports that a cyclic state has been shifted by `shift` (whole periods).
    void shift(std::size_t state, double shift);
    /// Reports that a jump has changed a cyclic state.
    void relocate(std::size_t state, double before, double after);

    struct Found {
        std::size_t probe;
        double at; ///< s
        int direction;
        bool at_contact;
    };
    /// Returns all passages in (0, length], in increasing order; valid until the next call.
    std::span<const Found> search(const Step& step);
    /// Shortens the step just searched to s: later passages are discarded and will be found again.
    void cut(const Step& step, double s);

private:
    /// Bounds on the change of a phase within a step, up and down. `most` is the distance by which a value may already
    /// have been passed between two steps, by round-off.
    struct Reach {
        double up = 0, down = 0, most = 0;
    };
    static Reach reach_of_line(double change);
    static Reach reach_of_series(std::span<const double> c, double length);
    struct Tracked {
        int side = 0;
        double lower = 0, upper = 0;             ///< next values of a phase, below and above
        double lower_slack = 0, upper_slack = 0; ///< tolerance at a value just passed, until the phase has left it
        bool on_section = false;                 ///< starts at `lower`: the motion decides in which direction it leaves
        double beyond_upper(double phase) const { return phase - upper - upper_slack; }
        double beyond_lower(double phase) const { return phase - lower + lower_slack; }
        bool is_near(double phase, const Reach& reach) const {
            const double above = beyond_upper(phase), below = beyond_lower(phase);
            return (above >= -reach.up && above <= reach.most) || (below <= reach.down && below >= -reach.most);
        }
    };
    /// A change that a search has made to the state of a probe.
    struct Change {
        std::size_t probe;
        double at; ///< or `unplaced`
        int direction;
        Tracked before;
    };
    /// Time of a passage in an unwanted direction that is the only one of its probe within the step.
    static constexpr double unplaced = std::numeric_limits<double>::infinity();
    /// The relevant data of a probe.
    struct Followed {
        Probe::Kind kind;
        Direction wanted;
        std::size_t index; ///< index of the phase's state, or of the observed expression
        bool wants(int direction) const {
            return wanted == Direction::both || (wanted == Direction::rising) == (direction > 0);
        }
    };
    /// A cyclic state and its phase probes.
    struct Phase {
        std::size_t state;
        std::vector<std::size_t> sizes;  ///< [mode] number of coefficients of its series (2 if its rate is constant)
        std::vector<std::size_t> probes; ///< rising
        double low = 0, high = 0;        ///< no probe's value is near while the phase is between these
        bool is_line(std::size_t mode) const { return sizes[mode] <= 2; }
    };
    void find_bounds();
    void sort_found();
    void search_phases(const Phase& phase, const Step& step);
    void search_expression(std::size_t probe, const Step& step);
    void search_series(std::size_t probe, std::span<const double> c, double length, roots::ClearSign clear);
    void begin_on(int side, std::size_t probe);
    void search_from_zero(std::size_t probe, std::span<const double> c, double length, double noise);
    void note_crossings(std::size_t probe, std::span<const double> c, double length, RootStart start);
    std::span<const double> rate_of(std::span<const double> c);
    double place(std::size_t probe, const Step& step);
    void search_phase(std::size_t probe, const Step& step, std::span<const double> c, const Reach& reach);
    /// Returns the coefficients of one lane, contiguous; valid until the next call.
    std::span<const double> without_gaps(const Series& series, std::size_t size) {
        return series.stride == 1 ? std::span<const double>(series.first, size) : gather(series, size);
    }
    std::span<const double> gather(const Series& series, std::size_t size);
    void note(std::size_t probe, double at, int direction, bool at_contact);
    void change(std::size_t probe, int direction);
    void leave_section(std::size_t probe, std::span<const double> c, double length);
    void locate(std::size_t probe, double value);

    Simulation simulation_;
    std::vector<double> phase_values_, periods_;
    RootFinder roots_;
    std::vector<Followed> followed_;
    std::vector<Phase> phases_;
    std::vector<std::size_t> expressions_; ///< probes that are not phases
    bool bounds_known_ = false;            ///< bounds of phases are up to date
    std::vector<Tracked> tracked_;
    std::vector<Change> changes_; ///< changes of the step just searched
    std::vector<double> work_, gathered_;
    std::vector<Root> found_roots_;
    std::vector<Found> found_;
    bool arc_start_ = true;
};

} // namespace graze
