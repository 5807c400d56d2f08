#include "graze/base/input_error.hpp"
#include "graze/orbit/solve.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "orbit/certify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace graze {

namespace {

std::vector<Probe> probes_of(const Model& model, const Signature& signature) {
    std::vector<Probe> probes;
    for (std::size_t s = 0; s < model.sections.size(); ++s)
        if (std::any_of(signature.begin(), signature.end(),
                        [&](const Segment& one) { return one.end == SegmentEnd::section && one.index == s; }))
            probes.push_back(section_probe(model, model.sections[s].name));
    return probes;
}

/// Follows a motion and tries each piece of it that has the signature as a first guess.
class SignatureSearch : public Observer {
public:
    SignatureSearch(const System& system, const Signature& wanted, const OrbitOptions& options,
                    const Simulation& simulation, const SignatureSearchOptions& search)
        : system_(system), wanted_(&wanted), options_(options), simulation_(simulation), search_(&search) {
        const Model& model = system.model();
        for (std::size_t s = 0; s < model.sections.size(); ++s)
            for (const Segment& one : wanted)
                if (one.end == SegmentEnd::section && one.index == s) {
                    section_of_probe_.push_back(s);
                    break;
                }
        entries_.push_back({0, {}, model.initial_state()});
    }

    void step(const Step& step) override {
        ++steps_;
        followed_time_ = time_ = step.start;
    }
    void contact(const Contact& contact) override {
        if (contact.kind == ContactKind::touch)
            return;
        if (contact.kind == ContactKind::sticking) {
            problem_ = fmt::format("contacts at '{}' accumulate at time {:.9g}",
                                   system_.model().events[contact.event].name, contact.time);
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
        return problem_.empty()
                   ? fmt::format("{} segments in a time of {:.6g} were looked at", entries_.size() - 1, followed_time_)
                   : problem_;
    }

private:
    /// The end of a segment and the state just after it.
    struct Entry {
        double time;
        Segment segment;
        std::vector<double> state;
    };

    bool is_wanted(const Segment& segment) const {
        return std::find(wanted_->begin(), wanted_->end(), segment) != wanted_->end();
    }
    /// Inserts an entry in the order of time: contacts and passages within a step arrive separately.
    void note(double time, const Segment& segment, std::span<const double> state) {
        auto place = entries_.end();
        while (place > entries_.begin() + 1 && (place - 1)->time > time)
            --place;
        entries_.insert(place, {time, segment, {state.begin(), state.end()}});
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
    std::vector<Entry> entries_;
    std::optional<OrbitSolution> found_, unphysical_, failed_;
    std::size_t steps_ = 0, trials_ = 0, next_ = 0;
    double time_ = 0, followed_time_ = 0;
    bool interrupted_ = false;
    std::string problem_;
};

} // namespace

std::optional<OrbitSolution> orbit_with_signature(const System& system, const Signature& signature,
                                                  const OrbitOptions& options, const SimulationOptions& simulation,
                                                  const SignatureSearchOptions& search) {
    const Model& model = system.model();
    constexpr double forever = 1e300;
    options.validate();
    validate_signature(model, signature);
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
