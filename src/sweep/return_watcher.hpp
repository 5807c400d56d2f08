#pragma once

#include "graze/sweep/attractor.hpp"
#include "graze/trajectory/observer.hpp"
#include "sweep/motion_derivatives.hpp"
#include "sweep/motion_parts.hpp"
#include "sweep/sample_recorder.hpp"
#include "sweep/section_map.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace graze {

/// A passage of the section, with what happened since the one before.
struct Return {
    double time = 0;
    std::size_t mode = 0;
    std::vector<double> state, least, greatest; ///< extent of the states since the return before
    std::vector<std::uint32_t> contacts;        ///< 2 * transition, plus 1 where contacts accumulated
};

/// Follows a trajectory from return to return, and stops it where it is told to.
class ReturnWatcher : public Observer {
public:
    /// @param kept how many of the last returns are remembered; @param bounds of states, may be empty
    ReturnWatcher(const SectionMap& map, std::size_t kept, std::vector<StateBounds> bounds);

    /// @param recorder also sees what happens; may be null
    void begin(std::span<const double> parameters, std::span<const double> periods, SampleRecorder* recorder);
    /// A trajectory starts at this time: returns that come sooner than `shortest` are the start itself.
    void start_leg(double time, double shortest);
    void stop_after(std::size_t returns) { stop_after_ = returns; }
    /// From now on these see what happens too, with marks at returns; null: none.
    void follow(MotionDerivatives* derivatives) { derivatives_ = derivatives; }
    /// Whether to stop at returns that come this close to one of the last `largest` (in the measure of `scale`); or
    /// that are where one before was, after contacts have accumulated: motions that have forgotten all they were repeat
    /// themselves exactly, whatever their period. @param thresholds for each return that is remembered
    void watch_recurrence(std::vector<double>* thresholds, std::size_t largest) {
        thresholds_ = thresholds;
        largest_ = largest;
    }

    std::size_t returns() const { return returns_; }
    bool escaped() const { return escaped_; }
    /// Whether it stopped because no return would come.
    bool stuck() const { return stuck_; }
    /// However many steps a return may take: its time is bounded otherwise.
    void allow_any_steps(bool any) { any_steps_ = any; }
    /// Whether to stop, every now and then, where no return comes.
    void watch_rest(bool rest) { rest_ = rest; }
    /// Whether it stopped to be looked at, since no return has come for long.
    bool looking() const { return looking_; }
    /// Largest extent of each state between any two returns so far.
    std::span<const double> widest() const { return widest_; }
    /// Extent of each state over all returns so far.
    double range(std::size_t state) const { return highest_[state] - lowest_[state]; }
    double lowest(std::size_t state) const { return lowest_[state]; }
    /// Extent of each state at the beginning: up to the second return, or until it was first looked at.
    std::span<const double> early() const { return early_; }
    /// What comes is a beginning: the motion has been displaced.
    void begin_anew() { early_.clear(); }
    /// All returns so far, in a few parts.
    const MotionParts& parts() const { return parts_; }
    /// Between which values the states were since the return before that one, that return included: in long steps it is
    /// all that is known of what came between.
    MotionPart part(std::size_t before) const;
    /// Period at whose return it stopped; 0: none.
    std::size_t recurrent() const { return recurrent_; }
    /// Whether that is longer than those that are looked for, of a motion that repeats itself exactly.
    bool recurs_exactly() const { return recurrent_ > largest_; }
    /// The return `before` returns before the last.
    const Return& recent(std::size_t before) const { return ring_[(next_ + ring_.size() - 1 - before) % ring_.size()]; }
    std::size_t remembered() const { return std::min(returns_, ring_.size()); }
    /// Extent of each state over the last returns; never zero.
    std::span<const double> scale() const { return scale_; }
    /// Distance of two states in that measure.
    double distance(std::span<const double> a, std::span<const double> b);
    /// Whether contacts have accumulated within the last `count` returns.
    bool has_stuck(std::size_t count) const;
    /// How many returns in a row, up to the last, have had the contacts of the return one period before; and the most
    /// before others came. @param period in returns, of those that are watched for recurrence
    std::size_t alike(std::size_t period) const { return alike_[period].now; }
    std::size_t longest_alike(std::size_t period) const { return alike_[period].longest; }
    /// All contacts of the last `count` returns.
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
    void check_bounds(std::span<const double> state);

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
    std::size_t last_stuck_ = 0; ///< return at which contacts had accumulated, counted from 1
    std::vector<double>* thresholds_ = nullptr;
    double leg_start_ = 0, shortest_ = 0, pending_time_ = 0;
    bool any_steps_ = false;
    bool pending_ = false, stop_ = false, escaped_ = false, stuck_ = false, looking_ = false, rest_ = false;
    std::size_t steps_ = 0, next_look_ = 0; ///< since the last return
    struct Alike {
        std::size_t now = 0, longest = 0;
    };
    std::vector<Alike> alike_; ///< for each period
};

} // namespace graze
