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
    /// Whether the motion has become larger from return to return, without contacts, in a field that is the same on all
    /// larger scales.
    bool goes_on(const ReturnWatcher& motion);
    /// The same, of a motion that does not come back to the section.
    bool goes_on(std::span<const double> state, std::size_t mode, std::span<const double> extents);

private:
    std::vector<double> extents(const Return& one) const;
    double ratio(std::span<const double> now, std::span<const double> before) const;

    const FieldMap* field_;
    const SectionMap* map_;
    FieldMap::Workspace workspace_;
    std::vector<double> periods_, mark_;
};

} // namespace graze
