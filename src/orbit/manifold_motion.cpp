#include "orbit/manifold_motion.hpp"

#include "graze/orbit/solve.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "orbit/certify.hpp"
#include "orbit/newton.hpp"
#include "orbit/sections_of.hpp"
#include "orbit/segment_entry.hpp"

#include <algorithm>

namespace graze {

namespace {

/// Divides a motion into segments.
class Divider : public Observer {
public:
    Divider(const System& system, const Signature& cycle, const std::vector<std::size_t>& sections)
        : system_(&system), cycle_(&cycle), sections_(&sections) {}

    void contact(const Contact& contact) override {
        if (contact.kind == ContactKind::touch)
            return;
        if (contact.kind == ContactKind::sticking) { // the motions beyond are of another kind
            ends_ = true;
            return;
        }
        const Segment segment{contact.mode_before, SegmentEnd::event, contact.transition};
        if (is_of_cycle(segment) || !is_identity_transition(*system_, contact.transition))
            note(contact.time, segment, contact.after);
    }
    void passage(const Passage& passage) override {
        const Segment segment{passage.mode, SegmentEnd::section, (*sections_)[passage.probe]};
        if (is_of_cycle(segment))
            note(passage.time, segment, passage.state);
    }
    bool stop() override { return ends_ || passed_.size() >= most_segments; }

    /// Appends the segments to those of an orbit. @param before time before the motion
    void append_to(Orbit& orbit, double before) const {
        double last = -before;
        for (const SegmentEntry& one : passed_) {
            orbit.signature.push_back(one.segment);
            orbit.durations.push_back(one.time - last);
            orbit.starts.push_back(one.state);
            last = one.time;
        }
    }

private:
    static constexpr std::size_t most_segments = 20000;
    bool is_of_cycle(const Segment& segment) const {
        return std::find(cycle_->begin(), cycle_->end(), segment) != cycle_->end();
    }
    void note(double time, const Segment& segment, std::span<const double> state) {
        insert_by_time(passed_, {time, segment, {state.begin(), state.end()}});
    }

    const System* system_;
    const Signature* cycle_;
    const std::vector<std::size_t>* sections_;
    std::vector<SegmentEntry> passed_;
    bool ends_ = false;
};

} // namespace

ManifoldFollower::ManifoldFollower(const System& system, const SaddleCycle& cycle, double tolerance, double longest)
    : cycle_(&cycle), sections_(sections_of(system.model(), cycle.orbit().signature)),
      simulation_(system, probes_of(system.model(), cycle.orbit().signature), {}, integration(tolerance)),
      jets_(simulation_, LaneKind::single), flow_(flow_of(simulation_)), longest_(longest) {
    flow_.set_parameters(cycle.orbit().parameters);
}

ManifoldMotion ManifoldFollower::follow(double beginning) {
    // The first part of the first segment is followed without events: the linear space may lie on the wrong side of a
    // surface on which the cycle starts, by the square of the distance.
    constexpr double share = 0.5;
    const Orbit& cycle = cycle_->orbit();
    ManifoldMotion motion{beginning, {{}, cycle.parameters, {}, {}, std::nullopt}};
    motion.orbit.starts.push_back(numbers_of(vector_of(cycle_->state()) + beginning * cycle_->unstable_direction()));
    std::vector<double> state = motion.orbit.starts.front();
    const std::size_t mode = cycle.signature.front().mode;
    const double before = share * cycle.durations.front();
    if (flow_.run(mode, state, before) != ModeFlow::Ending::done)
        return motion;
    Divider divider(simulation_.system(), cycle.signature, sections_);
    Trajectory trajectory(simulation_, cycle.parameters, borrowed(divider));
    trajectory.start(state, mode, 0, longest_);
    run(trajectory, jets_);
    divider.append_to(motion.orbit, before);
    return motion;
}

bool ManifoldFollower::may_pass(const ManifoldMotion& motion, std::size_t segments) const {
    const Signature &own = motion.orbit.signature, &cycle = cycle_->orbit().signature;
    return segments > 0 && segments < own.size() && own[segments - 1] == cycle.back() &&
           own[segments].mode == cycle.front().mode;
}

} // namespace graze
