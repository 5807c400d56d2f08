#include "graze/grazing/trial.hpp"

#include "base/enumerator_name.hpp"
#include "graze/base/input_error.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "orbit/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Ratio of speeds that counts as growth; largest ratio that counts as agreement with the map.
constexpr double growth = 30, agreement_with_map = 3;

/// Records the largest approach speed at the touched event, or the largest depth beyond it, of the contacts that belong
/// to the touch and not to other contacts of the orbit.
class LargestContact : public Observer {
public:
    /// @param time of the first touch
    LargestContact(const System& system, const CycleMap& map, double start, std::span<const double> parameters,
                   const std::function<bool()>& interrupted)
        : system_(system), map_(map), event_(map.contact.touch.event), start_(start),
          parameters_(parameters.begin(), parameters.end()), interrupted_(interrupted) {}

    void contact(const Contact& contact) override {
        if (contact.event != event_ || contact.kind == ContactKind::touch || !is_new(contact.time))
            return;
        ++contacts_;
        speed_ = std::max(speed_, -contact.rate_before);
    }
    void step(const Step& step) override {
        constexpr int parts = 8;
        for (int part = 1; part <= parts; ++part) {
            const double s = step.length * part / parts;
            if (!is_new(step.start + s))
                continue;
            std::vector<double> inputs;
            for (std::size_t i = 0; i < system_.states(); ++i)
                inputs.push_back(step.state(i, s));
            inputs.insert(inputs.end(), parameters_.begin(), parameters_.end());
            depth_ = std::max(depth_, -system_.event(event_)(inputs)[0]);
        }
    }
    bool stop() override { return interrupted_ && interrupted_(); }

    std::size_t contacts() const { return contacts_; }
    double speed() const { return speed_; }
    double depth() const { return depth_; }

private:
    bool is_new(double time) const { return map_.is_at_touch(time - start_, map_.period); }

    const System& system_;
    const CycleMap& map_;
    std::size_t event_;
    double start_;
    std::vector<double> parameters_;
    const std::function<bool()>& interrupted_;
    std::size_t contacts_ = 0;
    double speed_ = 0, depth_ = 0;
};

/// Simulates motions near one touch.
class TrialExperiment {
public:
    TrialExperiment(const System& system, const CycleMap& map, ParameterId parameter, const TrialOptions& options)
        : simulation_(system, {}, {}, integration(options.tolerance)), map_(map), parameter_(parameter),
          options_(options), compliant_(map.contact.order == MapOrder::three_halves) {
        for (std::size_t i = 0; i < map.contact.touch.state.size(); ++i)
            size_ += std::abs(map.contact.gradient[i]) * map.contact.touch.scales[i];
    }

    /// Scale of the event function.
    double size() const { return size_; }
    bool is_compliant() const { return compliant_; }
    double speed_at(double clearance) const { return std::sqrt(-2 * map_.contact.acceleration * clearance); }
    /// Returns the smallest useful clearance: it must exceed the resolution of the parameter and of the states in
    /// double precision.
    double smallest_clearance_for_trial() const {
        constexpr double digits = 1e-15, enough = 1e3, state_resolution = 1e-10;
        const double parameter = map_.contact.touch.parameters[parameter_.place()];
        return std::max(state_resolution * size_, enough * digits * std::abs(parameter * *map_.clearance_rate));
    }

