#pragma once

#include "sweep/field_map.hpp"
#include "sweep/return_watcher.hpp"

namespace graze {

/// Distinguishes motions that grow forever from chaotic ones; in both, neighbouring motions separate.
class GrowthWatch {
public:
    GrowthWatch(const FieldMap& field, const SectionMap& map) : field_(&field), map_(&map) {}

    void begin(std::span<const double> parameters, std::span<const double> periods);
    /// Sets the reference of `outward`: the extent over the last return.
    void mark(const ReturnWatcher& motion);
    /// Returns the logarithm of the growth of the motion's extent since the mark.
    double outward(const ReturnWatcher& motion) const;
    /// Returns the logarithm of the growth from the initial extent to the largest so far, of the state that has grown
    /// most.
    double since_start(const ReturnWatcher& motion) const { return ratio(motion.widest(), motion.early()); }
    /// Returns whether the motion has grown by 60 decades and to numbers as large, beyond any structure of a model.
    /// (From a tiny start, 60 decades may lead to an ordinary size.)
    bool outgrows_everything(const ReturnWatcher& motion) const;
    /// Returns whether the motion has grown from return to return, without contacts, in a field that is the same on all
    /// larger scales and has no event ahead.
    bool goes_on(const ReturnWatcher& motion);
    /// The same from one part of all returns to the next: for motions that are slow relative to the section's clock,
    /// whose neighbours are known to separate.
    bool goes_on_slowly(const ReturnWatcher& motion);
    /// Returns whether neighbouring motions have obeyed a linear equation for this number of returns up to the last:
    /// the field is linear except for clocks, and there were no contacts. Even if they separate, such a motion is not
    /// chaotic: either it grows itself, or it lies on an invariant plane without growth.
    bool is_linear(const ReturnWatcher& motion, std::size_t returns) const;
    /// The same as `goes_on`, for a motion at this state that does not return to the section.
    bool goes_on(const ReturnWatcher& motion, std::span<const double> state, std::size_t mode);

private:
    bool leads_outward(const ReturnWatcher& motion, const MotionPart& newest, const MotionPart& oldest);
    bool meets_no_event(std::size_t mode, const MotionPart& now, std::span<const double> down,
                        std::span<const double> up);
    std::vector<double> extents(const MotionPart& one) const;
    double ratio(std::span<const double> now, std::span<const double> before) const;

    const FieldMap* field_;
    const SectionMap* map_;
    FieldMap::Workspace workspace_;
    std::vector<double> periods_, mark_;
};

} // namespace graze
