#pragma once

#include "flow/kept_sign.hpp"
#include "graze/flow/roots.hpp"
#include "graze/trajectory/observer.hpp"
#include "graze/trajectory/simulation.hpp"

#include <cmath>
#include <limits>
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
    void cut(const Step& step, double s);

private:
    /// How far a phase may go within a step: one that only rises goes nowhere down. A value may be passed that lies
    /// behind it, if that is so between two steps and by round-off alone.
    struct Reach {
        double up = 0, down = 0, most = 0;
    };
    static Reach reach_of_line(double change);
    static Reach reach_of_series(std::span<const double> c, double length);
    struct Tracked {
        int side = 0;
        double lower = 0, upper = 0;             ///< next values of a phase, below and above
        double lower_slack = 0, upper_slack = 0; ///< of a value just passed, until it is left behind
        bool on_section = false;                 ///< begins at `lower`: the motion tells which way it leaves
        double beyond_upper(double phase) const { return phase - upper - upper_slack; }
        double beyond_lower(double phase) const { return phase - lower + lower_slack; }
        bool is_near(double phase, const Reach& reach) const {
            const double above = beyond_upper(phase), below = beyond_lower(phase);
            return (above >= -reach.up && above <= reach.most) || (below <= reach.down && below >= -reach.most);
        }
    };
    /// Something that a search has changed in what is known about a probe.
    struct Change {
        std::size_t probe;
        double at; ///< or `unplaced`
        int direction;
        Tracked before;
    };
    /// Of a passage in the direction that nobody asks for: the only one of its probe within the step.
    static constexpr double unplaced = std::numeric_limits<double>::infinity();
    /// What is asked of the simulation.
    struct Followed {
        Probe::Kind kind;
        Direction wanted;
        std::size_t index; ///< of a phase's state, or of what is observed
        bool wants(int direction) const {
            return wanted == Direction::both || (wanted == Direction::rising) == (direction > 0);
        }
    };
    /// A cyclic state, with all that wait for its values.
    struct Phase {
        std::size_t state;
        std::vector<std::size_t> sizes;  ///< of its series in each mode: the rate may be constant
        std::vector<std::size_t> probes; ///< rising
        double low = 0, high = 0;        ///< none of them is near while it stays between
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
    /// Coefficients of one lane, side by side; valid until the next ones are asked for.
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
    std::vector<std::size_t> expressions_; ///< probes that are none
    bool bounds_known_ = false;            ///< of phases
    std::vector<Tracked> tracked_;
    std::vector<Change> changes_; ///< of the step just searched
    std::vector<double> work_, gathered_;
    std::vector<Root> found_roots_;
    std::vector<Found> found_;
    bool arc_start_ = true;
};

} // namespace graze
