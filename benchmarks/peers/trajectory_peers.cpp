#include "trajectory_peers.hpp"

#include "../testbed.hpp"
#include "heyoka_peer.hpp"
#include "hybrid_case.hpp"
#include "reference.hpp"

#include "graze/trajectory/ensemble.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace peers {

namespace {

using State = HeyokaPeer::State;
using Columns = std::vector<State>; ///< derivatives, nondimensional, for each direction

constexpr std::array tolerances = {1e-8, 1e-14};
constexpr int run_periods = 30;       ///< of one run, which both repeat from the same state
constexpr int derivative_periods = 3; ///< later, derivatives on the stable orbit have decayed
/// Inputs of derivatives in the order of HeyokaPeer.
const std::array<std::string, HeyokaPeer::most_directions> inputs = {"q", "v", "I", "theta", "V0", "zeta", "R", "Ll"};

double largest_difference(const State& a, const State& b) {
    double result = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        result = std::max(result, std::abs(a[k] - b[k]));
    return result;
}

/// The motion that all follow: on the period-3 orbit, from a phase where neither section nor impact is near.
class Course {
public:
    explicit Course(int periods) : one(testbed_case(periods)), start(nondimensional(one.start)), phase(one.start[3]) {
        // Of each input in the order of `inputs`.
        const std::array<double, 4> numbers = {groups.voltage, groups.damping, groups.resistance, groups.inductance};
        input_units.assign(one.units.begin(), one.units.end());
        for (std::size_t p = 0; p < numbers.size(); ++p)
            input_units.push_back(one.model.values_of(std::vector{one.model.symbol(inputs[input_units.size()])})[0] /
                                  numbers[p]);
    }

    State nondimensional(std::span<const double> state) const {
        return {state[0] / one.units[0], state[1] / one.units[1], state[2] / one.units[2]};
    }
    double duration() const { return one.duration / one.time_unit; } ///< nondimensional

    /// Starts the reference at another voltage, or the orbit's.
    Reference reference(const Motions& motions) const {
        Reference result(*motions.exact, static_cast<Reference::Real>(one.longest_step) / one.time_unit);
        result.begin({start[0], start[1], start[2], phase}, one.mode);
        return result;
    }

    Testbed testbed;
    OdeintPeer::Parameters groups = testbed.groups();
    HybridCase one;
    State start;
    double phase;
    std::vector<double> input_units;
};

State state_of(const Reference& reference) {
    return {static_cast<double>(reference.state(0)), static_cast<double>(reference.state(1)),
            static_cast<double>(reference.state(2))};
}

/// States of the reference at all sections and at the end, and derivatives there.
struct Truth {
    std::vector<State> sections;
    State end;
    Columns columns;
    std::size_t impacts = 0;

    explicit Truth(const Course& course) {
        Reference reference = course.reference(course.one.motions);
        const auto half_turn = static_cast<Reference::Real>(std::numbers::pi_v<Reference::Real>);
        const auto duration = static_cast<Reference::Real>(course.one.duration) / course.one.time_unit;
        for (int count = 1;; ++count) {
            const Reference::Real time = (count * half_turn - course.phase) / course.groups.frequency;
            if (time >= duration)
                break;
            reference.advance(time);
            sections.push_back(state_of(reference));
        }
        reference.advance(duration);
        end = state_of(reference);
        impacts = reference.meetings.size();
        constexpr std::size_t known = 5; // the four states and the voltage
        for (std::size_t d = 0; d < known; ++d)
            columns.push_back({static_cast<double>(reference.derivative(0, d)),
                               static_cast<double>(reference.derivative(1, d)),
                               static_cast<double>(reference.derivative(2, d))});
    }
};

/// What graze tells during a run.
struct Told : graze::Observer {
    std::size_t impacts = 0;
    std::vector<State> passages;
    void contact(const graze::Contact& contact) override {
        impacts += contact.kind == graze::ContactKind::crossing ? 1 : 0;
    }
    void passage(const graze::Passage& passage) override {
        passages.push_back({passage.state[0], passage.state[1], passage.state[2]});
    }
};

std::vector<graze::Probe> probes_of(const graze::Model& model, HeyokaOutput output) {
    std::vector<graze::Probe> result;
    if (output != HeyokaOutput::none)
        for (const char* section : {"phase0", "phasepi"})
            result.push_back(graze::section_probe(model, section));
    if (output == HeyokaOutput::extrema)
        result.push_back(graze::section_probe(model, "nearest"));
    return result;
}

/// Runs of graze with the interface of HeyokaPeer.
class GrazeRun {
public:
    GrazeRun(const Course& course, double tolerance, HeyokaOutput output, std::size_t directions = 0)
        : course_(&course), simulation_(graze::System(course.one.model), probes_of(course.one.model, output), {},
                                        {.tolerance = tolerance}),
          jets_(simulation_, graze::LaneKind::single),
          trajectory_(simulation_, course.one.model.parameter_values(), borrowed(told_)),
          inputs_(inputs.begin(), inputs.begin() + static_cast<std::ptrdiff_t>(directions)) {}
    GrazeRun(const GrazeRun&) = delete;
    GrazeRun& operator=(const GrazeRun&) = delete;

