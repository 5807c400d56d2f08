#include "branch/inserted_contact.hpp"

#include "base/concatenated.hpp"
#include "branch/other_branch.hpp"

namespace graze {

namespace {

/// Returns an orbit traversed twice, the second time as images for a half orbit.
Orbit two_rounds(const System& system, const Orbit& orbit) {
    Orbit result = twice(orbit);
    const std::size_t count = orbit.segments();
    for (std::size_t k = 0; orbit.symmetry && k < count; ++k) {
        std::vector<double>& start = result.starts[count + k];
        start = system.symmetry(*orbit.symmetry).map(concatenated(start, orbit.parameters));
        result.signature[count + k] = image_of(system, *orbit.symmetry, orbit.signature[k], orbit);
    }
    return result;
}

/// Merges each segment that no event ends with the following one.
Orbit joined_pieces(const Orbit& pieces) {
    Orbit orbit{{}, pieces.parameters, {}, {}, pieces.symmetry};
    for (std::size_t k = 0; k < pieces.segments(); ++k)
        if (k == 0 || ends_by_transition(pieces.signature[k - 1])) {
            append(orbit, pieces.signature[k], pieces.starts[k], pieces.durations[k]);
        } else {
            orbit.signature.back() = pieces.signature[k];
            orbit.durations.back() += pieces.durations[k];
        }
    return orbit;
}

} // namespace

std::optional<Orbit> with_contact_inserted(const Simulation& simulation, const SpecialPoint& point,
                                           const std::vector<double>& after, std::size_t mode, const Segment& last) {
    const Orbit& grazing = point.solution.orbit;
    const Orbit rounds = two_rounds(simulation.system(), grazing);
    const std::size_t touching = point.segment, count = grazing.segments();
    double left = grazing.durations[touching] - point.time;
    Orbit orbit{{}, grazing.parameters, {}, {}, grazing.symmetry};
    std::vector<double> start = after;
    if (mode != grazing.signature[touching].mode) {
        const FollowedMotion motion = follow_motion(simulation, grazing.parameters, after, mode, grazing.return_time());
        std::size_t back = 1;
        while (back < motion.segments.size() && motion.segments[back].mode != grazing.signature[touching].mode)
            ++back;
        if (back >= motion.segments.size())
            return std::nullopt;
        for (std::size_t k = 0; k < back; ++k) {
            append(orbit, motion.segments[k], motion.starts[k], motion.durations[k]);
            left -= motion.durations[k];
        }
        start = motion.starts[back];
    }
    if (left < 0)
        return std::nullopt;
    append(orbit, rounds.signature[touching], start, left);
    for (std::size_t k = touching + 1; k <= touching + count; ++k)
        append(orbit, rounds.signature[k], rounds.starts[k], rounds.durations[k]);
    orbit.signature.back() = last;
    orbit.durations.back() = point.time;
    return joined_pieces(orbit);
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
