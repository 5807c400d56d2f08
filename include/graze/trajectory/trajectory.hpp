#pragma once

#include "graze/flow/dormant_states.hpp"
#include "graze/flow/roots.hpp"
#include "graze/flow/step_check.hpp"
#include "graze/flow/step_size.hpp"
#include "graze/trajectory/jet_set.hpp"
#include "graze/trajectory/observer.hpp"
#include "graze/trajectory/outcome.hpp"
#include "graze/trajectory/outlook.hpp"
#include "graze/trajectory/simulation.hpp"

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace graze {

class ProbeTracker;
class Tangents;

/// One trajectory of a hybrid system, as a state machine that is handed the jets of its present state one at a
/// time. Whoever drives it (`run` below for one, `Ensemble` for many in lanes) computes
/// `jet.compute(state())` for the tape of `mode()`, has an Outlook find a step after `previous_step()`, look at what
/// `propose` makes of it, and calls `advance`, until `finished()`.
///
/// Every event function is a polynomial over a step, whose roots are isolated: see docs/method.md.
class Trajectory {
public:
    /// @param parameters of the compiled model, in its order; @param observer must outlive the trajectory
    /// @throws InputError unless there are as many parameters as the model has
    Trajectory(const Simulation& simulation, std::span<const double> parameters, Observer& observer);
    ~Trajectory();
    Trajectory(Trajectory&&) noexcept;

    /// Begins at a state; may be called again to begin anew. Before it is called nothing can be run or asked for
    /// (std::logic_error).
    /// @param end_time may be infinite, if the observer stops
    /// @throws InputError for numbers of states that do not fit, states or a time that are not finite, a mode that
    /// there
    ///         is not, and periods that are not positive
    void start(std::span<const double> state, std::size_t mode, double time, double end_time);
    /// Makes no step longer than this, nor than the options allow; 0: no bound.
    void limit_step(double longest);
    /// Carries on a finished trajectory from where it is to a later time.
    void extend(double end_time);
    /// Also carries derivatives with respect to initial states and independent parameters, given by their names. Call
    /// after `start`. @throws InputError for an unknown name
    void carry_derivatives(std::span<const std::string> inputs);
    void carry_derivatives(std::initializer_list<std::string> inputs) {
        carry_derivatives(std::span(inputs.begin(), inputs.size()));
    }
    /// The same with respect to any directions: seeds are (states + parameters) numbers each, one direction after
    /// another. @throws InputError unless they are as many, and finite
    void carry_tangents(std::span<const double> seeds, std::size_t directions);
    /// Derivative of a state at the present time in one of the directions carried.
    /// @throws InputError when there is no such state or direction
    double derivative(std::size_t state, std::size_t direction) const;

    bool is_started() const { return compiled_mode_ != nullptr; }
    bool finished() const { return outcome_.ending != Ending::running; }
    const Outcome& outcome() const { return outcome_; }
    double time() const { return time_; }
    std::span<const double> state() const { return state_; }
    std::size_t mode() const { return mode_; }
    std::span<const double> parameters() const { return parameters_; }
    std::size_t steps() const { return steps_; }
    const Simulation& simulation() const { return simulation_; }
    /// Derivatives of the state at the present time, [state * directions + direction]; empty when not carried.
    std::span<const double> tangents() const;
    /// False after a contact at zero speed, where derivatives do not exist.
    bool tangents_valid() const;

    /// The last step that the series allowed; 0 at first.
    double previous_step() const { return previous_step_; }
    /// Begins to make a step, given the jet of state() in mode().
    /// @param jet single or ensemble; @param lane of this trajectory; @param step that the outlook has found
    /// @return the length of the step if nothing happens before (if it is not a number, `advance` tells why)
    double propose(const Jet& jet, double step, std::size_t lane = 0);
    /// Makes that step, or one contact without a step.
    /// @param outlook on the length that was returned
    void advance(const Outlook& outlook, std::size_t lane = 0);

private:
    struct Watch {
        int side = 0;  ///< sign of the event function where it was last known for certain
        int strip = 0; ///< coefficients that are zero at the start of an arc, plus one; 0: begins as it is
    };
    struct Touch {
        std::size_t watched;
        Root root;
        bool grazing; ///< zero to within round-off: neighbours meet the surface, or do not
    };
    /// How large an event's function has been.
    struct EventSize {
        double largest = 0;        ///< so far
        double of_arc = 0;         ///< at the beginnings of steps since the last contact
        double terms = 0;          ///< of what cancels in it, where the arc began
        bool left_surface = false; ///< the arc began on its surface
        /// The function and its rates at the beginning of the last step of the arc.
        double time = 0, value = 0, rate = 0, half_second = 0;
    };
    /// The last contacts at one event, for telling when they accumulate.
    struct ContactHistory {
        int count = 0;              ///< in a row, each slower than the one before
        bool interrupted = false;   ///< something else happened between the last two
        std::size_t serial = 0;     ///< of the last, among all contacts
        std::size_t transition = 0; ///< made at the last
        double time = 0;            ///< of the last
        double flight = 0;          ///< time between the last two
        double rate = 0;            ///< of the event function just before the last
        double speed = 0;           ///< of separation after the last
        double previous_speed = 0;  ///< and after the one before
    };
    /// A surface on which the motion was left by a contact, for as long as no mode watches it.
    struct Hold {
        bool on = false;
        bool carried = false;  ///< by a mode that does not watch it
        std::size_t since = 0; ///< steps made before
        double size = 0;       ///< of the event's function at the contact
    };
    static constexpr std::size_t no_event = static_cast<std::size_t>(-1);
    void require_started() const;
    void set_mode(std::size_t mode);

    // One step (trajectory.cpp)
    void find_series(const Jet& jet, std::size_t lane);
    double limited_by_floors(double step);
    std::span<const double> floors() const;
    double shortest_step() const;
    bool check_step(double& step, const Outlook& outlook, std::size_t lane);
    void move_along(double step, bool last, const Outlook& outlook, std::size_t lane);
    void wrap_cyclic_states(bool snap);
    void reduce_cyclic_states(std::span<double> state) const;
    void add_time(double step);
    void finish(Ending ending, double time, std::string detail = {});
    void finish_undefined();
    void finish_singular();
    void finish_unresolved();
    std::string where() const;
    // Roots of what falls to zero (branch_point.cpp)
    std::size_t jumping_rate(double s, double share);
    bool is_roundoff(std::size_t state, double difference);
    bool root_vanishes(double s);
    std::size_t limit_to_branch(double& step);
    void finish_at_branch(std::size_t state);
    bool leave_branch();
    bool can_leave_branch_by(double time, std::span<double> after);
    // What the observer is told of it (report.cpp)
    bool make_step(double& length);
    void report_passage(std::size_t probe, double at, int direction, bool at_contact);
    void report_touches(double step);
    void report_minima(double step);
    // The contact that comes first in it (contact_search.cpp)
    std::size_t find_contact(double& step, const Outlook& outlook, std::size_t lane);
    void look_beyond(std::size_t& first, double step, double uncertain);
    std::size_t passed_with_period(double step, const Outlook& outlook, std::size_t lane);
    bool find_fall(std::size_t watched, double length, Root& root);
    std::span<const double> shifted_series(std::size_t watched);
    void note_size(std::size_t watched);
    double touch_distance(std::size_t event, double size) const;
    double least_touch(std::size_t event) const;
    void keep_touches(std::size_t watched, std::span<const double> c);
    bool is_grazing(std::size_t watched, double s, double rate);
    double on_surface(std::size_t watched, double s);
    double error_of_root(std::size_t watched, double s);
    void update_sides(double length);
    // Transitions (contact.cpp)
    void make_contact(std::size_t watched, double s);
    void apply_transition(std::size_t transition, double rate);
    void jump(std::size_t index);
    std::optional<std::size_t> next_mode(std::size_t transition, bool& ends);
    void enter(std::size_t jump, std::size_t mode);
    void announce_contact();
    void hand_over_contact();
    // The start of an arc (arc_start.cpp)
    void begin_arc(double step);
    bool classify(std::size_t watched, double step);
    double surface_at_start(std::size_t watched, double size, double& drifted);
    bool is_due(std::size_t event) const;
    void finish_violated(std::size_t watched);
    double uncertainty_at_start(std::size_t watched, double size);
    double drift(std::size_t event, double size) const;
    bool fell_before(std::size_t watched, double at_surface);
    void hold_surfaces(std::size_t watched, double s);
    void weigh_terms(std::size_t watched);
    std::size_t leading_coefficient(std::size_t watched, double step, double drift);
    // Accumulations of contacts (chatter.cpp)
    void remember_contact(std::size_t event, double rate);
    bool complete_chatter(std::size_t watched, double step);
    bool another_event_within(std::size_t watched, double time);
    void judge_stand_still();
    void stick(std::size_t watched, std::size_t transition, double remaining, double impulse);
    void come_to_rest(std::size_t event, std::size_t transition, double rate);
    void carry_tangents_to_rest(std::size_t watched, double remaining, double per_impulse);

    std::span<const double> series(std::size_t index);
    std::span<const double> event_series(std::size_t watched) { return series(states_ + watched); }
    double evaluate_state(std::size_t index, double s) const {
        return evaluate_polynomial(series_[index], static_cast<std::size_t>(order_) + 1, s);
    }

    Simulation simulation_;
    const System::CompiledMode* compiled_mode_ = nullptr; ///< of mode_; null before the start
    Observer* observer_;
    std::vector<double> parameters_;
    StepSize step_size_;
    StepCheck step_check_;
    DormantStates dormant_states_;
    RootFinder roots_;
    std::unique_ptr<ProbeTracker> probes_;
    std::unique_ptr<Tangents> tangents_;
    std::size_t states_ = 0;
    int order_ = 0;

    std::vector<double> state_, inputs_, work_, periods_, fields_, jacobian_, row_, kick_, conditions_, before_, after_,
        values_, guarded_, floors_;
    std::vector<std::size_t> cyclic_states_;
    std::vector<double> terms_;       ///< what adds up to each coefficient of an event function, without signs
    std::span<const Series> series_;  ///< of states, events and observed expressions
    std::vector<Series> lane_series_; ///< the same, where the jet has many lanes
    std::vector<double> gathered_;    ///< coefficients from a jet of many lanes, side by side: made where needed
    std::vector<Watch> watches_;
    std::vector<Touch> touches_;
    std::vector<Root> found_touches_;
    std::vector<EventSize> event_sizes_; ///< of each event's function, by which touches are judged
    std::vector<double> surface_values_; ///< of each event's function at the contact that found it on its surface
    std::vector<Hold> holds_;            ///< for each event
    std::vector<double> uncertain_;      ///< errors of the inputs of functions
    std::vector<std::size_t> together_;  ///< events at the time of the last contact, still to be served

    Outcome outcome_;
    std::size_t mode_ = 0, steps_ = 0;
    double time_ = 0, time_low_ = 0, start_time_ = 0, end_time_ = 0;
    double previous_step_ = 0, largest_step_ = 0;
    double longest_allowed_ = 0;            ///< step; 0: any
    bool stop_after_contact_ = false;       ///< the observer stopped at a passage where a contact happens too
    bool arc_start_ = true, stuck_ = false; ///< stuck: the arc begins where contacts have accumulated
    double proposed_ = 0;                   ///< step by the series alone
    double believed_ = 0;                   ///< bound on the next step where the last was found too long; 0: none
    double descent_start_ = 0;              ///< length from which steps have been shrinking
    bool floored_ = false;                  ///< whether they have shrunk so far that sizes have floors
    bool leap_ = false;                     ///< the step is far longer than the one before
    std::size_t served_ = no_event;         ///< event of the contact at which the present arc began
    std::size_t branch_ahead_ = 0;          ///< state whose rate jumps where the arc must end; their number if none
    std::size_t last_jump_ = 0;             ///< that led to the present arc, unless it is the first
    std::optional<Contact> pending_;        ///< contact still to be announced, when the next jet is known
    std::vector<ContactHistory> histories_; ///< for each event
    std::size_t contacts_ = 0;
    int contacts_now_ = 0;
};

/// Drives one trajectory to its end.
/// @throws std::invalid_argument for jets of another simulation, or of several lanes
void run(Trajectory& trajectory, JetSet& jets);

} // namespace graze