    void run() {
        told_.impacts = 0;
        told_.passages.clear();
        trajectory_.start(course_->one.start, course_->one.mode, 0, course_->one.duration);
        if (!inputs_.empty())
            trajectory_.carry_derivatives(inputs_);
        graze::run(trajectory_, jets_);
        if (trajectory_.outcome().ending != graze::Ending::end_time)
            throw std::runtime_error("graze does not reach the end: " + trajectory_.outcome().detail);
    }

    State state() const { return course_->nondimensional(trajectory_.state()); }
    std::size_t steps() const { return trajectory_.steps(); }
    std::size_t impacts() const { return told_.impacts; }
    std::vector<State> passages() const {
        std::vector<State> result;
        for (const State& passage : told_.passages)
            result.push_back(course_->nondimensional(passage));
        return result;
    }
    double derivative(std::size_t state, std::size_t direction) const {
        return trajectory_.derivative(state, direction) * course_->input_units[direction] / course_->one.units[state];
    }

private:
    const Course* course_;
    graze::Simulation simulation_;
    graze::JetSet jets_;
    Told told_;
    graze::Trajectory trajectory_;
    std::vector<std::string> inputs_;
};

/// The fastest of heyoka's choices, made ready.
template <class Peer>
struct Fastest {
    HeyokaChoice choice;
    std::unique_ptr<Peer> peer;
};

/// @param make returns a peer for a choice; @param run runs it; @param quick true: takes the first choice
template <class Peer, class Make, class Run>
Fastest<Peer> fastest_of(std::span<const HeyokaChoice> choices, bool quick, Make&& make, Run&& run) {
    Fastest<Peer> result;
    double least = INFINITY;
    for (const HeyokaChoice choice : choices.first(quick ? 1 : choices.size())) {
        auto peer = std::make_unique<Peer>(make(choice));
        constexpr double budget = 0.1;
        const double time = least_seconds(budget, [&] { run(*peer); });
        if (time < least) {
            least = time;
            result = {choice, std::move(peer)};
        }
    }
    return result;
}

/// Runs of heyoka along the course.
class HeyokaRun {
public:
    HeyokaRun(const Course& course, double tolerance, HeyokaOutput output, bool quick, std::size_t directions = 0)
        : fastest_(fastest_of<HeyokaPeer>(
              choices, quick,
              [&](HeyokaChoice choice) { return HeyokaPeer(course.groups, tolerance, output, choice, directions); },
              [&](HeyokaPeer& peer) { peer.run(course.start, course.phase, course.duration()); })) {}

