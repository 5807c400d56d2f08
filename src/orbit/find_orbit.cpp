#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/orbit/solve.hpp"
#include "graze/sweep/point_search.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "orbit/certify.hpp"
#include "orbit/cut.hpp"
#include "orbit/sections_of.hpp"
#include "orbit/segment_entry.hpp"
#include "orbit/solve_equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>

namespace graze {

namespace {

std::string accumulation_in_words(const Model& model, const Contact& contact, std::string_view how) {
    return fmt::format("contacts at '{}' accumulate{} at time {:.9g}", model.events[contact.event].name, how,
                       contact.time);
}
/// Contacts whose accumulation is no segment: others come in between, or they are not slower and slower.
constexpr std::string_view mixed = " together with other events";
/// Number of equal contacts before an accumulation below which it is not theirs.
constexpr std::size_t fewest_contacts = 2;

/// Records the segments of a motion.
class SegmentRecorder : public Observer {
public:
    SegmentRecorder(const System& model, FollowedMotion& motion, Accumulations accumulations)
        : model_(&model), motion_(&motion), accumulations_(accumulations) {}

    void contact(const Contact& contact) override {
        if (contact.kind == ContactKind::touch)
            return;
        if (contact.kind == ContactKind::sticking) {
            accumulate(contact);
            return;
        }
        if (is_identity_transition(*model_, contact.transition))
            return;
        motion_->segments.push_back({contact.mode_before, SegmentEnd::event, contact.transition});
        motion_->durations.push_back(contact.time - last_);
        motion_->starts.emplace_back(contact.after.begin(), contact.after.end());
        last_ = contact.time;
    }
    bool stop() override { return !motion_->problem.empty(); }

private:
    /// Makes one segment of all contacts that accumulate.
    void accumulate(const Contact& contact) {
        if (accumulations_ == Accumulations::end) {
            motion_->problem = accumulation_in_words(model_->model(), contact, "");
            return;
        }
        const Segment each{contact.mode_before, SegmentEnd::event, contact.transition};
        double duration = contact.time - last_;
        std::size_t count = 0;
        for (; !motion_->segments.empty() && motion_->segments.back() == each; ++count) {
            duration += motion_->durations.back();
            motion_->segments.pop_back();
            motion_->durations.pop_back();
            motion_->starts.pop_back();
        }
        const bool is_segment = model_->model().transitions[contact.transition].chatter.has_value();
        if (!is_segment || (count < fewest_contacts && !motion_->segments.empty())) {
            motion_->problem = accumulation_in_words(model_->model(), contact, mixed);
            return;
        }
        motion_->segments.push_back({each.mode, SegmentEnd::chatter, each.index});
        motion_->durations.push_back(duration);
        motion_->starts.emplace_back(contact.after.begin(), contact.after.end());
        last_ = contact.time;
    }

    const System* model_;
    FollowedMotion* motion_;
    Accumulations accumulations_;
    double last_ = 0;
};

/// Extracts one period from a motion that was followed for more than two and a half. The period begins after the
/// contact that is followed by the longest time without contacts, so that round-off does not decide whether the last
/// contact belongs to it.
void extract_period(const FollowedMotion& motion, double duration, Orbit& orbit) {
    std::vector<double> times;
    double time = 0;
    for (const double each : motion.durations)
        times.push_back(time += each);
    std::size_t first = 0;
    double gap = -1;
    for (std::size_t k = 0; k + 1 < times.size() && (k == 0 || times[k] < times[0] + duration); ++k)
        if (times[k + 1] - times[k] > gap) {
            gap = times[k + 1] - times[k];
            first = k;
        }
    for (std::size_t k = first + 1; k < times.size() && times[k] < times[first] + duration + 0.5 * gap; ++k) {
        orbit.signature.push_back(motion.segments[k]);
        orbit.starts.push_back(motion.starts[k]);
        orbit.durations.push_back(motion.durations[k]);
    }
}

/// Follows a motion and tries each piece of it that has the signature as a first guess.
class SignatureSearch : public Observer {
public:
    SignatureSearch(const System& system, const Signature& wanted, const OrbitOptions& options,
                    const Simulation& simulation, const SignatureSearchOptions& search)
        : system_(system), wanted_(&wanted), options_(options), simulation_(simulation), search_(&search),
          section_of_probe_(sections_of(system.model(), wanted)) {
        entries_.push_back({0, {}, system.model().initial_state()});
    }