    /// Simulates the motion that starts on the orbit without contact, near the touch.
    TrialMotion run(double clearance) const {
        const TouchState& touch = map_.contact.touch;
        TrialMotion motion;
        motion.clearance = clearance;
        std::vector<double> parameters = touch.parameters, state = touch.state;
        const double change = clearance / *map_.clearance_rate;
        motion.parameter = parameters[parameter_.place()] += change;
        for (std::size_t i = 0; i < map_.active.size(); ++i)
            state[map_.active[i]] += map_.steady[i] * change;
        // Start before the contact, which precedes the touch by speed over acceleration.
        constexpr double earlier = 3;
        const double early = std::min(earlier * speed_at(clearance) / map_.contact.acceleration, 0.01 * map_.time);
        ModeFlow flow(simulation_.system(), simulation_.options().tolerance);
        flow.set_parameters(parameters);
        if (flow.run(touch.mode, state, -early) != ModeFlow::Ending::done)
            return motion;
        LargestContact largest_contact(simulation_.system(), map_, early, parameters, options_.interrupted);
        Trajectory trajectory(simulation_, parameters, borrowed(largest_contact));
        trajectory.start(state, touch.mode, 0, static_cast<double>(options_.cycles) * map_.time + early);
        JetSet jets(simulation_, LaneKind::single);
        graze::run(trajectory, jets);
        const Ending ending = trajectory.outcome().ending;
        motion.ended = ending == Ending::singular || ending == Ending::terminal;
        motion.followed = motion.ended || ending == Ending::end_time;
        motion.contacts = largest_contact.contacts();
        motion.largest = compliant_ ? largest_contact.depth() : largest_contact.speed();
        if (!map_.exists())
            return motion;
        MapMotionOptions map_options;
        map_options.transient = 0;
        map_options.cycles = options_.cycles;
        motion.predicted = map_motion(map_, clearance, map_options).largest;
        return motion;
    }

private:
    Simulation simulation_;
    const CycleMap& map_;
    ParameterId parameter_;
    const TrialOptions& options_;
    bool compliant_;
    double size_ = 0;
};

Trial with_reason(Trial trial, TrialOutcome outcome, std::string reason) {
    trial.outcome = outcome;
    trial.reason = std::move(reason);
    return trial;
}

bool is_near(double one, double other, double factor) {
    return one <= factor * other && other <= factor * one;
}

/// Checks that the first contact ends every motion.
Trial try_ending(const TrialExperiment& experiment) {
    Trial trial;
    for (const double factor : {1.0, 30.0})
        trial.motions.push_back(experiment.run(-experiment.smallest_clearance_for_trial() * factor));
    const bool all_end = std::ranges::all_of(trial.motions, [](const TrialMotion& motion) { return motion.ended; });
    return with_reason(trial, all_end ? TrialOutcome::agreed : TrialOutcome::contradicted,
                       all_end ? "contact ends the motion" : "contact does not end the motion");
}

/// Checks that contacts grow at every distance, the more the nearer the touch is.
Trial try_loss(const TrialExperiment& experiment, const Verdict& verdict, const TrialOptions& options) {
    Trial trial;
    const double least = experiment.smallest_clearance_for_trial();
    // Contacts grow only up to the reach of the growth. For sliding the reach is unknown; a share of the speed at which
    // the depth equals the scale of the function bounds the neighbourhood.
    const double reach = verdict.reach ? *verdict.reach : 0.1 * experiment.speed_at(-experiment.size());
    const double amplification = reach / experiment.speed_at(-least);
    if (!(amplification > growth))
        return with_reason(trial, TrialOutcome::undecided,
                           fmt::format("from the softest contacts that double precision allows, speeds would grow by "
                                       "a factor of {:.3g} only",
                                       amplification));
    // Number of contacts that the simulation must contain: about seven contacts amplify a tiny speed a thousandfold.
    constexpr std::size_t needed = 12;
    if (verdict.next_contact * needed > options.cycles)
        return with_reason(
            trial, TrialOutcome::undecided,
            fmt::format("contacts come {} cycles after one another: too many to be simulated", verdict.next_contact));
    bool all_grow = true, none_grows = true, followed = true;
    for (const double factor : {1.0, 30.0}) {
        trial.motions.push_back(experiment.run(-least * factor));
        const TrialMotion& motion = trial.motions.back();
        const double grown = motion.largest / experiment.speed_at(motion.clearance);
        const double expected = std::min(growth, 0.3 * motion.predicted / experiment.speed_at(motion.clearance));
        const bool grows = motion.ended || grown > expected;
        followed = followed && (grows || motion.followed);
        all_grow = all_grow && grows;
        none_grows = none_grows && !grows;
    }
    if (all_grow)
        return with_reason(trial, TrialOutcome::agreed, "contacts grow however near the touch is");
    if (none_grows && followed)
        return with_reason(trial, TrialOutcome::contradicted, "contacts do not grow");
    return with_reason(trial, TrialOutcome::undecided,
                       followed ? "contacts grow from one distance only"
                                : "motions could not be followed to their end");
}

