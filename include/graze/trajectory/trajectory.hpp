#pragma once

#include "graze/flow/dormant_states.hpp"
#include "graze/flow/roots.hpp"
#include "graze/flow/step_check.hpp"
#include "graze/flow/step_size.hpp"
#include "graze/trajectory/jet_set.hpp"
#include "graze/trajectory/observer.hpp"
#include "graze/trajectory/outcome.hpp"
#include "graze/trajectory/simulation.hpp"
#include "graze/trajectory/step_preview.hpp"

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace graze {

class ModeFlow;
class ProbeTracker;
struct JointRest;
class TableSteps;
class Tangents;

/// One trajectory of a hybrid system, as a state machine that receives the jets of its present state one at a time. The
/// caller (`run` below for one, `Ensemble` for many in lanes) computes `jet.compute(state())` for the tape of `mode()`,
/// has a StepPreview find a step after `previous_step()`, calls `propose`, has the preview evaluate the end of the
/// proposed step, and calls `advance`, until `finished()`.
///
/// Every event function is a polynomial over a step; its roots are isolated: see docs/method.md.
class Trajectory {
public:
    /// @param parameters in the order of the compiled model
    /// @param observer is shared; null: none
    /// @throws InputError for a wrong number of parameters
    Trajectory(const Simulation& simulation, std::span<const double> parameters,
               std::shared_ptr<Observer> observer = {});
    ~Trajectory();
    Trajectory(Trajectory&&) noexcept;

    /// Starts at a state; may be called again to start anew. All other functions throw OrderError before the
    /// first call.
    /// @param end_time may be infinite, if the observer stops
    /// @throws InputError for a wrong number of states, for states or a time that are not finite, for an unknown mode,
    /// and for periods that are not positive
    void start(std::span<const double> state, std::size_t mode, double time, double end_time);
    /// Bounds the steps, in addition to the options; 0: no bound.
    void limit_step(double longest);
    /// Continues a finished trajectory to a later time.
    void extend(double end_time);
    /// Computes derivatives too, with respect to the named initial states and independent parameters. To be called
    /// after `start`. @throws InputError for an unknown name
    void carry_derivatives(std::span<const std::string> inputs);
    void carry_derivatives(std::initializer_list<std::string> inputs) {
        carry_derivatives(std::span(inputs.begin(), inputs.size()));
    }
    /// The same in arbitrary directions: seeds are (states + parameters) numbers for each direction, one direction
    /// after another. @throws InputError for a wrong number of seeds, or seeds that are not finite
    void carry_tangents(std::span<const double> seeds, std::size_t directions);
    /// Returns the derivative of a state at the present time in one of the directions.
    /// @throws InputError when there is no such state or direction
    double derivative(std::size_t state, std::size_t direction) const;

    bool is_started() const { return compiled_mode_ != nullptr; }
    bool finished() const { return outcome_.ending != Ending::running; }
    const Outcome& outcome() const { return outcome_; }
    double time() const { return time_; }
    /// At the present time, as `tangents`: valid until the next step.
    std::span<const double> state() const { return state_; }
    std::size_t mode() const { return mode_; }
    std::span<const double> parameters() const { return parameters_; }
    std::size_t steps() const { return steps_; }
    const Simulation& simulation() const { return simulation_; }
    /// Returns derivatives of the state at the present time, [state * directions + direction]; empty if not computed.
    std::span<const double> tangents() const;
    /// False after a contact at zero speed, where derivatives do not exist.
    bool tangents_valid() const;

    /// Returns the last step that the series allowed; 0 at first.
    double previous_step() const { return previous_step_; }
    /// Proposes a step, given the jet of state() in mode().
    /// @param jet single or ensemble; @param lane of this trajectory; @param step found by the preview
    /// @return the length of the step if no event happens before its end (if NaN, `advance` reports the reason)
    double propose(const Jet& jet, double step, std::size_t lane = 0);
    /// Makes the proposed step, or one contact without a step.
    /// @param preview after evaluate_ends for the returned length
    void advance(const StepPreview& preview, std::size_t lane = 0);

private:
    struct Watch {
        int side = 0;  ///< sign of the event function where it was last certain
        int strip = 0; ///< number of leading coefficients that are zero at the start of an arc; 0: none
    };
    struct Touch {
        std::size_t watched;
        Root root;
        bool grazing; ///< zero to within round-off: neighbouring trajectories may or may not cross
    };
    /// Sizes of an event's function, for judging touches and round-off.
    struct EventSize {
        double largest = 0;        ///< since the start
        double of_arc = 0;         ///< at the beginnings of steps since the last contact
        double terms = 0;          ///< size of its cancelling terms at the start of the arc
        bool left_surface = false; ///< the arc began on its surface
        /// The function and its rates at the beginning of the last step of the arc.
        double time = 0, value = 0, rate = 0, half_second = 0;
    };
    /// The last contacts at one event, from which accumulations are detected.
    struct ContactHistory {
        int count = 0;              ///< consecutive contacts, each slower than the one before
        bool interrupted = false;   ///< another event happened between the last two
        std::size_t serial = 0;     ///< number of the last among all contacts
        std::size_t transition = 0; ///< transition made at the last
        double time = 0;            ///< time of the last
        double flight = 0;          ///< time between the last two
        double rate = 0;            ///< rate of the event function just before the last
        double speed = 0;           ///< separation speed after the last
        double previous_speed = 0;  ///< separation speed after the one before
    };
    /// A passage from one mode to another without a jump.
    struct Crossing {
        std::size_t event = 0, mode_before = 0, mode_after = 0;
        double time = 0, time_low = 0;
        std::vector<double> state{};
    };
    /// A surface on which a contact left the motion, while no mode watches it: the motion may rest on it.
    struct Hold {
        bool on = false;
        bool carried = false;  ///< the motion has moved along it in a mode that does not watch it
        std::size_t since = 0; ///< number of steps made before the contact
        double size = 0;       ///< size of the event's function at the contact
    };
    static constexpr std::size_t no_event = static_cast<std::size_t>(-1);
    void require_started() const;
    void set_mode(std::size_t mode);

    // One step (trajectory.cpp)
    void find_series(const Jet& jet, std::size_t lane);
    double limited_by_floors(double step);
    std::span<const double> floors() const;
    double shortest_step() const;
    bool check_step(double& step, const StepPreview& preview, std::size_t lane);
    void move_along(double step, bool last, const StepPreview& preview, std::size_t lane);
    void wrap_cyclic_states(bool snap);
    void reduce_cyclic_states(std::span<double> state) const;
    void add_time(double step);
    void finish(Ending ending, double time, std::string detail = {});
    void finish_undefined();
    void finish_singular();
    void finish_unresolved();
    std::string where() const;
    // Radicands that fall to zero (branch_point.cpp)
    std::size_t jumping_rate(double s, double share);
    bool is_roundoff(std::size_t state, double difference);
    bool root_vanishes(double s);
    std::size_t limit_to_branch(double& step);
    void finish_at_branch(std::size_t state);
    bool leave_branch();
    bool can_leave_branch_by(double time, std::span<double> after);
    double leave_root(double longest);
    // Reports to the observer (report.cpp)
    bool make_step(double& length);
    void report_passage(std::size_t probe, double at, int direction, bool at_contact);
    void report_touches(double step);
    void report_minima(double step);
    // The first contact in the step (contact_search.cpp)
    std::size_t find_contact(double& step, const StepPreview& preview, std::size_t lane);
    std::size_t fallen_to_roundoff(double& step);
    void find_simultaneous(std::size_t& first, double step, double uncertain);
    std::size_t passed_with_period(double step, const StepPreview& preview, std::size_t lane);
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
    void add_simultaneous(std::size_t first);
    void finish_without_way(std::size_t transition);
    void finish_otherwise(const Transition& transition, double time);
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
    bool begins_beside_surface();
    bool is_two_fold(std::size_t event, double s);
    bool ends_at_two_fold();
    bool is_near_zero(std::size_t event, double s, double share);
    void finish_at_two_fold(double time);
    bool finish_at_paradox(double time);
    double uncertainty_at_start(std::size_t watched, double size);
    double drift(std::size_t event, double size) const;
    bool fell_before(std::size_t watched, double at_surface);
    void hold_surfaces(std::size_t watched, double s);
    void sum_term_sizes(std::size_t watched);
    bool is_cancelled_fall(std::size_t watched, double step);
    std::size_t leading_coefficient(std::size_t watched, double step, double drift);
    // Accumulations of contacts (chatter.cpp)
    void remember_contact(std::size_t event, double rate);
    bool complete_chatter(std::size_t watched, double step);
    bool another_event_within(std::size_t watched, double time);
    void judge_stand_still();
    void stick(std::size_t watched, std::size_t transition, double remaining, double impulse);
    void find_displacements(double share);
    void come_to_rest(std::size_t event, std::size_t transition, double rate);
    // Contacts that come to rest together (joint_chatter.cpp)
    bool complete_joint_chatter(double step, bool standing_still);
    bool is_nearby(std::size_t watched, double step, bool standing_still);
    bool is_steady(double time, double longest_error);
    void move_to_rest(const std::vector<std::size_t>& members, const JointRest& rest);
    void rest_together(const std::vector<std::size_t>& events);
    std::optional<std::size_t> transition_to_rest(std::size_t event) const;
    // Surfaces that are crossed in turn, ever faster (spiral.cpp)
    void remember_crossing(std::size_t event, std::size_t mode_before);
    bool complete_spiral(double step);
    std::size_t length_of_turn() const;
    bool is_at_surface(std::size_t event, double step);
    std::optional<std::size_t> transition_at_corner(std::size_t turn) const;
    void carry_tangents_to_rest(std::size_t watched, double remaining, double per_impulse);
    // Contacts that come to rest (resting_contact.cpp)
    double change_by_rest(const Transition& transition);
    std::optional<std::size_t> transition_to_rest(std::size_t event, std::optional<std::size_t> known);

    std::span<const double> series(std::size_t index);
    std::span<const double> event_series(std::size_t watched) { return series(states_ + watched); }
    double evaluate_state(std::size_t index, double s) const {
        return evaluate_polynomial(series_[index], static_cast<std::size_t>(order_) + 1, s);
    }

    Simulation simulation_;
    const System::CompiledMode* compiled_mode_ = nullptr; ///< compiled mode_; null before the start
    std::shared_ptr<Observer> observer_;                  ///< never null
    std::vector<double> parameters_;
    StepSize step_size_;
    StepCheck step_check_;
    DormantStates dormant_states_;
    RootFinder roots_;
    std::unique_ptr<ProbeTracker> probes_;
    std::unique_ptr<Tangents> tangents_;
    std::unique_ptr<TableSteps> table_steps_; ///< null if no mode looks up a table
    std::unique_ptr<ModeFlow> leaving_;       ///< made when the zero of a radicand is left
    std::size_t states_ = 0;
    int order_ = 0;

    std::vector<double> state_, inputs_, work_, periods_, fields_, jacobian_, row_, kick_, conditions_, before_, after_,
        values_, guarded_, floors_;
    std::vector<std::size_t> cyclic_states_;
    std::vector<double> terms_;       ///< sums of the absolute terms of each coefficient of an event function
    std::span<const Series> series_;  ///< series of states, events and observed expressions
    std::vector<Series> lane_series_; ///< the same, where the jet has many lanes
    std::vector<double> gathered_;    ///< contiguous coefficients from a jet of many lanes: made where needed
    std::vector<Watch> watches_;
    std::vector<Touch> touches_;
    std::vector<Root> found_touches_;
    std::vector<EventSize> event_sizes_; ///< sizes of each event's function, by which touches are judged
    std::vector<double> surface_values_; ///< value of each event's function at the contact that put it on its surface
    std::vector<Hold> holds_;            ///< for each event
    std::vector<double> uncertain_;      ///< errors of the inputs of functions
    std::vector<Crossing> crossings_;    ///< the last ones, from which spirals are detected
    std::vector<double> contact_values_; ///< of contacts that may come to rest together: see System::CompiledContacts
    std::vector<std::size_t> together_;  ///< simultaneous events that are still to be handled

    Outcome outcome_;
    std::size_t mode_ = 0, steps_ = 0;
    double time_ = 0, time_low_ = 0, start_time_ = 0, end_time_ = 0;
    double previous_step_ = 0, largest_step_ = 0;
    double longest_allowed_ = 0;            ///< longest allowed step; 0: no bound
    bool stop_after_contact_ = false;       ///< the observer stopped at a passage that coincides with a contact
    bool arc_start_ = true, stuck_ = false; ///< stuck: the arc begins where contacts have accumulated
    double proposed_ = 0;                   ///< step chosen from the series alone
    double believed_ = 0;                   ///< bound on the next step after a step was shortened by the check; 0: none
    double descent_start_ = 0;              ///< length from which steps have been shrinking
    bool floored_ = false;                  ///< steps have become so short that sizes have floors
    bool leap_ = false;                     ///< the step is far longer than the one before
    std::size_t start_event_ = no_event;    ///< event of the contact at which the present arc began
    std::size_t branch_ahead_ = 0;          ///< state whose rate jumps where the arc must end; number of states if none
    std::size_t last_jump_ = 0;             ///< jump that led to the present arc, unless it is the first
    std::optional<Contact> pending_;        ///< contact to be reported when the next jet is known
    std::vector<ContactHistory> histories_; ///< for each event
    std::size_t contacts_ = 0;
    int contacts_now_ = 0;
    int contacts_nearby_ = 0; ///< contacts since `nearby_since_`, between which hardly any time passes
    double nearby_since_ = 0;
};

/// Runs one trajectory to its end.
/// @throws InputError for jets of another simulation, or of several lanes
void run(Trajectory& trajectory, JetSet& jets);

} // namespace graze
