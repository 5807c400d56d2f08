#pragma once

#include "sweep/field_map.hpp"
#include "sweep/return_watcher.hpp"

#include <span>
#include <vector>

namespace graze {

/// Tells motions that grow for ever from chaotic ones, whose neighbours part too.
class GrowthWatch {
public:
    GrowthWatch(const FieldMap& field, const SectionMap& map) : field_(&field), map_(&map) {}

    void begin(std::span<const double> parameters, std::span<const double> periods);
    /// Takes the extent over the last return as that from which `outward` counts.
    void mark(const ReturnWatcher& motion);
    /// Logarithm of the growth of the motion's extent since the mark.
    double outward(const ReturnWatcher& motion) const;
    /// Logarithm of the growth from the extent at the beginning to the largest so far, of the state that has grown
    /// most.
    double since_start(const ReturnWatcher& motion) const { return ratio(motion.widest(), motion.early()); }
    /// Whether the motion has outgrown whatever a model may hold: by 60 decades, up to numbers as large. From next to
    /// nothing, as many lead to an ordinary size.
    bool outgrows_everything(const ReturnWatcher& motion) const;
    /// Whether the motion has become larger from return to return, without contacts, in a field that is the same on all
    /// larger scales, where it will meet no event.
    bool goes_on(const ReturnWatcher& motion);
    /// The same from one part of all returns to the next: of motions that are slow beside the section's clock, and
    /// whose neighbours are known to part.
    bool goes_on_slowly(const ReturnWatcher& motion);
    /// Whether neighbours have obeyed a linear equation for so many returns, up to the last: in a field that is linear
    /// but for clocks, and without contacts. They may part, but no such motion is chaotic: either it grows as they
    /// part, or it lies on the plane along which nothing does.
    bool is_linear(const ReturnWatcher& motion, std::size_t returns) const;
    /// The same as `goes_on`, of a motion that is at this state and does not come back to the section.
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