    void run(const Course& course) { fastest_.peer->run(course.start, course.phase, course.duration()); }
    const HeyokaPeer& peer() const { return *fastest_.peer; }
    HeyokaChoice choice() const { return fastest_.choice; }

private:
    static constexpr std::array choices = {HeyokaChoice{false, true}, HeyokaChoice{false, false},
                                           HeyokaChoice{true, true}, HeyokaChoice{true, false}};
    Fastest<HeyokaPeer> fastest_;
};

/// The error at the end, and at the sections if they are told.
template <class Run>
double error_of(const Run& run, const Truth& truth, HeyokaOutput output) {
    double error = largest_difference(run.state(), truth.end);
    if (run.impacts() != truth.impacts)
        return INFINITY;
    if (output != HeyokaOutput::sections && output != HeyokaOutput::grid)
        return error;
    const std::vector<State> passages = run.passages();
    if (passages.size() != truth.sections.size())
        return INFINITY;
    for (std::size_t i = 0; i < passages.size(); ++i)
        error = std::max(error, largest_difference(passages[i], truth.sections[i]));
    return error;
}

/// Alternates two runs until they have taken the budget of seconds.
template <class Own, class Peer>
PairedTiming alternate(double budget, Own&& own, Peer&& peer) {
    PairedTiming timing(Clock::processor);
    const double end = read_clock(Clock::processor) + budget;
    do
        timing.round(own, peer);
    while (read_clock(Clock::processor) < end);
    return timing;
}

void print_head(const char* title) {
    std::printf("\n%s\n\n| output | tolerance | graze, periods/s | heyoka, periods/s | ratio | error, graze | error, "
                "heyoka | steps a period | heyoka with |\n|---|---|---|---|---|---|---|---|---|\n",
                title);
}

void print_row(const std::string& what, double tolerance, int periods, const PairedTiming& timing, double error,
               double peer_error, const std::string& steps, const HeyokaChoice& choice) {
    std::printf("| %s | %.0e | %.3g | %.3g | %.3f | %.1e | %.1e | %s | %s |\n", what.c_str(), tolerance,
                periods / timing.own(), periods / timing.peer(), timing.peer() / timing.own(), error, peer_error,
                steps.c_str(), choice.name().c_str());
    std::fflush(stdout);
}

struct NamedOutput {
    HeyokaOutput output;
    const char* name;
};
constexpr std::array outputs = {NamedOutput{HeyokaOutput::none, "none"},
                                NamedOutput{HeyokaOutput::sections, "two sections, as events"},
                                NamedOutput{HeyokaOutput::grid, "two sections, whose times heyoka is told"},
                                NamedOutput{HeyokaOutput::extrema, "two sections, and maxima of the displacement"}};

void compare_one(const Course& course, double budget, bool quick) {
    const Truth truth(course);
    print_head("One trajectory on the period-3 orbit; errors after 30 periods and at all sections");
    for (const auto& [output, name] : outputs) {
        for (const double tolerance : tolerances) {
            GrazeRun own(course, tolerance, output);
            HeyokaRun heyoka(course, tolerance, output, quick);
            const PairedTiming timing = alternate(
                budget, [&] { own.run(); }, [&] { heyoka.run(course); });
            if (own.passages().size() != heyoka.peer().passages().size())
                throw std::runtime_error("graze and heyoka find different numbers of passages");
            print_row(name, tolerance, run_periods, timing, error_of(own, truth, output),
                      error_of(heyoka.peer(), truth, output),
                      std::to_string(own.steps() / run_periods) + ", " +
                          std::to_string(heyoka.peer().steps() / run_periods),
                      heyoka.choice());
        }
    }
}

/// Both at many tolerances, and their speeds at equal error, the largest at all sections.
void compare_at_equal_error(const Course& course, double budget, bool quick) {
    constexpr HeyokaOutput output = HeyokaOutput::grid;
    constexpr std::array levels = {1e-7, 1e-9, 1e-11, 1e-13};
    constexpr int loosest = 5, tightest = 15; // powers of the tolerances
    const Truth truth(course);
    std::vector<Effort> own, peer;
    for (int power = loosest; power <= tightest; ++power) {
        const double tolerance = std::pow(10.0, -power);
        GrazeRun run(course, tolerance, output);
        HeyokaRun heyoka(course, tolerance, output, quick);
        const PairedTiming timing = alternate(
            0.5 * budget, [&] { run.run(); }, [&] { heyoka.run(course); });
        own.push_back({tolerance, timing.own(), error_of(run, truth, output)});
        peer.push_back({tolerance, timing.peer(), error_of(heyoka.peer(), truth, output)});
    }
    std::printf("\nOne trajectory with two sections, whose times heyoka is told, at equal error at all sections\n\n"
                "| error | graze, periods/s | heyoka, periods/s | ratio |\n|---|---|---|---|\n");
    for (const double level : levels) {
        const auto seconds = seconds_at(own, level), other = seconds_at(peer, level);
        if (seconds && other)
            std::printf("| %.0e | %.3g | %.3g | %.3f |\n", level, run_periods / *seconds, run_periods / *other,
                        *other / *seconds);
        else
            std::printf("| %.0e | %s | %s | - |\n", level, seconds ? "reached" : "-", other ? "reached" : "-");
    }
}

/// What outputs cost in each program by itself: the remaining share of its speed.
void compare_costs(const Course& course, double budget, bool quick) {
    std::printf("\nShare of its own speed that each program keeps with more output\n\n| output | tolerance | graze | "
                "heyoka |\n|---|---|---|---|\n");
    for (const auto& [output, name] : outputs) {
        if (output == HeyokaOutput::none)
            continue;
        for (const double tolerance : tolerances) {
            GrazeRun plain(course, tolerance, HeyokaOutput::none), more(course, tolerance, output);
            HeyokaRun peer_plain(course, tolerance, HeyokaOutput::none, quick),
                peer_more(course, tolerance, output, quick);
            const PairedTiming own = alternate(
                budget, [&] { more.run(); }, [&] { plain.run(); });
            const PairedTiming peer = alternate(
                budget, [&] { peer_more.run(course); }, [&] { peer_plain.run(course); });
            std::printf("| %s | %.0e | %.3f | %.3f |\n", name, tolerance, own.peer() / own.own(),
                        peer.peer() / peer.own());
            std::fflush(stdout);
        }
    }
}

/// Trajectories at many voltages by graze's Ensemble.
class GrazeGroup {
public:
    GrazeGroup(const Course& course, std::span<const double> voltages, double tolerance)
        : course_(&course), simulation_(graze::System(course.one.model), {}, {}, {.tolerance = tolerance}),
          ensemble_(simulation_), told_(voltages.size()) {
        graze::Model model = course.one.model;
        for (std::size_t i = 0; i < voltages.size(); ++i) {
            model.set_parameter("V0", voltages[i] * course.one.parameter_unit);
            trajectories_.emplace_back(simulation_, model.parameter_values(), borrowed(told_[i]));
        }
    }
    GrazeGroup(const GrazeGroup&) = delete;
    GrazeGroup& operator=(const GrazeGroup&) = delete;

