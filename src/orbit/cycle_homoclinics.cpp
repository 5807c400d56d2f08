#include "orbit/cycle_homoclinics.hpp"

#include "graze/base/input_error.hpp"
#include "orbit/cut.hpp"
#include "orbit/manifold_motion.hpp"
#include "orbit/newton.hpp"
#include "orbit/shooting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Largest distance from the cycle at which orbits are enclosed no longer and solved for, in units of its own and the
/// motions' extents; number of motions per fundamental domain, and of turns after those beside the cycle.
constexpr double near = 0.3;
constexpr int motions_per_domain = 64, further_turns = 20;

/// Two motions between which one is homoclinic if it is so near the cycle after this number of segments.
struct Enclosure {
    ManifoldMotion low, high;
    std::size_t segments = 0;
};

bool begin_alike(const ManifoldMotion& one, const ManifoldMotion& other, std::size_t segments) {
    const Signature &a = one.orbit.signature, &b = other.orbit.signature;
    const auto count = static_cast<std::ptrdiff_t>(segments);
    return a.size() >= segments && b.size() >= segments && std::equal(a.begin(), a.begin() + count, b.begin());
}

/// Merges the segments beside each contact away from the cycle with the neighbours that sections end: there the contact
/// may pass a section as parameters change, which is nothing to the motion. One turn stays at either end.
void merge_beside_contacts(Orbit& orbit) {
    const std::size_t turn = orbit.cycle.value();
    const auto is_section = [&](std::size_t s) { return orbit.signature[s].end == SegmentEnd::section; };
    const auto merge_with_next = [&](std::size_t s) {
        const auto place = static_cast<std::ptrdiff_t>(s);
        orbit.durations[s] += orbit.durations[s + 1];
        orbit.signature.erase(orbit.signature.begin() + place);
        orbit.starts.erase(orbit.starts.begin() + place + 1);
        orbit.durations.erase(orbit.durations.begin() + place + 1);
    };
    for (std::size_t s = turn; s + 1 < orbit.segments(); ++s) {
        if (is_section(s) || s + turn >= orbit.segments())
            continue;
        if (s > turn && is_section(s - 1))
            merge_with_next(--s);
        if (s + 2 + turn < orbit.segments() && is_section(s + 1) && is_section(s + 2))
            merge_with_next(s + 1);
    }
}

class HomoclinicSearch {
public:
    HomoclinicSearch(const System& system, const Orbit& cycle, const OrbitOptions& options,
                     const std::function<bool()>& interrupted)
        : system_(&system), simulation_(system, {}, {}, integration(options.tolerance)), options_(options),
          interrupted_(&interrupted), cycle_(simulation_, cycle, {}) {}

    std::vector<OrbitSolution> find() {
        if (!cycle_.follow(cycle_.orbit().parameters))
            throw InputError("no orbit is homoclinic to this one: " + cycle_.problem(),
                             "choose an unstable orbit with one multiplier outside the unit circle, a real one");
        // Sizes of the motions are not known at first: the cycle's scales are a guess.
        follow_domain();
        set_scales();
        follow_domain();
        std::vector<OrbitSolution> found;
        for (const std::vector<ManifoldMotion>& side : sides_)
            search(side, found);
        if (found.empty() && !is_interrupted())
            throw InputError(
                fmt::format("no orbit that is homoclinic to the cycle was found within {} turns beside those in which "
                            "it leaves the cycle; its unstable multiplier is {:.6g}",
                            further_turns, cycle_.unstable_multiplier()),
                "begin at other parameters: manifolds may not cross here, or only touch");
        return found;
    }

private:
    bool is_interrupted() const { return *interrupted_ && (*interrupted_)(); }

    /// Follows motions from one fundamental domain on either side; where the multiplier is negative they alternate, and
    /// one domain contains both sides.
    void follow_domain() {
        const double multiplier = cycle_.unstable_multiplier(), growth = cycle_.growth();
        const double begin = cycle_.wanted_distances().departure;
        const double domain = multiplier > 0 ? growth : 2 * growth;
        const int turns = static_cast<int>(std::ceil((domain - std::log(begin)) / growth)) + further_turns;
        ManifoldFollower follower(*system_, cycle_, options_.tolerance, turns * cycle_.orbit().period());
        sides_.clear();
        for (const double side : {1.0, -1.0}) {
            if (side < 0 && multiplier < 0)
                break;
            sides_.emplace_back();
            for (int i = 0; i <= motions_per_domain && !is_interrupted(); ++i)
                sides_.back().push_back(follower.follow(side * begin * std::exp(-domain * i / motions_per_domain)));
        }
        follower_.emplace(std::move(follower));
    }

