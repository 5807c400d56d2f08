#pragma once

#include "graze/base/borrowed.hpp"
#include "graze/flow/roots.hpp"

#include <cstddef>
#include <span>

namespace graze {

/// One step of an arc: Taylor polynomials in s = time - start, valid for 0 <= s <= length. Its series are there during
/// the call that tells of it; RecordedStep is a copy.
struct Step {
    double start = 0, length = 0;
    std::size_t mode = 0;
    int order = 0;
    std::span<const Series> states;   ///< order + 1 coefficients each, in powers of s
    std::span<const Series> events;   ///< watched event functions of the mode
    std::span<const Series> observed; ///< observed expressions

    /// Value of a state or series at s. Arguments are not checked, since this is called at every step.
    double state(std::size_t index, double s) const { return value(states[index], s); }
    double value(const Series& series, double s) const {
        return evaluate_polynomial(series, static_cast<std::size_t>(order) + 1, s);
    }
};

enum class ContactKind {
    crossing, ///< the event function falls through zero: the transition is made
    touch,    ///< a minimum within the touch distance of zero, without falling through: nothing happens
    sticking, ///< accumulation of contacts, or contact at zero speed: the transition's `chatter` is made
};

/// A contact: an occurrence at the surface of an event, where its function is zero. Recorder::RecordedContact is a
/// copy.
struct Contact {
    ContactKind kind = ContactKind::crossing;
    double time = 0;
    std::size_t event = 0;
    std::size_t transition = 0; ///< index in Model::transitions
    std::size_t mode_before = 0, mode_after = 0;
    double rate_before = 0;                ///< rate of the event function along the flow: minus the approach speed
    double rate_after = 0;                 ///< rate of the same function just after, along the flow of the next mode
    double value = 0;                      ///< value of the event function (its minimum, for a touch)
    bool simultaneous = false;             ///< at the same time as the contact before
    std::span<const double> before, after; ///< states; valid during the call
};

/// The crossing of a probe's surface, or an extremum of its expression. Recorder::RecordedPassage is a copy.
struct Passage {
    std::size_t probe = 0;
    double time = 0;
    int direction = 0; ///< +1 rising (or a minimum), -1 falling (or a maximum)
    std::size_t mode = 0;
    bool at_contact = false;       ///< an extremum made by a jump or a change of mode
    std::span<const double> state; ///< valid during the call
};

/// The least value of a watched event function over a step.
struct StepMinimum {
    std::size_t event = 0;
    double time = 0;
    Minimum minimum; ///< `at` counts from the start of the step
};

/// Receives what happens along a trajectory, in the order of time within each kind. Any function may be left undefined.
class Observer {
public:
    virtual ~Observer() = default;
    /// Called for each step, after its length is known.
    virtual void step(const Step&) {}
    virtual void contact(const Contact&) {}
    virtual void passage(const Passage&) {}
    virtual void minimum(const StepMinimum&) {}
    /// Called before the step or contact is reported: the motion meets a surface at zero speed, to within round-off,
    /// and derivatives do not exist from there on. Only called if follows_derivatives().
    virtual void grazing() {}
    /// Returns whether `grazing` is wanted; it costs time at each contact.
    virtual bool follows_derivatives() const { return false; }
    /// Called after each step: true ends the trajectory with Ending::stopped.
    virtual bool stop() { return false; }
};

} // namespace graze
