#include "branch/inserted_contact.hpp"

#include "graze/orbit/solve.hpp"

#include <algorithm>

namespace graze {

namespace {

struct Entry {
    Segment segment;
    std::vector<double> start;
    double duration;
};

/// Returns the segments of an orbit twice, the second time as images for a half orbit.
std::vector<Entry> two_rounds(const System& system, const Orbit& orbit) {
    std::vector<Entry> entries;
    for (std::size_t k = 0; k < orbit.segments(); ++k)
        entries.push_back({orbit.signature[k], orbit.starts[k], orbit.durations[k]});
    const Function map = orbit.symmetry ? system.symmetry(*orbit.symmetry).map : Function();
    for (std::size_t k = 0; k < orbit.segments(); ++k) {
        Entry entry = entries[k];
        if (orbit.symmetry) {
            entry.segment = image_of(system, *orbit.symmetry, entry.segment, orbit);
            entry.start.insert(entry.start.end(), orbit.parameters.begin(), orbit.parameters.end());
            entry.start = map(entry.start);
        }
        entries.push_back(std::move(entry));
    }
    return entries;
}

/// Merges each segment that no event ends with the following one.
Orbit joined(const Orbit& like, const std::vector<Entry>& entries) {
    Orbit orbit{{}, like.parameters, {}, {}, like.symmetry};
    bool continues = false;
    for (const Entry& entry : entries) {
        if (!continues) {
            append(orbit, entry.segment, entry.start, entry.duration);
        } else {
            orbit.signature.back() = entry.segment;
            orbit.durations.back() += entry.duration;
        }
        continues = entry.segment.end != SegmentEnd::event;
    }
    return orbit;
}

} // namespace

std::optional<Orbit> with_contact_inserted(const Simulation& simulation, const SpecialPoint& point,
                                           const std::vector<double>& after, std::size_t mode, const Segment& last) {
    const Orbit& grazing = point.solution.orbit;
    const std::vector<Entry> rounds = two_rounds(simulation.system(), grazing);
    const std::size_t touching = point.segment, count = grazing.segments();
    double left = grazing.durations[touching] - point.time;
    std::vector<Entry> entries;
    std::vector<double> start = after;
    if (mode != grazing.signature[touching].mode) {
        const FollowedMotion motion = follow_motion(simulation, grazing.parameters, after, mode, grazing.return_time());
        std::size_t back = 1;
        while (back < motion.segments.size() && motion.segments[back].mode != grazing.signature[touching].mode)
            ++back;
        if (back >= motion.segments.size())
            return std::nullopt;
        for (std::size_t k = 0; k < back; ++k) {
            entries.push_back({motion.segments[k], motion.starts[k], motion.durations[k]});
            left -= motion.durations[k];
        }
        start = motion.starts[back];
    }
    if (left < 0)
        return std::nullopt;
    entries.push_back({rounds[touching].segment, start, left});
    for (std::size_t k = touching + 1; k <= touching + count; ++k)
        entries.push_back(rounds[k]);
    entries.back().segment = last;
    entries.back().duration = point.time;
    return joined(grazing, entries);
}

Orbit begun_after_first_contact(const System& system, const Orbit& like, const FollowedMotion& motion, double period) {
    Orbit orbit{{}, like.parameters, {}, {}, like.symmetry};
    const std::size_t count = motion.segments.size();
    double known = 0;
    for (std::size_t k = 1; k < count; ++k) {
        append(orbit, motion.segments[k], motion.starts[k], motion.durations[k]);
        known += motion.durations[k];
    }
    const Segment& first = motion.segments[0];
    append(orbit, like.symmetry ? image_of(system, *like.symmetry, first, like) : first, motion.starts[count],
           period - known);
    return orbit;
}

} // namespace graze