    /// Measures distances by the extents of the motions up to where they begin to come back, since they may escape
    /// afterwards. Of different extents the narrowest count.
    void set_scales() {
        constexpr double least_share = 1e-6;
        double least = std::numeric_limits<double>::infinity();
        Eigen::VectorXd narrowest = cycle_.scales();
        for (const std::vector<ManifoldMotion>& side : sides_)
            for (const ManifoldMotion& motion : side) {
                const auto extent = extent_before_return(motion);
                if (extent && cycle_.length_of(*extent) < least) {
                    least = cycle_.length_of(*extent);
                    // A state that stays at the cycle's start, such as a phase, keeps its scale.
                    narrowest =
                        (extent->array() > least_share * cycle_.scales().array()).select(*extent, cycle_.scales());
                }
            }
        cycle_.set_scales(narrowest);
    }

    /// Returns the largest distances of the states from the cycle's start, up to where the unstable coordinate begins
    /// to fall; empty where it does not.
    std::optional<Eigen::VectorXd> extent_before_return(const ManifoldMotion& motion) const {
        Eigen::VectorXd extent = Eigen::VectorXd::Zero(cycle_.scales().size());
        double before = 0;
        for (std::size_t k = 0; k <= motion.segments(); ++k) {
            extent = extent.cwiseMax(cycle_.from_cycle(motion.orbit.starts[k]).cwiseAbs());
            if (k > 0 && !follower_->may_pass(motion, k))
                continue;
            if (const double here = std::abs(unstable_coordinate(motion, k)); here < before)
                return extent;
            else
                before = here;
        }
        return std::nullopt;
    }

    double unstable_coordinate(const ManifoldMotion& motion, std::size_t segments) const {
        return cycle_.unstable_coordinate().dot(cycle_.from_cycle(motion.orbit.starts[segments]));
    }
    double stable_distance(const ManifoldMotion& motion, std::size_t segments) const {
        const Eigen::VectorXd off = cycle_.from_cycle(motion.orbit.starts[segments]);
        return cycle_.length_of(off - cycle_.unstable_direction() * cycle_.unstable_coordinate().dot(off));
    }
    /// True when the signs of the unstable coordinate differ after equal segments, the last of which may pass the
    /// cycle's start.
    bool enclose(const ManifoldMotion& low, const ManifoldMotion& high, std::size_t segments) const {
        return begin_alike(low, high, segments) && follower_->may_pass(low, segments) &&
               follower_->may_pass(high, segments) &&
               unstable_coordinate(low, segments) * unstable_coordinate(high, segments) < 0;
    }

    /// Searches the motions of one side, for the orbits that come back after the fewest turns. They come in pairs, of
    /// which one may come back a turn later.
    void search(const std::vector<ManifoldMotion>& side, std::vector<OrbitSolution>& found) {
        constexpr int most_trials = 200;
        std::size_t longest = 0;
        for (const ManifoldMotion& motion : side)
            longest = std::max(longest, motion.segments());
        std::vector<bool> done(side.size(), false);
        const std::size_t before = found.size();
        std::size_t last = longest;
        int trials = 0;
        for (std::size_t k = cycle_.segments(); k < last && found.size() < before + 2; ++k)
            for (std::size_t i = 0; i + 1 < side.size() && trials < most_trials && !is_interrupted(); ++i) {
                if (done[i] || !enclose(side[i], side[i + 1], k))
                    continue;
                ++trials;
                auto orbit = solution_in({side[i], side[i + 1], k});
                if (!orbit)
                    continue;
                done[i] = true;
                last = std::min(last, k + cycle_.segments() + 1);
                found.push_back(std::move(*orbit));
            }
    }

    /// Returns the homoclinic orbit in an enclosure; empty if the motions between have different segments, or do not
    /// approach the cycle.
    std::optional<OrbitSolution> solution_in(Enclosure enclosure) {
        const EndDistances wanted = cycle_.wanted_distances();
        std::optional<ManifoldMotion> middle;
        for (;;) {
            const double at = 0.5 * (enclosure.low.beginning + enclosure.high.beginning);
            if (at == enclosure.low.beginning || at == enclosure.high.beginning)
                break;
            ManifoldMotion next = follower_->follow(at);
            if (!begin_alike(next, enclosure.low, enclosure.segments) || !follower_->may_pass(next, enclosure.segments))
                break;
            middle = std::move(next);
            const bool low = unstable_coordinate(*middle, enclosure.segments) *
                                 unstable_coordinate(enclosure.low, enclosure.segments) >
                             0;
            (low ? enclosure.low : enclosure.high) = *middle;
            if (go_on(enclosure) && stable_distance(enclosure.low, enclosure.segments) < wanted.approach)
                break;
        }
        if (!middle || enclosure.segments >= enclosure.low.orbit.starts.size() ||
            !(stable_distance(enclosure.low, enclosure.segments) < near))
            return std::nullopt;
        return solved(enclosure);
    }

