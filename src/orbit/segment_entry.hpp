#pragma once

#include "graze/orbit/signature.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace graze {

/// The end of a segment of a motion and the state just after it.
struct SegmentEntry {
    double time;
    Segment segment;
    std::vector<double> state;
};

/// Inserts an entry in the order of time: contacts and passages within a step arrive separately. @param first number of
/// entries that stay before all others
inline void insert_by_time(std::vector<SegmentEntry>& entries, SegmentEntry entry, std::ptrdiff_t first = 0) {
    auto place = entries.end();
    while (place > entries.begin() + first && (place - 1)->time > entry.time)
        --place;
    entries.insert(place, std::move(entry));
}

} // namespace graze
