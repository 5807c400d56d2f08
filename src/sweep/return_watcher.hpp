#pragma once

#include "graze/sweep/attractor.hpp"
#include "sweep/motion_derivatives.hpp"
#include "sweep/sample_recorder.hpp"
#include "sweep/section_map.hpp"

#include <algorithm>
#include <cstdint>

namespace graze {

/// A passage of the section, with the contacts since the one before.
struct Return {
    double time = 0;
    std::size_t mode = 0;
    std::vector<double> state, least, greatest; ///< range of the states since the return before
    std::vector<std::uint32_t> contacts;        ///< 2 * transition, plus 1 where contacts accumulated
};

/// The range of each state over a part of a motion, and whether there were contacts.
struct MotionPart {
    std::vector<double> least, greatest;
    bool contacts = false;

    void include(const MotionPart& other);
    void include(std::span<const double> state);
    double extent(std::size_t state) const { return greatest[state] - least[state]; }
};

/// All returns of a motion in a few parts of equal length; the length doubles when there are too many parts. However
/// slow the motion is relative to the section's clock, parts are as long as the observation allows.
class MotionParts {
public:
    void clear();
    void add(const MotionPart& one);
    /// Returns the number of complete parts.
    std::size_t count() const { return parts_.size(); }
    const MotionPart& recent(std::size_t before) const { return parts_[parts_.size() - 1 - before]; }
    /// Returns the number of consecutive returns without contacts, up to the last.
    std::size_t quiet() const { return quiet_; }

private:
    std::vector<MotionPart> parts_;
    MotionPart current_;
    std::size_t length_ = 1, in_current_ = 0, quiet_ = 0; ///< in returns
};

/// Observes a trajectory from return to return, and stops it on request.
class ReturnWatcher : public Observer {
public:
    /// @param kept number of last returns that are stored; @param bounds of states, may be empty
    ReturnWatcher(const SectionMap& map, std::size_t kept, std::vector<StateBounds> bounds);

    /// @param recorder receives all calls too; may be null
    void begin(std::span<const double> parameters, std::span<const double> periods, SampleRecorder* recorder);
    /// Starts a trajectory at this time: returns earlier than `shortest` are the start itself.
    void start_leg(double time, double shortest);
    void stop_after(std::size_t returns) { stop_after_ = returns; }
    /// From now on `derivatives` observe the motion too, with marks at returns; null: none.
    void follow(MotionDerivatives* derivatives) { derivatives_ = derivatives; }
    /// Stops at returns that are close to one of the last `largest` returns (in units of `scale`); or that equal an
    /// earlier return after an accumulation of contacts: motions that lose all memory there repeat themselves exactly,
    /// whatever the period. @param thresholds allowed distance for each number of returns
    void watch_recurrence(std::vector<double>* thresholds, std::size_t largest) {
        thresholds_ = thresholds;
        largest_ = largest;
    }

    std::size_t returns() const { return returns_; }
    bool escaped() const { return escaped_; }
    /// True if the trajectory was stopped because no return can be expected.
    bool stuck() const { return stuck_; }
    /// Allows any number of steps in a return: its time is bounded otherwise.
    void allow_any_steps(bool any) { any_steps_ = any; }
    /// Enables stops for examination while no return comes.
    void watch_rest(bool rest) { rest_ = rest; }
    /// True if it stopped for examination because no return has come for long.
    bool paused() const { return paused_; }
    /// Returns the largest extent of each state between two returns so far.
    std::span<const double> widest() const { return widest_; }
    /// Returns the extent of each state over all returns so far.
    double range(std::size_t state) const { return highest_[state] - lowest_[state]; }
    double lowest(std::size_t state) const { return lowest_[state]; }
    /// Returns the extent of each state at the beginning: up to the second return, or to the first examination.
    std::span<const double> early() const { return early_; }
    /// Marks a new beginning: the motion has been displaced.
    void begin_anew() { early_.clear(); }
    /// Returns all returns so far in a few parts.
    const MotionParts& parts() const { return parts_; }
    /// Returns the range of the states from one return (included) to the next: in long steps nothing else is known of
    /// the motion in between.
    MotionPart part(std::size_t before) const;
    /// Returns the period of the recurrence at which it stopped; 0: none.
    std::size_t recurrent() const { return recurrent_; }
    /// Returns whether that is an exact repetition with a period longer than those that are searched.
    bool recurs_exactly() const { return recurrent_ > largest_; }
    /// Returns the return that is `before` returns before the last.
    const Return& recent(std::size_t before) const { return ring_[(next_ + ring_.size() - 1 - before) % ring_.size()]; }
    std::size_t remembered() const { return std::min(returns_, ring_.size()); }
    /// Returns the extent of each state over the last returns; never zero.
    std::span<const double> scale() const { return scale_; }
    /// Returns the distance of two states in units of `scale`.
    double distance(std::span<const double> a, std::span<const double> b);
    /// Returns whether contacts have accumulated within the last `count` returns.
    bool has_stuck(std::size_t count) const;
    /// Returns the number of consecutive returns up to the last with the contacts of the return one period before; and
    /// the largest such number before other contacts came. @param period in returns, at most `largest`
    std::size_t alike(std::size_t period) const { return alike_[period].now; }
    std::size_t longest_alike(std::size_t period) const { return alike_[period].longest; }
    /// Returns all contacts of the last `count` returns.
    std::vector<std::uint32_t> contacts(std::size_t count) const;

    void step(const Step& step) override;
    void contact(const Contact& contact) override;
    void passage(const Passage& passage) override;
    void grazing() override;
    bool follows_derivatives() const override { return derivatives_ != nullptr; }
    bool stop() override;

private:
    void include(std::size_t state, double value);
    void include(std::span<const double> state);
    void arrive(double time, std::size_t mode, std::span<const double> state);
    void compare_contacts();
    void update_scale();
    void find_noise();
    void widen();
    std::size_t find_recurrence();
    std::size_t find_exact_recurrence();

    const SectionMap* map_;
    std::vector<StateBounds> bounds_;
    SectionMap::Workspace workspace_;
    SampleRecorder* recorder_ = nullptr;
    MotionDerivatives* derivatives_ = nullptr;
    std::vector<double> periods_, scale_, noise_, difference_, least_, greatest_, widest_, early_, lowest_, highest_;
    std::vector<Return> ring_;
    MotionParts parts_;
    Return current_;
    std::size_t next_ = 0, returns_ = 0, stop_after_ = 0, largest_ = 0, recurrent_ = 0;
    std::size_t last_stuck_ = 0; ///< last return with an accumulation of contacts, counted from 1
    std::vector<double>* thresholds_ = nullptr;
    double leg_start_ = 0, shortest_ = 0, pending_time_ = 0;
    bool any_steps_ = false;
    bool pending_ = false, stop_ = false, escaped_ = false, stuck_ = false, paused_ = false, rest_ = false;
    std::size_t steps_ = 0, next_check_ = 0; ///< steps since the last return, and at the next examination
    struct Alike {
        std::size_t now = 0, longest = 0;
    };
    std::vector<Alike> alike_; ///< for each period
};

} // namespace graze