    void step(const Step& step) override {
        ++steps_;
        followed_time_ = time_ = step.start;
    }
    void contact(const Contact& contact) override {
        if (contact.kind == ContactKind::touch)
            return;
        if (contact.kind == ContactKind::sticking) {
            accumulate(contact);
            return;
        }
        const Segment segment{contact.mode_before, SegmentEnd::event, contact.transition};
        if (is_wanted(segment) || !is_identity_transition(simulation_.system(), contact.transition))
            note(contact.time, segment, contact.after);
    }
    void passage(const Passage& passage) override {
        const Segment segment{passage.mode, SegmentEnd::section, section_of_probe_[passage.probe]};
        if (is_wanted(segment))
            note(passage.time, segment, passage.state);
        else
            elsewhere_ = segment;
    }
    bool stop() override {
        constexpr std::size_t seldom = 64;
        if (steps_ % seldom == 0 && search_->interrupted && search_->interrupted())
            interrupted_ = true;
        if (!interrupted_ && !found_)
            try_pieces();
        return interrupted_ || found_ || !problem_.empty() || steps_ >= search_->steps ||
               entries_.size() > search_->segments + wanted_->size() || trials_ >= search_->trials;
    }

    /// Tries the pieces that the last step has completed.
    void conclude(const Outcome& outcome) {
        if (interrupted_ || found_)
            return;
        if (problem_.empty() && outcome.ending != Ending::stopped)
            problem_ = fmt::format("it ends at time {:.9g}: {}{}{}", outcome.time, name_of(outcome.ending),
                                   outcome.detail.empty() ? "" : ", ", outcome.detail);
        time_ = std::numeric_limits<double>::infinity();
        try_pieces();
    }
    bool interrupted() const { return interrupted_; }
    const std::optional<OrbitSolution>& found() const { return found_; }
    const std::optional<OrbitSolution>& unphysical() const { return unphysical_; }
    const std::optional<OrbitSolution>& failed() const { return failed_; }
    /// Returns how far the motion was followed, or why it ended.
    std::string extent() const {
        if (!problem_.empty())
            return problem_;
        std::string text =
            fmt::format("{} segments in a time of {:.6g} were looked at", entries_.size() - 1, followed_time_);
        if (elsewhere_ && entries_.size() == 1) {
            const std::string section = end_name(system_.model(), *elsewhere_),
                              &mode = system_.model().modes[elsewhere_->mode].name;
            text += fmt::format(", and '{}' is passed in the mode '{}': write '{}:{}'", section, mode, mode, section);
        }
        return text;
    }

private:
    bool is_wanted(const Segment& segment) const {
        return std::find(wanted_->begin(), wanted_->end(), segment) != wanted_->end();
    }
    void note(double time, const Segment& segment, std::span<const double> state) {
        insert_by_time(entries_, {time, segment, {state.begin(), state.end()}}, 1);
    }
    /// Makes one entry of all contacts that accumulate.
    void accumulate(const Contact& contact) {
        const Segment each{contact.mode_before, SegmentEnd::event, contact.transition};
        std::size_t count = 0;
        for (; entries_.size() > 1 && entries_.back().segment == each; ++count)
            entries_.pop_back();
        const bool is_segment = system_.model().transitions[contact.transition].chatter.has_value();
        if (!is_segment || (count < fewest_contacts && entries_.size() > 1)) {
            problem_ = accumulation_in_words(system_.model(), contact, mixed);
            return;
        }
        next_ = std::min(next_, entries_.size() - 1);
        note(contact.time, {each.mode, SegmentEnd::chatter, each.index}, contact.after);
    }
    void try_pieces() {
        // Entries within the current step may be incomplete.
        for (; next_ + wanted_->size() < entries_.size() && entries_[next_ + wanted_->size()].time < time_ && !found_ &&
               trials_ < search_->trials;
             ++next_) {
            bool same = true;
            for (std::size_t k = 0; k < wanted_->size() && same; ++k)
                same = entries_[next_ + 1 + k].segment == (*wanted_)[k];
            if (same)
                try_piece();
        }
    }
    void try_piece() {
        ++trials_;
        Orbit guess{*wanted_, system_.model().parameter_values(), {}, {}, std::nullopt};
        for (std::size_t k = next_; k < next_ + wanted_->size(); ++k) {
            guess.starts.push_back(entries_[k].state);
            guess.durations.push_back(entries_[k + 1].time - entries_[k].time);
        }
        OrbitSolution solution = solve_orbit(system_, guess, options_);
        if (solution.outcome != OrbitOutcome::converged) {
            solution.orbit = guess;
            if (!failed_)
                failed_ = std::move(solution);
        } else if (!solution.certificate.admissible) {
            if (!unphysical_)
                unphysical_ = solution;
            if (search_->unphysical)
                found_ = std::move(solution);
        } else {
            found_ = std::move(solution);
        }
    }