    void run() {
        for (graze::Trajectory& trajectory : trajectories_)
            trajectory.start(course_->one.start, course_->one.mode, 0, course_->one.duration);
        ensemble_.run(trajectories_);
    }
    State state(std::size_t i) const { return course_->nondimensional(trajectories_[i].state()); }

private:
    const Course* course_;
    graze::Simulation simulation_;
    graze::Ensemble ensemble_;
    std::vector<Told> told_;
    std::vector<graze::Trajectory> trajectories_;
};

void compare_ensembles(const Course& course, double budget, bool quick) {
    constexpr std::size_t count = 64, every = 8;
    constexpr double spread = 0.01; // of the voltage, in volts
    std::vector<double> voltages;
    for (std::size_t i = 0; i < count; ++i)
        voltages.push_back(course.groups.voltage + spread * static_cast<double>(i) / count / course.one.parameter_unit);
    std::vector<State> truth;
    for (std::size_t i = 0; i < count; i += every) {
        OdeintPeer::Parameters groups = course.groups;
        groups.voltage = voltages[i];
        const Motions motions = testbed_motions(groups);
        Reference reference = course.reference(motions);
        reference.advance(static_cast<Reference::Real>(course.one.duration) / course.one.time_unit);
        truth.push_back(state_of(reference));
    }
    print_head("64 trajectories at voltages near that of the orbit: graze's Ensemble and heyoka's batches of 8; errors "
               "after 30 periods");
    constexpr std::array choices = {HeyokaChoice{.rotating_phase = false}, HeyokaChoice{.rotating_phase = true}};
    for (const double tolerance : tolerances) {
        GrazeGroup own(course, voltages, tolerance);
        const auto run_peer = [&](HeyokaEnsemble& ensemble) {
            ensemble.run(course.start, course.phase, voltages, course.duration());
        };
        const auto [choice, peer] = fastest_of<HeyokaEnsemble>(
            choices, quick, [&](HeyokaChoice tried) { return HeyokaEnsemble(course.groups, tolerance, tried); },
            run_peer);
        const PairedTiming timing = alternate(
            budget, [&] { own.run(); }, [&] { run_peer(*peer); });
        double error = 0, peer_error = 0;
        for (std::size_t i = 0; i < truth.size(); ++i) {
            error = std::max(error, largest_difference(own.state(every * i), truth[i]));
            peer_error = std::max(peer_error, largest_difference(peer->states()[every * i], truth[i]));
        }
        print_row("none", tolerance, run_periods * static_cast<int>(count), timing, error, peer_error, "-", choice);
    }
}

template <class Run>
Columns columns_of(const Run& run, std::size_t directions) {
    Columns result;
    for (std::size_t d = 0; d < directions; ++d)
        result.push_back({run.derivative(0, d), run.derivative(1, d), run.derivative(2, d)});
    return result;
}

/// The largest difference of columns that both have, each relative to the size of the second.
double distance(const Columns& a, const Columns& b) {
    double result = 0;
    for (std::size_t d = 0; d < std::min(a.size(), b.size()); ++d)
        result = std::fmax(result, largest_difference(a[d], b[d]) / largest_difference(b[d], {}));
    return result;
}

void compare_derivatives_of_both(const Course& course, double budget, bool quick) {
    const Course brief(derivative_periods);
    const Truth truth(brief);
    std::printf(
        "\nDerivatives: share of the motion's speed, and heyoka's time with them divided by graze's; errors after "
        "%d periods, by states and voltage; last, how far apart both are by all inputs\n\n| inputs | tolerance | "
        "graze | heyoka | ratio | error, graze | error, heyoka | apart |\n|---|---|---|---|---|---|---|---|\n",
        derivative_periods);
    for (const std::size_t directions : {1, 7, 8}) {
        for (const double tolerance : tolerances) {
            GrazeRun plain(course, tolerance, HeyokaOutput::none),
                more(course, tolerance, HeyokaOutput::none, directions),
                short_run(brief, tolerance, HeyokaOutput::none, directions);
            HeyokaRun peer_plain(course, tolerance, HeyokaOutput::none, quick),
                peer(course, tolerance, HeyokaOutput::none, true, directions);
            const PairedTiming own = alternate(
                budget, [&] { more.run(); }, [&] { plain.run(); });
            const PairedTiming other = alternate(
                budget, [&] { peer.run(course); }, [&] { peer_plain.run(course); });
            const PairedTiming both = alternate(
                budget, [&] { more.run(); }, [&] { peer.run(course); });
            short_run.run();
            peer.run(brief);
            const Columns columns = columns_of(short_run, directions),
                          peer_columns = columns_of(peer.peer(), directions);
            std::printf("| %zu | %.0e | %.3f | %.3f | %.3g | %.1e | %.1e | %.1e |\n", directions, tolerance,
                        own.peer() / own.own(), other.peer() / other.own(), both.peer() / both.own(),
                        distance(columns, truth.columns), distance(peer_columns, truth.columns),
                        distance(peer_columns, columns));
            std::fflush(stdout);
        }
    }
}

} // namespace

void compare_trajectories(bool quick) {
    const double budget = quick ? 0.05 : 2;
    const Course course(run_periods);
    compare_one(course, budget, quick);
    compare_at_equal_error(course, budget, quick);
    compare_ensembles(course, budget, quick);
    compare_costs(course, budget, quick);
    compare_derivatives_of_both(course, budget, quick);
}

} // namespace peers