/// Checks that speeds or depths agree with the map and shrink with the distance.
Trial try_persistence(const TrialExperiment& experiment) {
    Trial trial;
    constexpr double nearer = 100;
    const double first = experiment.smallest_clearance_for_trial();
    for (const double factor : {nearer, 1.0})
        trial.motions.push_back(experiment.run(-first * factor));
    const TrialMotion& far = trial.motions[0];
    const TrialMotion& near = trial.motions[1];
    if (!near.ended && !near.followed)
        return with_reason(trial, TrialOutcome::undecided, "the motion could not be followed to its end");
    // Speeds scale with the square root of the distance, depths of compliant contacts with the distance.
    const double shrunk = experiment.is_compliant() ? nearer : std::sqrt(nearer);
    const bool shrinks = is_near(far.largest, shrunk * near.largest, agreement_with_map);
    if (!far.ended && !near.ended && near.contacts > 0 && shrinks &&
        is_near(near.largest, near.predicted, agreement_with_map))
        return with_reason(trial, TrialOutcome::agreed, "contact speeds agree with the map");
    if (near.contacts > 0 && near.largest * agreement_with_map > far.largest)
        return with_reason(trial, TrialOutcome::contradicted, "contacts do not grow softer towards the touch");
    if (!far.ended && !near.ended && near.contacts == 0)
        return with_reason(trial, TrialOutcome::undecided, "no contacts are seen so near the touch");
    if (near.ended || near.largest > growth * near.predicted)
        return with_reason(trial, TrialOutcome::contradicted, "contacts are much harder than the map predicts");
    return with_reason(trial, TrialOutcome::undecided, "contacts are neither as the map predicts nor much harder");
}

std::vector<MotionBeyond> motions_beyond(const CycleMap& map, const Verdict& verdict, ParameterId parameter) {
    if (verdict.outcome != GrazingOutcome::persists || map.contact.order != MapOrder::square_root ||
        !map.clearance_rate || *map.clearance_rate == 0)
        return {};
    double size = 0;
    for (std::size_t i = 0; i < map.gradient.size(); ++i)
        size += std::abs(map.gradient[i]) * map.scales[i];
    const double value = map.contact.touch.parameters[parameter.place()];
    std::vector<MotionBeyond> motions;
    for (const int digits : {3, 5, 7}) {
        const double clearance = -size * std::pow(10.0, -digits);
        motions.push_back({digits, value + clearance / *map.clearance_rate, map_motion(map, clearance)});
    }
    return motions;
}

} // namespace

void TrialOptions::validate() const {
    if (cycles == 0 || cycles > 1'000'000)
        throw InputError(fmt::format("{} cycles are not possible", cycles), "give 1 to 1000000");
    require_tolerance_in_range(tolerance);
}

std::string_view name_of(TrialOutcome outcome) {
    constexpr std::string_view names[] = {"agreed", "contradicted", "undecided"};
    return enumerator_name(names, outcome, "undecided");
}

Trial try_verdict(const System& system, const CycleMap& map, const Verdict& verdict, ParameterId parameter,
                  const TrialOptions& options) {
    options.validate();
    Trial trial;
    if (verdict.outcome == GrazingOutcome::undecided)
        return with_reason(trial, TrialOutcome::undecided, "there is no verdict to be checked: " + verdict.reason);
    if (!map.clearance_rate || !(std::abs(*map.clearance_rate) > 0))
        return with_reason(trial, TrialOutcome::undecided, "no parameter is known that moves the orbit from its touch");
    if (map.contact.touch.state.size() != system.states() || map.contact.touch.parameters.size() != system.parameters())
        throw InputError("the map belongs to another model", "give the system that it was made from");
    const TrialExperiment experiment(system, map, parameter, options);
    if (map.contact.ends)
        return try_ending(experiment);
    return verdict.outcome == GrazingOutcome::lost ? try_loss(experiment, verdict, options)
                                                   : try_persistence(experiment);
}

TouchReport touch_report(const System& system, const CycleMap& map, std::optional<ParameterId> parameter, bool verify,
                         const TrialOptions& options) {
    TouchReport report;
    report.verdict = verdict_of(map);
    if (verify && !parameter)
        throw InputError("no parameter is given that moves the orbit from its touch", "name a parameter that does");
    if (verify)
        report.trial = try_verdict(system, map, report.verdict, *parameter, options);
    if (parameter)
        report.beyond = motions_beyond(map, report.verdict, *parameter);
    return report;
}

} // namespace graze