    System system_;
    const Signature* wanted_;
    OrbitOptions options_;
    Simulation simulation_;
    const SignatureSearchOptions* search_;
    std::vector<std::size_t> section_of_probe_;
    std::vector<SegmentEntry> entries_;
    std::optional<OrbitSolution> found_, unphysical_, failed_;
    std::size_t steps_ = 0, trials_ = 0, next_ = 0;
    double time_ = 0, followed_time_ = 0;
    std::optional<Segment> elsewhere_; ///< a passage of one of the sections in another mode than the signature's
    bool interrupted_ = false;
    std::string problem_;
};

} // namespace

FollowedMotion follow_motion(const Simulation& simulation, std::span<const double> parameters,
                             std::span<const double> state, std::size_t mode, double time,
                             Accumulations accumulations) {
    require_finite(time, "the time for which a motion is followed");
    FollowedMotion motion;
    motion.starts.emplace_back(state.begin(), state.end());
    SegmentRecorder recorder(simulation.system(), motion, accumulations);
    Trajectory trajectory(simulation, parameters, borrowed(recorder));
    trajectory.start(state, mode, 0, time);
    JetSet jets(simulation, LaneKind::single);
    run(trajectory, jets);
    motion.final_state.assign(trajectory.state().begin(), trajectory.state().end());
    motion.final_mode = trajectory.mode();
    const Outcome& outcome = trajectory.outcome();
    if (motion.problem.empty() && outcome.ending != Ending::end_time && outcome.ending != Ending::stopped)
        motion.problem = fmt::format("the motion ends at time {:.9g}: {}{}{}", outcome.time, name_of(outcome.ending),
                                     outcome.detail.empty() ? "" : ", ", outcome.detail);
    return motion;
}

OrbitSolution find_orbit(const System& system, const AttractorOptions& settle, const OrbitOptions& options,
                         const SimulationOptions& simulation) {
    return *find_orbit(system, settle, options, simulation, [] { return false; });
}

std::optional<OrbitSolution> find_orbit(const System& system, const AttractorOptions& settle,
                                        const OrbitOptions& options, const SimulationOptions& simulation,
                                        const std::function<bool()>& interrupted) {
    const Model& model = system.model();
    const auto factory = attractor_searches(system, settle, {}, {}, simulation);
    const auto search = factory->make();
    search->begin(model.parameter_values(), model.initial_state(), model.initial_mode);
    JetSet jets(factory->simulation(), LaneKind::single);
    do {
        if (interrupted())
            return std::nullopt;
        run(search->trajectory(), jets);
    } while (search->proceed());
    const PointResult& result = search->result();
    // With a clock section an equilibrium returns like any orbit.
    const bool returns = result.label == Label::equilibrium && result.period > 0;
    const auto no_orbit = [&] {
        return InputError(fmt::format("the motion does not settle on a periodic orbit: it is {}{}{}",
                                      name_of(result.label), result.outcome.detail.empty() ? "" : ", ",
                                      result.outcome.detail),
                          "start elsewhere, allow more cycles or longer periods, or give the orbit's states");
    };
    if (result.label == Label::equilibrium && !returns)
        return solve_equilibrium(system, orbit_of_rest(result.mode, result.state, model.parameter_values()), options);
    if (result.label != Label::periodic && !returns)
        throw no_orbit();
    const auto followed = [&](double periods) {
        return follow_motion(factory->simulation(), model.parameter_values(), result.state, result.mode,
                             periods * result.duration, Accumulations::segments);
    };
    FollowedMotion motion = followed(2.6);
    // Contacts that have not accumulated at the end of the time would be taken for others.
    if (std::ranges::any_of(motion.segments, [](const Segment& one) { return one.end == SegmentEnd::chatter; }))
        motion = followed(3.6);
    if (!motion.problem.empty())
        throw InputError("the orbit has no signature: " + motion.problem,
                         "choose parameters at which contacts do not accumulate in this way");
    // Near an equilibrium, contacts of the motion may be due to round-off: they belong to no orbit.
    if (returns && !motion.segments.empty())
        throw no_orbit();
    Orbit orbit;
    orbit.parameters = model.parameter_values();
    if (motion.segments.empty()) {
        const auto closed = close_at_section(system, orbit.parameters, result.state, result.mode, result.duration,
                                             settle.section, std::nullopt);
        if (!closed)
            throw InputError("the orbit passes none of the model's sections", "declare one that it passes");
        orbit = *closed;
    } else {
        extract_period(motion, result.duration, orbit);
    }
    if (const auto half = half_orbit(system, orbit))
        return solve_orbit(system, *half, options);
    OrbitSolution solution = solve_orbit(system, orbit, options);
    // A transient may have hidden the symmetry of the orbit, so it is tested again after refinement.
    const auto half = solution.outcome == OrbitOutcome::converged ? half_orbit(system, solution.orbit) : std::nullopt;
    return half ? solve_orbit(system, *half, options) : solution;
}

std::optional<OrbitSolution> orbit_with_signature(const System& system, const Signature& signature,
                                                  const OrbitOptions& options, const SimulationOptions& simulation,
                                                  const SignatureSearchOptions& search) {
    const Model& model = system.model();
    constexpr double forever = 1e300;
    options.validate();
    validate_signature(model, signature);
    if (is_homoclinic(signature))
        throw InputError(
            "a homoclinic orbit takes an infinite time: no motion from the initial state has its signature",
            "follow periodic orbits up to the point HC in which their branch ends");
    const Simulation simulated(system, probes_of(model, signature), {}, simulation);
    SignatureSearch follower(system, signature, options, simulated, search);
    Trajectory trajectory(simulated, model.parameter_values(), borrowed(follower));
    trajectory.start(model.initial_state(), model.initial_mode, 0, forever);
    JetSet jets(simulated, LaneKind::single);
    run(trajectory, jets);
    follower.conclude(trajectory.outcome());
    if (follower.interrupted())
        return std::nullopt;
    if (follower.found()) {
        const auto half = half_orbit(system, follower.found()->orbit);
        return half ? solve_orbit(system, *half, options) : follower.found();
    }
    const std::string text = to_string(model, signature);
    if (follower.unphysical())
        throw InputError(fmt::format("the orbit with the signature '{}' that was found is not admissible: {}", text,
                                     follower.unphysical()->certificate.reason),
                         "begin elsewhere by `from` and `mode`, or take it all the same by `unphysical = true`");
    if (follower.failed())
        return follower.failed();
    throw InputError(
        fmt::format("the motion from the initial state does not have the signature '{}': {}", text, follower.extent()),
        "begin elsewhere by `from` and `mode`, or give a table of the motion");
}

} // namespace graze