    /// Encloses the orbit a turn later as long as the motions are far nearer to the stable space than to the cycle.
    /// @return true when they are so
    bool go_on(Enclosure& enclosure) const {
        constexpr double nearer = 0.3;
        const auto is_narrow = [&] {
            const double distance = stable_distance(enclosure.low, enclosure.segments);
            return distance < near &&
                   std::abs(unstable_coordinate(enclosure.low, enclosure.segments)) < nearer * distance &&
                   std::abs(unstable_coordinate(enclosure.high, enclosure.segments)) < nearer * distance;
        };
        while (is_narrow()) {
            const std::size_t later = enclosure.segments + cycle_.segments();
            if (!enclose(enclosure.low, enclosure.high, later) ||
                !(stable_distance(enclosure.low, later) < stable_distance(enclosure.low, enclosure.segments)))
                return true;
            enclosure.segments = later;
        }
        return false;
    }

    std::optional<OrbitSolution> solved(const Enclosure& enclosure) {
        constexpr int most_rounds = 4;
        constexpr double farthest = 10, share = 0.05;
        const auto count = static_cast<std::ptrdiff_t>(enclosure.segments);
        Orbit orbit = enclosure.low.orbit;
        orbit.signature.resize(enclosure.segments);
        orbit.durations.resize(enclosure.segments);
        const std::vector<double> end = orbit.starts[enclosure.segments];
        orbit.starts.erase(orbit.starts.begin() + count, orbit.starts.end());
        // One turn beside the cycle after it has come back.
        const SaddleCycle::Turn turn = cycle_.turn_from(cycle_.from_cycle(end));
        const Signature& signature = cycle_.orbit().signature;
        orbit.signature.insert(orbit.signature.end(), signature.begin(), signature.end());
        orbit.starts.insert(orbit.starts.end(), turn.starts.begin(), turn.starts.end());
        orbit.durations.insert(orbit.durations.end(), turn.durations.begin(), turn.durations.end());
        if (!std::equal(signature.begin(), signature.end(), orbit.signature.begin()))
            return std::nullopt;
        orbit.cycle = cycle_.segments();
        if (std::ranges::all_of(signature, [](const Segment& one) { return one.end == SegmentEnd::section; }))
            merge_beside_contacts(orbit);
        for (int round = 0; round < most_rounds; ++round) {
            OrbitSolution solution = solve_orbit(*system_, orbit, options_);
            if (solution.outcome != OrbitOutcome::converged || !solution.certificate.admissible)
                return std::nullopt;
            Shooting equations(simulation_, solution.orbit, {});
            OrbitEvaluation at = equations.evaluation();
            if (!equations.evaluate(equations.unknowns_of(solution.orbit), at))
                return std::nullopt;
            const CycleEnds& ends = *equations.cycle_ends();
            const EndDistances is = ends.distances(solution.orbit.starts.front(), at.pieces.back().after);
            const double extent = excursion(solution.orbit);
            if (!(is.departure < share * farthest * extent) || !(is.approach < share * farthest * extent))
                return std::nullopt;
            if (!turns_need_renewal(ends, solution.orbit, at.pieces.back().after))
                return solution;
            orbit = with_suitable_turns(ends, solution.orbit, at.pieces.back().after).orbit;
        }
        return std::nullopt;
    }

    /// The largest distance from the cycle's start, in units of the extents: a solution all along the cycle is none.
    double excursion(const Orbit& orbit) const {
        double largest = 0;
        for (const std::vector<double>& start : orbit.starts)
            largest = std::max(largest, cycle_.length_of(cycle_.from_cycle(start)));
        return std::min(largest, 1.0);
    }

    const System* system_;
    Simulation simulation_;
    OrbitOptions options_;
    const std::function<bool()>* interrupted_;
    SaddleCycle cycle_;
    std::optional<ManifoldFollower> follower_;
    std::vector<std::vector<ManifoldMotion>> sides_;
};

/// The orbit with segments that the model's own motion has: between contacts, or passages of a section.
Orbit with_model_segments(const System& system, const Orbit& orbit) {
    const Orbit whole = whole_orbit(system, orbit);
    if (std::ranges::none_of(whole.signature, [](const Segment& one) { return one.end == SegmentEnd::cut; }))
        return whole;
    auto closed = close_at_section(system, whole.parameters, whole.starts.front(), whole.signature.front().mode,
                                   whole.period(), "", std::nullopt);
    if (!closed)
        throw InputError("the cycle passes none of the model's sections", "declare one that it passes");
    closed->parameters = whole.parameters;
    return *closed;
}

} // namespace

std::vector<OrbitSolution> homoclinic_orbits(const System& system, const Orbit& cycle, const OrbitOptions& options,
                                             const std::function<bool()>& interrupted) {
    options.validate();
    validate_orbit(system.model(), cycle);
    if (is_rest(cycle.signature) || is_homoclinic(cycle.signature) || cycle.cycle)
        throw InputError("orbits are homoclinic to a periodic orbit", "begin at an unstable orbit of a branch");
    const Orbit whole = with_model_segments(system, cycle);
    if (std::ranges::any_of(whole.signature, [](const Segment& one) { return one.end == SegmentEnd::chatter; }))
        throw InputError("orbits that are homoclinic to a cycle with complete chatter are not found",
                         "choose another cycle");
    return HomoclinicSearch(system, whole, options, interrupted).find();
}

} // namespace graze
